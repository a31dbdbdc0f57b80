"""A guided session in a browser, as a person goes through it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from chrome import wait
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.keys import Keys

# A drive and its countdown, on a computer that does other things, too.
PATIENCE_S = 120.0
# Tells whether the drive is over; where it stands, because the computer was slow, lets it go on.
_OVER = """(() => {
  document.querySelector("dialog[open] button.main")?.click();
  return !document.querySelector(".drive");
})()"""


def at(window: Chrome, text: str) -> None:
    """Wait for the page with this heading, of the page or of the laboratory's text."""
    shown = (
        f"[...document.querySelectorAll('h1')].some((one) => one.textContent.includes({text!r}))"
    )
    wait(window, shown, PATIENCE_S)


def press(window: Chrome, text: str) -> None:
    """Press the button with this text as soon as it is there."""
    usable = "[...document.querySelectorAll('button:enabled')]"
    found = f"{usable}.find(one => one.innerText === {text!r})"
    wait(window, f"!!{found}", PATIENCE_S)
    window.execute_script(f"{found}.click()")


def start(window: Chrome) -> None:
    """Start the drive that is announced, and wait until the car drives."""
    press(window, "Start the drive")
    wait(window, "document.querySelector('.drive-count')?.textContent === ''", PATIENCE_S)


def pedal(window: Chrome, hold_s: float) -> None:
    """Hold the key of the gas pedal."""
    ActionChains(window).key_down(Keys.ARROW_UP).pause(hold_s).key_up(Keys.ARROW_UP).perform()


def drive_on(window: Chrome) -> None:
    """Press the gas pedal in the drive that goes on, and wait until that is over."""
    pedal(window, 1.2)
    wait(window, _OVER, PATIENCE_S)


def arrive(window: Chrome, stored: Path) -> None:
    """Drive on, to where the drive must have been stored."""
    drive_on(window)
    assert stored.is_file()


def answer(window: Chrome, title: str, remark: str = "") -> None:
    """Tick the fourth box of every scale, and write a remark."""
    at(window, title)
    window.execute_script(
        """
        for (const field of document.querySelectorAll("fieldset")) {
          field.querySelectorAll("input[type=radio]")[3]?.click();
          const area = field.querySelector("textarea");
          if (area) {
            area.value = arguments[0];
            area.dispatchEvent(new Event("input"));
          }
        }
        """,
        remark,
    )
    press(window, "Continue")


def to_first_drive(window: Chrome, address: str, participant: str) -> None:
    """Agree and choose the keyboard."""
    window.get(f"{address}?p={participant}&language=en")
    at(window, "Drive it yourself")
    press(window, "Continue")
    press(window, "I agree")
    press(window, "Drive with it")
    at(window, "Drive 1 of 2")


def record(folder: Path, participant: str) -> dict[str, Any]:
    """Return what is kept of a session."""
    return dict(json.loads((folder / f"sessions/{participant}.json").read_text("utf-8")))
