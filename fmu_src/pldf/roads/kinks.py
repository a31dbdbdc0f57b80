"""Bends drawn as straight chords, and kinks: where the line turns at a point.

A car does not turn at a point. It rounds a corner of angle ``a``, leaving the line by ``e``, on an
arc of radius ``e / (1 / cos(a / 2) - 1)``, about ``8 e / a²``, whose length is about ``8 e / a``:
so far the turn is spread, half of it to each side; over no more than half of the chord to the next
corner (which makes the polygon's own radius out of a bend drawn as chords), and at least over a
car's length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from ..kernel.arrays import FloatArray
from .bending import CURVATURE, Boxes, S, bent, spans_of
from .per_metre import left_values, right_values
from .sampling import Joints

CAR_LENGTH_M: Final = 5.0
# A lane of 3.5 m leaves a car of 1.8 m 0.85 m on each side; a driver uses about half of that.
LANE_PLAY_M: Final = 0.5
SPREAD_MAX_M: Final = 25.0  # to each side
# Headings in files are rounded; a joint below this is no corner.
TURN_MIN_RAD: Final = 5e-4


@dataclass(frozen=True)
class Turn:
    """Corners in a row.

    Attributes:
        first_m, last_m: where the first and the last stand, on the route.
        count: how many.
        turn_rad: all together, positive to the left.
        line: of the file, where the first stands; 0: not known.
    """

    first_m: float
    last_m: float
    count: int
    turn_rad: float
    line: int


def corners(joints: Joints, felt_per_m: float) -> tuple[Boxes, list[Turn]]:
    """Return the curves that a car drives around corners of the line, and the corners in groups.

    Args:
        joints: where geometries meet, in order.
        felt_per_m: curvature below which nobody feels a curve.
    """
    at_m, turn_rad, line = (values[np.abs(joints.turn_rad) > TURN_MIN_RAD] for values in joints)
    # Headings are absolute: what one is rounded by, the next joint takes back; so the sums count.
    boxes = spread(at_m, turn_rad)
    felt = np.abs(boxes.at(at_m, False)) + np.abs(boxes.at(at_m, True)) > 2.0 * felt_per_m
    at_m, turn_rad, line = at_m[felt], turn_rad[felt], line[felt]
    return spread(at_m, turn_rad), _turns(at_m, turn_rad, line)


def spread(at_m: FloatArray, turn_rad: FloatArray) -> Boxes:
    """Return the curves, two per corner, that a car drives around corners in order of ``at_m``."""
    size = np.abs(turn_rad)
    free = np.clip(4.0 * LANE_PLAY_M / size, 0.5 * CAR_LENGTH_M, SPREAD_MAX_M)
    chord = np.concatenate(([np.inf], np.diff(at_m), [np.inf]))
    left = np.clip(0.5 * chord[:-1], 0.5 * CAR_LENGTH_M, free)
    right = np.clip(0.5 * chord[1:], 0.5 * CAR_LENGTH_M, free)
    return Boxes(
        np.concatenate((at_m - left, at_m)),
        np.concatenate((at_m, at_m + right)),
        np.concatenate((0.5 * turn_rad / left, 0.5 * turn_rad / right)),
    )


def with_boxes(knots: FloatArray, boxes: Boxes) -> FloatArray:
    """Return the knots with the curvature of ``boxes`` added."""
    s_m, curvature = knots[S], knots[CURVATURE]

    def curve(at_m: FloatArray, behind: bool) -> FloatArray:
        values = right_values if behind else left_values
        return values(s_m, curvature, at_m) + boxes.at(at_m, behind)

    return bent(knots, spans_of(boxes.start_m, boxes.end_m), boxes.edges_m, curve)


def _turns(at_m: FloatArray, turn_rad: FloatArray, line: FloatArray) -> list[Turn]:
    """Return the corners, those less than two spreads apart as one."""
    if len(at_m) == 0:
        return []
    starts = np.concatenate(([0], np.flatnonzero(np.diff(at_m) > 2.0 * SPREAD_MAX_M) + 1))
    ends = np.append(starts[1:], len(at_m)) - 1
    totals = np.add.reduceat(turn_rad, starts)
    return [
        Turn(float(at_m[i]), float(at_m[j]), int(j - i + 1), float(total), int(line[i]))
        for i, j, total in zip(starts, ends, totals, strict=True)
    ]
