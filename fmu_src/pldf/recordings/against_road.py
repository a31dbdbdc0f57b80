"""What a recording says against the road it is said to be driven on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..findings import Finding
from ..kernel.arrays import RouteArrays
from .quality import cells_of, quality_of, road_length_m
from .recording import Recording

COVERAGE: Final = "coverage"  # the place of that finding: a note here, a warning in a study
_BEYOND_M: Final = 50.0  # past either end of the road: a car's braking distance after a drive
_COVERED: Final = 0.9
_OTHER_LIMIT_MPS: Final = 0.3  # half of what separates two limits is far more; rounding is less
_OTHER_LIMIT_SHARE: Final = 0.03
_SHIFTS_M: Final = 200


def against_road(
    recording: Recording, file: str, route: RouteArrays, scales_fit: bool
) -> Iterator[Finding]:
    """Yield where positions and limits do not fit ``route``.

    Args:
        recording: the recording.
        file: its file.
        route: the road.
        scales_fit: False: a unit is wrong, so that other limits say nothing about the road.
    """
    quality, length = quality_of(recording, route), road_length_m(route)
    if quality.to_m < 0.0 or quality.from_m > length:
        yield Finding(
            "error", file, 0, "s_m",
            f"from {quality.from_m:.0f} to {quality.to_m:.0f} m; the road is from 0 to "
            f"{length:.0f} m", "no sample lies on the road", "check the road, and where its "
            "position 0 is",
        )  # fmt: skip
        return
    yield from _ends(file, quality.from_m, quality.to_m, length)
    if quality.coverage < _COVERED:
        yield Finding(
            "note", file, 0, COVERAGE,
            f"covers {100 * quality.coverage:.0f} % of the road: {quality.from_m:.0f} to "
            f"{quality.to_m:.0f} m of {length:.0f} m",
            "rates are those of this part, and nothing is learned elsewhere",
            "was the drive broken off? then leave it out, or say so in the report",
        )  # fmt: skip
    if scales_fit:
        yield from _other_limits(recording, file, route)


def _ends(file: str, from_m: float, to_m: float, length: float) -> Iterator[Finding]:
    if to_m > length + _BEYOND_M:
        yield Finding(
            "warning", file, 0, "s_m",
            f"goes on to {to_m:.0f} m, {to_m - length:.0f} m past the road's end ({length:.0f} m)",
            "nothing is learned there, and its time does not count for the rates",
            "is it another road, or one drawn too short? cut the recording at the road's end",
        )  # fmt: skip
    if from_m < -_BEYOND_M:
        yield Finding(
            "warning", file, 0, "s_m", f"begins at {from_m:.0f} m, before the road",
            "nothing is learned there, but its time counts for the rates",
            "is position 0 the road's beginning? else add the difference in a mapping file",
        )  # fmt: skip


def _other_limits(recording: Recording, file: str, route: RouteArrays) -> Iterator[Finding]:
    if "limit_mps" not in recording:
        return
    s = recording["s_m"]
    on_road = (s >= 0.0) & (s <= road_length_m(route))
    share = _share_of_other_limits(recording, route, 0)
    if not on_road.any() or share < _OTHER_LIMIT_SHARE:
        return
    shifts = range(-_SHIFTS_M, _SHIFTS_M + 1, 5)
    shares = {shift: _share_of_other_limits(recording, route, shift) for shift in shifts}
    best_shifts = [shift for shift in shifts if shares[shift] == min(shares.values())]
    best = best_shifts[len(best_shifts) // 2]
    fits = shares[best] < 0.2 * share
    yield Finding(
        "warning", file, 0, "limit_mps",
        f"is not the road's on {100 * share:.0f} % of the samples"
        + (f", but would be {abs(best)} m {'further on' if best > 0 else 'back'}" if fits else ""),
        "what is learned lies at the wrong place, or on another road",
        f"add {best} m to s_m in a mapping file" if fits
        else "check that this is the road driven; temporary limits of a scenario are in order",
    )  # fmt: skip


def _share_of_other_limits(recording: Recording, route: RouteArrays, shift_m: int) -> float:
    """Return the share of samples on the road whose limit is none within 5 m there."""
    s, limit = recording["s_m"] + shift_m, recording["limit_mps"]
    road = np.asarray(route.limit_mps)
    on_road = (s >= 0.0) & (s <= road_length_m(route))
    if not on_road.any():
        return 1.0
    near = [
        np.abs(road[cells_of(s[on_road] + off, route)] - limit[on_road]) for off in (-5.0, 0.0, 5.0)
    ]
    return float(np.mean(np.min(near, axis=0) > _OTHER_LIMIT_MPS))
