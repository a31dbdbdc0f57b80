"""Reads driver scripts: CSV files that say what to press where or when."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from pldf.errors import ModelError
from pldf.files.tables import Column, Fault, Format, Table, read_table
from pldf.findings import Finding

from .script_kernel import (
    AT_POSITION,
    AT_TIME,
    BRAKE,
    CANCEL,
    DOWN,
    DOWN_LONG,
    FORGET_HERE,
    GAS,
    PAUSE,
    RESUME,
    UNDO,
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
    "pause": PAUSE,
    "forget_here": FORGET_HERE,
    "undo": UNDO,
}
PEDALS: Final = ("gas", "brake")
SCRIPT: Final = Format(
    "driver script",
    "event",
    (
        Column("at", low=0.0, high=1e9),
        Column("unit", "word", words=tuple(UNITS)),
        Column("control", "word", words=tuple(CONTROLS)),
        Column("value", low=0.0, high=1.0, blank=True),
        Column("duration_s", unit="s", low=1e-3, high=1e6),
    ),
)
COLUMNS: Final = SCRIPT.names


class Event(NamedTuple):
    """One line of a script, with codes instead of words."""

    at: float
    unit: int
    control: int
    value: float
    duration_s: float


class Script(list[Event]):
    """The events of a file, in its order.

    Attributes:
        notes: how the file was read.
    """

    notes: tuple[Finding, ...] = ()


def packed_script(script_id: int) -> Path:
    """Return the file of a packed script; ModelError lists the known ones."""
    return packed_file(SCRIPTS, PACKED, script_id, "scripts")


def packed_file(folder: Path, names: tuple[str, ...], script_id: int, called: str) -> Path:
    """Return the file with this number; ModelError lists the known ones as what they are called."""
    if not 0 <= script_id < len(names):
        known = ", ".join(f"{i} ({name})" for i, name in enumerate(names))
        raise ModelError(f"script_id {script_id} is unknown; packed {called} are {known}")
    return folder / names[script_id]


def read_script(path: Path) -> Script:
    """Read a script's events in the order of the file.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    table = read_table(path, SCRIPT)
    table.refuse(_unfit_values(table))
    units, controls = list(UNITS.values()), list(CONTROLS.values())
    rows = zip(*(table.numbers[name].tolist() for name in COLUMNS), strict=True)
    script = Script(
        Event(
            at=at,
            unit=units[int(unit)],
            control=controls[int(control)],
            value=1.0 if isnan(value) else value,
            duration_s=duration_s,
        )
        for at, unit, control, value, duration_s in rows
    )
    script.notes = tuple(table.notes)
    return script


def script_arrays(events: list[Event]) -> ScriptArrays:
    """Return these events as arrays for the kernel, none of them begun."""
    columns = [np.array(column, dtype=np.float64) for column in zip(*events, strict=True)]
    return ScriptArrays(*(*columns, np.full(len(events), -1.0)))


def _unfit_values(table: Table) -> Iterator[Fault]:
    """Pedals need their travel; a contact or button is closed, so its value is empty or 1."""
    controls, values = (table.numbers[name].tolist() for name in ("control", "value"))
    words = list(CONTROLS)
    for row, (control, value) in enumerate(zip(controls, values, strict=True)):
        word = words[int(control)]
        if word in PEDALS and isnan(value):
            yield table.fault(row, "value", f"missing; {word} needs a number from 0 to 1")
        elif word not in PEDALS and not (isnan(value) or value == 1.0):
            yield table.fault(row, "value", f"'{value:g}' for {word}; leave it empty")
