"""A guided session in a browser: what is asked and driven is stored, whatever happens."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from chrome import chrome, console, wait
from guided_page import answer, arrive, at, pedal, press, record, start, to_first_drive
from pldf.cockpit.bundle import as_json, bundle
from pldf.cockpit.desk_study import read_desk_study
from selenium.webdriver import Chrome
from served_cockpit import served, tell

HOSTILE = '<img src=x onerror="document.title=1">, "quoted",\nand #more'


@pytest.fixture(scope="module")
def short() -> dict[str, Any]:
    """The packaged desk study with short drives, of which each system has one."""
    made = bundle(read_desk_study())
    # Long enough for RESUME, a press of the gas pedal, and something to learn.
    more = {"end_m": 150.0, "practice": 0, "breaks": {"A2": 0.02}}
    made["plan"] |= more | {"orders": {"AB": ["A2", "B1"], "BA": ["A2", "B1"]}}
    return made


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    with chrome(tmp_path_factory.mktemp("browser"), (640, 480), webgl=True) as window:
        yield window


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module")
def address(short: dict[str, Any], folder: Path) -> Iterator[str]:
    with served(as_json(short), folder) as address:
        yield address


def rows_of(table: Path, participant: str) -> list[dict[str, str]]:
    with table.open(newline="", encoding="utf-8") as lines:
        return [row for row in csv.DictReader(lines) if row["participant"] == participant]


def test_a_whole_session_leaves_what_the_analysis_reads(
    short: dict[str, Any], address: str, window: Chrome, folder: Path
) -> None:
    to_first_drive(window, address, "P01")
    for phase in ("A2", "B1"):
        start(window)
        arrive(window, folder / f"recordings/P01_{phase}.csv")
        for questionnaire in short["questionnaires"]:
            answer(window, questionnaire["title"]["en"], HOSTILE)
        if phase == "A2":
            at(window, "A short break")
            press(window, "End the session")
            press(window, "Go on where it was stopped")
            at(window, "A short break")
            press(window, "Continue")
    at(window, "Thank you")
    press(window, "See what the car learned from you")
    wait(window, "!!document.querySelector('.after-map')")
    assert console(window) == []
    assert window.title == "Drive it yourself"
    learned = next(folder.glob("profiles/driver-000001_route-*.pldf"))
    assert b"\niterations 2\n" in learned.read_bytes()[:400]
    after_a2 = (folder / "sessions/P01/A2" / learned.name).read_bytes()
    assert b"\niterations 1\n" in after_a2[:400]
    scored = rows_of(folder / "questionnaire.csv", "P01")
    assert [(row["phase"], row["laan_1"]) for row in scored] == [("A2", "4"), ("B1", "4")]
    said = [row for row in rows_of(folder / "answers.csv", "P01") if row["item"] == "remarks"]
    assert [row["answer"] for row in said] == [HOSTILE] * 2
    kept = record(folder, "P01")
    assert kept["finished"]
    told = [(one["name"], one["ending"], one["device"]) for one in kept["attempts"]]
    assert told == [("A2", "arrived", "keyboard"), ("B1", "arrived", "keyboard")]
    assert all(one["timing"]["steps"] > 0 for one in kept["attempts"])


def test_a_reload_and_a_stop_lose_nothing(address: str, window: Chrome, folder: Path) -> None:
    window.get(address)
    by_another = "JSON.stringify({camera: 'chase', sound: false})"
    window.execute_script(f"localStorage.setItem('pldf-cockpit settings', {by_another})")
    to_first_drive(window, address, "P02")
    start(window)
    pedal(window, 0.3)
    window.refresh()
    wait(window, "document.body.innerText.includes('The last drive was interrupted')")
    start(window)
    tell(address, {"kind": "abort", "participant": "P01", "reason": "somebody else"})
    tell(address, {"kind": "abort", "participant": "P02", "reason": "fire drill"})
    at(window, "The drive ended early")
    press(window, "Drive it again")
    start(window)
    for _ in range(2):  # the second time while it counts down
        press(window, "Pause")
        wait(window, "!!document.querySelector('dialog[open]')")
        window.execute_script("document.querySelector('dialog').close()")  # nobody need know why
        wait(window, "!!document.querySelector('dialog[open]')")
        press(window, "Go on driving")
    press(window, "Stop")
    press(window, "I feel unwell")
    at(window, "The drive ended early")
    wait(window, "document.body.innerText.includes('Reason: I feel unwell')")
    assert wait(window, "document.querySelector('button.main').innerText") == "End the session"
    press(window, "End the session")
    at(window, "The session was stopped")
    window.refresh()
    press(window, "Go on where it was stopped")
    at(window, "Drive 1 of 2")
    told = [(one["ending"], one["reason"]) for one in record(folder, "P02")["attempts"]]
    assert told == [("cut off", ""), ("stopped", "fire drill"), ("stopped", "felt unwell")]
    shown = record(folder, "P02")["attempts"][-1]["shown"]
    assert (shown["camera"], shown["sound"], shown["fov_deg"]) == ("cockpit", True, 60.0)
    assert not list(folder.glob("recordings/P02*"))
    assert not list(folder.glob("profiles/driver-000002*"))
    kept = sorted(path.name for path in (folder / "sessions/P02/stopped").iterdir())
    assert kept == ["A2_2.csv", "A2_2_inputs.csv", "A2_3.csv", "A2_3_inputs.csv"]


def test_answers_survive_a_reload_and_what_is_missing_is_shown(
    short: dict[str, Any], address: str, window: Chrome, folder: Path
) -> None:
    only = short["questionnaires"][0]["title"]["en"]
    to_first_drive(window, address, "P03")
    start(window)
    arrive(window, folder / "recordings/P03_A2.csv")
    at(window, only)
    window.execute_script("document.querySelectorAll('input[name=laan_3]')[1].click()")
    window.refresh()
    at(window, only)
    press(window, "Continue")
    wait(window, "document.body.innerText.includes('Still to answer or to correct: 8')")
    wrong = "[...document.querySelectorAll('fieldset.wrong')].map(one => one.dataset.item)"
    told = window.execute_script(f"return {wrong}")
    assert told == [f"laan_{number}" for number in (1, 2, 4, 5, 6, 7, 8, 9)]
    assert window.execute_script("return document.activeElement.name") == "laan_1"
    answer(window, only)
    at(window, short["questionnaires"][1]["title"]["en"])
    assert rows_of(folder / "questionnaire.csv", "P03")[0]["laan_3"] == "4"


def test_data_that_cannot_be_stored_are_kept_until_they_can(
    address: str, window: Chrome, folder: Path
) -> None:
    window.get(f"{address}?p=4&language=en")
    at(window, "Drive it yourself")
    window.execute_script(
        "window.kept = fetch; window.fetch = async () => { throw new Error('no more server'); };"
    )
    press(window, "Continue")
    at(window, "The data could not be stored: no more server")
    assert not (folder / "sessions/P04.json").exists()
    window.execute_script("window.fetch = window.kept")
    press(window, "Try again")
    press(window, "I agree")
    at(window, "How do you drive?")
    assert record(folder, "P04")["step"] == "device"


def test_a_number_is_one_person_in_one_window(address: str, window: Chrome, folder: Path) -> None:
    window.get(f"{address}?p=05&language=de")
    press(window, "Weiter")
    at(window, "Drive it yourself")
    first = window.current_window_handle
    window.switch_to.new_window("tab")
    window.get(f"{address}?p=P5&language=en")
    at(window, "This session is open in another window")
    window.get(f"{address}?p=VP5&language=en")
    at(window, "P05 has the same number")
    window.get(f"{address}?p=Anna&language=en")
    wait(window, "document.body.innerText.includes('Please do not use a name')")
    assert not list(folder.glob("sessions/*Anna*")) + list(folder.glob("sessions/VP*"))
    window.close()
    window.switch_to.window(first)
    assert window.title == "Selbst fahren"
    press(window, "Ich stimme nicht zu")
    at(window, "Danke")
    kept = record(folder, "P05")
    assert (kept["given"], kept["attempts"]) == ([], [])
