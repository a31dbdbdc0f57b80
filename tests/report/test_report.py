"""The report, from a small simulated study, in a real browser."""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pldf.analysis.analysis import StudyFolder, analyse
from pldf.cli import main
from pldf.instance import ModelError
from pldf.report import paper
from pldf.report.contents import Contents, collect
from pldf.report.figures.study import study_figures
from pldf.report.page import report_of
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

STUDY = """title = "Three <people>"
[participants]
count = 3
seed = 4
[recordings]
participants = ["P001"]
"""
LONG_RUN = """stretch_factor,drive,pedal_percent,combined_percent,content_percent,wish_error_kmh
0,1,22,50,0,9
0,2,12,24,10,6
0.5,1,22,50,0,9
0.5,2,10,20,20,5
"""
# Satisfying items alone: A is annoying, B nice.
QUESTIONNAIRE = """participant,system,laan_2,laan_4,laan_6,laan_8
P001,A,4,4,2,2
P001,B,2,2,4,5
P002,A,3,4,2,3
P002,B,2,1,5,4
P003,A,5,4,1,2
P003,B,3,2,4,4
"""
REQUEST = "Network.requestWillBeSent"
FIGURES = ("rates", "compared", "drives", "development", "steps", "long_run", "base")
BROWSER_FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-component-update",
    "--disable-background-networking", "--disable-sync", "--disable-dev-shm-usage",
    "--window-size=1200,1000",
)  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of three simulated drivers, the first one recorded."""
    out = tmp_path_factory.mktemp("study")
    (out / "three.toml").write_text(STUDY)
    assert main(["study", str(out / "three.toml"), "--out", str(out / "out"), "--jobs", "1"]) == 0
    (out / "out" / "long_run.csv").write_text(LONG_RUN)
    (out / "out" / "questionnaire.csv").write_text(QUESTIONNAIRE)
    return out / "out"


@pytest.fixture(scope="module")
def contents(folder: Path) -> Contents:
    return collect(analyse(StudyFolder(folder)), StudyFolder(folder))


@pytest.fixture(scope="module")
def html(contents: Contents) -> str:
    return report_of(contents)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    driver = shutil.which("chromedriver")
    if driver is None:
        assert not os.environ.get("CI"), "CI tests the report in a browser: install chromedriver"
        pytest.skip("no chromedriver: apt-get install chromium-driver")
    options = webdriver.ChromeOptions()
    for flag in (*BROWSER_FLAGS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    window = webdriver.Chrome(options=options, service=Service(driver))
    yield window
    window.quit()


@pytest.fixture(scope="module")
def page(browser: webdriver.Chrome, html: str, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(html, encoding="utf-8")
    browser.get(path.as_uri())
    wait(browser, "document.querySelectorAll('.plotly-graph-div .main-svg').length >= 7")
    return browser


def wait(window: webdriver.Chrome, condition: str) -> None:
    end = time.monotonic() + 30.0
    while not window.execute_script(f"return {condition}"):
        assert time.monotonic() < end, condition
        time.sleep(0.05)


def test_the_page_opens_without_errors_and_without_network(page: webdriver.Chrome) -> None:
    assert [entry["message"] for entry in page.get_log("browser")] == []
    asked = [
        event["params"]["request"]["url"]
        for entry in page.get_log("performance")
        if (event := json.loads(entry["message"])["message"])["method"] == REQUEST
        and event["params"]["documentURL"] == page.current_url
    ]
    assert [url for url in asked if not url.startswith(("data:", "blob:"))] == [page.current_url]


def test_every_figure_is_drawn(page: webdriver.Chrome) -> None:
    shown = page.find_elements(By.CSS_SELECTOR, ".plotly-graph-div")
    assert [figure.get_attribute("id") for figure in shown] == [f"figure-{n}" for n in FIGURES]
    for figure in shown:
        assert figure.size["height"] > 300
        lines = figure.find_elements(By.CSS_SELECTOR, ".trace.scatter path")
        drawn = [line for line in lines if len(line.get_attribute("d") or "") > 20]
        assert len(drawn) >= 2, figure.get_attribute("id")


def test_the_legend_hides_and_shows_a_drive(page: webdriver.Chrome) -> None:
    entry = "#figure-compared .legend .traces"
    names = [e.text for e in page.find_elements(By.CSS_SELECTOR, entry)]
    at = names.index("Speed driven in A2")
    visible = (
        "document.getElementById('figure-compared')._fullData"
        ".find((trace) => trace.name === 'Speed driven in A2').visible"
    )
    assert page.execute_script(f"return {visible}") is True
    toggle = page.find_elements(By.CSS_SELECTOR, f"{entry} .legendtoggle")[at]
    page.execute_script("arguments[0].scrollIntoView({block: 'center'})", toggle)
    toggle.click()
    wait(page, f"{visible} === 'legendonly'")
    time.sleep(0.5)  # two clicks in quick succession mean something else
    page.find_elements(By.CSS_SELECTOR, f"{entry} .legendtoggle")[at].click()
    wait(page, f"{visible} === true")


def test_the_buttons_show_an_intervention_step_by_step(page: webdriver.Chrome) -> None:
    buttons = page.find_elements(By.CSS_SELECTOR, "#figure-steps .updatemenu-button")
    assert [button.text for button in buttons] == [
        "1 recorded", "2 stretched", "3 offset", "4 mean", "5 smoothed",
    ]  # fmt: skip
    page.execute_script("arguments[0].scrollIntoView({block: 'center'})", buttons[1])
    buttons[1].click()
    shown = (
        "document.getElementById('figure-steps')._fullData"
        ".filter((trace) => trace.visible === true).map((trace) => trace.name).join()"
    )
    wait(page, f"{shown} === 'Speed driven,Profile followed,1 recorded,2 stretched'")


def test_zooming_is_along_the_distance(page: webdriver.Chrome) -> None:
    page.execute_script(
        "Plotly.relayout('figure-base', {'xaxis.range[0]': 1, 'xaxis.range[1]': 2})"
    )
    layout = "document.getElementById('figure-base')._fullLayout"
    ranges = page.execute_script(f"return [{layout}.xaxis.range, {layout}.xaxis2.range]")
    assert ranges == [[1, 2], [1, 2]]  # speeds and curvature together
    assert page.execute_script(f"return {layout}.yaxis.fixedrange") is True


def test_it_prints_on_paper(page: webdriver.Chrome) -> None:
    page.execute_script("dispatchEvent(new Event('beforeprint'))")
    width = "document.querySelector('#figure-rates .main-svg').clientWidth"
    wait(page, f"{width} === 680")
    assert page.execute_script(
        "return [...document.querySelectorAll('details')].every(d => d.open)"
    )
    page.execute_script("dispatchEvent(new Event('afterprint'))")
    wait(page, f"{width} > 900")


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
        "<th>Satisfying (&minus;2 … +2)</th><td>&minus;1.00</td><td>1.17</td>",
    ):
        assert text in html, text


def test_the_steps_of_the_intervention_fit_together(contents: Contents) -> None:
    assert contents.driver is not None
    steps = contents.driver.steps
    assert steps is not None
    end = steps.piece_m[-1]
    assert steps.stretched_m[-1] == end
    assert steps.joined_mps[-1] == pytest.approx(steps.recorded_mps[-1])
    start = steps.stretched_m[0]
    at = int(start - steps.node_m[0])
    assert steps.driven_mps[at] == pytest.approx(steps.joined_mps[0], abs=0.2)
    inside = (steps.node_m > start) & (steps.node_m < end)
    assert abs(steps.mean_mps - steps.followed_mps)[inside].max() > 0.5


def test_a_driver_without_recordings_and_a_study_without_any(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ModelError, match=r"recordings/P002_A2.csv.*recorded are P001"):
        collect(analyse(StudyFolder(folder)), StudyFolder(folder), "P002")
    shutil.copy(folder / "drives.csv", tmp_path)
    report = tmp_path / "report.html"
    assert main(["analyse", str(tmp_path), "--report", str(report)]) == 0
    assert f"Report: {report}" in capsys.readouterr().out
    text = report.read_text(encoding="utf-8")
    assert "3 recorded participants" in text
    assert "no recordings" in text


def test_figures_for_papers_are_the_same_bytes_every_time(
    contents: Contents, tmp_path: Path
) -> None:
    assert tuple(study_figures(contents)) == FIGURES
    for folder in ("one", "two"):
        for name, scene in study_figures(contents).items():
            paper.save(scene, tmp_path / folder / f"{name}.svg")
    for name in FIGURES:
        one, two = (tmp_path / folder / f"{name}.svg" for folder in ("one", "two"))
        assert one.read_bytes() == two.read_bytes()


def test_the_command_writes_figures_as_pdf(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "drives.csv", tmp_path)
    figures = tmp_path / "figures"
    command = ["analyse", str(tmp_path), "--figures", str(figures), "--format", "pdf"]
    assert main(command) == 0
    assert {path.name for path in figures.iterdir()} == {"base.pdf", "rates.pdf"}
    assert (figures / "rates.pdf").read_bytes().startswith(b"%PDF")


def test_a_report_on_the_wrong_road_is_refused(folder: Path, tmp_path: Path) -> None:
    road = tmp_path / "road.csv"
    road.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n4500,0,20\n")
    source = ["analyse", str(folder), "--route", str(road), "--report", str(tmp_path / "r.html")]
    assert main(source) == 1
    assert not (tmp_path / "r.html").exists()
