"""Curves as a car drives them: what a map says of them, judged over a car's length.

Three repairs, each made only where something is found: corners of the line are rounded (``kinks``),
noise is smoothed (``noise``), spikes are rounded like corners (``spikes``). A road on which nothing
is found keeps its bits.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from typing import Final

import numpy as np

from ...findings import Finding, Severity, short
from ...kernel.arrays import FloatArray
from ...kernel.units import KMH_PER_MPS
from .bending import CURVATURE, LIMIT, S, averaged, spans_of
from .joints import Joints
from .kinks import CAR_LENGTH_M, SPREAD_MAX_M, Turn, corners, with_boxes
from .noise import Noise, smoothed
from .spikes import Spike, rounded_spikes

# The base profile's lateral acceleration; only to tell whether a curve is felt.
_LATERAL_MPS2: Final = 2.5
_OVER_LIMIT_MPS: Final = 50.0 / KMH_PER_MPS
_STRAIGHT_KMH: Final = 300.0

# Where a place on the route is in the file: its line (0: not known), and road and metre in words.
Locate = Callable[[float], tuple[int, str]]


def judged(
    knots: FloatArray, joints: Joints, smoothing_m: float | None, file: str, locate: Locate
) -> tuple[FloatArray, list[Finding]]:
    """Return the knots with the curvature that a car drives, and what is told about it.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
        joints: where geometries meet; none for a route that is given by its curvature.
        smoothing_m: as ``RoadOptions.smoothing_m``.
        file: for what is told.
        locate: as above.
    """
    felt = _felt_per_m(knots)
    boxes, turns = corners(joints, felt)
    knots, noises = smoothed(with_boxes(knots, boxes), smoothing_m, felt)
    knots = averaged(knots, spans_of(boxes.start_m, boxes.end_m), CAR_LENGTH_M)
    knots, spikes = rounded_spikes(knots, felt)
    # What the rounding of corners leaves is told with the corners.
    noises = [n for n in noises if not (_rounded(n.start_m, turns) and _rounded(n.end_m, turns))]
    spikes = [spike for spike in spikes if not _rounded(spike.start_m, turns)]

    def finding(
        at_m: float, text: str, severity: Severity = "warning", way_out: str = ""
    ) -> Finding:
        line, place = locate(at_m)
        return Finding(severity, file, line, place, text, "", way_out)

    told = [finding(turn.first_m, _turn(turn, knots)) for turn in turns]
    told += [finding(noise.start_m, *_noise(noise, smoothing_m)) for noise in noises]
    told += [finding(spike.start_m, _spike(spike, knots)) for spike in spikes]
    return knots, told


def _rounded(at_m: float, turns: list[Turn]) -> bool:
    """Tell whether corners were rounded at this place."""
    k = bisect_right(turns, at_m + SPREAD_MAX_M, key=lambda turn: turn.first_m)
    return k > 0 and at_m <= turns[k - 1].last_m + SPREAD_MAX_M


def _felt_per_m(knots: FloatArray) -> float:
    """Return the curvature that nobody feels who drives at most 50 km/h above every limit."""
    fastest = float(np.max(knots[LIMIT])) + _OVER_LIMIT_MPS
    return _LATERAL_MPS2 / (fastest * fastest)


def _turn(turn: Turn, knots: FloatArray) -> str:
    angle = abs(np.degrees(turn.turn_rad))
    near = slice(*np.searchsorted(knots[S], (turn.first_m - 2.0, turn.last_m + 2.0)))
    driven = _driven(float(np.max(np.abs(knots[CURVATURE, near]), initial=0.0)))
    if turn.count == 1:
        return f"the line turns by {angle:.1f} degrees at a point; driven as {driven}"
    length = turn.last_m - turn.first_m
    places = f"the line turns at {turn.count} points over {length:.0f} m"
    if abs(turn.turn_rad) < 0.5 * turn.size_rad:
        return f"{places}, to and fro; driven as {driven} at the sharpest"
    return f"{places}, by {angle:.0f} degrees in all: a bend drawn as chords? Driven as {driven}"


def _noise(noise: Noise, smoothing_m: float | None) -> tuple[str, Severity, str]:
    before, after = (short(1.0 / max(k, 1e-9)) for k in noise.sharpest_per_m)
    sharpest = f"sharpest curve R {before} m before and R {after} m after"
    length = noise.end_m - noise.start_m
    if smoothing_m is not None:
        return f"curvature smoothed over {noise.spacing_m:g} m; {sharpest}", "note", ""
    return (
        f"the curvature is noise over {length:.0f} m, {noise.sigma_per_m:.2g}/m between points"
        f" {short(noise.spacing_m)} m apart; smoothed, {sharpest}",
        "warning",
        "--smoothing M sets the length of the mean, --smoothing 0 leaves it as it is",
    )


def _spike(spike: Spike, knots: FloatArray) -> str:
    length = spike.end_m - spike.start_m
    angle = abs(np.degrees(spike.turn_rad))
    near = slice(*np.searchsorted(knots[S], (spike.start_m, spike.end_m + 1e-9)))
    left = float(np.max(np.abs(knots[CURVATURE, near]), initial=0.0))
    return (
        f"R {short(1.0 / spike.curvature_per_m)} m over {length:.2g} m ({_degrees(angle)}) is no"
        f" curve of a road; driven as {_driven(left)}"
    )


def _degrees(angle_deg: float) -> str:
    return f"{angle_deg:.1f} degrees" if angle_deg >= 0.1 else "less than 0.1 degrees"


def _driven(curvature_per_m: float) -> str:
    speed = np.sqrt(_LATERAL_MPS2 / max(curvature_per_m, 1e-9)) * KMH_PER_MPS
    if speed > _STRAIGHT_KMH:
        return "straight on"
    return f"R {short(1.0 / curvature_per_m)} m ({speed:.0f} km/h)"
