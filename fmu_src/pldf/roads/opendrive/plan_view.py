"""What the plan views of a file say, in arrays: a city has a million geometries.

As elements they would take two kilobytes each. A number that is none is kept as NaN, with its
text: it is an error only in a road that is driven.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Final, NamedTuple
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from .ragged import Indices
from .xml_tree import Element, as_number, is_plain, no_number

POSE: Final = ("s", "x", "y", "hdg", "length")
NO_SHAPE, LINE, ARC, SPIRAL, POLY3, NORMALIZED, ARC_LENGTH, UNKNOWN_RANGE = range(8)
_UV: Final = ("aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV")
# By kind: the element and its numbers. Of paramPoly3 there are three, by pRange.
_SHAPES: Final[tuple[tuple[str, tuple[str, ...]], ...]] = (
    ("", ()),
    ("line", ()),
    ("arc", ("curvature",)),
    ("spiral", ("curvStart", "curvEnd")),
    ("poly3", ("a", "b", "c", "d")),
    ("paramPoly3", _UV),
    ("paramPoly3", _UV),
    ("paramPoly3", _UV),
)
_KINDS: Final = {name: kind for kind, (name, _) in enumerate(_SHAPES[:ARC_LENGTH])}
_RANGES: Final = {"normalized": NORMALIZED, "arclength": ARC_LENGTH}
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
        self.texts: list[str | None] = []  # those that wait
        self._values = array("d")
        self.none: dict[int, str | None] = {}  # the text of those that are no number

    def all(self) -> FloatArray:
        """Return all; nothing can be added any more."""
        if self.texts:
            self.convert()
        return np.frombuffer(self._values) if self._values else np.empty(0)

    def convert(self) -> None:
        """Make numbers of the texts that wait."""
        try:
            plain = is_plain("".join(self.texts))  # type: ignore[arg-type]
            new = array("d", map(float if plain else as_number, self.texts))  # type: ignore[arg-type]
        except (ValueError, TypeError):
            new = array("d", map(as_number, self.texts))
        for at in np.flatnonzero(~np.isfinite(new)):
            text = self.texts[at]
            self.none[len(self._values) + int(at)] = None if text is None else text[:_TEXT_MAX]
        self._values += new
        self.texts.clear()


def _param_poly3(attributes: dict[str, str]) -> int:
    return _RANGES.get(attributes.get("pRange", "normalized").strip().lower(), UNKNOWN_RANGE)


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

    def handlers(
        self,
        parser: expat.XMLParserType,
        skipped_lines: int,
        check_depth: Callable[[int], None],
        closed: Callable[[], None],
    ) -> tuple[Callable[[str, dict[str, str]], None], Callable[[str], None]]:
        """Return what handles the elements inside a ``planView``, and their ends.

        They are called two million times for a city, so they call nothing that can be at hand. Of
        a geometry with two shapes the first counts.

        Args:
            parser: of the file.
            skipped_lines: before what the parser got.
            check_depth: is asked about elements inside others, with how many these are.
            closed: is called at the end of the ``planView``.
        """
        kinds, lines, shape_lines = self._kind, self._line, self._shape_line
        poses, numbers = self._poses.texts, self._numbers.texts
        depth, is_geometry = 0, False

        def start(tag: str, attributes: dict[str, str]) -> None:
            nonlocal depth, is_geometry
            depth += 1
            if depth == 1:
                is_geometry = tag.rpartition(":")[2] == "geometry"
                if is_geometry:
                    poses.extend(map(attributes.get, POSE))
                    kinds.append(NO_SHAPE)
                    lines.append(parser.CurrentLineNumber + skipped_lines)
                    shape_lines.append(0)
                    if len(poses) > _AT_ONCE:
                        self._convert()
            elif depth == 2 and is_geometry:
                kind = _KINDS.get(tag.rpartition(":")[2], NO_SHAPE)
                if kinds[-1] == NO_SHAPE != kind:
                    if kind == NORMALIZED:
                        kind = _param_poly3(attributes)
                    kinds[-1] = kind
                    shape_lines[-1] = parser.CurrentLineNumber + skipped_lines
                    numbers.extend(map(attributes.get, _SHAPES[kind][1]))
            else:
                check_depth(depth)

        def end(_: str) -> None:
            nonlocal depth
            if depth:
                depth -= 1
            else:
                closed()

        return start, end

    def rows(self, plans: list[PlanView]) -> Rows:
        """Return the geometries of ``plans``."""
        row = np.concatenate([np.arange(plan.first, plan.stop) for plan in plans])
        # Those of one plan are not copied.
        where = slice(plans[0].first, plans[0].stop) if len(plans) == 1 else row
        return Rows(
            self._poses.all().reshape(-1, len(POSE))[where],
            np.frombuffer(self._kind, dtype=np.int8)[where],
            np.frombuffer(self._line, dtype=np.intc)[where],
            np.frombuffer(self._shape_line, dtype=np.intc)[where],
            self._first_numbers()[where],
            row,
        )

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
        self._numbers.all()
        bad = np.array(sorted(self._numbers.none), dtype=np.intp)
        first = np.searchsorted(bad, rows.first_number)
        ends = np.searchsorted(bad, rows.first_number + _NUMBERS[rows.kind])
        for at in np.flatnonzero(ends > first):
            tag, names = _SHAPES[rows.kind[at]]
            for number, name in enumerate(names, int(rows.first_number[at])):
                if number in self._numbers.none:
                    text = no_number(tag, name, self._numbers.none[number])
                    found.append((int(rows.shape_line[at]), text))
        missing = "no line, arc, spiral, poly3 or paramPoly3 in this geometry"
        found += [(int(line), missing) for line in rows.line[rows.kind == NO_SHAPE]]
        unknown = "<paramPoly3> attribute pRange is neither arcLength nor normalized; correct it"
        found += [(int(line), unknown) for line in rows.shape_line[rows.kind == UNKNOWN_RANGE]]
        return found

    def _convert(self) -> None:
        self._poses.convert()
        self._numbers.convert()

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
