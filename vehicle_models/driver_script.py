"""Reads driver scripts: CSV files that say what to press where or when."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from pldf.instance import ModelError

from .script_kernel import (
    AT_POSITION,
    AT_TIME,
    BRAKE,
    CANCEL,
    DOWN,
    DOWN_LONG,
    GAS,
    RESUME,
    UP,
    UP_LONG,
    ScriptArrays,
)

SCRIPTS: Final = Path(__file__).parent / "scripts"
# The order is that of ``script_id``: append, never insert.
PACKED: Final = ("pedals_and_lever.csv", "brake_for_village.csv")
UNITS: Final = {"s": AT_TIME, "m": AT_POSITION}
CONTROLS: Final = {
    "gas": GAS,
    "brake": BRAKE,
    "resume": RESUME,
    "cancel": CANCEL,
    "up": UP,
    "down": DOWN,
    "up_long": UP_LONG,
    "down_long": DOWN_LONG,
}
COLUMNS: Final = ("at", "unit", "control", "value", "duration_s")


class Event(NamedTuple):
    """One line of a script, with codes instead of words."""

    at: float
    unit: int
    control: int
    value: float
    duration_s: float


def packed_script(script_id: int) -> Path:
    """Return the file of a packed script; ModelError lists the known ones."""
    if not 0 <= script_id < len(PACKED):
        known = ", ".join(f"{i} ({name})" for i, name in enumerate(PACKED))
        raise ModelError(f"script_id {script_id} is unknown; packed scripts are {known}")
    return SCRIPTS / PACKED[script_id]


def read_script(path: Path) -> list[Event]:
    """Read a script's events in the order of the file; ModelError names file and line."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not a UTF-8 text file"
        raise ModelError(f"cannot read the driver script {path}: {reason}") from error
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    rows = zip((number for number, _ in lines), csv.reader(line for _, line in lines), strict=True)
    number, header = next(rows, (1, []))
    place = _columns(f"{path}, line {number}", [name.strip() for name in header])
    events = [_event(f"{path}, line {number}", place, row) for number, row in rows]
    if not events:
        raise ModelError(f"{path}: no events; each line below the header is one event")
    return events


def script_arrays(events: list[Event]) -> ScriptArrays:
    """Return these events as arrays for the kernel, none of them begun."""
    columns = [np.array(column, dtype=np.float64) for column in zip(*events, strict=True)]
    return ScriptArrays(*(*columns, np.full(len(events), -1.0)))


def _columns(where: str, header: list[str]) -> dict[str, int]:
    missing = [name for name in COLUMNS if name not in header]
    if missing:
        raise ModelError(f"{where}: no column {missing[0]}; the header is {','.join(COLUMNS)}")
    return {name: header.index(name) for name in COLUMNS}


def _event(where: str, place: dict[str, int], row: list[str]) -> Event:
    if len(row) <= max(place.values()):
        raise ModelError(f"{where}: {len(row)} fields, expected {','.join(place)}")
    cells = {name: row[column].strip() for name, column in place.items()}
    control = _word(where, "control", cells["control"], CONTROLS)
    return Event(
        at=_number(where, "at", cells["at"], (0.0, 1e9)),
        unit=_word(where, "unit", cells["unit"], UNITS),
        control=control,
        value=_value(where, control, cells["value"]),
        duration_s=_number(where, "duration_s", cells["duration_s"], (1e-3, 1e6)),
    )


def _value(where: str, control: int, text: str) -> float:
    """Pedals need their travel; a lever contact is closed, so its value is empty or 1."""
    if control in (GAS, BRAKE):
        return _number(where, "value", text, (0.0, 1.0))
    if text not in ("", "1"):
        raise ModelError(f"{where}: value '{text}' for the lever; leave it empty")
    return 1.0


def _number(where: str, name: str, text: str, allowed: tuple[float, float]) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not allowed[0] <= number <= allowed[1]:
        low, high = allowed
        raise ModelError(f"{where}: {name} '{text}'; a number from {low:g} to {high:g} is needed")
    return number


def _word(where: str, name: str, text: str, words: dict[str, int]) -> int:
    if text not in words:
        raise ModelError(f"{where}: {name} '{text}' is unknown; use one of {', '.join(words)}")
    return words[text]
