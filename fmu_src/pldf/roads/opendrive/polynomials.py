"""poly3 and paramPoly3: cubic polynomials (u(p), v(p)) of a parameter p.

Curvature and heading are analytic in the parameter; which parameter belongs to an arc length is
found by integration. Everything is computed for many polynomials at once.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from .quadrature import NODES, means
from .ragged import Indices, distinct_runs, firsts, running_sums, within

_TABLE_STEP_M: Final = 0.25
# A polynomial longer or shorter than its geometry by more than this share is a wrong pRange.
_LENGTH_TOLERANCE: Final = 0.05
_AT_ONCE: Final = 10_000  # polynomials whose faults are looked for at a time


class GeometryError(ValueError):
    """A polynomial is no road."""


class _Table(NamedTuple):
    """Which parameter belongs to which arc length, polynomial behind polynomial."""

    cells: Indices  # of each polynomial; it has one value more
    parameter: FloatArray
    arc_m: FloatArray


@dataclass(frozen=True)
class Polynomials:
    """The curves (u(p), v(p)) of some geometries; arrays of one length.

    poly3 is v(u), which reaches its arc length before u does. Real files keep the p of paramPoly3
    only nearly proportional to the arc length, so that of the curve is used, scaled to ``length_m``
    where the curve is to end with the parameter.
    """

    cubics: FloatArray  # [n, 8]: coefficients of u, then of v, lowest first
    parameter_end: FloatArray
    length_m: FloatArray
    scaled: NDArray[np.bool_]
    line: NDArray[np.intc]  # of the file

    def points(
        self, which: Indices, ds: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return curvature, heading, u and v, ``ds`` metres behind the starts of ``which``.

        Equal ones in ``which`` stand together. Where the curve stands still, at one of its ends,
        its curvature is not finite, and its heading the one of the points beside.

        Raises:
            GeometryError: the curve has no length, or not that of its geometry.
        """
        distinct, group = distinct_runs(which)
        some = self._take(distinct)
        table, faults = some._table()
        if any(faults):
            raise GeometryError(next(filter(None, faults)))
        p = _interpolated(table, group, ds)
        u, v = some.cubics[group, :4].T, some.cubics[group, 4:].T
        u1, v1, u2, v2 = _slope(u, p), _slope(v, p), _bend(u, p), _bend(v, p)
        pace = np.hypot(u1, v1)
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = (u1 * v2 - v1 * u2) / pace**3
        still = pace == 0.0
        ahead = np.where(p == 0.0, 1.0, -1.0)
        heading = np.arctan2(np.where(still, ahead * v2, v1), np.where(still, ahead * u2, u1))
        return curvature, heading, _value(u, p), _value(v, p)

    def faults(self) -> list[tuple[int, str]]:
        """Return file line and text of each that is no road."""
        found: list[tuple[int, str]] = []
        for first in range(0, len(self.line), _AT_ONCE):
            some = self._take(slice(first, first + _AT_ONCE))
            _, texts = some._table()
            found += [(int(at), text) for at, text in zip(some.line, texts, strict=True) if text]
        return found

    def _take(self, which: Indices | slice) -> Polynomials:
        return Polynomials(*(getattr(self, field.name)[which] for field in fields(self)))

    def _table(self) -> tuple[_Table, list[str]]:
        cells = np.maximum(8, np.ceil(self.length_m / _TABLE_STEP_M)).astype(np.intp)
        owner, cell = within(cells)
        step = self.parameter_end / cells
        stations = (cell * step[owner])[:, None] + step[owner, None] * NODES
        u, v = (self.cubics[owner, four].T[..., None] for four in (slice(4), slice(4, 8)))
        pace = np.hypot(_slope(u, stations), _slope(v, stations))
        arc_m = running_sums(step[owner] * means(pace), cells)
        holder, index = within(cells + 1)
        last = index == cells[holder]
        parameter = np.where(last, self.parameter_end[holder], index * step[holder])
        faults = self._faults(cells, arc_m)
        length = np.where(self.scaled, self.length_m / arc_m[firsts(cells + 1) + cells], 1.0)
        return _Table(cells, parameter, arc_m * length[holder]), faults

    def _faults(self, cells: Indices, arc_m: FloatArray) -> list[str]:
        rising = np.append(np.diff(arc_m) > 0.0, True)
        rising[firsts(cells + 1)[1:] - 1] = True  # from one polynomial to the next
        moves = np.logical_and.reduceat(rising, firsts(cells + 1))
        arc = arc_m[firsts(cells + 1) + cells]
        fits = ~self.scaled | (np.abs(arc - self.length_m) <= _LENGTH_TOLERANCE * self.length_m)
        return [
            "the polynomial stands still; check its coefficients" if not moves[at]
            else "" if fits[at]
            else f"the polynomial is {arc[at]:.6g} m long, its geometry {self.length_m[at]:.6g} m; "
            "check length and pRange"
            for at in range(len(cells))
        ]  # fmt: skip


def _interpolated(table: _Table, group: Indices, ds: FloatArray) -> FloatArray:
    """Return the parameters at ``ds``: ``np.interp``, each in the table of its own polynomial."""
    begins = firsts(table.cells + 1)[group]
    low, high = begins.copy(), begins + table.cells[group]
    end = high.copy()
    for _ in range(int(np.max(table.cells)).bit_length()):
        middle = (low + high + 1) >> 1
        behind = table.arc_m[middle] <= ds
        low = np.where(behind, middle, low)
        high = np.where(behind, high, middle - 1)
    following = np.minimum(low + 1, end)
    known, p = table.arc_m[low], table.parameter[low]
    span = table.arc_m[following] - known
    slope = np.divide(table.parameter[following] - p, span, out=np.zeros_like(p), where=span > 0.0)
    return np.where(ds > known, slope * (ds - known) + p, p)


def _value(c: FloatArray, p: FloatArray) -> FloatArray:
    value: FloatArray = c[0] + p * (c[1] + p * (c[2] + p * c[3]))
    return value


def _slope(c: FloatArray, p: FloatArray) -> FloatArray:
    slope: FloatArray = c[1] + p * (2.0 * c[2] + p * (3.0 * c[3]))
    return slope


def _bend(c: FloatArray, p: FloatArray) -> FloatArray:
    bend: FloatArray = 2.0 * c[2] + p * (6.0 * c[3])
    return bend
