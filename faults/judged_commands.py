"""Recordings that contradict themselves: what ``pldf`` makes of them, as its user sees it.

A drive is made up here, sound and whole; then it is spoilt as laboratories spoil them: other units,
columns mixed up, signals frozen, samples lost. What is learned, and the rates, have to be those of
the sound file, or the command has to say on stderr what is the matter, or to end with 1.
"""

from __future__ import annotations

import csv
import random
import tempfile
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Final

import numpy as np
from pldf import cli
from pldf.profiles.store import read_profile

from .byte_changes import DAMAGES
from .experiment import Counts, Experiment, Progress
from .sheet_changes import CONTENTS, DRESSES
from .spoilt_drives import ROAD, SPOILS, Array, Drive, sheet_of, sound_drive
from .verdicts import Verdict, Word, counted

# Differences that no driver feels and no table shows: a hundredth of a second of an intervention,
# the last digit of a rounded log.
PROFILE_MPS: Final = 0.1
RATE: Final = 0.005

PHASES: Final = ("A1", "A2", "B1", "B2")


@dataclass(frozen=True)
class Outcome:
    """What a command left: its exit status, what it told, and the numbers that it wrote."""

    status: int
    told: str
    numbers: dict[str, Array]


def run(arguments: list[str], numbers: Callable[[], dict[str, Array]]) -> Outcome:
    """Run ``pldf`` in this process."""
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()) as told:
        status = cli.main(arguments)
    return Outcome(status, told.getvalue(), numbers() if status == 0 else {})


class Learning:
    """``pldf learn``: the profile is judged."""

    name = "learn"
    tolerance = PROFILE_MPS

    def __init__(self, folder: Path) -> None:
        (folder / "road.csv").write_text(ROAD)
        self.folder = folder
        self.sound = self.outcome(sheet_of(sound_drive()).written())
        assert self.sound.status == 0, self.sound.told

    def drive(self) -> Drive:
        """Return the drive that is spoilt."""
        return sound_drive()

    def outcome(self, data: bytes) -> Outcome:
        """Learn from a recording with this content."""
        path, out = self.folder / "P001_A1.csv", self.folder / "out.pldf"
        path.write_bytes(data)
        out.unlink(missing_ok=True)
        road = str(self.folder / "road.csv")
        command = ["learn", "--route", road, "--recording", str(path), "--out", str(out)]
        return run(command, lambda: self._learned(out))

    @staticmethod
    def _learned(out: Path) -> dict[str, Array]:
        newest = read_profile(out).iterations[-1]
        return {"learned_mps": newest.learned_mps, "offset_mps": newest.offset_mps}


class Analysing:
    """``pldf analyse``: the rates are judged."""

    name = "analyse"
    tolerance = RATE

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "laboratory"
        (folder / "road.csv").write_text(ROAD)
        (self.folder / "recordings").mkdir(parents=True)
        for who in (1, 2):
            for at, phase in enumerate(PHASES):
                drive = sound_drive(400.0 + 30.0 * who, 850.0 + 20.0 * at, 2.0 + 0.25 * at)
                path = self.folder / "recordings" / f"P00{who}_{phase}.csv"
                path.write_bytes(sheet_of(drive).written())
        self.sound = self.outcome(sheet_of(self.drive()).written())
        assert self.sound.status == 0, self.sound.told

    def drive(self) -> Drive:
        """Return the drive that is spoilt."""
        return sound_drive(450.0, 880.0, 2.25)

    def outcome(self, data: bytes) -> Outcome:
        """Analyse the study with this content in one of its recordings."""
        (self.folder / "recordings" / "P001_A2.csv").write_bytes(data)
        return run(
            ["analyse", str(self.folder), "--route", str(self.folder.parent / "road.csv")],
            self._rates,
        )

    def _rates(self) -> dict[str, Array]:
        with (self.folder / "analysis" / "participants.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        return {
            name: np.array([float(row[name]) for row in rows])
            for name in ("pedal_rate", "set_speed_rate", "combined_rate")
        }


def spoilt(drive: Drive, chance: random.Random) -> tuple[str, bytes]:
    """Return what was done to a drive, and the file of what is left."""
    done = []
    if chance.random() < 0.7:
        done.append(chance.choice(list(SPOILS)))
        SPOILS[done[-1]](drive, chance)
    sheet = sheet_of(drive)
    if not done or chance.random() < 0.1:
        done.append(chance.choice(list(CONTENTS)))
        CONTENTS[done[-1]](sheet, chance)
    if chance.random() < 0.1:
        done.append(chance.choice(list(DRESSES)))
        DRESSES[done[-1]](sheet, chance)
    data = sheet.written()
    if chance.random() < 0.05:
        done.append(chance.choice(list(DAMAGES)))
        data = DAMAGES[done[-1]](data, chance)
    return " ".join(done), data


def verdict(judge: Learning | Analysing, data: bytes) -> tuple[Word, str]:
    """Return right, told, refused or violation, and what speaks for it."""
    try:
        outcome = judge.outcome(data)
    except Exception as error:
        return "violation", f"{type(error).__name__}: {error}"
    if outcome.status:
        refused = outcome.status == 1 and "P001_A" in outcome.told
        return "refused" if refused else "violation", f"exit {outcome.status}: {outcome.told}"
    if outcome.told and outcome.told != judge.sound.told:
        return "told", outcome.told
    wrong = list(_wrong(judge, outcome))
    return ("violation", wrong[0]) if wrong else ("right", "")


def _wrong(judge: Learning | Analysing, outcome: Outcome) -> Iterator[str]:
    for name, values in outcome.numbers.items():
        sound = judge.sound.numbers[name]
        if values.shape != sound.shape or not np.isfinite(values).all():
            yield f"{name} is no number, or of another length"
        elif (away := float(np.abs(values - sound).max())) > judge.tolerance:
            yield f"{name} differs by {away:.3g} without a word"


KINDS: Final[tuple[type[Learning | Analysing], ...]] = (Learning, Analysing)


def trials(kind: type[Learning | Analysing], count: int, seed: int) -> Iterator[Verdict]:
    """Spoil a recording so often; yield what the command made of it."""
    chance = random.Random(f"{kind.name} {seed}")
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        judge = kind(Path(folder))
        for _ in range(count):
            done, data = spoilt(judge.drive(), chance)
            yield Verdict(done, *verdict(judge, data))


def commands(count: int, seed: int, progress: Progress) -> Counts:
    """Learn from and analyse so many spoilt recordings; count the verdicts."""
    return counted(KINDS, trials, count, seed, progress)


EXPERIMENTS: Final = (
    Experiment(
        "judged_commands",
        "From a recording that contradicts itself, what is learned and what is counted stays "
        "what it was, or the command tells, or refuses.",
        commands,
        count=240,
        short=40,
    ),
)
