"""``participants.csv``: one line per participant with seed and every parameter of the driver."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from ..files.tables import Cell, Column, Format, read_table, table_csv
from ..findings import Finding
from ..kernel.signals import Signal
from .participants import DRIVER_SIGNALS, Participant
from .phases import SEED_MAX

_FIELDS: Final = {signal.name: field for field, signal in DRIVER_SIGNALS.items()}


def _column(signal: Signal) -> Column:
    if signal.kind == "Boolean":
        return Column(signal.name, "flag", needed=False)
    low, high = signal.range
    return Column(
        signal.name,
        "number" if signal.kind == "Real" else "whole",
        unit=signal.unit,
        low=low,
        high=high,
        needed=False,
    )


PARTICIPANTS: Final = Format(
    "list of participants",
    "participant",
    (
        Column(
            "participant",
            "text",
            pattern=r"P(00[1-9]|0[1-9]\d|[1-9]\d{2,8})",
            wanted="P and a number, such as P001",
            needed=False,
        ),
        Column("seed", "whole", low=0.0, high=float(SEED_MAX)),
        *map(_column, DRIVER_SIGNALS.values()),
    ),
    closed=True,
)


def participants_csv(participants: Sequence[Participant]) -> bytes:
    """Return the file's content; every number reads back to the same bits."""
    columns: dict[str, list[Cell]] = {
        "participant": [one.id for one in participants],
        "seed": [one.seed for one in participants],
    }
    for name, field in _FIELDS.items():
        columns[name] = [one.value(field) for one in participants]
    return table_csv(columns)


def read_participants(path: Path, notes: list[Finding] | None = None) -> tuple[Participant, ...]:
    """Read explicit participants.

    Needed is the column ``seed``. Without the column ``participant`` they are numbered in the order
    of the lines; parameters without a column keep the driver model's defaults.

    Args:
        path: the file.
        notes: how it was read is added to them.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    table = read_table(path, PARTICIPANTS)
    if notes is not None:
        notes += table.notes
    ids = table.texts.get("participant") or [f"P{n + 1:03d}" for n in range(len(table))]
    table.refuse(
        table.fault(row, "participant", f"{ids[row]} occurs twice, first in line {line}")
        for row, line in table.repeated(ids)
    )
    values = {_FIELDS[n]: column.tolist() for n, column in table.numbers.items() if n in _FIELDS}
    participants = [
        Participant(name, int(seed), {field: column[row] for field, column in values.items()})
        for row, (name, seed) in enumerate(zip(ids, table.numbers["seed"], strict=True))
    ]
    return tuple(sorted(participants, key=lambda person: person.number))
