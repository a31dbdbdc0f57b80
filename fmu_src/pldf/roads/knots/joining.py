"""The roads of a way, put behind each other.

Where roads are linked, the reference line may move sideways by any number of lanes: the lanes go
straight on, the line from which they are counted does not. The arc length is that of the roads; the
route's line (x, y), on which a car is looked for, moves over smoothly before and behind the link. A
jump along the road, or one beyond all lanes, is a fault.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding, short
from ...kernel.arrays import FloatArray
from ..curves.bending import S, X, Y
from ..curves.joints import Joints
from .sampling import LINE_GAP_MAX_M, Stretch, jumps, wrapped

SIDEWAYS_MAX_M: Final = 40.0
# Over how many times its width a line moves over, to each side of the link.
_BLEND: Final = 5.0
_TURN_BACK_RAD: Final = np.radians(120.0)
_TELL_MAX: Final = 5


def joined(stretches: list[Stretch], notes: list[Finding]) -> tuple[FloatArray, Joints]:
    """Return the knots of the whole way, float64 [6, knots], and all its joints.

    A border has two knots only where curvature or grade jump.

    Args:
        stretches: the roads in the order in which they are driven.
        notes: gets what is told of links.

    Raises:
        ModelError: roads do not meet where they are linked; names all such links.
    """
    parts: list[FloatArray] = []
    joints = [stretches[0].joints]
    moves: list[tuple[Stretch, complex]] = []
    faults: list[ModelError] = []
    for before, behind in pairwise(stretches):
        end, start = before.columns[:, -1], behind.columns[:, 0]
        gap = complex(*(start - end)[4:])
        fault = _fault(before, behind, gap)
        if fault:
            faults.append(behind.place.error(behind.contents.leg.road, fault))
        if abs(gap) > LINE_GAP_MAX_M:
            moves.append((behind, gap))
        parts.append(before.columns if jumps(end, start) else before.columns[:, :-1])
        joints += [_link(before, behind), behind.joints]
    if faults:
        raise ModelError("\n".join(map(str, faults)))
    parts.append(stretches[-1].columns)
    knots = np.concatenate(parts, axis=1) if len(parts) > 1 else parts[0]
    for stretch, gap in moves:
        _blend(knots, float(stretch.columns[S, 0]), gap)
    _tell(moves, notes)
    return knots, Joints(*(np.concatenate(values) for values in zip(*joints, strict=True)))


def _fault(before: Stretch, behind: Stretch, gap: complex) -> str:
    """Return why the road behind does not go on where the one before ends; empty: it does."""
    turn = wrapped(behind.start_heading_rad - before.end_heading_rad)
    if abs(turn) > _TURN_BACK_RAD:
        return (
            f"it begins in the direction from which road {before.place.road} comes (a turn of"
            f" {abs(np.degrees(turn)):.0f} degrees); is the contactPoint of the link right?"
        )
    middle = before.end_heading_rad + 0.5 * turn
    local = gap * np.exp(-1j * middle)
    # Lines that fan out are apart lengthways as well, each measured by its own direction.
    along = abs(local.real) - abs(local.imag) * abs(np.sin(turn))
    if along > LINE_GAP_MAX_M or abs(local.imag) > SIDEWAYS_MAX_M:
        lengthways, aside = short(abs(local.real)), short(abs(local.imag))
        return (
            f"it begins {lengthways} m along and {aside} m beside the end of road"
            f" {before.place.road}, to which it is linked; correct x and y or the link"
        )
    return ""


def _link(before: Stretch, behind: Stretch) -> Joints:
    turn = wrapped(behind.start_heading_rad - before.end_heading_rad)
    line = behind.contents.leg.road.line
    return Joints(*np.array([[behind.columns[S, 0]], [turn], [float(line)]]))


def _blend(knots: FloatArray, at_m: float, gap: complex) -> None:
    """Let the line move over by half of ``gap`` before and half behind ``at_m``."""
    length = _BLEND * abs(gap)
    near = slice(*np.searchsorted(knots[S], (at_m - length, at_m + length)))
    s_m = knots[S, near]
    behind = s_m >= at_m
    # Two knots stand at the link only where the curvature jumps; then the first lies before it.
    twins = np.flatnonzero(s_m == at_m)
    behind[twins[:-1]] = False
    share = np.clip(1.0 - np.abs(s_m - at_m) / length, 0.0, 1.0)
    smooth = 0.5 * share * share * (3.0 - 2.0 * share) * np.where(behind, -1.0, 1.0)
    knots[X, near] += smooth * gap.real
    knots[Y, near] += smooth * gap.imag


def _tell(moves: list[tuple[Stretch, complex]], notes: list[Finding]) -> None:
    if not moves:
        return
    shown = ", ".join(
        f"{abs(gap):.1f} m at {stretch.columns[S, 0]:.0f} m (road {stretch.place.road})"
        for stretch, gap in moves[:_TELL_MAX]
    )
    more = f", and {len(moves) - _TELL_MAX} more" if len(moves) > _TELL_MAX else ""
    first = moves[0][0]
    notes.append(
        Finding(
            "note",
            str(first.place.path),
            first.contents.leg.road.line,
            f"road {first.place.road}",
            f"the line moves sideways where roads are linked, as lanes do: {shown}{more}",
            f"x and y move over within {_BLEND:g} times that, the arc length does not change",
        )
    )
