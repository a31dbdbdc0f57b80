"""Bends drawn as straight chords, and kinks: where the line turns at a point.

A car does not turn at a point. It rounds a corner of angle ``a``, leaving the line by ``e``, on an
arc of radius ``e / (1 / cos(a / 2) - 1)``, about ``8 e / a²``, whose length is about ``8 e / a``:
so far the turn is spread, half of it to each side, but over no more than half of the chord to the
next corner, and at least over a car's length. Corners of one bend have half of the chord between
them in any case: that makes its own radius out of a bend drawn as chords.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from ..per_metre import left_values, right_values
from .bending import CURVATURE, Boxes, S, bent, spans_of
from .joints import Joints

CAR_LENGTH_M: Final = 5.0
# A lane of 3.5 m leaves a car of 1.8 m 0.85 m on each side; a driver uses about half of that.
LANE_PLAY_M: Final = 0.5
SPREAD_MAX_M: Final = 25.0  # to each side
# Headings in files are rounded; a joint below this is no corner.
TURN_MIN_RAD: Final = 5e-4
# Corners of one bend turn the same way; the smaller of two at least so far, as a share.
_ALIKE: Final = 1.0 / 3.0


@dataclass(frozen=True)
class Turn:
    """Corners in a row.

    Attributes:
        first_m, last_m: where the first and the last stand, on the route.
        count: how many.
        turn_rad: all together, positive to the left.
        size_rad: the same without signs.
    """

    first_m: float
    last_m: float
    count: int
    turn_rad: float
    size_rad: float


def corners(joints: Joints, felt_per_m: float) -> tuple[Boxes, list[Turn]]:
    """Return the curves that a car drives around corners of the line, and the corners in groups.

    Args:
        joints: where geometries meet, in order.
        felt_per_m: curvature below which nobody feels a curve.
    """
    turns = np.abs(joints.turn_rad) > TURN_MIN_RAD
    at_m, turn_rad = joints.s_m[turns], joints.turn_rad[turns]
    # Headings are absolute: what one is rounded by, the next joint takes back; so the sums count.
    boxes = spread(at_m, turn_rad)
    felt = np.abs(boxes.at(at_m, False)) + np.abs(boxes.at(at_m, True)) > 2.0 * felt_per_m
    at_m, turn_rad = at_m[felt], turn_rad[felt]
    return spread(at_m, turn_rad), _turns(at_m, turn_rad)


def spread(at_m: FloatArray, turn_rad: FloatArray, length_m: FloatArray | float = 0.0) -> Boxes:
    """Return the curves, two per corner, that a car drives around corners in order of ``at_m``.

    ``length_m`` is over how far they turn already.
    """
    shortest_m = 0.5 * CAR_LENGTH_M
    free = np.clip(4.0 * LANE_PLAY_M / np.abs(turn_rad), shortest_m, SPREAD_MAX_M)
    half = np.clip(0.5 * np.diff(at_m), shortest_m, SPREAD_MAX_M)
    bend = _one_bend(at_m, turn_rad)
    # Along a bend each corner has half of the chord, on its outside no less than that.
    inner = np.maximum(np.append(half * bend, 0.0), np.append(0.0, half * bend))
    outer = np.maximum(free, inner)
    left = np.append(outer[:1], np.where(bend, half, np.minimum(half, outer[1:])))
    right = np.append(np.where(bend, half, np.minimum(half, outer[:-1])), outer[-1:])
    left, right = (np.maximum(side, 0.5 * length_m) for side in (left, right))
    return Boxes(
        np.concatenate((at_m - left, at_m)),
        np.concatenate((at_m, at_m + right)),
        np.concatenate((0.5 * turn_rad / left, 0.5 * turn_rad / right)),
    )


def _one_bend(at_m: FloatArray, turn_rad: FloatArray) -> NDArray[np.bool_]:
    """Tell of each corner but the last whether the next is another one of the same bend."""
    size = np.abs(turn_rad)
    alike = _ALIKE * np.maximum(size[1:], size[:-1]) < np.minimum(size[1:], size[:-1])
    near: NDArray[np.bool_] = np.diff(at_m) <= 2.0 * SPREAD_MAX_M
    return alike & near & (turn_rad[1:] * turn_rad[:-1] > 0.0)


def with_boxes(knots: FloatArray, boxes: Boxes) -> FloatArray:
    """Return the knots with the curvature of ``boxes`` added."""
    s_m, curvature = knots[S], knots[CURVATURE]

    def curve(at_m: FloatArray, behind: bool) -> FloatArray:
        values = right_values if behind else left_values
        return values(s_m, curvature, at_m) + boxes.at(at_m, behind)

    return bent(knots, spans_of(boxes.start_m, boxes.end_m), boxes.edges_m, curve)


def _turns(at_m: FloatArray, turn_rad: FloatArray) -> list[Turn]:
    """Return the corners, those less than two spreads apart as one."""
    if len(at_m) == 0:
        return []
    starts = np.concatenate(([0], np.flatnonzero(np.diff(at_m) > 2.0 * SPREAD_MAX_M) + 1))
    ends = np.append(starts[1:], len(at_m)) - 1
    totals = (np.add.reduceat(turns, starts) for turns in (turn_rad, np.abs(turn_rad)))
    return [
        Turn(float(at_m[i]), float(at_m[j]), int(j - i + 1), float(turn), float(size))
        for i, j, turn, size in zip(starts, ends, *totals, strict=True)
    ]
