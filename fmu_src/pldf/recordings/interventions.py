"""Interventions and rates read from a recording alone (section 4), independent of the kernel."""

from __future__ import annotations

from math import nan
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray
from ..kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from ..kernel.parameters import LearningParameters
from .recording import Recording

Kind = Literal["gas", "brake", "set_speed"]

GAP_S: Final = 0.3  # shorter gaps between pedal interventions merge: pedal bounce
PRESSED: Final = 0.02  # pedal travel from which a pedal counts as pressed
# A set-speed offset up to this is rounding.
OFFSET_TOLERANCE_MPS: Final = LearningParameters().learning_offset_tolerance_mps


class Interval(NamedTuple):
    """Rows ``first`` to ``last`` of a recording; ``last`` is the row in which it is over."""

    kind: Kind
    first: int
    last: int


class Rates(NamedTuple):
    """Shares of a drive's time, 0..1."""

    pedal: float
    set_speed: float
    combined: float


def pedal_interventions(recording: Recording) -> list[Interval]:
    """Return the pedal interventions in order; one that begins with gas and ends by brake is one.

    The kind is "brake" if the driver braked in it, else "gas".
    """
    mode = recording["mode"]
    last_row = len(recording) - 1
    gas = mode == GAS_OVERRIDE
    inactive = (gas | (mode == STANDBY)) & _after_activation(mode)
    intervals: list[Interval] = []
    for first, behind in runs(inactive):
        start = _start(recording, first, behind)
        if start < 0:
            continue
        stop = min(behind, last_row)
        braked = bool(np.any(mode[start:behind] == STANDBY))
        previous = intervals[-1] if intervals else None
        if previous and recording["time_s"][start] - recording["time_s"][previous.last] < GAP_S:
            intervals.pop()
            start, braked = previous.first, braked or previous.kind == "brake"
        intervals.append(Interval("brake" if braked else "gas", start, stop))
    return intervals


def set_speed_interventions(recording: Recording) -> list[Interval]:
    """Return the stretches with an offset of the set speed that was set in this drive.

    None if the recording has no offsets: then it is not known.
    """
    if "set_speed_offset_mps" not in recording:
        return []
    active = np.abs(recording["set_speed_offset_mps"]) > OFFSET_TOLERANCE_MPS
    last_row = len(recording) - 1
    return [Interval("set_speed", a, min(b, last_row)) for a, b in runs(active)]


def rates_of(recording: Recording) -> Rates:
    """Return the intervention rates: time shares between the first and the last row.

    Without offsets of the set speed, two of them are NaN: not known.
    """
    time = recording["time_s"]
    pedal = _marked(pedal_interventions(recording), len(recording))
    offset = _marked(set_speed_interventions(recording), len(recording))
    passed = np.diff(time)
    total = time[-1] - time[0]
    shares = [float(np.sum(passed[m[:-1]]) / total) for m in (pedal, offset, pedal | offset)]
    if "set_speed_offset_mps" not in recording:
        return Rates(shares[0], nan, nan)
    return Rates(*shares)


def _start(recording: Recording, first: int, behind: int) -> int:
    """Return the row at which the driver's pedal made the function inactive, -1 if none did.

    Standby without brake is the lever's doing; gas in standby is no override.
    """
    mode, brake = recording["mode"], recording["brake_pedal"] > PRESSED
    for row in range(first, behind):
        if mode[row] == GAS_OVERRIDE:
            return row
        took_over = mode[row - 1] in (ACTIVE, GAS_OVERRIDE)
        if took_over and (brake[row] or brake[row - 1]):
            return row
    return -1


def _after_activation(mode: FloatArray) -> NDArray[np.bool_]:
    return np.maximum.accumulate((mode == ACTIVE) | (mode == GAS_OVERRIDE))


def _marked(intervals: list[Interval], rows: int) -> NDArray[np.bool_]:
    marks = np.zeros(rows, dtype=bool)
    for interval in intervals:
        marks[interval.first : interval.last] = True
    return marks


def runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first row and row behind the last of each run of true values."""
    edges = np.flatnonzero(np.diff(flags.astype(np.int8), prepend=0, append=0))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
