"""How the curvature of a route's knots is replaced on parts of it, all else keeping its bits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from ..per_metre import along

# Rows of the knots' array.
S, CURVATURE, LIMIT, GRADE, X, Y = range(6)

Curve = Callable[[FloatArray, bool], FloatArray]


@dataclass(frozen=True)
class Boxes:
    """The sum of stretches of constant curvature.

    Attributes:
        start_m, end_m: float64 [n], where each begins and ends.
        curvature_per_m: float64 [n], of each.
    """

    start_m: FloatArray
    end_m: FloatArray
    curvature_per_m: FloatArray

    @property
    def edges_m(self) -> FloatArray:
        """All places at which the sum may jump."""
        return np.unique(np.concatenate((self.start_m, self.end_m)))

    def at(self, s_m: FloatArray, behind: bool) -> FloatArray:
        """Return the sum just before or just behind each place, in 1/m."""
        side = "right" if behind else "left"
        sums: FloatArray = np.zeros(len(s_m))
        for edge_m, sign in ((self.start_m, 1.0), (self.end_m, -1.0)):
            order = np.argsort(edge_m, kind="stable")
            total = np.concatenate(([0.0], np.cumsum(self.curvature_per_m[order])))
            sums += sign * total[np.searchsorted(edge_m[order], s_m, side=side)]  # type: ignore[call-overload]
        return sums


def spans_of(start_m: FloatArray, end_m: FloatArray) -> FloatArray:
    """Return the union of intervals as float64 [n, 2], in order and apart from each other."""
    if len(start_m) == 0:
        return np.zeros((0, 2))
    order = np.argsort(start_m, kind="stable")
    first, reach = start_m[order], np.maximum.accumulate(end_m[order])
    new = np.concatenate(([True], first[1:] > reach[:-1]))
    last = np.concatenate((new[1:], [True]))
    return np.stack((first[new], reach[last]), axis=1)


def in_a_row(index: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Return rising whole numbers, those that follow each other as one array."""
    return np.split(index, np.flatnonzero(np.diff(index) > 1) + 1) if len(index) else []


def turned(knots: FloatArray, at_m: FloatArray) -> FloatArray:
    """Return the change of heading from the start to each place, in rad."""
    s_m, value = knots[S], knots[CURVATURE]
    total = np.concatenate(([0.0], np.cumsum(0.5 * (value[1:] + value[:-1]) * np.diff(s_m))))
    i = np.clip(np.searchsorted(s_m, at_m, side="right") - 1, 0, len(s_m) - 2)
    ds = at_m - s_m[i]
    gap = s_m[i + 1] - s_m[i]
    slope = np.divide(value[i + 1] - value[i], gap, out=np.zeros_like(ds), where=gap > 0.0)
    angle: FloatArray = total[i] + ds * (value[i] + 0.5 * slope * ds)
    return angle


def averaged(knots: FloatArray, spans_m: FloatArray, window_m: float) -> FloatArray:
    """Return the knots with the mean curvature over ``window_m`` around each place in the spans."""
    first_m, last_m = knots[S, 0], knots[S, -1]

    def curve(at_m: FloatArray, _behind: bool) -> FloatArray:
        start = np.clip(at_m - 0.5 * window_m, first_m, last_m)
        end = np.clip(at_m + 0.5 * window_m, first_m, last_m)
        mean: FloatArray = (turned(knots, end) - turned(knots, start)) / (end - start)
        return mean

    wide = spans_of(spans_m[:, 0] - 0.5 * window_m, spans_m[:, 1] + 0.5 * window_m)
    metres = np.arange(np.ceil(first_m), last_m + 1.0)
    return bent(knots, wide, metres, curve)


def recurved(
    knots: FloatArray, spans_m: FloatArray, curve: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Return the knots with another curvature at those in ``spans_m``; none stands elsewhere.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
        spans_m: float64 [m, 2], as from ``spans_of``.
        curve: gives the new curvature at places in the spans; it does not jump.
    """
    inside = _inside(knots[S], spans_m)
    after = knots.copy()
    after[CURVATURE, inside] = curve(knots[S, inside])
    # Where only the curvature jumped there is one knot now.
    twin = np.zeros(len(inside), dtype=bool)
    twin[:-1] = inside[:-1] & np.all(after[:, 1:] == after[:, :-1], axis=0)
    return after[:, ~twin] if np.any(twin) else after


def bent(knots: FloatArray, spans_m: FloatArray, corners_m: FloatArray, curve: Curve) -> FloatArray:
    """Return the knots with another curvature inside ``spans_m``.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
        spans_m: float64 [m, 2], as from ``spans_of``; may reach over the ends of the route.
        corners_m: places where the new curvature bends or jumps; new knots stand there.
        curve: gives the new curvature just before (False) or behind (True) places in the spans.
    """
    s_m = knots[S]
    spans_m = spans_m[(spans_m[:, 1] > s_m[0]) & (spans_m[:, 0] < s_m[-1])]
    if len(spans_m) == 0:
        return knots
    ends = np.clip(spans_m, s_m[0], s_m[-1])
    old = s_m[_inside(s_m, ends)]
    corners = corners_m[_inside(corners_m, ends)]
    at = np.unique(np.concatenate((old, corners, ends.ravel())))
    sides = [_side(knots, at, curve, ends, behind) for behind in (False, True)]
    jump = np.any(sides[0][[CURVATURE, GRADE, X, Y]] != sides[1][[CURVATURE, GRADE, X, Y]], axis=0)
    jump &= (at > s_m[0]) & (at < s_m[-1])
    sides[0][LIMIT] = sides[1][LIMIT]  # of a jump's first knot it counts nowhere
    new = np.concatenate((sides[0][:, jump], _ends(sides, at, s_m)), axis=1)
    first = np.searchsorted(s_m, ends[0, 0], side="left")
    last = np.searchsorted(s_m, ends[-1, 1], side="right")
    between = knots[:, first:last]
    merged = np.concatenate((between[:, ~_inside(between[S], ends)], new), axis=1)
    merged = merged[:, np.argsort(merged[S], kind="stable")]
    return np.concatenate((knots[:, :first], merged, knots[:, last:]), axis=1)


def _ends(sides: list[FloatArray], at: FloatArray, s_m: FloatArray) -> FloatArray:
    """Return the knots behind each place; at the end of the route there is none behind."""
    behind = sides[1].copy()
    behind[:, at >= s_m[-1]] = sides[0][:, at >= s_m[-1]]
    return behind


def _side(
    knots: FloatArray, at: FloatArray, curve: Curve, ends: FloatArray, behind: bool
) -> FloatArray:
    s_m = knots[S]
    side = np.concatenate((at[None], along(s_m, knots[1:], at, behind=behind)))
    side[LIMIT] = knots[LIMIT][np.searchsorted(s_m, at, side="right") - 1]
    # Just before the first place of a span, and behind its last, nothing changes.
    outer = ends[:, 1] if behind else ends[:, 0]
    own = ~np.isin(at, outer)
    side[CURVATURE, own] = curve(at[own], behind)
    return side


def _inside(s_m: FloatArray, spans_m: FloatArray) -> NDArray[np.bool_]:
    at = np.searchsorted(spans_m[:, 0], s_m, side="right") - 1
    inside: NDArray[np.bool_] = (at >= 0) & (s_m <= spans_m[np.maximum(at, 0), 1])
    return inside
