"""A study of simulated drivers whose every drive was recorded: what is true of it is known."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from built_once import once
from pldf.cli import main
from pldf.recordings.recording import Recording, read_recording, write_recording

TEXT = """
title = "all recorded"
[participants]
count = 3
seed = 1
[recordings]
participants = "all"
"""
PEOPLE = ("P001", "P002", "P003")
PHASES = ("A1", "A2", "A3", "B1", "B2", "B3")
ACTING = ("A1", "A2", "B1", "B2")


def driven_study(factory: pytest.TempPathFactory) -> Path:
    """The folder of that study; do not change it."""

    def drive(folder: Path) -> None:
        (folder / "study.toml").write_text(TEXT)
        assert main(["study", str(folder / "study.toml"), "--out", str(folder / "out")]) == 0

    return once(factory, "driven_study", drive) / "out"


@cache
def recording_of(study: Path, who: str, phase: str) -> Recording:
    return read_recording(study / "recordings" / f"{who}_{phase}.csv")


def without_columns(recording: Recording, *names: str) -> Recording:
    """The recording of a laboratory that did not write these columns."""
    return Recording({name: v for name, v in recording.columns.items() if name not in names})


def laboratory_of(study: Path, folder: Path, *lacking: str, every: int = 10) -> Path:
    """Copy the recordings into ``folder`` as a laboratory has them: fewer rows and columns."""
    (folder / "recordings").mkdir(parents=True)
    for who in PEOPLE:
        for phase in PHASES:
            whole = recording_of(study, who, phase)
            thin = Recording({name: v[::every].copy() for name, v in whole.columns.items()})
            write_recording(
                folder / "recordings" / f"{who}_{phase}.csv", without_columns(thin, *lacking)
            )
    return folder
