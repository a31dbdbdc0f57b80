"""The exported page from a disk: a session, closed in the middle, and what it hands out."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZipFile

import pytest
from chrome import asked, chrome, console
from guided_page import PATIENCE_S, answer, at, drive_on, press, start, to_first_drive
from pldf.analysis.unpacked import unpacked_study
from pldf.cli import main
from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from pldf.cockpit.export import write_export
from pldf.cockpit.page_json import as_json
from pldf.recordings.recording import read_recording
from selenium.webdriver import Chrome

HANDED_OUT = "pldf-cockpit.zip"
TITLES = ("The system that you drove with", "How the car drove", "In your own words")


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the page: the packaged desk study with two short drives."""
    folder = tmp_path_factory.mktemp("stick")
    made = bundle(read_desk_study())
    made["plan"] |= {"end_m": 150.0, "practice": 0}
    made["plan"] |= {"orders": {"AB": ["A2", "B1"], "BA": ["A2", "B1"]}}
    write_export(folder / "cockpit.html", as_json(made))
    return folder


@pytest.fixture(scope="module")
def window(place: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    with chrome(tmp_path_factory.mktemp("browser"), (640, 480), webgl=True) as window:
        where = {"behavior": "allow", "downloadPath": str(place)}
        window.execute_cdp_cmd("Browser.setDownloadBehavior", where)
        yield window


def test_a_session_without_server_and_network(
    place: Path, window: Chrome, capsys: pytest.CaptureFixture[str]
) -> None:
    address = (place / "cockpit.html").as_uri()
    to_first_drive(window, address, "P01")
    driven_once(window)
    at(window, "Drive 2 of 2")
    window.get(address)  # as if the browser had been closed, and its file opened again
    window.get(f"{address}?p=P01&language=en")
    at(window, "Drive 2 of 2")
    driven_once(window)
    at(window, "Thank you")
    press(window, "Hand out all data as a zip")
    handed_out = waited_for(place / HANDED_OUT)
    assert console(window) == []
    assert [url for url in asked(window) if not re.match("file:|data:|blob:", url)] == []

    folder = unpacked_study([handed_out])
    for phase in ("A2", "B1"):
        assert read_recording(folder / f"recordings/P01_{phase}.csv")["s_m"][-1] > 145.0
    (profile,) = folder.glob("profiles/driver-000001_route-*.pldf")
    assert b"\niterations 2\n" in profile.read_bytes()
    (session,) = json.loads((folder / "session.json").read_text(encoding="utf-8"))["sessions"]
    assert session["finished"]
    both = [handed_out, as_somebody_else(handed_out)]
    assert {"cockpit.toml", "road.csv"} <= {path.name for path in folder.iterdir()}
    never = [f"--without=P0{who}_{phase}" for who in (1, 2) for phase in ("A1", "B2")]
    assert main(["analyse", *map(str, both), *never]) == 0, capsys.readouterr().err
    assert "means of 2 participants" in capsys.readouterr().out
    assert (place / "unpacked" / "analysis" / "tests.csv").is_file()


def as_somebody_else(handed_out: Path) -> Path:
    """Return what P02 would have handed out who stopped each drive a moment earlier."""
    path = handed_out.with_name("P02.zip")
    with ZipFile(handed_out) as given, ZipFile(path, "w") as made:
        for name in given.namelist():
            data = given.read(name)
            if name.startswith("recordings/"):
                data = b"".join(data.splitlines(keepends=True)[:-10])
            if not name.startswith(("profiles/", "sessions/P01/")):
                made.writestr(name.replace("P01", "P02"), data.replace(b"P01", b"P02"))
    return path


def driven_once(window: Chrome) -> None:
    start(window)
    drive_on(window)
    for title in TITLES:
        answer(window, title, "quiet")


def waited_for(path: Path) -> Path:
    """Return the file as soon as the browser has saved it."""
    end = time.monotonic() + PATIENCE_S
    while not path.is_file():
        assert time.monotonic() < end, sorted(path.parent.iterdir())
        time.sleep(0.05)
    return path
