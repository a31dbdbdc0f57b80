"""The report as text: one self-contained file, the same study as the same bytes."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from pldf.analysis.analysis import analyse
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.report.contents import Contents, collect
from pldf.report.page import report_of


def test_the_same_study_gives_the_same_bytes(html: str, folder: Path) -> None:
    again = collect(analyse(StudyFolder(folder)), StudyFolder(folder))
    assert report_of(again) == html


def test_numbers_texts_and_parameters(html: str, contents: Contents) -> None:
    combined = contents.analysis.comparisons["combined"]
    for text in (
        "<title>Three &lt;people&gt;</title>",
        "3 simulated drivers, 18 drives",
        f"{100 * combined.mean_first:.1f} %",
        "p = 9.78 · 10<sup>&minus;8</sup>",
        "t(42) = 6.42",
        "learning.stretch_factor",
        "body.mass_kg",
        "wish.offset_mps",
        "count = 3",
        "<th>Satisfying (&minus;2 … +2)</th><td>3</td><td>&minus;1.00</td><td>1.17</td>",
    ):
        assert text in html, text


def test_nothing_of_a_study_is_taken_for_html(contents: Contents) -> None:
    hostile = "</title><script>alert(1)</script>"
    texts = {**contents.texts, "study.toml": hostile}
    assert contents.driver is not None
    driver = replace(contents.driver, participant=hostile)
    page = report_of(replace(contents, title=hostile, texts=texts, driver=driver))
    assert "alert(1)</script>" not in page
    assert page.count("&lt;script&gt;alert(1)") >= 5  # title, headings, caption, text


def test_the_page_names_no_other_file(html: str) -> None:
    own = re.sub(r"<script>.*?</script>", "", html, flags=re.DOTALL)
    assert not re.findall(r'(?:src|href)="(?!#)[^"]*"|@import|url\(', own)


def test_a_study_without_recordings_has_a_report(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(folder / "drives.csv", tmp_path)
    report = tmp_path / "report.html"
    assert main(["analyse", str(tmp_path), "--report", str(report)]) == 0
    assert f"Report: {report}" in capsys.readouterr().out
    text = report.read_text(encoding="utf-8")
    assert "3 recorded participants" in text
    assert "no recordings" in text


def test_a_report_without_spread_and_with_missing_answers(tmp_path: Path) -> None:
    lines = ["participant,phase,pedal_rate,set_speed_rate,combined_rate"]
    for who, a in (("P1", 0.3), ("P2", 0.4), ("P3", 0.7)):
        b = a - 0.1
        lines += [f"{who},{phase},{a},{a},{a}" for phase in ("A1", "A2")]
        lines += [f"{who},{phase},{b:.1f},{b:.1f},{b:.1f}" for phase in ("B1", "B2")]
    (tmp_path / "drives.csv").write_text("\n".join(lines))
    answers = ["participant,system,laan_2,laan_4,laan_6,laan_8"]
    answers += ["P1,A,4,4,2,2", "P1,B,2,2,4,5", "P2,A,3,4,2,3", "P2,B,2,1,5,4"]
    answers += ["P3,A,5,4,1,2", "P3,B,3,NA,,4"]
    (tmp_path / "questionnaire.csv").write_text("\n".join(answers))
    report = tmp_path / "report.html"
    assert main(["analyse", str(tmp_path), "--report", str(report)]) == 0
    text = report.read_text(encoding="utf-8")
    assert "t(2): no spread, all differences are the same" in text
    assert text.count("<td>no spread</td>") == 3  # d_z of the three rates
    assert "<th>Satisfying (&minus;2 … +2)</th><td>2</td>" in text
    assert ", n = 5</td>" in text  # alpha
    told = "line 7, participant P3, system B: 2 of 4 items of satisfying not answered"
    assert told in text
    assert str(tmp_path) not in re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)


def test_plotly_brings_its_licence(html: str) -> None:
    assert re.search(r"plotly\.js v[\d.]+\s.{0,200}Licensed under the MIT license", html, re.S)
