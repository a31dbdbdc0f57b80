"""What the plan views of a file say, in arrays: a city has a million geometries.

As elements they would take two kilobytes each. A number that is none is kept as NaN, with its
text: it is an error only in a road that is driven.
"""

from __future__ import annotations

import math
from array import array
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray
from .ragged import Indices
from .xml_tree import Element, no_number

POSE: Final = ("s", "x", "y", "hdg", "length")
NO_SHAPE, LINE, ARC, SPIRAL, POLY3, NORMALIZED, ARC_LENGTH = range(7)
_UV: Final = ("aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV")
# By kind: the element and its numbers. Of paramPoly3 there are two, by pRange.
_SHAPES: Final[tuple[tuple[str, tuple[str, ...]], ...]] = (
    ("", ()),
    ("line", ()),
    ("arc", ("curvature",)),
    ("spiral", ("curvStart", "curvEnd")),
    ("poly3", ("a", "b", "c", "d")),
    ("paramPoly3", _UV),
    ("paramPoly3", _UV),
)
_KINDS: Final = {name: kind for kind, (name, _) in enumerate(_SHAPES[:ARC_LENGTH])}
_NUMBERS: Final = np.array([len(names) for _, names in _SHAPES])
_AT_ONCE: Final = 50_000  # texts that wait until they are made numbers
_TEXT_MAX: Final = 50  # characters of a text that is no number


class Rows(NamedTuple):
    """Some geometries as the file states them; NaN where a number is none."""

    pose: FloatArray  # [n, 5]: s, x, y, heading, length
    kind: NDArray[np.int8]  # [n]: one of the kinds above
    line: NDArray[np.intc]  # [n]: of the file
    shape_line: NDArray[np.intc]  # [n]: of the element that gives the shape
    first_number: Indices  # [n]: where in ``numbers`` those of the shape begin
    row: Indices  # [n]: in the table

    @property
    def s_m(self) -> FloatArray:
        """Where they start."""
        return self.pose[:, 0]

    @property
    def length_m(self) -> FloatArray:
        """How long they are."""
        return self.pose[:, 4]

    def take(self, which: Indices) -> Rows:
        """Return those at ``which``, in that order."""
        return Rows(*(values[which] for values in self))  # type: ignore[arg-type]


class _Numbers:
    """Attributes of many elements as one array."""

    def __init__(self) -> None:
        self._values = array("d")
        self._texts: list[str | None] = []
        self.none: dict[int, str | None] = {}  # the text of those that are no number

    def add(self, attributes: dict[str, str], names: tuple[str, ...]) -> None:
        self._texts += map(attributes.get, names)
        if len(self._texts) > _AT_ONCE:
            self._convert()

    def all(self) -> FloatArray:
        """Return all; nothing can be added any more."""
        if self._texts:
            self._convert()
        return np.frombuffer(self._values) if self._values else np.empty(0)

    def _convert(self) -> None:
        try:
            new = array("d", map(float, self._texts))  # type: ignore[arg-type]
        except (ValueError, TypeError):
            new = array("d", map(_number, self._texts))
        for at in np.flatnonzero(~np.isfinite(new)):
            text = self._texts[at]
            self.none[len(self._values) + int(at)] = None if text is None else text[:_TEXT_MAX]
        self._values += new
        self._texts.clear()


def _number(text: str | None) -> float:
    try:
        return math.nan if text is None else float(text)
    except ValueError:
        return math.nan


class GeometryTable:
    """Every geometry of a file, in its order."""

    def __init__(self) -> None:
        self._poses = _Numbers()
        self._numbers = _Numbers()
        self._kind = bytearray()
        self._line = array("i")
        self._shape_line = array("i")
        self._first_number: Indices | None = None

    def __len__(self) -> int:
        return len(self._kind)

    def add(self, attributes: dict[str, str], line: int) -> None:
        """Begin a ``geometry``."""
        self._poses.add(attributes, POSE)
        self._kind.append(NO_SHAPE)
        self._line.append(line)
        self._shape_line.append(line)

    def shape(self, tag: str, attributes: dict[str, str], line: int) -> None:
        """Give the last geometry its shape, unless ``tag`` is none or it has one."""
        kind = _KINDS.get(tag, NO_SHAPE)
        if kind == NO_SHAPE or self._kind[-1] != NO_SHAPE:
            return
        if kind == NORMALIZED and attributes.get("pRange", "normalized").lower() == "arclength":
            kind = ARC_LENGTH
        self._kind[-1] = kind
        self._shape_line[-1] = line
        if kind != LINE:
            self._numbers.add(attributes, _SHAPES[kind][1])

    def rows(self, plans: list[PlanView]) -> Rows:
        """Return the geometries of ``plans``."""
        row = np.concatenate([np.arange(plan.first, plan.stop) for plan in plans])
        kind = np.frombuffer(self._kind, dtype=np.int8)[row]
        pose = self._poses.all().reshape(-1, len(POSE))[row]
        line = np.frombuffer(self._line, dtype=np.intc)[row]
        shape_line = np.frombuffer(self._shape_line, dtype=np.intc)[row]
        return Rows(pose, kind, line, shape_line, self._first_numbers()[row], row)

    def numbers(self, rows: Rows, count: int) -> FloatArray:
        """Return the ``count`` numbers of each shape, [n, count]."""
        numbers: FloatArray = self._numbers.all()[rows.first_number[:, None] + np.arange(count)]
        return numbers

    def faults(self, rows: Rows, names: tuple[str, ...]) -> list[tuple[int, str]]:
        """Return line and text of each number of ``names`` in the pose that is none."""
        none = self._poses.none
        columns = np.array([POSE.index(name) for name in names])
        bad = np.argwhere(~np.isfinite(rows.pose[:, columns]))
        return [
            (
                int(rows.line[at]),
                no_number("geometry", names[k], none[int(rows.row[at]) * len(POSE) + columns[k]]),
            )
            for at, k in bad
        ]

    def shape_faults(self, rows: Rows) -> list[tuple[int, str]]:
        """Return line and text of each number of the shapes that is none, and of missing shapes."""
        found: list[tuple[int, str]] = []
        finite = np.concatenate(([0], np.cumsum(~np.isfinite(self._numbers.all()))))
        ends = rows.first_number + _NUMBERS[rows.kind]
        for at in np.flatnonzero(finite[ends] > finite[rows.first_number]):
            tag, names = _SHAPES[rows.kind[at]]
            for number, name in enumerate(names, int(rows.first_number[at])):
                if number in self._numbers.none:
                    text = no_number(tag, name, self._numbers.none[number])
                    found.append((int(rows.shape_line[at]), text))
        missing = "no line, arc, spiral, poly3 or paramPoly3 in this geometry"
        found += [(int(line), missing) for line in rows.line[rows.kind == NO_SHAPE]]
        return found

    def _first_numbers(self) -> Indices:
        if self._first_number is None:
            counts = _NUMBERS[np.frombuffer(self._kind, dtype=np.int8)]
            self._first_number = np.cumsum(counts) - counts
        return self._first_number


class PlanView(Element):
    """A ``planView``: its geometries are rows of a table, from ``first`` up to ``stop``."""

    __slots__ = ("first", "stop", "table")

    def __init__(self, attributes: dict[str, str], line: int, table: GeometryTable) -> None:
        super().__init__("planView", attributes, line)
        self.table = table
        self.first = self.stop = len(table)
