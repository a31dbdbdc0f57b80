"""Which rows of a recording are one drive along the road (``pldf.kernel.lap``, on columns)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from ..findings import Finding
from ..function import DrivingFunction
from ..kernel.arrays import FloatArray
from ..kernel.codes import ACTIVE, GAS_OVERRIDE
from ..kernel.lap import SET_BACK_M
from .recording import Recording

_MODES_DRIVEN: Final = (float(ACTIVE), float(GAS_OVERRIDE))


def first_lap(recording: Recording, function: DrivingFunction, file: str = "") -> Recording:
    """Return the rows up to the road's end, or until the car is set back, and a note of the rest.

    Args:
        recording: as it was read.
        function: prepared for the route.
        file: of the recording, for the notes.
    """
    length_m = len(function.route.limit_mps) - 1.0
    begin, set_back = _between_jumps(recording, function)
    on_road = recording["s_m"][begin:set_back]
    beyond = np.flatnonzero(on_road >= length_m)
    # What begins behind the end is judged as a whole, where the road is compared.
    ends = begin + int(beyond[0]) + 1 if len(beyond) and on_road[0] < length_m else set_back
    if (begin, ends) == (0, len(recording)):
        return recording
    columns = {name: values[begin:ends] for name, values in recording.columns.items()}
    told = _told(recording, file, (begin, ends, set_back))
    return replace(recording, columns=columns, notes=(*recording.notes, *told))


def _between_jumps(recording: Recording, function: DrivingFunction) -> tuple[int, int]:
    """Return the row at which the lap begins, and the one at which the car is set back."""
    time, s = recording["time_s"], recording["s_m"]
    driven = np.isin(recording["mode"], _MODES_DRIVEN)
    begin = 0
    for row in _jumps_back(recording, function):
        if row <= begin or _comes_back(time, s, row, function.record.learning_recording_gap_s):
            continue
        if driven[begin:row].any():
            return begin, row
        begin = row
    return begin, len(s)


def _jumps_back(recording: Recording, function: DrivingFunction) -> list[int]:
    """Return the rows further back than a correction of the position, or than a car can reverse."""
    time, s, speed = (recording[name] for name in ("time_s", "s_m", "speed_mps"))
    reach_m = np.maximum(speed[1:], speed[:-1]) * np.diff(time)
    reach_m += function.record.control_position_jump_max_m
    return [
        row + 1 for row in np.flatnonzero(-np.diff(s) > np.maximum(reach_m, SET_BACK_M)).tolist()
    ]


def _comes_back(time: FloatArray, s: FloatArray, row: int, patience_s: float) -> bool:
    """Tell whether a jump back was a glitch: soon the car is where it was before."""
    soon = s[row : int(np.searchsorted(time, time[row] + patience_s, side="right"))]
    return bool(np.any(soon >= s[row - 1] - SET_BACK_M))


def _told(recording: Recording, file: str, rows: tuple[int, int, int]) -> Iterator[Finding]:
    begin, ends, set_back = rows
    time, s = recording["time_s"], recording["s_m"]
    if begin:
        yield Finding(
            "note", file, 0, "s_m",
            f"from {s[begin - 1]:.0f} back to {s[begin]:.0f} m at {time[begin]:g} s, before the "
            "function was active", "the drive begins there",
        )  # fmt: skip
    if ends < set_back:
        yield Finding(
            "note", file, 0, "s_m",
            f"{time[set_back - 1] - time[ends - 1]:.1f} s behind the road's end",
            "they are no part of the drive: neither learned nor counted in the rates",
        )  # fmt: skip
    if set_back < len(s):
        yield Finding(
            "warning", file, 0, "s_m",
            f"set back from {s[set_back - 1]:.0f} to {s[set_back]:.0f} m at {time[set_back]:g} s",
            "the drive ends there; what follows is neither learned nor counted",
            "cut the recording there, and give the next drive a file of its own",
        )  # fmt: skip
