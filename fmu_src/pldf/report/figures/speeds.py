"""What several figures show: speeds over distance, in km/h over km."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from ...kernel.arrays import FloatArray
from ...kernel.units import KMH_PER_MPS
from ...recordings.recording import Recording
from .. import palette
from ..scene import Axis, Line, Stroke

KM: Final = 1e-3
SPEED: Final = Axis("Speed", "km/h")
_ROW_S: Final = 0.1


def speed_line(s_m: FloatArray, speed_mps: FloatArray, stroke: Stroke, label: str) -> Line:
    """Return a speed (or a difference of speeds) over distance."""
    return Line(s_m * KM, speed_mps * KMH_PER_MPS, stroke, label)


def limit_line(s_m: FloatArray, limit_mps: FloatArray) -> Line:
    """Return the legal limit over distance; only the ends and where it changes are kept."""
    changes = np.flatnonzero(np.diff(limit_mps)) + 1
    corners = np.unique(np.concatenate(([0], changes, [len(s_m) - 1])))
    line = speed_line(s_m[corners], limit_mps[corners], palette.LIMIT, "Legal limit")
    return replace(line, stepped=True)


def base_line(s_m: FloatArray, base_mps: FloatArray) -> Line:
    """Return the base profile over distance."""
    return speed_line(s_m, base_mps, palette.BASE, "Base profile")


def zero_line(x: Axis) -> Line:
    """Return a thin line at zero along the whole axis ``x``."""
    return Line(np.array(x.ends), np.zeros(2), palette.ZERO)


def distance_axis(start_m: float, end_m: float) -> Axis:
    """Return the axis along a road."""
    return Axis("Distance", "km", low=float(start_m) * KM, high=float(end_m) * KM)


def distance_of(recording: Recording) -> Axis:
    """Return the axis along what was driven."""
    return distance_axis(recording["s_m"][0], recording["s_m"][-1])


def speed_axis(recordings: Iterable[Recording]) -> Axis:
    """Return a speed axis with all that was driven and allowed, with room below."""
    names = ("limit_mps", "base_mps", "profile_mps", "speed_mps")
    shown = [(r[name], name) for r in recordings for name in names if name in r]
    low = KMH_PER_MPS * min(float(np.min(v)) for v, name in shown if name != "limit_mps")
    high = KMH_PER_MPS * max(float(np.max(v)) for v, _ in shown)
    room = high - low
    return replace(SPEED, low=max(low - 0.25 * room - 2.0, 0.0), high=high + 0.08 * room + 2.0)


def thinned(recording: Recording) -> Recording:
    """Return a row every tenth of a second or so, and the last one: more does not show."""
    time = recording["time_s"]
    every = max(1, round(_ROW_S / float(np.median(np.diff(time))))) if len(time) > 1 else 1
    rows = np.unique(np.append(np.arange(0, len(time), every), len(time) - 1))
    return Recording({name: values[rows] for name, values in recording.columns.items()})
