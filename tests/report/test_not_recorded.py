"""A laboratory that did not record what the function followed: only what is known is drawn."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from driven_study import driven_study, laboratory_of, recording_of
from pldf.analysis.analysis import analyse
from pldf.analysis.study_folder import StudyFolder
from pldf.report.contents import Contents, collect
from pldf.report.figures.study import study_figures
from pldf.report.page import report_of
from pldf.report.paper import drawn
from pldf.roads import open_route


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return driven_study(tmp_path_factory)


@pytest.fixture
def laboratory(driven: Path, tmp_path: Path) -> Path:
    lacking = ("profile_mps", "base_mps", "limit_mps")
    return laboratory_of(driven, tmp_path / "laboratory", *lacking)


def shown(study: StudyFolder) -> Contents:
    return collect(analyse(study), study, "P001")


def lines(contents: Contents, figure: str) -> list[str]:
    scene = study_figures(contents)[figure]
    return [getattr(part, "label", "") for panel in scene.panels for part in panel.elements]


def test_what_was_followed_in_b_is_left_out_and_said(laboratory: Path) -> None:
    contents = shown(StudyFolder(laboratory, open_route("study")))
    assert contents.driver is not None
    assert contents.driver.not_known == ("B1", "B2", "B3")
    assert contents.driver.profile.iterations == ()
    figures = study_figures(contents)
    assert "development" not in figures
    assert "Learned profile, followed" not in lines(contents, "drives")
    titles = [panel.title for panel in figures["drives"].panels if panel.title]
    left_out = ["(not known: profile followed)" in title for title in titles]
    assert left_out == [False] * 2 + [True] * 2
    page = report_of(contents)
    assert "Not known, so left out: the profile followed in B1, B2 and B3." in page
    assert "What the function learned from P001" not in page
    printed = "".join(text.get_text() for text in drawn(figures["drives"]).findobj(match=_is_text))
    assert printed.count("not known: profile followed") == 2


def test_with_learned_profiles_it_is_drawn_as_it_was(driven: Path, laboratory: Path) -> None:
    study = StudyFolder(laboratory, open_route("study"), profiles=driven / "profiles")
    contents = shown(study)
    assert contents.driver is not None
    assert contents.driver.not_known == ()
    assert [one.note for one in contents.driver.profile.iterations] == ["A2", "B1", "B2"]
    for number, seen in enumerate(("B1", "B2", "B3"), start=1):
        whole = recording_of(driven, "P001", seen)
        learned = contents.driver.profile.iteration(number).learned_mps
        expected = np.interp(np.arange(float(len(learned))), whole["s_m"], whole["profile_mps"])
        inside = slice(0, int(whole["s_m"][-1]) - 5)
        assert np.max(np.abs(learned[inside] - expected[inside])) < 0.05
        assert np.max(np.abs(learned - contents.driver.profile.base_mps)) > 1.0
    assert "Learned profile, followed" in lines(contents, "drives")
    assert "Not known" not in report_of(contents)


def test_a_study_with_known_rates_shows_drives_whose_set_speed_is_not_known(
    driven: Path, tmp_path: Path
) -> None:
    folder = laboratory_of(
        driven, tmp_path / "rates", "profile_mps", "base_mps", "limit_mps", "set_speed_offset_mps"
    )
    (folder / "drives.csv").write_bytes((driven / "drives.csv").read_bytes())
    contents = shown(StudyFolder(folder, open_route("study")))
    panels = study_figures(contents)["drives"].panels
    titles = [panel.title for panel in panels if panel.title]
    assert titles[0].count("not known") == 0
    assert "(not known: profile followed, where the driver set the speed)" in titles[2]
    assert "where the driver set the speed in B1, B2" in report_of(contents)


def test_the_report_quotes_what_was_left_out(driven: Path, tmp_path: Path) -> None:
    folder = laboratory_of(driven, tmp_path / "excluded")
    (folder / "exclusions.csv").write_text(
        "participant,phase,reason\nP002,B1,simulator <sickness>\n"
    )
    study = StudyFolder(folder, open_route("study"), frozenset({"P003_A3"}))
    page = re.sub(r"\s+", " ", report_of(shown(study)))
    assert "<th>P002</th><td>B1</td><td>simulator &lt;sickness&gt;</td>" in page
    assert "exclusions.csv, line 2" in page
    assert "<th>P003_A3</th><td>all</td><td>no reason was given</td><td>--without</td>" in page
    assert "participant P002: B1 left out, so B is the mean of B2" in page
    assert str(folder) not in page


def _is_text(artist: object) -> bool:
    return hasattr(artist, "get_text")
