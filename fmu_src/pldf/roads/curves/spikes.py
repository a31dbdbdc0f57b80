"""Curvature over less than a car's length: no road has it, most of all not at full speed.

A spike is a stretch shorter than a car whose curvature is more than twice that of what lies around
it. It is driven as a kink of the same turn (``kinks``): a junction's arc of 6 m radius over 8 m is
a curve, and 20 m radius over 1 m is a kink of 2.9 degrees, which a car rounds at 300 km/h.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from ..per_metre import left_values, right_values, sharpest_curve
from .bending import CURVATURE, S, bent, in_a_row, spans_of
from .kinks import CAR_LENGTH_M, spread

# A stretch of a car's length may touch one cell more than it has metres.
_CELLS: Final = int(CAR_LENGTH_M) + 1


class Spike(NamedTuple):
    """A stretch that is no curve."""

    start_m: float
    end_m: float
    turn_rad: float  # beyond what lies around it, positive to the left
    curvature_per_m: float  # as it was, the sharpest


def rounded_spikes(knots: FloatArray, felt_per_m: float) -> tuple[FloatArray, list[Spike]]:
    """Return the knots with spikes driven as kinks, and which; the same array if there are none.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
        felt_per_m: curvature below which nobody feels a curve.
    """
    cells = _suspicious(knots, felt_per_m)
    spikes = [
        spike for spike in (_spike(knots, run) for run in in_a_row(cells)) if spike is not None
    ]
    if not spikes:
        return knots, []
    return _without(knots, spikes), spikes


def _suspicious(knots: FloatArray, felt_per_m: float) -> NDArray[np.intp]:
    """Return the cells of 1 m far sharper than every stretch of a car's length that holds them."""
    nodes = np.arange(int(knots[S, -1]) + 1, dtype=np.float64)
    if len(nodes) <= _CELLS:
        return np.zeros(0, dtype=np.intp)
    sharpest = sharpest_curve(knots[S], knots[CURVATURE], nodes)
    around = _opened(sharpest)
    return np.flatnonzero(sharpest > np.maximum(2.0 * around, felt_per_m))


def _opened(values: FloatArray) -> FloatArray:
    """Return the highest minimum over ``_CELLS`` cells that hold each one (a grey opening)."""
    # Beyond the ends of the route it goes on as it ends: what is cut off may be long.
    padded = np.pad(values, _CELLS - 1, mode="edge")
    lowest = _over_windows(np.minimum, padded)
    return _over_windows(np.maximum, lowest)


def _over_windows(extreme: np.ufunc, values: FloatArray) -> FloatArray:
    count = len(values) - _CELLS + 1
    result = values[:count].copy()
    for i in range(1, _CELLS):
        extreme(result, values[i : i + count], out=result)
    return result


def _spike(knots: FloatArray, cells: NDArray[np.intp]) -> Spike | None:
    """Return what stands out at these cells, None if it is as long as a car."""
    s_m = knots[S]
    reach = slice(*np.searchsorted(s_m, (cells[0] - CAR_LENGTH_M, cells[-1] + 1.0 + CAR_LENGTH_M)))
    near_m, near = s_m[reach], np.abs(knots[CURVATURE, reach])
    within = np.flatnonzero((near_m >= cells[0]) & (near_m <= cells[-1] + 1.0))
    if len(within) == 0:
        return None
    peak = int(within[np.argmax(near[within])])
    low = near <= 0.5 * near[peak]
    before, behind = np.flatnonzero(low[:peak]), np.flatnonzero(low[peak:])
    if len(before) == 0 or len(behind) == 0:
        return None
    first, last = before[-1], peak + behind[0]
    if _width_m(near_m, near, first, last) >= CAR_LENGTH_M:
        return None
    i, j = reach.start + first, reach.start + last
    bridge = 0.5 * (knots[CURVATURE, i] + knots[CURVATURE, j]) * (s_m[j] - s_m[i])
    turned = float(np.trapezoid(knots[CURVATURE, i : j + 1], s_m[i : j + 1]))
    return Spike(float(s_m[i]), float(s_m[j]), turned - float(bridge), float(near[peak]))


def _width_m(s_m: FloatArray, curvature: FloatArray, first: int, last: int) -> float:
    """Return how long the curvature is above half of its peak."""
    half = 0.5 * np.max(curvature[first : last + 1])
    edges = []
    for low, high in ((first, first + 1), (last, last - 1)):
        share = (half - curvature[low]) / (curvature[high] - curvature[low])
        edges.append(s_m[low] + share * (s_m[high] - s_m[low]))
    return float(edges[1] - edges[0])


def _without(knots: FloatArray, spikes: list[Spike]) -> FloatArray:
    start_m, end_m, turn_rad, _ = np.array(spikes).T
    boxes = spread(
        0.5 * (start_m + end_m), np.where(turn_rad == 0.0, 1e-12, turn_rad), end_m - start_m
    )
    s_m, curvature = knots[S], knots[CURVATURE]
    low_start, low_end = left_values(s_m, curvature, start_m), right_values(s_m, curvature, end_m)

    def curve(at_m: FloatArray, behind: bool) -> FloatArray:
        values = (right_values if behind else left_values)(s_m, curvature, at_m)
        k = np.maximum(np.searchsorted(start_m, at_m, side="right") - 1, 0)
        inside = (at_m >= start_m[k]) & (at_m <= end_m[k])
        inside &= (at_m > start_m[k]) | behind
        inside &= (at_m < end_m[k]) | (not behind)
        share = (at_m - start_m[k]) / (end_m[k] - start_m[k])
        bridge = low_start[k] * (1.0 - share) + low_end[k] * share
        return np.where(inside, bridge, values) + boxes.at(at_m, behind)

    spans = spans_of(np.concatenate((boxes.start_m, start_m)), np.concatenate((boxes.end_m, end_m)))
    return bent(knots, spans, np.concatenate((boxes.edges_m, start_m, end_m)), curve)
