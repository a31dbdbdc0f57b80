"""The five kinds of OpenDRIVE plan view geometry: curvature, heading and line over arc length.

Line, arc and spiral have a curvature linear in arc length. poly3 and paramPoly3 are cubic
polynomials (``polynomials.py``). Everything is computed for many geometries at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from .polynomials import Polynomials
from .quadrature import NODES, means
from .ragged import Indices, distinct_runs, firsts, running_sums, within

_AT_ONCE: Final = 1 << 14  # chords that are computed together
STRAIGHT: Final = -1  # in ``Geometries.cubic``: no polynomial


class Points(NamedTuple):
    """Points of reference lines, one value each."""

    curvature_per_m: FloatArray  # signed, positive to the left
    heading_rad: FloatArray  # from the x axis to the left
    x_m: FloatArray
    y_m: FloatArray


@dataclass(frozen=True)
class Geometries:
    """Pieces of a reference line in order of ``start_m``; arrays of one length."""

    start_m: FloatArray
    x_m: FloatArray
    y_m: FloatArray
    heading_rad: FloatArray
    length_m: FloatArray
    curvature_start_per_m: FloatArray  # 0 for polynomials
    curvature_end_per_m: FloatArray
    cubic: Indices  # row in ``polynomials``; STRAIGHT: line, arc or spiral
    polynomials: Polynomials
    line: NDArray[np.intc]  # of the file

    @staticmethod
    def linear(
        x_m: float, y_m: float, heading_rad: float, length_m: float, start: float, end: float
    ) -> Geometries:
        """Return one line, arc or spiral, by the curvature in 1/m at its start and at its end."""
        start_m, x, y, heading, length, first, last = np.array(
            [[0.0], [x_m], [y_m], [heading_rad], [length_m], [start], [end]]
        )
        line = np.zeros(1, dtype=np.intc)
        nothing = np.empty(0)
        none = Polynomials(np.empty((0, 8)), nothing, nothing, nothing.astype(bool), line[:0])
        cubic = np.array([STRAIGHT])
        return Geometries(start_m, x, y, heading, length, first, last, cubic, none, line)

    def points(self, which: Indices, ds: FloatArray) -> Points:
        """Return the points ``ds`` metres behind the starts of the geometries ``which``.

        Raises:
            GeometryError: a polynomial that is no road.
        """
        which, ds = np.asarray(which, dtype=np.intp), np.asarray(ds, dtype=np.float64)
        start, rate = self.curvature_start_per_m[which], self._rates(which)
        curvature = start + rate * ds
        turn = _turn(start, rate, ds)
        u, v = ds.copy(), np.zeros_like(ds)
        cubic = self.cubic[which]
        for kind, local in (
            ((cubic == STRAIGHT) & (rate == 0.0) & (start != 0.0), self._arcs),
            ((cubic == STRAIGHT) & (rate != 0.0), self._spirals),
        ):
            at = np.flatnonzero(kind)
            if len(at):
                chord = local(which[at], ds[at])
                u[at], v[at] = chord.real, chord.imag
        at = np.flatnonzero(cubic != STRAIGHT)
        if len(at):
            curvature[at], turn[at], u[at], v[at] = self.polynomials.points(cubic[at], ds[at])
        heading = self.heading_rad[which]
        cos, sin = np.cos(heading), np.sin(heading)
        x, y = self.x_m[which] + u * cos - v * sin, self.y_m[which] + u * sin + v * cos
        return Points(curvature, heading + turn, x, y)

    def _rates(self, which: Indices) -> FloatArray:
        change = self.curvature_end_per_m[which] - self.curvature_start_per_m[which]
        rates: FloatArray = change / self.length_m[which]
        return rates

    def _arcs(self, which: Indices, ds: FloatArray) -> NDArray[np.complex128]:
        half_turn = 0.5 * self.curvature_start_per_m[which] * ds
        chord: NDArray[np.complex128] = ds * np.exp(1j * half_turn) * np.sinc(half_turn / np.pi)
        return chord

    def _spirals(self, which: Indices, ds: FloatArray) -> NDArray[np.complex128]:
        """Return the Fresnel integrals, summed metre by metre."""
        distinct, group = distinct_runs(which)
        start, rate = self.curvature_start_per_m[distinct], self._rates(distinct)
        floor = np.floor(ds)
        metres = np.zeros(len(distinct), dtype=np.intp)
        np.maximum.at(metres, group, floor.astype(np.intp) + 1)
        owner, metre = within(metres)
        table = running_sums(
            _chords(start, rate, owner, metre.astype(np.float64), np.ones(len(metre))), metres
        )
        entry = (firsts(metres + 1))[group] + floor.astype(np.intp)
        return table[entry] + _chords(start, rate, group, floor, ds - floor)


def _turn(start: FloatArray, rate: FloatArray, ds: FloatArray) -> FloatArray:
    return ds * (start + 0.5 * rate * ds)


def _chords(
    start: FloatArray, rate: FloatArray, owner: Indices, ds: FloatArray, span: FloatArray
) -> NDArray[np.complex128]:
    """Return how far the spirals ``owner`` lead over ``span`` (up to 1 m), from ``ds`` on."""
    chords = np.zeros(len(ds), dtype=np.complex128)
    long = np.flatnonzero(span)
    for first in range(0, len(long), _AT_ONCE):
        some = long[first : first + _AT_ONCE]
        stations = ds[some, None] + span[some, None] * NODES
        turn = _turn(start[owner[some], None], rate[owner[some], None], stations)
        chords[some] = span[some] * means(np.exp(1j * turn))
    return chords
