"""The report in a real browser."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator
from typing import Any

import pytest
from chrome import asked, chrome, console, wait
from selenium import webdriver
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.by import By

FIGURES = ("rates", "compared", "drives", "development", "steps", "long_run", "plan", "base")


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    with chrome(tmp_path_factory.mktemp("profile")) as window:
        yield window


@pytest.fixture(scope="module")
def page(browser: webdriver.Chrome, html: str, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(html, encoding="utf-8")
    browser.get(path.as_uri())
    wait(browser, "document.querySelectorAll('.plotly-graph-div .main-svg').length >= 7")
    return browser


def test_the_page_opens_without_errors_and_without_network(page: webdriver.Chrome) -> None:
    assert console(page) == []
    urls = [url for url in asked(page) if not url.startswith(("data:", "blob:"))]
    assert urls == [page.current_url]


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


def test_hovering_over_an_intervention_tells_which(page: webdriver.Chrome) -> None:
    place = """
        const figure = document.getElementById('figure-compared');
        figure.scrollIntoView({block: 'center', behavior: 'instant'});
        const bars = figure._fullData.find((t) => t.yaxis === 'y2' && t.text);
        const {left, top} = figure.getBoundingClientRect();
        const {xaxis2, yaxis2} = figure._fullLayout;
        return [[...bars.text], left + xaxis2._offset + xaxis2.d2p(bars.x[0]) + 1,
            top + yaxis2._offset + yaxis2.d2p(0.5 * (bars.y[0] + bars.y[2]))];
    """
    texts, x, y = page.execute_script(place)
    assert re.match(r"[AB]\d, (Gas|Brake|Set speed).*: \d+\.\d s$", texts[0])
    pointer = ActionBuilder(page)
    pointer.pointer_action.move_to_location(round(x), round(y))
    pointer.perform()
    shown = "[...document.querySelectorAll('#figure-compared .hoverlayer text')]"
    wait(page, f"{shown}.some((told) => {json.dumps(texts)}.includes(told.textContent))")
