"""A whole desk study as a person does it: the command, the page, keys, a gamepad, the analysis."""

from __future__ import annotations

import base64
import csv
import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from chrome import chrome, console, wait
from guided_page import at, press, start
from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from pldf.cosim.fmu import Fmu
from pldf.recordings.recording import Recording, read_recording, recording_csv
from repeated_person import drive_again, read_changes
from selenium.webdriver import ActionChains, Chrome
from selenium.webdriver.common.keys import Keys

STUDY = """
title = "A short study"

[drives]
phases = ["A2", "B1"]

[road]
route = "road.csv"

[cockpit]
practice = 0
"""
# From this position on: curvature, limit. A bend at 80 km/h, then 50.
ROAD = ((0, 0.0, 80), (140, 1 / 110, 80), (240, 0.0, 80), (300, 0.0, 50), (420, 0.0, 50))
PHASES = ("A2", "B1")
QUESTIONNAIRES = ("The system that you drove with", "How the car drove", "In your own words")
# A drive takes 25 s; a computer that does other things, too, lets it stand now and then.
DRIVE_S = 240.0
PAD = """
window.pad = {
  id: "Pedals of a test", index: 0, connected: true, mapping: "standard", axes: [0, 0, 0, 0],
  timestamp: 0,
  buttons: Array.from({length: 17}, () => ({pressed: false, touched: false, value: 0})),
};
navigator.getGamepads = () => [window.pad, null, null, null];
window.press = (button, value) => {
  window.pad.buttons[button] = {pressed: value > 0.5, touched: value > 0, value};
};
"""
GAS, BRAKE = 7, 6  # of a standard gamepad
NEVER_DRIVEN = "participant,phase,reason\n" + "".join(
    f"{who},{phase},not part of this study\n" for who in ("P01", "P02") for phase in ("A1", "B2")
)
OVER = "return !document.querySelector('.drive')"
GO_ON = "document.querySelector('dialog[open] button.main')?.click()"


class Driven(NamedTuple):
    """What the session left.

    Attributes:
        study: the study file.
        folder: what the server wrote.
        console: what the page wrote to the browser's console.
    """

    study: Path
    folder: Path
    console: list[str]


def key(window: Chrome, name: str, held_s: float) -> None:
    ActionChains(window).key_down(name).pause(held_s).key_up(name).perform()


def by_keyboard(window: Chrome, chance: random.Random) -> None:
    """Do something with the keys, for a time that is never the same."""
    name = chance.choice([Keys.ARROW_UP, Keys.ARROW_UP, Keys.ARROW_DOWN, "e", "r"])
    key(window, name, chance.uniform(0.05, 0.9 if name == Keys.ARROW_UP else 0.3))
    if name == Keys.ARROW_DOWN:
        key(window, "r", 0.1)  # whoever brakes switches off


def by_gamepad(window: Chrome, chance: random.Random) -> None:
    """Press a pedal of the gamepad; now and then the page draws nothing for a while."""
    button = chance.choice([GAS, GAS, BRAKE])
    window.execute_script(f"press({button}, {chance.uniform(0.05, 0.7)})")
    time.sleep(chance.uniform(0.1, 0.8))
    window.execute_script(f"press({button}, 0)")
    if button == BRAKE:
        key(window, "r", 0.1)
    busy_ms = chance.choice([0, 0, 60, 300])
    window.execute_script(
        f"const end = performance.now() + {busy_ms}; while (performance.now() < end);"
    )


def driven(window: Chrome, act: Callable[[Chrome, random.Random], None], seed: int) -> None:
    """Drive to the end of the road."""
    chance = random.Random(seed)
    start(window)
    end = time.monotonic() + DRIVE_S
    while not window.execute_script(OVER):
        assert time.monotonic() < end, console(window)
        window.execute_script(GO_ON)
        act(window, chance)
        time.sleep(chance.uniform(0.2, 1.5))


def answered(window: Chrome, title: str) -> None:
    """Answer all that is asked on a page with this heading, by keys alone."""
    at(window, title)
    groups = window.execute_script(
        "return [...new Set([...document.querySelectorAll('input[type=radio]')].map(i => i.name))]"
    )
    for group in groups:
        window.execute_script(f"document.getElementsByName({group!r})[0].focus()")
        ActionChains(window).send_keys(Keys.SPACE, Keys.ARROW_RIGHT).perform()
    press(window, "Continue")


def answer_all(window: Chrome) -> None:
    for title in QUESTIONNAIRES:
        answered(window, title)


def use(window: Chrome, row: int) -> None:
    """Choose what to drive with: a row of the list."""
    wait(window, f"document.querySelectorAll('.devices li').length > {row}")
    window.execute_script(
        f"document.querySelectorAll('.devices li')[{row}].querySelector('button').click()"
    )


def session(window: Chrome, address: str) -> None:
    """Go through the whole study as P01; reload where a drive has been stored."""
    window.get(f"{address}?p=P01&order=AB&language=en")
    press(window, "Continue")
    press(window, "I agree")
    use(window, 1)  # the keyboard stands below the gamepad
    at(window, "Drive 1 of 2")
    driven(window, by_keyboard, seed=1)
    answer_all(window)
    at(window, "Drive 2 of 2")
    window.refresh()
    at(window, "Drive 2 of 2")
    press(window, "Another device")
    use(window, 0)
    driven(window, by_gamepad, seed=2)
    answer_all(window)
    at(window, "Thank you")


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """Return what a person's session with ``pldf cockpit`` left behind."""
    place = tmp_path_factory.mktemp("desk")
    study, folder = place / "study.toml", place / "out"
    study.write_text(STUDY, encoding="utf-8")
    rows = [f"{s},{curvature!r},{limit / 3.6!r}" for s, curvature, limit in ROAD]
    text = "\n".join(["s_m,curvature_per_m,speed_limit_mps", *rows, ""])
    study.with_name("road.csv").write_text(text, encoding="utf-8")
    with serving(study, folder) as address, chrome(place / "browser", (800, 600), webgl=True) as w:
        w.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": PAD})
        session(w, address)
        return Driven(study, folder, console(w))


def test_the_page_had_nothing_to_complain_of(done: Driven) -> None:
    assert done.console == []


@pytest.mark.parametrize("phase", PHASES)
def test_a_drive_is_that_of_the_native_fmus_fed_with_its_inputs(
    done: Driven, natively: dict[str, bytes], phase: str
) -> None:
    recording = done.folder / f"recordings/P01_{phase}.csv"
    assert recording.read_bytes() == natively[phase]
    used = {change.name for change in read_changes(done.folder / f"inputs/P01_{phase}.csv")}
    assert {"driver.gas_pedal", "driver.brake_pedal", "lever.resume"} <= used


def test_the_profile_is_that_of_the_native_fmus(done: Driven, natively: dict[str, bytes]) -> None:
    (profile,) = (done.folder / "profiles").glob("*.pldf")
    assert profile.read_bytes() == natively["profile"]
    assert profile.read_bytes().count(b"\niteration ") == 2


def test_the_questionnaire_has_all_answers(done: Driven) -> None:
    with (done.folder / "questionnaire.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["participant"], row["phase"]) for row in rows] == [("P01", p) for p in PHASES]
    assert all(row[f"laan_{item}"] == "2" for row in rows for item in range(1, 10))


def test_pldf_analyse_reads_the_folder_as_it_is(done: Driven, tmp_path: Path) -> None:
    folder = tmp_path / "laboratory"
    shutil.copytree(done.folder, folder)
    add_somebody(folder)
    (folder / "exclusions.csv").write_text(NEVER_DRIVEN, encoding="utf-8")
    told = run("analyse", str(folder))
    with (folder / "analysis/tests.csv").open(encoding="utf-8", newline="") as file:
        counts = {row["measure"]: row["participants"] for row in csv.DictReader(file)}
    assert counts["combined"] == counts["usefulness"] == "2", told


def add_somebody(folder: Path) -> None:
    """Let P02 have answered like P01 and driven a little less far: an analysis needs two people."""
    for path in sorted(folder.glob("recordings/P01_*.csv")):
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)[:-10]
        path.with_name(path.name.replace("P01", "P02")).write_text("".join(lines), encoding="utf-8")
    answers = folder / "questionnaire.csv"
    head, *rows = answers.read_text(encoding="utf-8").splitlines()
    theirs = [row.replace("P01", "P02") for row in rows]
    answers.write_text("\n".join([head, *rows, *theirs, ""]), encoding="utf-8")


@pytest.fixture(scope="module")
def natively(
    done: Driven, native_fmus: dict[str, Fmu], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, bytes]:
    """Return recordings by phase, and the profile, of native FMUs fed with the same inputs."""
    place = tmp_path_factory.mktemp("again")
    made = bundle(read_desk_study(str(done.study)))
    road = place / "road.prepared"
    road.write_bytes(base64.b64decode(made["road"]["prepared"]))
    results = {}
    for phase in PHASES:
        values = values_of(made["plan"], phase, road, place / "store")
        changes = read_changes(done.folder / f"inputs/P01_{phase}.csv")
        drive = drive_again(native_fmus, values, changes, made["plan"]["end_m"], 0.01)
        comments = read_recording(done.folder / f"recordings/P01_{phase}.csv").comments
        results[phase] = recording_csv(Recording(drive.recording.columns, comments))
    (profile,) = (place / "store").glob("*.pldf")
    return {**results, "profile": profile.read_bytes()}


def values_of(plan: dict[str, Any], phase: str, road: Path, store: Path) -> dict[str, Any]:
    """Return what the native FMUs are told for a drive of the plan, as driver 1."""
    (found,) = (drive for drive in plan["drives"] if drive["phase"] == phase)
    values = {part: {**own, "route_file": str(road)} for part, own in found["values"].items()}
    values["pldf"] |= {"profile_store": str(store), "driver_id": 1}
    return values


def run(*arguments: str) -> str:
    """Run ``pldf`` and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-m", "pldf", *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@contextmanager
def serving(study: Path, folder: Path) -> Iterator[str]:
    """Yield the address that ``pldf cockpit`` prints."""
    command = [sys.executable, "-m", "pldf", "cockpit", str(study), "--out", str(folder)]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        [*command, "--no-browser"], stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        assert process.stdout is not None
        told = process.stdout.readline()
        address = re.search(r"http://\S+", told)
        assert address, told
        try:
            yield address[0]
        finally:
            process.terminate()
