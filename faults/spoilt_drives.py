"""A drive that is sound, and the ways in which laboratories spoil its recording.

Other units, columns mixed up, signals frozen or late, samples lost: every number is one that a
recording may hold, and only together they cannot be true.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .judged_kinds import MODES
from .sheets import Sheet

Array = NDArray[np.float64]
Drive = dict[str, Array]
Spoil = Callable[[Drive, random.Random], None]

LIMIT_MPS: Final = 27.78
ROAD: Final = (
    "s_m,curvature_per_m,speed_limit_mps\n"
    f"0,0,{LIMIT_MPS}\n1300,0,{LIMIT_MPS}\n1300,0,22.22\n1800,0,22.22\n"
)
_KMH: Final = ("speed_mps", "set_speed_mps", "limit_mps", "profile_mps", "base_mps")


def sound_drive(gas_m: float = 500.0, brake_m: float = 900.0, offset_mps: float = 2.78) -> Drive:
    """Return 80 s at 10 Hz: gas, brake, and a set speed of the driver's own from 1400 m on."""
    step, wish = 0.1, 25.0
    rows = []
    s, v, was = 20.0, 25.0, 25.0
    for n in range(1000):
        if s > 1780.0:
            break
        limit = LIMIT_MPS if s < 1300.0 else 22.22
        gas, brake = gas_m < s < gas_m + 120.0, brake_m < s < brake_m + 80.0
        offset = offset_mps if s > 1450.0 else 0.0
        followed = min(25.0, max(limit + offset, 0.0)) if s < 1230.0 else limit + offset
        wish = followed + 3.0 * gas - 4.0 * brake
        v += step * float(np.clip(wish - v, -1.5, 1.5))
        mode = 3.0 if gas else 1.0 if brake else 2.0
        rows.append((n * step, s, v, (v - was) / step, mode, 0.4 * gas, 0.3 * brake,
                     limit + offset, offset, followed, followed, limit, 1.0))  # fmt: skip
        s, was = s + step * v, v
    names = (
        "time_s", "s_m", "speed_mps", "acceleration_mps2", "mode", "gas_pedal", "brake_pedal",
        "set_speed_mps", "set_speed_offset_mps", "profile_mps", "base_mps", "limit_mps", "eligible",
    )  # fmt: skip
    return dict(zip(names, np.array(rows).T.round(4), strict=True))


def sheet_of(drive: Mapping[str, Array]) -> Sheet:
    """Return the file that this drive is recorded in."""
    columns = [
        [MODES[int(v)] if name == "mode" and v in range(5) else f"{v:.10g}" for v in values]
        for name, values in drive.items()
    ]
    return Sheet(list(drive), [list(row) for row in zip(*columns, strict=True)])


def _scaled(factor: float, *names: str) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        for name in names:
            drive[name] = drive[name] * factor

    return spoil


def _absent(*names: str) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        for name in names:
            del drive[name]

    return spoil


def _kept_rows(keep: Callable[[int, random.Random], Array | slice]) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        rows = keep(len(drive["time_s"]), chance)
        for name in drive:
            drive[name] = drive[name][rows]

    return spoil


def _without(seconds: float) -> Callable[[int, random.Random], Array]:
    def keep(count: int, chance: random.Random) -> Array:
        lost = round(10 * seconds)
        return np.delete(np.arange(count), slice(at := chance.randrange(count - lost), at + lost))

    return keep


def _frozen(*names: str) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        at = chance.randrange(100, 350)
        for name in names:
            drive[name][at : at + 300] = drive[name][at]

    return spoil


def _swapped(a: str, b: str) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        drive[a], drive[b] = drive[b], drive[a]

    return spoil


def _late(name: str) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        rows = chance.choice((50, 100))
        drive[name] = np.concatenate((np.full(rows, drive[name][0]), drive[name][:-rows]))

    return spoil


def _added(name: str, value: float) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        drive[name] = drive[name] + value

    return spoil


def _spike(name: str, value: float) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        drive[name][chance.randrange(10, len(drive[name]) - 10)] += value

    return spoil


def _set(name: str, value: float) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        drive[name] = np.full_like(drive[name], value)

    return spoil


def _rounded(**digits: int) -> Spoil:
    def spoil(drive: Drive, chance: random.Random) -> None:
        for name, count in digits.items():
            drive[name] = drive[name].round(count)

    return spoil


def _float32(drive: Drive, chance: random.Random) -> None:
    for name in drive:
        drive[name] = drive[name].astype(np.float32).astype(np.float64)


def _shuffled(count: int, chance: random.Random) -> Array:
    return np.array(chance.sample(range(count), count))


SPOILS: Final[dict[str, Spoil]] = {
    "kmh": _scaled(3.6, "speed_mps"),
    "kmh_everywhere": _scaled(3.6, *_KMH, "set_speed_offset_mps"),
    "mph": _scaled(2.23694, "speed_mps"),
    "set_speed_kmh": _scaled(3.6, "set_speed_mps"),
    "offset_kmh": _scaled(3.6, "set_speed_offset_mps"),
    "limit_kmh": _scaled(3.6, "limit_mps"),
    "profile_kmh": _scaled(3.6, "profile_mps"),
    "milliseconds": _scaled(1e3, "time_s"),
    "microseconds": _scaled(1e6, "time_s"),
    "minutes": _scaled(1.0 / 60.0, "time_s"),
    "kilometres": _scaled(1e-3, "s_m"),
    "centimetres": _scaled(1e2, "s_m"),
    "feet": _scaled(3.28084, "s_m"),
    "percent": _scaled(100.0, "gas_pedal", "brake_pedal"),
    "brake_sign": _scaled(-1.0, "brake_pedal"),
    "gas_sign": _scaled(-1.0, "gas_pedal"),
    "speed_sign": _scaled(-1.0, "speed_mps"),
    "s_sign": _scaled(-1.0, "s_m"),
    "offset_sign": _scaled(-1.0, "set_speed_offset_mps"),
    "acceleration_g": _scaled(1.0 / 9.81, "acceleration_mps2"),
    "acceleration_sign": _scaled(-1.0, "acceleration_mps2"),
    "backwards": lambda drive, _chance: drive.update(s_m=1800.0 - drive["s_m"]),
    "epoch": _added("time_s", 1.7e9),
    "from_400_m": _added("s_m", 400.0),
    "behind_the_road": _added("s_m", 3000.0),
    "no_offset": _absent("set_speed_offset_mps"),
    "no_set_speed": _absent("set_speed_mps"),
    "no_set_speed_and_no_offset": _absent("set_speed_mps", "set_speed_offset_mps"),
    "no_pedals": _absent("gas_pedal", "brake_pedal"),
    "no_limit": _absent("limit_mps"),
    "no_profile": _absent("profile_mps", "base_mps"),
    "no_eligible": _absent("eligible"),
    "no_acceleration": _absent("acceleration_mps2"),
    "half": _kept_rows(lambda count, _chance: slice(count // 2)),
    "second_half": _kept_rows(lambda count, _chance: slice(count // 2, None)),
    "drop_out_of_1_6_s": _kept_rows(_without(1.6)),
    "drop_out_of_6_s": _kept_rows(_without(6.0)),
    "drop_out_of_20_s": _kept_rows(_without(20.0)),
    "one_row_lost": _kept_rows(_without(0.1)),
    "reversed": _kept_rows(lambda _count, _chance: slice(None, None, -1)),
    "shuffled": _kept_rows(_shuffled),
    "frozen_speed": _frozen("speed_mps"),
    "frozen_position": _frozen("s_m"),
    "frozen_mode": _frozen("mode"),
    "frozen_all_but_time": _frozen("s_m", "speed_mps", "acceleration_mps2", "mode"),
    "time_and_position_swapped": _swapped("time_s", "s_m"),
    "speed_and_acceleration_swapped": _swapped("speed_mps", "acceleration_mps2"),
    "speed_and_set_speed_swapped": _swapped("speed_mps", "set_speed_mps"),
    "set_speed_and_offset_swapped": _swapped("set_speed_mps", "set_speed_offset_mps"),
    "set_speed_and_limit_swapped": _swapped("set_speed_mps", "limit_mps"),
    "pedals_swapped": _swapped("gas_pedal", "brake_pedal"),
    "speed_late": _late("speed_mps"),
    "position_late": _late("s_m"),
    "mode_late": _late("mode"),
    "offset_late": _late("set_speed_offset_mps"),
    "speed_spike": _spike("speed_mps", 70.0),
    "position_spike": _spike("s_m", 300.0),
    "time_spike": _spike("time_s", 1000.0),
    "offset_spike": _spike("set_speed_offset_mps", 7.0),
    "off": _set("mode", 0.0),
    "never_eligible": _set("eligible", 0.0),
    "standstill": _set("speed_mps", 0.0),
    "constant_set_speed": _set("set_speed_mps", LIMIT_MPS),
    "missing_as_99": _spike("speed_mps", -124.0),
    "mode_from_1": _added("mode", 1.0),
    "two_decimals": _rounded(speed_mps=2, set_speed_mps=2, set_speed_offset_mps=2, limit_mps=2),
    "whole_positions": _rounded(s_m=0),
    "coarse_time": _rounded(time_s=0),
    "float32": _float32,
}
