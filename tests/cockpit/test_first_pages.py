"""The pages around a drive in a browser: read by everybody, used by keyboard, fed with files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from chrome import chrome, console, wait
from guided_page import at, press
from pldf.cockpit.bundle import as_json, bundle
from pldf.cockpit.desk_study import read_desk_study
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from served_cockpit import served

# WCAG 2.2, success criterion 1.4.3: contrast of text with what is behind it.
POOR_CONTRAST = """
const channels = (colour) => colour.match(/[\\d.]+/g).map(Number);
const light = (part) => (part /= 255) <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
function behind(element) {
  for (let at = element; at; at = at.parentElement) {
    const colour = channels(getComputedStyle(at).backgroundColor);
    if (colour.length < 4 || colour[3] === 1) return colour;
  }
  return [255, 255, 255];
}
const texts = [...document.querySelectorAll("body *")].filter((one) => one.checkVisibility()
  && [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim()));
return texts.map((one) => {
  const style = getComputedStyle(one);
  const both = [luminance(channels(style.color)), luminance(behind(one))].sort((a, b) => b - a);
  const size = parseFloat(style.fontSize);
  const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
  const ratio = (both[0] + 0.05) / (both[1] + 0.05);
  return { text: one.textContent.trim().slice(0, 40), ratio, poor: ratio < (large ? 3 : 4.5) };
});
"""
# A wheel of which browsers know no layout: the pedals rest at 1, gas and brake are axes 1 and 2.
WHEEL = """
window.wheel = { id: "Wheel 9000", index: 0, mapping: "", connected: true, timestamp: 0,
  axes: [0, 1, 1], buttons: Array.from({ length: 8 }, () => ({ value: 0, pressed: false })) };
navigator.getGamepads = () => [window.wheel];
"""


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    with chrome(tmp_path_factory.mktemp("browser"), (1280, 720), webgl=True) as window:
        yield window


@pytest.fixture(scope="module")
def made() -> dict[str, Any]:
    return bundle(read_desk_study())


@pytest.fixture(scope="module")
def address(made: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(as_json(made), tmp_path_factory.mktemp("study")) as address:
        yield address


def is_readable(window: Chrome) -> bool:
    texts = window.execute_script(POOR_CONTRAST)
    assert len(texts) > 5
    poor = [(one["text"], round(one["ratio"], 2)) for one in texts if one["poor"]]
    assert poor == []
    return True


def moved(window: Chrome, axis: int, value: float) -> None:
    """Move an axis of the wheel, and let the page look at it."""
    window.execute_script("window.wheel.axes[arguments[0]] = arguments[1]", axis, value)
    window.execute_async_script(
        "const done = arguments[0];"
        "requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )


def question(window: Chrome) -> str:
    shown = "document.querySelector('.question')?.textContent ?? ''"
    return str(window.execute_script(f"return {shown}"))


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_first_page_is_readable_in_both_languages(
    address: str, window: Chrome, language: str
) -> None:
    window.get(f"{address}?language={language}")
    at(window, {"en": "Drive it yourself", "de": "Selbst fahren"}[language])
    assert is_readable(window)
    assert window.execute_script("return document.documentElement.lang") == language
    assert window.execute_script(
        "return [...document.querySelectorAll('input, select, textarea')].every("
        "(one) => one.labels.length || one.ariaLabel)"
    )
    assert console(window) == []


def test_the_keyboard_alone_leads_to_the_first_drive(address: str, window: Chrome) -> None:
    window.get(f"{address}?language=en")
    at(window, "Drive it yourself")
    window.execute_script("document.querySelector('input[name=p]').focus()")
    ActionChains(window).send_keys("11", Keys.ENTER).perform()
    wait(window, "location.search.includes('p=P11')")
    for page in ("Welcome", "I agree", "How do you drive?"):
        wait(window, f"document.body.innerText.includes({page!r})")
        assert is_readable(window)
        # The heading has the focus, the next stop is what one came for.
        wait(window, "document.activeElement.matches('h1')")
        ActionChains(window).send_keys(Keys.TAB, Keys.ENTER).perform()
    at(window, "Practice drive 1")
    assert is_readable(window)
    lowest = "Math.max(...[...document.querySelectorAll('.buttons button')].map((one) => one"
    assert window.execute_script(f"return {lowest}.getBoundingClientRect().bottom))") < 2 * 720


def test_a_wheel_is_set_up_by_pressing_and_is_known_the_next_time(
    address: str, window: Chrome
) -> None:
    window.get(f"{address}?p=12&language=en")
    press(window, "Continue")
    press(window, "I agree")
    window.execute_script(WHEEL)
    press(window, "Set up")
    press(window, "Begin")
    wait(window, "document.querySelector('.question')?.textContent.includes('gas')")
    for axis in (1, 2):
        moved(window, axis, -1.0)
        moved(window, axis, 1.0)
    wait(window, "document.querySelector('.question')?.textContent.includes('wheel')")
    moved(window, 0, -1.0)
    moved(window, 0, 0.0)
    while question(window):
        press(window, "My device has none")
    at(window, "Wheel 9000")
    wait(window, "document.querySelectorAll('meter').length === 3")
    moved(window, 1, -1.0)
    travel = "[...document.querySelectorAll('meter')].map((one) => one.value)"
    assert window.execute_script(f"return {travel}") == [1, 0, 0]
    assert is_readable(window)
    moved(window, 1, 1.0)
    press(window, "Keep and continue")
    at(window, "Practice drive 1")
    press(window, "Another device")
    press(window, "Drive with it")
    at(window, "Practice drive 1")
    assert console(window) == []


def test_recordings_are_compared_and_what_cannot_be_read_says_why(
    address: str, window: Chrome, tmp_path: Path
) -> None:
    lines = "".join(f"{t / 10},{t * 2},{20},ACTIVE\n" for t in range(100))
    quick = "".join(f"{t / 10},{t * 3},{30},ACTIVE\n" for t in range(100))
    for name, content in (
        ("one.csv", f"time_s,s_m,speed_mps,mode\n{lines}"),
        ("two.csv", f"time_s,s_m,speed_mps,mode\n{quick}"),
        ("bad.csv", "a,b\n1,2\n"),
        ("worse.pldf", "PLDF-PROFILE 2\n"),
    ):
        (tmp_path / name).write_text(content)
    window.get(f"{address}?language=en")
    at(window, "Drive it yourself")
    chosen = window.find_element(By.CSS_SELECTOR, "input[type=file]")
    chosen.send_keys("\n".join(str(tmp_path / name) for name in ("bad.csv", "worse.pldf")))
    problems = "[...document.querySelectorAll('.card .problem')].map((one) => one.textContent)"
    wait(window, f"{problems}.filter(Boolean).length === 2")
    told = window.execute_script(f"return {problems}.filter(Boolean)")
    assert "the columns time_s, s_m, speed_mps are missing" in told[0]
    assert told[1].startswith("worse.pldf: ")
    chosen = window.find_element(By.CSS_SELECTOR, "input[type=file]")
    chosen.send_keys("\n".join(str(tmp_path / name) for name in ("one.csv", "two.csv")))
    wait(window, "document.querySelector('.replay-compared')?.textContent.includes('two.csv')")
    beside = "document.querySelector('.replay-compared').textContent"
    assert "two.csv: 108 km/h here" in window.execute_script(f"return {beside}")
    press(window, "Back")
    at(window, "Drive it yourself")
    assert console(window) == []


def test_the_second_half_of_a_double_click_is_not_for_the_next_page(
    address: str, window: Chrome
) -> None:
    window.get(f"{address}?p=13&language=en")
    at(window, "Drive it yourself")
    clicked = "dispatchEvent(new MouseEvent('click', {detail: 1, bubbles: true}))"
    onward = "document.querySelector('.buttons button.main')"
    window.execute_async_script("setTimeout(arguments[0], 600)")
    window.execute_async_script(
        f"""
        const done = arguments[0];
        new MutationObserver((_, observer) => {{
          if ({onward}?.innerText === "I agree") {{
            observer.disconnect();
            {onward}.{clicked};
            setTimeout(done, 600);
          }}
        }}).observe(document.body, {{ childList: true, subtree: true }});
        {onward}.{clicked};
        """
    )
    assert window.execute_script(f"return {onward}.innerText") == "I agree"
    window.execute_script(f"{onward}.{clicked}")
    at(window, "How do you drive?")
