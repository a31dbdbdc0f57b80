"""Where the knots of a road lie, and what the road is like there: many at a time.

A road is cut into pieces that have one geometry, one limit and one elevation record each. A piece
has a knot at both ends and at every whole step in between.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from ..limits.speeds import Limits
from ..opendrive.contents import MERGE_M, Contents
from ..opendrive.geometry import STRAIGHT
from ..opendrive.ragged import Indices, firsts

_STEP_M: Final = 1.0
_POLYNOMIAL_STEP_M: Final = 0.5
_AT_ONCE: Final = 1 << 17  # knots that are computed together


class Pieces(NamedTuple):
    """The pieces of a road in the order in which they are driven, one value each."""

    geometry: Indices
    grade: Indices  # elevation record
    limit_mps: FloatArray
    start_m: FloatArray  # on the route
    end_m: FloatArray
    counts: Indices  # knots
    polynomial: NDArray[np.bool_]


class Knots(NamedTuple):
    """Knots of pieces behind each other."""

    columns: FloatArray  # [6, knots]: s, curvature, limit, grade, x, y
    heading_rad: FloatArray  # as the road is drawn
    piece: Indices

    def take(self, which: Indices | slice) -> Knots:
        """Return those at ``which``."""
        return Knots(self.columns[:, which], self.heading_rad[which], self.piece[which])

    def followed_by(self, others: Knots) -> Knots:
        """Return these and, behind them, the ``others``."""
        return Knots(*(np.concatenate(both, axis=-1) for both in zip(self, others, strict=True)))


def pieces_of(road: Contents, limits: Limits, offset_m: float) -> Pieces:
    """Return the pieces of ``road``, which begins ``offset_m`` behind the start of the route."""
    geometries = road.geometries
    starts, limit_mps = np.array(limits, dtype=np.float64).reshape(-1, 2).T
    borders = _borders(road, np.concatenate((geometries.start_m, road.grades[:, 0], starts)))
    middle = 0.5 * (borders[:-1] + borders[1:])
    ends = (borders[:-1], borders[1:])
    if road.leg.against:
        middle = middle[::-1]
        ends = (road.length_m - borders[:0:-1], road.length_m - borders[-2::-1])
    geometry = _latest(geometries.start_m, middle)
    polynomial = geometries.cubic[geometry] != STRAIGHT
    start_m, end_m = offset_m + ends[0], offset_m + ends[1]
    step_m = _step_m(polynomial)
    inside = np.maximum(np.ceil(end_m / step_m) - np.floor(start_m / step_m) - 1.0, 0.0)
    return Pieces(
        geometry, _latest(road.grades[:, 0], middle), limit_mps[_latest(starts, middle)],
        start_m, end_m, inside.astype(np.intp) + 2, polynomial,
    )  # fmt: skip


def _step_m(polynomial: NDArray[np.bool_]) -> FloatArray:
    """Return how far apart the knots inside of pieces are."""
    return np.where(polynomial, _POLYNOMIAL_STEP_M, _STEP_M)


def _borders(road: Contents, starts: FloatArray) -> FloatArray:
    inner = np.unique(starts[(starts > MERGE_M) & (starts < road.length_m - MERGE_M)])
    inner = inner[np.diff(inner, prepend=0.0) > MERGE_M]
    return np.concatenate(([0.0], inner, [road.length_m]))


def _latest(starts: FloatArray, at_m: FloatArray) -> Indices:
    return np.searchsorted(starts, at_m, side="right") - 1


def knots_of(road: Contents, pieces: Pieces, offset_m: float) -> Iterator[Knots]:
    """Yield the knots of all ``pieces`` in order.

    Those of a polynomial or a spiral come together: what is integrated along them is then
    integrated once.

    Raises:
        ModelError: a polynomial that is none.
    """
    begins = firsts(pieces.counts)
    total = int(begins[-1] + pieces.counts[-1])
    rates = road.geometries.curvature_end_per_m - road.geometries.curvature_start_per_m
    together = pieces.polynomial | (rates[pieces.geometry] != 0.0)
    first = 0
    while first < total:
        stop = min(first + _AT_ONCE, total)
        piece = int(np.searchsorted(begins, stop, side="left")) - 1
        if together[piece]:
            stop = int(begins[piece] + pieces.counts[piece])
        some = slice(int(np.searchsorted(begins, first, side="right")) - 1, piece + 1)
        inside = np.minimum(begins[some] + pieces.counts[some], stop) - np.maximum(
            begins[some], first
        )
        on = np.repeat(np.arange(some.start, some.stop), inside)
        yield _computed(road, pieces, offset_m, on, np.arange(first, stop) - begins[on])
        first = stop


def _computed(
    road: Contents, pieces: Pieces, offset_m: float, piece: Indices, number: Indices
) -> Knots:
    """Return the knots with these numbers, from 0 on, of these pieces."""
    start_m, step_m = pieces.start_m[piece], _step_m(pieces.polynomial[piece])
    route_m = (np.floor(start_m / step_m) + number) * step_m
    route_m = np.where(number == 0, start_m, route_m)
    route_m = np.where(number == pieces.counts[piece] - 1, pieces.end_m[piece], route_m)
    against = road.leg.against
    s_m = road.length_m - (route_m - offset_m) if against else route_m - offset_m
    sign = -1.0 if against else 1.0
    geometry = pieces.geometry[piece]
    points = road.points(geometry, np.maximum(s_m - road.geometries.start_m[geometry], 0.0))
    grade_start, _, b, c, d = road.grades[pieces.grade[piece]].T
    dz = s_m - grade_start
    grade = sign * (b + dz * (2.0 * c + dz * (3.0 * d)))
    curvature, limit = sign * points.curvature_per_m, pieces.limit_mps[piece]
    columns = np.stack((route_m, curvature, limit, grade, points.x_m, points.y_m))
    return Knots(columns, points.heading_rad, piece)
