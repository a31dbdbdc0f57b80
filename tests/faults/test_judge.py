"""The judge of spoilt files: what it says of sound ones, and whether it sees what is wrong."""

from __future__ import annotations

import csv
import random
from dataclasses import replace
from math import nan
from pathlib import Path

import pytest

from faults.judged_kinds import Answer, Kind
from faults.judged_tables import KINDS, judged, trials
from faults.sheet_changes import DRESSES
from faults.sheets import Dress, Unclear, number
from faults.verdicts import same

ROUTE = KINDS[0]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
@pytest.mark.parametrize("dress", DRESSES)
def test_however_a_sound_table_is_written_the_judge_reads_the_same(kind: Kind, dress: str) -> None:
    plain = kind.sheet(random.Random(1))
    dressed = kind.sheet(random.Random(1))
    DRESSES[dress](dressed, random.Random(2))
    meant = judged(kind, plain.written(), plain.dress)
    assert same(judged(kind, dressed.written(), dressed.dress), meant)


@pytest.mark.parametrize(
    ("cell", "decimal", "meant"),
    [
        ("1,5", ",", 1.5),
        ("1.234,5", ",", 1234.5),
        ("1.234", ",", 1234.0),
        ("1,234.5", ".", 1234.5),
        ("1\u202f234.5", ".", 1234.5),
        ("\u22121.5e3", ".", -1500.0),
        ("\u0663", ".", 3.0),
        ("NaN", ".", None),
        ("-99", ".", None),
    ],
)
def test_what_people_mean_by_a_cell(cell: str, decimal: str, meant: float | None) -> None:
    assert number(cell, Dress(decimal=decimal)) == meant


@pytest.mark.parametrize("cell", ["1,5", "72 km/h", "1_000", "0x1F", "1e999", "12 34", "--1"])
def test_what_nobody_can_know(cell: str) -> None:
    with pytest.raises(Unclear):
        number(cell, Dress())


def _guessed(path: Path) -> Answer:
    """Read a route as careless programs do: what is no number is 0, what is absent too."""
    with path.open(newline="", encoding="utf-8", errors="replace") as file:
        rows = [
            {name: _number(cell) for name, cell in row.items() if name}
            for row in csv.DictReader(file)
        ]
    return Answer({name: [row.get(name, 0.0) for row in rows] for name in ROUTE.columns})


def _number(cell: object) -> float:
    try:
        return float(str(cell))
    except ValueError:
        return 0.0


def test_a_reader_that_guesses_is_found_out() -> None:
    verdicts = list(trials(replace(ROUTE, read=_guessed), 400, 1))
    broken = {verdict.done.split()[0] for verdict in verdicts if verdict.word == "violation"}
    assert {"semicolons", "missing", "unit", "odd", "thousands_apostrophes"} <= broken


def _raises(path: Path) -> Answer:
    raise UnicodeDecodeError("utf-8", b"", 0, 1, "as an unprepared reader does")


def test_a_traceback_is_no_refusal() -> None:
    assert {verdict.word for verdict in trials(replace(ROUTE, read=_raises), 20, 1)} == {
        "violation"
    }


def test_a_note_about_something_else_excuses_nothing() -> None:
    def told(path: Path) -> Answer:
        values = {name: [nan] for name in ROUTE.columns}
        return Answer(values, "line 3: the last line has no end")

    assert {verdict.word for verdict in trials(replace(ROUTE, read=told), 50, 1)} <= {
        "violation",
        "told",
    }
    words = [v.word for v in trials(replace(ROUTE, read=told), 50, 1) if v.done in DRESSES]
    assert words
    assert set(words) == {"violation"}
