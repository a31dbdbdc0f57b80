"""A part of a study: the drives of one participant, as JSON, checked when they are read."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Final, Literal

import msgspec
from msgspec import Meta

from ..files.tables import Cell
from .drive_row import DriveRow

_Share = Annotated[float, Meta(ge=0.0, le=1.0)]
_Amount = Annotated[float, Meta(ge=0.0)]
# The columns of ``drives.csv``.
_Row = tuple[
    str, str, Literal["A", "B"], int, _Amount, _Share, _Share, _Share, _Amount, float, float
]
_WHAT: Final = "not the drives of this participant in this study"


def part_json(rows: Sequence[DriveRow]) -> bytes:
    """Return the content of a part."""
    return json.dumps([row.cells for row in rows]).encode()


def read_part(path: Path, participant: str, phases: Sequence[str]) -> list[list[Cell]]:
    """Return the rows of the drives of ``participant``, who drove ``phases`` in this order.

    Raises:
        ValueError: it is damaged, and how.
        OSError: it cannot be read.
    """
    try:
        rows: list[list[Cell]] = json.loads(path.read_bytes())
    except RecursionError:
        raise ValueError("lists within lists without end") from None
    for row in msgspec.convert(rows, list[_Row]):
        if row[0] != participant:
            raise ValueError(f"{_WHAT}: {row[0]!r}")
    names, places = [row[1] for row in rows], [row[3] for row in rows]
    if names != list(phases) or places != list(range(1, len(phases) + 1)):
        raise ValueError(f"{_WHAT}: {len(rows)} of {len(phases)} drives, or in another order")
    return rows
