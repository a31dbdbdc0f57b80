"""Where speed and position say different things for seconds: one of them is late, or wrong."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..findings import Finding
from ..kernel.units import KMH_PER_MPS
from .frozen import driven_m
from .quality import HOLE_S
from .recording import Recording

_WINDOW_S: Final = 3.0
_APART_MPS: Final = 1.2
_APART: Final = 0.05  # of the speed; wheels and tyres
_LASTS_S: Final = 3.0


def apart(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield that the mean speed over some seconds is not the way by the time."""
    time_s, s_m = recording["time_s"], recording["s_m"]
    behind = np.searchsorted(time_s, time_s + _WINDOW_S)
    rows = np.flatnonzero(behind < len(time_s))
    if not len(rows):
        return
    ends, passed_s = behind[rows], time_s[behind[rows]] - time_s[rows]
    by_speed = driven_m(recording)
    off_mps = np.abs(by_speed[ends] - by_speed[rows] - s_m[ends] + s_m[rows])
    off_mps /= passed_s
    steps_m = np.diff(np.unique(s_m))
    rounded_mps = (2.0 * steps_m.min() if len(steps_m) else 0.0) / _WINDOW_S
    allowed = np.maximum(_APART_MPS + rounded_mps, _APART * np.abs(recording["speed_mps"][rows]))
    holes = np.concatenate(([0], np.cumsum(np.diff(time_s) > HOLE_S)))
    wrong = rows[(off_mps > allowed) & (holes[ends] == holes[rows])]
    lasts_s = float(np.diff(time_s)[wrong].sum())
    if lasts_s >= _LASTS_S:
        yield Finding(
            "warning", file, 0, "speed_mps, s_m",
            f"for {lasts_s:.1f} s, first at {time_s[wrong[0]]:.1f} s ({s_m[wrong[0]]:.0f} m), they "
            f"differ by up to {KMH_PER_MPS * off_mps.max():.1f} km/h in the mean over "
            f"{_WINDOW_S:g} s",
            "what is learned there is of another place or speed",
            "look for a signal that is late or stood still; cut these samples out",
        )  # fmt: skip
