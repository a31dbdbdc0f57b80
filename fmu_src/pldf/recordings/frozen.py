"""Signals that stand still or jump while others say that the car drives on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..findings import Finding
from ..kernel.arrays import FloatArray
from .interventions import runs
from .quality import HOLE_S
from .recording import Recording

_STANDS_M: Final = 5.0  # a position that stands while the car drives so far is frozen
_SPEED_HOLDS_S: Final = 3.0
_SPEED_DIFFERS_MPS: Final = 1.0
_SPEED_DIFFERS: Final = 0.05
_JUMP_M: Final = 15.0  # beyond what rounding to 10 m and 1 s steps explain
_ACCELERATION_MAX_MPS2: Final = 12.0  # no tyre does more
_SPEED_STEP_MPS: Final = 3.0  # noise of a sensor between two samples
_TOLD: Final = 3


def frozen(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield where position or speed stand still, or jump, while the other one does not."""
    by_speed = driven_m(recording)
    yield from _frozen_position(recording, by_speed, file)
    yield from _frozen_speed(recording, file)
    yield from _position_jumps(recording, by_speed, file)
    yield from _speed_jumps(recording, file)


def driven_m(recording: Recording) -> FloatArray:
    """Return the way since the first sample by the speed alone (trapezoids)."""
    time, speed = recording["time_s"], recording["speed_mps"]
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    return np.concatenate(([0.0], np.cumsum(steps)))


def _frozen_position(recording: Recording, by_speed: FloatArray, file: str) -> Iterator[Finding]:
    time, s = recording["time_s"], recording["s_m"]
    stands = [
        (a, b)
        for a, b in _constant(s)
        if by_speed[b] - by_speed[a] > _STANDS_M and time[b] - time[a] > HOLE_S
    ]
    if stands:
        told = [
            f"at {s[a]:.0f} m for {time[b] - time[a]:.1f} s from {time[a]:.1f} s on"
            for a, b in stands[:_TOLD]
        ]
        lost = sum(float(by_speed[b] - by_speed[a]) for a, b in stands)
        yield Finding(
            "warning", file, 0, "s_m",
            f"stands still {_listed(told, len(stands))}, while speed_mps says {lost:.0f} m",
            "what happened there is learned at the wrong place or not at all",
            "look for what froze the position; cut these samples out: a hole costs less",
        )  # fmt: skip


def _frozen_speed(recording: Recording, file: str) -> Iterator[Finding]:
    time, s, speed = recording["time_s"], recording["s_m"], recording["speed_mps"]
    stands = []
    for a, b in _constant(speed):
        if (lasted := time[b] - time[a]) > _SPEED_HOLDS_S:
            by_position = (s[b] - s[a]) / lasted
            allowed = max(_SPEED_DIFFERS_MPS, _SPEED_DIFFERS * abs(by_position))
            if abs(by_position - speed[a]) > allowed:
                stands.append((a, b, by_position))
    if stands:
        told = [
            f"at {speed[a]:.2f} m/s for {time[b] - time[a]:.1f} s from {s[a]:.0f} m on (s_m and "
            f"time_s say {other:.2f} m/s)"
            for a, b, other in stands[:_TOLD]
        ]
        yield Finding(
            "warning", file, 0, "speed_mps", f"stands still {_listed(told, len(stands))}",
            "what is learned there is not what was driven",
            "look for what froze the speed; cut these samples out: a hole costs less",
        )  # fmt: skip


def _position_jumps(recording: Recording, by_speed: FloatArray, file: str) -> Iterator[Finding]:
    time, s = recording["time_s"], recording["s_m"]
    passed_s = np.diff(time)
    off = np.diff(s) - np.diff(by_speed)
    # Within a step the speed can have been anything that brakes and power allow.
    allowed = _JUMP_M + _ACCELERATION_MAX_MPS2 * passed_s**2 / 4.0
    rows = np.flatnonzero((np.abs(off) > allowed) & (passed_s <= HOLE_S)).tolist()
    # A position that catches up after it stood still is told as frozen.
    ends = {b for _, b in _constant(s)}
    if rows := [row for row in rows if row not in ends or off[row] < 0.0]:
        told = [f"from {s[r]:.0f} to {s[r + 1]:.0f} m at {time[r]:.1f} s" for r in rows[:_TOLD]]
        laps = bool(np.any(off[rows] < -0.5 * np.ptp(s)))
        yield Finding(
            "warning", file, 0, "s_m", f"jumps {_listed(told, len(rows))}, while speed_mps says "
            f"{np.diff(by_speed)[rows[0]]:.0f} m",
            "positions behind a jump back are passed over, those in a jump forwards are guessed",
            "cut the recording there: each lap is a recording of its own" if laps
            else "correct the position, or cut the recording there",
        )  # fmt: skip


def _speed_jumps(recording: Recording, file: str) -> Iterator[Finding]:
    time, s, speed = recording["time_s"], recording["s_m"], recording["speed_mps"]
    change, passed_s = np.diff(speed), np.diff(time)
    rows = np.flatnonzero(
        np.abs(change) > _SPEED_STEP_MPS + _ACCELERATION_MAX_MPS2 * passed_s
    ).tolist()
    if rows:
        told = [
            f"from {speed[r]:.1f} to {speed[r + 1]:.1f} m/s within {passed_s[r]:.2g} s at "
            f"{s[r]:.0f} m"
            for r in rows[:_TOLD]
        ]
        yield Finding(
            "warning", file, 0, "speed_mps",
            f"jumps {_listed(told, len(rows))}: no car accelerates so",
            "an intervention that holds the jump teaches a wrong speed",
            "look for lost samples or zeros that the logger wrote; cut these samples out",
        )  # fmt: skip


def _constant(values: FloatArray) -> list[tuple[int, int]]:
    """Return first and last row of each run of two or more equal values."""
    return runs(np.diff(values) == 0.0)


def _listed(told: list[str], count: int) -> str:
    return "; ".join(told) + (f"; and {count - len(told)} times more" if count > len(told) else "")
