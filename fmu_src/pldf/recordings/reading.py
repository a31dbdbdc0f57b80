"""From a file to our columns: which column is which, in which unit, at which time."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..findings import Finding
from ..kernel.arrays import FloatArray
from .growing_time import with_growing_time
from .inputs import Input, open_input
from .mapping import RecordingMap, remembered_map
from .matching import found_columns, is_converted, other_units, recognised, told_of_map
from .titles import with_meant_names
from .values import format_of, numbers_of


class Columns(NamedTuple):
    """What was read: our columns by name, comments of the file, and what has to be known."""

    numbers: dict[str, FloatArray]
    comments: tuple[str, ...]
    notes: tuple[Finding, ...]


def read_columns(path: Path, mapping: RecordingMap | None) -> Columns:
    """Read a recording with ``mapping``, else with the one kept for it, else with our names.

    Raises:
        ModelError: naming file, line, column and value of all that cannot be used.
    """
    file = open_input(path)
    with file.placed():
        found = _read(file, mapping or remembered_map(path))
    return found._replace(notes=tuple(map(file.place, found.notes)))


def _read(file: Input, mapping: RecordingMap | None) -> Columns:
    if mapping is None:
        mapping = recognised(file) or RecordingMap("")
    notes: list[Finding] = []
    mapping = with_meant_names(file, mapping, notes)
    found = found_columns(file, mapping)
    notes += other_units(file, mapping, found)
    if mapping.name or any(is_converted(column) for column in found):
        notes.append(told_of_map(file, mapping, found))
    table, told = file.table(format_of(found, mapping))
    numbers = numbers_of(table, found, mapping)
    notes += [*told, *table.notes]
    clock = next(column.name for column in found if column.ours.name == "time_s")
    numbers = with_growing_time(table, numbers, notes, clock)
    return Columns(numbers, table.comments, tuple(notes))
