"""Columns in another unit than their name says, told by what the others say.

Way by the speed, over windows of the recording, against way by the position: the median of the
windows is robust against holes, jumps and noise. Speeds that nothing measures a second time are
held against the legal limit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from ..findings import Finding, Severity
from ..kernel.arrays import FloatArray, RouteArrays
from ..kernel.codes import ACTIVE
from ..kernel.units import KMH_PER_MPS
from .frozen import driven_m
from .quality import HOLE_S, cells_of
from .recording import Recording
from .units import UNITS

_MPH_PER_MPS: Final = float(1 / UNITS["m/s"]["mph"])
_WINDOWS: Final = 60
_WINDOW_M: Final = 20.0  # a shorter way says little: positions may be whole metres
_WINDOWS_MIN: Final = 3
_SAME_UNIT: Final = 0.04  # how near a factor must be to that of a unit
_AGREES: Final = 0.05  # a tachometer may be off so far
_SPREAD_MAX: Final = 0.1
_SPEED_MAX_MPS: Final = 100.0  # 360 km/h
_LIMIT_MAX_MPS: Final = 65.0  # 234 km/h; above what is written for a road without a limit
_LIMIT_USED: Final = 0.4  # of a limit above 30 m/s some part of a drive is faster than that
_DRIVE_MIN_M: Final = 100.0  # a shorter "drive" is one in km
_TOGETHER: Final = frozenset(
    (speed, other)
    for speed, others in (("km/h", "ms us ns km"), ("mph", "ms us ns mi ft"))
    for other in others.split()
)  # two wrong units that come together
_NEVER_FITS: Final = 2.0  # set speed over limit, from where on it has to be told


class _Unit(NamedTuple):
    """Another unit of a column, and by how much it changes way by speed over way by position."""

    column: str
    unit: str
    factor: float


_UNITS: Final = (
    *(_Unit("speed_mps", unit, float(1 / size)) for unit, size in UNITS["m/s"].items()),
    *(_Unit("time_s", unit, float(1 / size)) for unit, size in UNITS["s"].items()),
    *(_Unit("s_m", unit, float(size)) for unit, size in UNITS["m"].items()),
)


def unit_doubts(recording: Recording, file: str, route: RouteArrays | None) -> Iterator[Finding]:
    """Yield columns that seem to be in another unit, with the factor."""
    told = list(_speed_and_position(recording, file))
    yield from told
    if not told:
        yield from _too_fast(recording, file)
        yield from _acceleration(recording, file)
    yield from _speeds_and_limit(recording, file, route)
    yield from _offset(recording, file)


def _speed_and_position(recording: Recording, file: str) -> Iterator[Finding]:
    ratios = _ratios(recording)
    if len(ratios) < _WINDOWS_MIN:
        return
    ratio = float(np.median(ratios))
    if abs(ratio - 1.0) <= _AGREES:
        return
    if ratio < 0.0 and np.median(recording["speed_mps"]) < 0.0:
        yield Finding(
            "error", file, 0, "speed_mps", "speed_mps is negative while s_m rises",
            "nothing is learned from a car that goes backwards",
            "is the axis the other way? then factor = -1 for speed_mps in a mapping file",
        )  # fmt: skip
        return
    if ratio < 0.0:
        yield Finding(
            "error", file, 0, "s_m, speed_mps", "s_m falls while speed_mps is positive",
            "nothing is learned from a drive against the road's direction",
            "is the position counted from the road's other end? then factor = -1 and add = LENGTH "
            "for s_m in a mapping file; if it was driven the other way, name the road of that way",
        )  # fmt: skip
        return
    low, high = np.percentile(ratios, (25.0, 75.0))
    steady = bool(high - low < _SPREAD_MAX * ratio)
    units = _units_for(ratio, float(np.ptp(recording["s_m"])), _period(recording))
    severity: Severity = "error" if steady and (units or not 0.8 < ratio < 1.25) else "warning"
    yield Finding(
        severity, file, 0, ", ".join(unit.column for unit in units) or "speed_mps",
        f"speed_mps is {ratio:.4g} times what s_m and time_s say"
        + (f": {_asked(units)}" if units else ""),
        "every speed, position or duration would be wrong by that",
        stated(*((one.column, one.unit) for one in units)) if units
        else "check the units of speed_mps, s_m and time_s",
    )  # fmt: skip


def _asked(units: tuple[_Unit, ...]) -> str:
    return " and ".join(f"{unit.column} in {unit.unit}" for unit in units) + "?"


def stated(*units: tuple[str, str]) -> str:
    """Return the way out: lines of a mapping file that state the unit of our columns."""
    lines = ", ".join(f'{name} = {{ column = "{name}", unit = "{unit}" }}' for name, unit in units)
    return f"state the unit in a mapping file (--map), under [recording]: {lines}"


def _ratios(recording: Recording) -> FloatArray:
    """Return way by speed over way by position, per window in which the car moves."""
    s, by_speed = recording["s_m"], driven_m(recording)
    rows = len(recording)
    edges = np.unique(np.linspace(0, rows - 1, min(_WINDOWS, rows - 1) + 1).astype(np.intp))
    by_s, by_v = np.diff(s[edges]), np.diff(by_speed[edges])
    # In whichever unit one of them is, the other one shows that the car moves.
    moves = (np.abs(by_v) > 0.0) & (np.abs(by_s) > 0.0)
    moves &= np.maximum(np.abs(by_s), np.abs(by_v)) > _WINDOW_M
    windows = np.divide(by_v, by_s, out=np.zeros_like(by_v), where=moves)
    return windows[moves]


def _period(recording: Recording) -> float:
    return float(np.median(np.diff(recording["time_s"])))


def _units_for(ratio: float, driven: float, period_s: float) -> tuple[_Unit, ...]:
    """Return the unit, or the two, that explain ``ratio``; empty if none does."""
    plausible = [unit for unit in _UNITS if unit.factor != 1.0]
    plausible = [unit for unit in plausible if _is_plausible(unit, driven, period_s)]
    speeds = [unit for unit in plausible if unit.column == "speed_mps"]
    choices = [(unit,) for unit in plausible]
    others = [unit for unit in plausible if unit.column != "speed_mps"]
    both = [(v, o) for v in speeds for o in others if (v.unit, o.unit) in _TOGETHER]
    for units in (*choices, *both):
        if abs(ratio / np.prod([unit.factor for unit in units]) - 1.0) <= _SAME_UNIT:
            return units
    return ()


def _is_plausible(unit: _Unit, driven: float, period_s: float) -> bool:
    """Tell units of one factor apart: a drive is no 100 m long, and no sample takes minutes."""
    if unit.unit in ("km", "mi"):
        return driven < _DRIVE_MIN_M
    if unit.column == "time_s" and unit.factor > 1.0:
        return driven >= _DRIVE_MIN_M and 1.0 / unit.factor < period_s
    return True


def _too_fast(recording: Recording, file: str) -> Iterator[Finding]:
    usual = float(np.median(recording["speed_mps"]))
    if usual > _SPEED_MAX_MPS:
        yield Finding(
            "error", file, 0, "speed_mps", f"mostly {usual:.4g} m/s, which is "
            f"{KMH_PER_MPS * usual:.0f} km/h", "no car drives so; every number would be wrong",
            "check the units of speed_mps, s_m and time_s, which fit each other",
        )  # fmt: skip


def _speeds_and_limit(
    recording: Recording, file: str, route: RouteArrays | None
) -> Iterator[Finding]:
    """Hold limit, set speed and profiles against the legal limit."""
    limit = _limit(recording, route)
    if limit is None:
        return
    if route is not None and "limit_mps" in recording:
        yield from _against_limit(recording, "limit_mps", limit, file)
    elif float(np.max(limit)) > _LIMIT_MAX_MPS or _never_used(recording, limit):
        text = f"up to {np.max(limit):.4g} m/s, driven at up to {recording['speed_mps'].max():.4g}"
        yield _wrong_unit(file, "limit_mps", text, "km/h", "a legal limit")
        return
    for name in ("set_speed_mps", "profile_mps", "base_mps"):
        if name in recording:
            yield from _against_limit(recording, name, limit, file)


def _never_used(recording: Recording, limit: FloatArray) -> bool:
    """Tell whether limits that no town has are never driven at, nor the set speed near them."""
    used = max(
        float(np.max(recording[name] / np.maximum(limit, 1.0)))
        for name in ("speed_mps", "set_speed_mps")
        if name in recording
    )
    return bool(np.min(limit) >= 30.0 - 1e-9 and used < _LIMIT_USED)


def _limit(recording: Recording, route: RouteArrays | None) -> FloatArray | None:
    if route is not None:
        return np.asarray(route.limit_mps)[cells_of(recording["s_m"], route)]
    return recording.columns.get("limit_mps")


def _against_limit(
    recording: Recording, name: str, limit: FloatArray, file: str
) -> Iterator[Finding]:
    """A set speed is the limit or near it; a profile reaches it somewhere and is rarely above."""
    rows = recording["mode"] == ACTIVE
    if not rows.any() or np.any(limit <= 0.0):
        return
    ratio = recording[name][rows] / limit[rows]
    usual = float(np.median(ratio) if name in ("set_speed_mps", "limit_mps") else
                  np.percentile(ratio, 90.0))  # fmt: skip
    for unit, factor in (("km/h", KMH_PER_MPS), ("mph", _MPH_PER_MPS)):
        if abs(usual / factor - 1.0) <= 3 * _SAME_UNIT:
            text = f"{usual:.3g} times the legal limit"
            yield _wrong_unit(file, name, text, unit, "what the driver or the function sets")
            return
        if abs(usual * factor - 1.0) <= 3 * _SAME_UNIT and name == "set_speed_mps":
            text = f"the legal limit is {1 / usual:.3g} times set_speed_mps"
            yield _wrong_unit(file, "limit_mps", text, unit, "a legal limit")
            return
    if name == "set_speed_mps" and not 1.0 / _NEVER_FITS < usual < _NEVER_FITS:
        yield Finding(
            "warning", file, 0, name,
            f"mostly {usual:.3g} times the legal limit; nobody sets that on a road",
            "set-speed rates and learned offsets would be wrong",
            "check what this column holds, and its unit",
        )  # fmt: skip


def _wrong_unit(file: str, name: str, text: str, unit: str, what: str) -> Finding:
    return Finding(
        "error", file, 0, name, f"{text}: {name} in {unit}?",
        f"{what} is not so; rates and what is learned would be wrong",
        stated((name, unit)),
    )  # fmt: skip


def _offset(recording: Recording, file: str) -> Iterator[Finding]:
    """Hold the offset against set speed minus limit, where both are there and not zero."""
    if any(n not in recording for n in ("set_speed_offset_mps", "set_speed_mps", "limit_mps")):
        return
    offset = recording["set_speed_offset_mps"]
    other = recording["set_speed_mps"] - recording["limit_mps"]
    rows = (np.abs(other) > 0.2) & (np.abs(offset) > 0.2)
    if np.count_nonzero(rows) < _WINDOWS_MIN:
        return
    ratio = offset[rows] / other[rows]
    for unit, factor in (("km/h", KMH_PER_MPS), ("mph", _MPH_PER_MPS)):
        if np.mean(np.abs(ratio / factor - 1.0) <= _SAME_UNIT) > 0.9:
            text = f"{factor:.3g} times set_speed_mps minus limit_mps"
            yield _wrong_unit(file, "set_speed_offset_mps", text, unit, "an offset")


def _acceleration(recording: Recording, file: str) -> Iterator[Finding]:
    """Hold the acceleration against the change of the speed, by least squares over windows."""
    if "acceleration_mps2" not in recording:
        return
    time, speed = recording["time_s"], recording["speed_mps"]
    stated = recording["acceleration_mps2"]
    whole = np.diff(time) <= HOLE_S
    steps = np.where(whole, 0.5 * (stated[1:] + stated[:-1]) * np.diff(time), 0.0)
    by_speed = np.where(whole, np.diff(speed), 0.0)
    edges = np.searchsorted(time, np.arange(time[0], time[-1], 2.0 * HOLE_S))
    edges = np.unique(edges[edges < len(steps)])[:-1]
    if len(edges) < 10:
        return
    stated_change, change = (np.add.reduceat(x, edges) for x in (steps, by_speed))
    if np.sqrt(np.mean(change**2)) < 0.5 or not np.any(stated_change):
        return
    likeness = float(np.corrcoef(stated_change, change)[0, 1])
    slope = float(np.sum(stated_change * change) / np.sum(change**2))
    if abs(likeness) < 0.9 or 0.5 < slope < 2.0:
        return
    in_g = abs(slope * 9.81 - 1.0) < 0.1
    meant = "in g?" if in_g else "with the other sign?" if slope < 0.0 else ""
    yield Finding(
        "warning", file, 0, "acceleration_mps2",
        f"{slope:.3g} times what speed_mps and time_s say{': ' + meant if meant else ''}",
        "what is drawn of it is wrong",
        f"factor = {1 / slope:.3g} for acceleration_mps2 in a mapping file, or leave it out",
    )  # fmt: skip
