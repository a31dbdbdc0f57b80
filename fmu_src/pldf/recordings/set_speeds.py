"""Whether the set speed and the driver's part of it say the same."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..findings import Finding
from ..kernel.arrays import FloatArray
from ..kernel.units import KMH_PER_MPS
from .recording import Recording

_CHANGE_MIN_MPS: Final = 1.0 / KMH_PER_MPS  # a step of the lever; below is rounding
_APART_S: Final = 2.0  # two columns of one logger are not that late against each other


def set_speeds(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield that the offset changes where the set speed does not.

    Whatever had been learned, a lever moves both alike. Not so at a sign, which ends an offset.
    """
    if not ("set_speed_mps" in recording and "set_speed_offset_mps" in recording):
        return
    time_s, offset_mps = recording["time_s"], recording["set_speed_offset_mps"]
    rows = np.flatnonzero(np.abs(np.diff(offset_mps)) > _CHANGE_MIN_MPS)
    at_signs = recording["limit_mps"] if "limit_mps" in recording else recording["set_speed_mps"]
    alone = [
        row
        for row in rows.tolist()
        if _spread(time_s, recording["set_speed_mps"], row) < 0.5 * _CHANGE_MIN_MPS
        and _spread(time_s, at_signs, row) < 0.5 * _CHANGE_MIN_MPS
    ]
    if alone:
        kmh = KMH_PER_MPS * (offset_mps[alone[0] + 1] - offset_mps[alone[0]])
        yield Finding(
            "warning", file, 0, "set_speed_mps, set_speed_offset_mps",
            f"{len(alone)} of {len(rows)} changes of the offset are none of the set speed, the "
            f"first by {kmh:+.1f} km/h at {time_s[alone[0] + 1]:.1f} s",
            "one of them is not what it is taken for; rates go by the offset, lessons by both",
            "leave out the wrong one: the other says enough, with the road and the learned profile",
        )  # fmt: skip


def _spread(time_s: FloatArray, values: FloatArray, row: int) -> float:
    """Return highest minus lowest value around a row."""
    first, behind = np.searchsorted(time_s, (time_s[row] - _APART_S, time_s[row] + _APART_S))
    return float(np.ptp(values[first : max(behind, row + 2)]))
