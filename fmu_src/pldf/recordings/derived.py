"""Columns that a recording lacks, derived from the route and the profile that was driven.

What cannot be known stays absent: a set speed of a function that had learned says what the driver
did only if one knows what was learned.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from ..findings import Finding
from ..function import DrivingFunction
from ..kernel.arrays import FloatArray
from ..kernel.codes import GAS_OVERRIDE, STANDBY
from ..kernel.units import KMH_PER_MPS
from .columns import COLUMNS
from .lap import first_lap
from .quality import cells_of
from .recording import Recording

# Decision: a set speed that changes up to this long before or after a sign changes because of it: a
# second of delay, and half a second for the rounding of places and times.
SIGN_LAG_S: Final = 1.5
NO_SET_SPEED: Final = "neither set_speed_mps nor set_speed_offset_mps was recorded"
# What stands in for a column, where that is more than a derivative.
_HOWS: Final = {
    "limit_mps": "from the road",
    "base_mps": "planned from the road",
    "gas_pedal": "GAS_OVERRIDE counts as gas",
    "brake_pedal": "standby after driving counts as braked",
    "eligible": "learning was allowed everywhere",
}
# What one has to know of the profile that was followed.
_LEARNED: Final = ("profile_mps", "set_speed_offset_mps")
_ROUNDING: Final = 1.0 + 1e-6  # what is written as exactly the tolerance is within it


class Offsets(NamedTuple):
    """Offsets of a set speed from what the function sets by itself.

    Attributes:
        offset_mps: per row; 0 where the function set it.
        at_signs: number of rows at which the set speed is late or early for a sign.
    """

    offset_mps: FloatArray
    at_signs: int


def completed(
    recording: Recording, function: DrivingFunction, file: str = "", profile_known: bool = True
) -> Recording:
    """Return one lap of ``recording`` with all columns that can be known, and notes of it.

    Pedals come from the mode (standby after driving counts as braked), acceleration from the
    speed, set speed and offset from each other and what the function sets by itself: the limit
    with what it had learned.

    Args:
        recording: as it was read.
        function: prepared for the route; it follows the profile that was driven.
        file: of the recording, for the notes.
        profile_known: False if it is not known what the function had learned before the drive:
            then ``profile_mps``, and set speed and offset from each other, are not derived.
    """
    recording = first_lap(recording, function, file)
    columns = dict(recording.columns)
    road, profile = _Road(function, columns["s_m"]), function.profile
    limit_mps = road.per_cell(function.route.limit_mps)
    columns.setdefault("limit_mps", limit_mps)
    columns.setdefault("base_mps", road.per_node(profile.base_mps))
    columns.setdefault("gas_pedal", (columns["mode"] == GAS_OVERRIDE).astype(np.float64))
    columns.setdefault("brake_pedal", (columns["mode"] == STANDBY).astype(np.float64))
    columns.setdefault("eligible", np.ones(len(recording)))
    columns.setdefault("acceleration_mps2", np.gradient(columns["speed_mps"], columns["time_s"]))
    at_signs = 0
    if profile_known:
        columns.setdefault("profile_mps", road.per_node(profile.learned_mps))
        automatic_mps = limit_mps + road.per_cell(profile.offset_mps)
        at_signs = _add_set_speed(columns, automatic_mps, function)
    notes = (
        *recording.notes,
        *_roads_and_pedals(recording, file),
        *(_set_speed(recording, function, file, at_signs) if profile_known else ()),
        *(() if profile_known else _unknown(recording, file)),
    )
    kept = {name: columns[name] for name in COLUMNS if name in columns}
    return replace(recording, columns=kept, notes=notes)


def _add_set_speed(
    columns: dict[str, FloatArray], automatic_mps: FloatArray, function: DrivingFunction
) -> int:
    """Add set speed and offset, from each other; return how many rows at signs are no offset."""
    if "set_speed_mps" not in columns:
        offset_mps = columns.setdefault("set_speed_offset_mps", np.zeros(len(automatic_mps)))
        columns["set_speed_mps"] = automatic_mps + offset_mps
    if "set_speed_offset_mps" in columns:
        return 0
    tolerance_mps = function.record.learning_offset_tolerance_mps
    found = offsets_of(columns["time_s"], columns["set_speed_mps"], automatic_mps, tolerance_mps)
    columns["set_speed_offset_mps"] = found.offset_mps
    return found.at_signs


class _Road:
    """Values along a road at the positions of a recording."""

    def __init__(self, function: DrivingFunction, s_m: FloatArray) -> None:
        self._s_m, self._node = s_m, np.arange(float(len(function.route.limit_mps)))
        self._cell = cells_of(s_m, function.route)

    def per_cell(self, values: object) -> FloatArray:
        found: FloatArray = np.asarray(values, dtype=np.float64)[self._cell]
        return found

    def per_node(self, values: object) -> FloatArray:
        return np.interp(self._s_m, self._node, np.asarray(values, dtype=np.float64))


def offsets_of(
    time_s: FloatArray, set_mps: FloatArray, automatic_mps: FloatArray, tolerance_mps: float
) -> Offsets:
    """Return by how much the driver had set the speed away from what the function sets.

    Recordings are rounded, and their columns are not of the very same moment. So a difference up
    to the tolerance is none. Neither is one shortly behind a sign while the set speed is still the
    old one, nor one shortly before it if the set speed is that of the sign already. Nothing is set
    where the set speed is 0 or less.

    Args:
        time_s: of the rows.
        set_mps: set speed that was recorded.
        automatic_mps: what the function sets by itself at the place of each row.
        tolerance_mps: half a displayed unit (``learning.offset_tolerance_mps``).
    """
    tolerance = tolerance_mps * _ROUNDING
    offset = set_mps - automatic_mps
    offset = np.where((np.abs(offset) <= tolerance) | (set_mps <= 0.0), 0.0, offset)
    at_signs = 0
    for sign in (np.flatnonzero(np.diff(automatic_mps)) + 1).tolist():
        rows = slice(
            _early_from(time_s, set_mps, sign, automatic_mps[sign], tolerance),
            _late_until(time_s, set_mps, sign, tolerance),
        )
        at_signs += int(np.count_nonzero(offset[rows]))
        offset[rows] = 0.0
    return Offsets(offset, at_signs)


def _late_until(time_s: FloatArray, set_mps: FloatArray, sign: int, tolerance: float) -> int:
    """Return the row up to which the set speed is that of before the row ``sign``, if not long."""
    changed = np.flatnonzero(np.abs(set_mps[sign:] - set_mps[sign - 1]) > tolerance)
    row = sign + int(changed[0]) if len(changed) else len(set_mps)
    return row if time_s[row - 1] - time_s[sign] <= SIGN_LAG_S * _ROUNDING else sign


def _early_from(
    time_s: FloatArray, set_mps: FloatArray, sign: int, behind_mps: float, tolerance: float
) -> int:
    """Return the row from which the set speed is that of behind the row ``sign``, if not long."""
    different = np.flatnonzero(np.abs(set_mps[:sign] - behind_mps) > tolerance)
    row = int(different[-1]) + 1 if len(different) else 0
    return row if time_s[sign] - time_s[row] <= SIGN_LAG_S * _ROUNDING else sign


def _roads_and_pedals(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield how absent columns came about that have nothing to do with the set speed."""
    told = [f"{name} ({how})" for name, how in _HOWS.items() if name not in recording]
    if told:
        yield Finding("note", file, 0, "", f"not recorded, so derived: {', '.join(told)}")


def _unknown(recording: Recording, file: str) -> Iterator[Finding]:
    """Yield what stays absent since it is not known what the function had learned."""
    if absent := [name for name in _LEARNED if name not in recording]:
        yield Finding(
            "note", file, 0, "",
            f"{', '.join(absent)} not recorded, and what the function had learned before is not "
            "known", "it is left out, not guessed",
        )  # fmt: skip


def _set_speed(
    recording: Recording, function: DrivingFunction, file: str, at_signs: int
) -> Iterator[Finding]:
    """Yield how the offset of the set speed came about."""
    if "set_speed_offset_mps" in recording:
        return
    if "set_speed_mps" not in recording:
        yield Finding(
            "warning", file, 0, "",
            NO_SET_SPEED,
            "the set speed counts as never changed by the driver",
            "record one of them, or a column set_speed_offset_mps of zeros if nobody could",
        )  # fmt: skip
        return
    tolerance = KMH_PER_MPS * function.record.learning_offset_tolerance_mps
    late = "; not where it is but late or early for a sign" if at_signs else ""
    yield Finding(
        "note", file, 0, "",
        "set_speed_offset_mps not recorded, so derived: what set_speed_mps differs from limit and "
        f"learned offset by more than {tolerance:g} km/h{late}",
    )  # fmt: skip
