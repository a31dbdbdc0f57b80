"""Reads traffic scripts: CSV files that say what the car ahead does where or when."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from pldf.files.tables import Column, Fault, Format, Table, read_table
from pldf.findings import Finding

from .driver_script import UNITS, packed_file
from .lead_motion import USUAL_MPS2
from .lead_script_kernel import APPEAR, LEAVE, LOST, SEEN, SPEED, LeadScriptArrays

TRAFFIC_SCRIPTS: Final = Path(__file__).parent / "traffic_scripts"
# The order is that of ``script_id``: append, never insert.
PACKED_TRAFFIC: Final = ("cut_in_and_stop.csv", "stop_and_go.csv")
ACTIONS: Final = {"appear": APPEAR, "speed": SPEED, "lost": LOST, "seen": SEEN, "leave": LEAVE}
# What an action needs, and what it may have besides.
_NEEDED: Final = {"appear": ("gap_m", "speed_mps"), "speed": ("speed_mps",)}
_ALLOWED: Final = {**_NEEDED, "speed": ("speed_mps", "acceleration_mps2")}
_VALUES: Final = ("gap_m", "speed_mps", "acceleration_mps2")
TRAFFIC_SCRIPT: Final = Format(
    "traffic script",
    "event",
    (
        Column("at", low=0.0, high=1e9),
        Column("unit", "word", words=tuple(UNITS)),
        Column("action", "word", words=tuple(ACTIONS)),
        Column("gap_m", unit="m", low=0.0, high=1e4, blank=True),
        Column("speed_mps", unit="m/s", low=0.0, high=80.0, blank=True),
        Column("acceleration_mps2", unit="m/s2", low=0.1, high=12.0, blank=True, needed=False),
    ),
)


class LeadEvent(NamedTuple):
    """One line of a traffic script, with codes instead of words; 0 where a number says nothing."""

    at: float
    unit: int
    action: int
    gap_m: float
    speed_mps: float
    acceleration_mps2: float


class TrafficScript(list[LeadEvent]):
    """The events of a file, in its order.

    Attributes:
        notes: how the file was read.
    """

    notes: tuple[Finding, ...] = ()


def packed_traffic(script_id: int) -> Path:
    """Return the file of a packed traffic script; ModelError lists the known ones."""
    return packed_file(TRAFFIC_SCRIPTS, PACKED_TRAFFIC, script_id, "traffic scripts")


def read_traffic(path: Path) -> TrafficScript:
    """Read a traffic script's events in the order of the file.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    table = read_table(path, TRAFFIC_SCRIPT)
    table.refuse(_unfit_values(table))
    units, actions = list(UNITS.values()), list(ACTIONS.values())
    script = TrafficScript(
        LeadEvent(at, units[int(unit)], actions[int(action)], *values)
        for at, unit, action, *values in zip(*_columns(table), strict=True)
    )
    script.notes = tuple(table.notes)
    return script


def traffic_arrays(events: list[LeadEvent]) -> LeadScriptArrays:
    """Return these events as arrays for the kernel, none of them done."""
    columns = [np.array(column, dtype=np.float64) for column in zip(*events, strict=True)]
    return LeadScriptArrays(*(*columns, np.zeros(len(events))))


def _columns(table: Table) -> Iterator[list[float]]:
    """Yield the columns; blank numbers are 0, a blank strength is the usual one."""
    blank = np.full(len(table.numbers["at"]), np.nan)
    for name in TRAFFIC_SCRIPT.names:
        usual = USUAL_MPS2 if name == "acceleration_mps2" else 0.0
        values = table.numbers.get(name, blank)
        yield np.where(np.isnan(values), usual, values).tolist()


def _unfit_values(table: Table) -> Iterator[Fault]:
    """An action has the numbers that it needs, and none that would mean nothing."""
    words = list(ACTIONS)
    there = [name for name in _VALUES if name in table.numbers]
    for row, action in enumerate(table.numbers["action"].tolist()):
        word = words[int(action)]
        for name in there:
            value = float(table.numbers[name][row])
            if isnan(value) and name in _NEEDED.get(word, ()):
                yield table.fault(row, name, f"missing; {word} needs it")
            elif not isnan(value) and name not in _ALLOWED.get(word, ()):
                yield table.fault(row, name, f"'{value:g}' for {word}; leave it empty")
