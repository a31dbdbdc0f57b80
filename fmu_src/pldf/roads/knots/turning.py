"""What a polynomial does between two knots.

Its curvature at them may say nothing about it: at a cusp it is infinite, and a curve that is bent
within a hand's breadth is missed. Where curvature that is linear between the knots would turn the
road otherwise than the polynomial does, it is taken as constant: by how much the heading changes
over the length between them.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ...findings import Finding
from ...kernel.arrays import FloatArray
from ..opendrive.contents import Contents
from ..opendrive.ragged import Indices
from .knots import Knots, Pieces

# Half a metre of a bend of 3 m radius stays below them.
_SAME_PER_M: Final = 0.01
_SAME: Final = 0.1  # as a share of the mean curvature


class Turns(NamedTuple):
    """Where curvature was taken from the heading, one value per interval."""

    s_m: FloatArray  # its begin on the route
    stated_per_m: FloatArray  # the larger absolute curvature at its ends, not always finite
    mean_per_m: FloatArray


def as_turned(knots: Knots, pieces: Pieces) -> tuple[Knots, Turns]:
    """Return ``knots`` so that polynomials turn as their headings do, and where that changed them.

    Clean ones stay as they are. A knot between two such intervals becomes two.
    """
    s_m, curvature = knots.columns[:2]
    inside = pieces.polynomial[knots.piece[1:]] & (np.diff(knots.piece) == 0)
    turn = np.remainder(np.diff(knots.heading_rad) + np.pi, 2.0 * np.pi) - np.pi
    mean = np.divide(turn, np.diff(s_m), out=np.zeros_like(turn), where=inside)
    linear = 0.5 * (curvature[1:] + curvature[:-1])
    with np.errstate(invalid="ignore"):
        same = np.abs(linear - mean) <= _SAME_PER_M + _SAME * np.abs(mean)
    wrong = np.flatnonzero(inside & ~same)
    stated = np.maximum(*np.abs((curvature[wrong], curvature[wrong + 1])))  # NaN if one is
    turns = Turns(s_m[wrong], stated, mean[wrong])
    return (_turned(knots, wrong, mean[wrong]) if len(wrong) else knots), turns


def _turned(knots: Knots, wrong: Indices, mean: FloatArray) -> Knots:
    """Return knots with the curvature ``mean`` from those at ``wrong`` to their next ones."""
    ahead = knots.columns[1].copy()
    behind = ahead.copy()
    ahead[wrong] = behind[wrong + 1] = mean
    first = np.diff(knots.piece, prepend=-1) != 0  # behind it the piece has nothing
    last = np.diff(knots.piece, append=-1) != 0
    behind[first], ahead[last] = ahead[first], behind[last]
    copies = np.where(ahead == behind, 1, 2)
    made = knots.take(np.repeat(np.arange(len(copies)), copies))
    second = np.cumsum(copies) - 1
    made.columns[1, second - copies + 1] = behind
    made.columns[1, second] = ahead
    return made


def told(turns: list[Turns], road: Contents, offset_m: float) -> tuple[Finding, ...]:
    """Return what is told of ``turns``: how many there are, and the worst."""
    s_m, stated, mean = (np.concatenate(values) for values in zip(*turns, strict=True))
    if not len(s_m):
        return ()
    size = np.where(np.isfinite(stated), np.abs(stated - np.abs(mean)), np.inf)
    worst = int(np.argmax(size))
    own_m = s_m[worst] - offset_m
    if road.leg.against:
        own_m = road.length_m - own_m
    at = max(int(np.searchsorted(road.geometries.start_m, own_m, side="right")) - 1, 0)
    place = f"road {road.place.road}, s = {own_m:.6g} m"
    finite = np.isfinite(stated[worst])
    curvature = f"curvature of {stated[worst]:.3g}/m" if finite else "infinite curvature"
    text = f"a polynomial's {curvature} is no turn of its line"
    more = f" (and at {len(s_m) - 1} more places of this road)" if len(s_m) > 1 else ""
    took = f"it turns by {mean[worst]:.3g}/m there, which was taken"
    file, line = str(road.place.path), int(road.geometries.line[at])
    return (Finding("note", file, line, place, text + more, took),)
