"""What the native build has to know of a model, besides its signals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from ...instance import Watch


@dataclass(frozen=True)
class NativeModel:
    """One model as the native runtime sees it: a record and a block of float64 columns.

    The block holds ``groups`` one after the other, each named tuple's arrays with one value per
    node; behind them ``events``, with one value per line of a driver's script.

    Attributes:
        name: model identifier.
        about: one sentence.
        record: class of the record.
        texts: class of the String parameters.
        modules: kernel modules that the entry points need.
        entries: functions ``(record, block, nodes, rows, step_s)``: ``start`` and ``step``;
            ``refresh`` if outputs follow inputs without a step; ``adopt``, ``learn``, ``forget``,
            ``mark`` and ``take_back`` if the model learns.
        groups: named tuples of arrays per node, in the order of the block.
        kept: how many of the groups belong to the state; the others are work space.
        route: the group that is filled from the route.
        route_if: field and value that ask for a route; an empty field: always.
        events: named tuple of arrays per line of a script, None without scripts.
        events_if: field and value that ask for a script.
        watches: what the user is told about while driving.
        bounds: pairs of Real parameters; the first, a bound, must not be weaker than the second.
    """

    name: str
    about: str
    record: type[Any]
    texts: type[Any]
    modules: tuple[ModuleType, ...]
    entries: dict[str, Callable[..., None]]
    groups: tuple[type[Any], ...]
    kept: int
    route: type[Any]
    watches: tuple[Watch, ...]
    route_if: tuple[str, int] = ("", 0)
    events: type[Any] | None = None
    events_if: tuple[str, int] = ("", 0)
    bounds: tuple[tuple[str, str], ...] = ()

    def first(self, kind: type[Any], field: str = "") -> int:
        """Return the column of ``kind``'s first array, or of the one named ``field``."""
        before = self.groups[: self.groups.index(kind)]
        inner = kind._fields.index(field) if field else 0
        return sum(len(group._fields) for group in before) + inner

    @property
    def node_columns(self) -> int:
        """Number of arrays per node."""
        return sum(len(group._fields) for group in self.groups)

    @property
    def kept_columns(self) -> int:
        """Number of those that belong to the state; they come first."""
        return sum(len(group._fields) for group in self.groups[: self.kept])

    @property
    def event_columns(self) -> int:
        """Number of arrays per line of a script."""
        return len(self.events._fields) if self.events is not None else 0

    def block(self, nodes: int, rows: int) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Return a zeroed block, as the C runtime allocates it."""
        return np.zeros(self.node_columns * nodes + self.event_columns * rows)
