"""What was learned, shown after the drive, to keep or to forget."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from typing import Any

import pytest
from chrome import chrome, console, wait
from pldf.profiles.profile_file import encode
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from served_cockpit import served
from watched_drive import bundle, road
from watched_profile import after, before, forgotten

SHOW = """
const [drive, language, done] = arguments;
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const here = (path) => import(new URL(path, location.href).href);
(async () => {
  const { AfterDrive } = await here("cluster/after_drive.js");
  const { roadOf } = await here("engine/road.js");
  const { speak } = await here("language.js");
  speak(language);
  globalThis.asked = [];
  new AfterDrive(document.querySelector("main"), {
    road: roadOf({ ...drive.road, prepared: bytes(drive.road.prepared) }),
    frames: drive.frames, unit: "KMH", messages: drive.messages,
    before: bytes(drive.before), after: bytes(drive.after),
    forget: drive.forgotten && (async (places_m) => {
      asked.push(places_m);
      if (places_m.some((at) => at < 1000)) throw new Error("the disk is full.");
      return bytes(places_m.length > 0 ? drive.forgotten : drive.after);
    }),
  });
  done("");
})().catch((error) => done(String(error.stack)));
"""
PLACES = "[...document.querySelectorAll('.after-place')]"


def frames() -> list[dict[str, Any]]:
    """A drive in which the driver braked from 2000 to 2200 m."""
    made = []
    for s_m in range(0, 4500, 10):
        braked = 2000 <= s_m < 2200
        values = {
            "vehicle.s_m": s_m,
            "vehicle.speed_mps": 15.0 if braked else 17.0,
            "mode": 1 if braked else 2,
            "driver.brake_pedal": 0.3 if braked else 0.0,
            "set_speed_offset_mps": 0.0,
            "base_speed_mps": 60.0 / 3.6,
        }
        made.append({"time_s": s_m / 17.0, "lateral_m": 0, "heading_rad": 0, "values": values})
    return made


def text(data: bytes) -> str:
    return base64.b64encode(data).decode()


@pytest.fixture(scope="module")
def drive() -> dict[str, Any]:
    return {
        "road": road(),
        "frames": frames(),
        "messages": [
            {"level": "info", "part": "pldf", "text": "pedal intervention 1: <b>learned</b>"},
            {"level": "info", "part": "vehicle", "text": "nothing of the function"},
        ],
        "before": text(encode(before())),
        "after": text(after()),
        "forgotten": text(forgotten()),
    }


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    folder = tmp_path_factory.mktemp("after")
    with served(bundle(), folder) as address, chrome(folder / "browser") as opened:
        opened.get(address + "experimenter.html")
        wait(opened, "document.querySelector('.desk-nobody')")
        yield opened
        assert console(opened) == []


def show(window: webdriver.Chrome, drive: dict[str, Any], language: str = "en") -> None:
    assert window.execute_async_script(SHOW, drive, language) == ""


def told(window: webdriver.Chrome) -> list[str]:
    script = f"return {PLACES}.map((place) => place.querySelector('.after-lesson').innerText)"
    return list(window.execute_script(script))


def press(window: webdriver.Chrome, place: int, choice: str) -> None:
    window.execute_script(f"{PLACES}[{place}].querySelector('input[value={choice}]').click()")
    wait(window, "document.querySelector('.after-places[aria-busy=false]')")


def test_what_happened_and_what_was_learned_is_told(
    window: webdriver.Chrome, drive: dict[str, Any]
) -> None:
    show(window, drive)
    summary = window.find_element(By.CSS_SELECTOR, ".after-summary").text
    assert summary == "You acted: brake 1\N{MULTIPLICATION SIGN}. 2 places are learned."
    assert told(window) == [
        "+8 km/h: 68 instead of 60\n0.50 to 0.70 km \N{MIDDLE DOT} learned in drive 1",
        "\N{MINUS SIGN}6 km/h: 54 instead of 60\n"
        "2.00 to 2.20 km \N{MIDDLE DOT} new from this drive",
    ]
    assert len(window.find_elements(By.CSS_SELECTOR, ".map-badge")) == 2
    said = "return [...document.querySelectorAll('.after details li')].map((li) => li.textContent)"
    assert window.execute_script(said) == ["pedal intervention 1: <b>learned</b>"]
    drawn = window.execute_script(
        "const c = document.querySelector('.after-plot canvas');"
        "return new Set(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).size"
    )
    assert drawn > 20


def test_a_place_is_forgotten_and_kept_again(
    window: webdriver.Chrome, drive: dict[str, Any]
) -> None:
    show(window, drive)
    press(window, 1, "forget")
    gone = f"return {PLACES}.map((place) => place.dataset.forgotten)"
    assert window.execute_script(gone) == ["false", "true"]
    assert told(window)[1].endswith("forgotten")
    badges = "[...document.querySelectorAll('.map-badge')]"
    assert window.execute_script(f"return {badges}[1].dataset.forgotten") == "true"
    press(window, 1, "keep")
    assert window.execute_script(gone) == ["false", "false"]
    assert window.execute_script("return asked") == [[2000], []]


def test_what_could_not_be_forgotten_is_kept_and_told(
    window: webdriver.Chrome, drive: dict[str, Any]
) -> None:
    show(window, drive)
    press(window, 0, "forget")
    error = window.find_element(By.CSS_SELECTOR, ".after-error").text
    assert error.startswith("This could not be forgotten: the disk is full.")
    kept = f"return {PLACES}.map((place) => place.querySelector('input:checked').value)"
    assert window.execute_script(kept) == ["keep", "keep"]


def test_it_is_done_with_keys_alone(window: webdriver.Chrome, drive: dict[str, Any]) -> None:
    show(window, drive)
    radios = window.find_elements(By.CSS_SELECTOR, ".after-place input")
    radios[2].send_keys(Keys.ARROW_RIGHT)
    wait(window, "document.querySelector('.after-places[aria-busy=false]')")
    assert window.execute_script("return asked") == [[2000]]
    focused = "return document.activeElement.value"
    assert window.execute_script(focused) == "forget"


def test_who_may_not_forget_is_not_asked(window: webdriver.Chrome, drive: dict[str, Any]) -> None:
    show(window, drive | {"forgotten": None}, "de")
    assert window.find_elements(By.CSS_SELECTOR, ".after-place input") == []
    assert told(window)[0].startswith("+8 km/h: 68 statt 60\n0,50 bis 0,70 km")
