"""Whether a route's line (x, y) tells of the same road as its arc length and curvature.

A table states the same twice: where the road is, and how it bends. Speeds follow from the
curvature, the place of a car (``localization`` XY) from the line; if they are of different roads,
one of them is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..kernel.arrays import FloatArray
from .curves.bending import S, X, Y, turned

# Of chords that meet: so long at least, or as two knots are apart.
_CHORD_M: Final = 50.0
_CHORD_MAX_M: Final = 200.0
_TURN_MAX_RAD: Final = np.radians(6.0)
_LENGTH_SHARE_MAX: Final = 0.05
# A chord's mean heading is that of so many parts of it.
_PARTS: Final = 20


def line_doubts(knots: FloatArray) -> Iterator[tuple[float, str]]:
    """Yield place in m and text of what contradicts itself.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
    """
    length = float(np.sum(np.hypot(np.diff(knots[X]), np.diff(knots[Y]))))
    share = length / float(knots[S, -1])
    if abs(share - 1.0) > _LENGTH_SHARE_MAX:
        yield (
            0.0,
            f"the line of x_m and y_m is {length:.6g} m long, s_m {knots[S, -1]:.6g} m; are both"
            " in m, and is s_m along the line?",
        )
        return
    yield from _turns(knots)


def _turns(knots: FloatArray) -> Iterator[tuple[float, str]]:
    """Yield the place where line and curvature turn most differently, if clearly so."""
    chord = max(_CHORD_M, 2.0 * float(np.max(np.diff(knots[S]))))
    if chord > _CHORD_MAX_M or knots[S, -1] < 2.0 * chord:
        return
    at_m, bend = _turn_of_curvature(knots, chord)
    line = _turn_of_line(knots, at_m, chord)
    off = np.abs(np.angle(np.exp(1j * (line - bend))))
    wrong = off > _TURN_MAX_RAD
    if not np.any(wrong):
        return
    k = int(np.argmax(off))
    count = int(np.sum(np.diff(wrong.astype(np.int8), prepend=0) > 0))
    places = f", the worst of {count} places" if count > 1 else ""
    yield (
        float(at_m[k]),
        f"x_m and y_m turn by {np.degrees(line[k]):.0f} degrees over {2.0 * chord:.0f} m,"
        f" curvature_per_m by {np.degrees(bend[k]):.0f}{places}; speeds follow from the"
        " curvature, XY localization from the line",
    )


def _turn_of_line(knots: FloatArray, at_m: FloatArray, chord_m: float) -> FloatArray:
    places = [_point(knots, at_m + step * chord_m) for step in (-1.0, 0.0, 1.0)]
    turn: FloatArray = np.angle((places[2] - places[1]) / (places[1] - places[0]))
    return turn


def _turn_of_curvature(knots: FloatArray, chord_m: float) -> tuple[FloatArray, FloatArray]:
    """Return places, and the change of the mean heading from the chord before to that behind."""
    step = chord_m / _PARTS
    heading = turned(knots, np.arange(0.5 * step, float(knots[S, -1]), step))
    total = np.concatenate(([0.0], np.cumsum(heading)))
    at = np.arange(_PARTS, len(heading) - _PARTS + 1, _PARTS // 4)
    turn: FloatArray = (total[at + _PARTS] - 2.0 * total[at] + total[at - _PARTS]) / _PARTS
    return at.astype(np.float64) * step, turn


def _point(knots: FloatArray, at_m: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.complex128]]:
    x_m, y_m = (np.interp(at_m, knots[S], knots[row]) for row in (X, Y))
    point: np.ndarray[tuple[int], np.dtype[np.complex128]] = x_m + 1j * y_m
    return point
