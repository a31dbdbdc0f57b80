"""The part of the generated C code that says what a restored state may hold."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields

from ...kernel.ranges import LAST_NODE, NODES, Range, columns_of, ranges_of
from .c_source import number
from .model import NativeModel


def cell_ranges(model: NativeModel, cells: list[str]) -> Iterator[Iterable[str]]:
    """Yield what each cell of a restored state may hold."""
    ranges = ranges_of(model.record)
    for watch in model.watches:
        if ranges[watch.field] != Range(0, len(watch.texts) - 1):
            raise ValueError(f"{watch.field}: its range does not fit the texts of the watch")
    for spec in fields(model.record):
        kind = "KIND_INTEGER" if isinstance(spec.default, int) else "KIND_REAL"
        allowed = ranges[spec.name]
        yield _range(kind, allowed, cells) if allowed is not None else _range("0", Range(), cells)


def column_ranges(model: NativeModel) -> Iterator[Iterable[str]]:
    """Yield what each kept column may hold: those per node, then those per line of a script."""
    events = (model.events,) if model.events is not None else ()
    for group in (*model.groups[: model.kept], *events):
        for allowed in columns_of(group):
            yield _range("KIND_REAL", allowed, [])


def _range(kind: str, allowed: Range, cells: list[str]) -> Iterator[str]:
    places = {"": "NOWHERE", NODES: "NODES", LAST_NODE: "LAST_NODE"}
    yield kind
    yield number(allowed.low)
    yield number(allowed.high)
    yield places.get(allowed.at_most) or str(cells.index(allowed.at_most))
    yield places.get(allowed.plus) or str(cells.index(allowed.plus))
