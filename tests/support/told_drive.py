"""A drive in which every kind of thing becomes of an intervention, as inputs per step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from pldf.function import DrivingFunction
from pldf.recordings.recording import Recording
from pldf.roads import Mark, read_route, write_route_csv

STEP_S = 0.1
ROAD = """s_m,curvature_per_m,speed_limit_mps
0,0,27.7777777777777786
1200,0,13.8888888888888893
1240,0,27.7777777777777786
5000,0,27.7777777777777786
"""

Inputs = dict[str, float | bool]


MARKS = (
    Mark(0.0, "road", "12 Hauptstra\N{LATIN SMALL LETTER SHARP S}e"),
    Mark(1200.0, "road", "7", against=True),
    Mark(1200.0, "sign", "50 km/h sign"),
    Mark(1700.0, "road", "100"),
)


def write_road(folder: Path) -> Path:
    """Write the road: 100 km/h with 50 km/h over 40 m, on three roads of a map."""
    path = folder / "road.csv"
    path.write_text(ROAD)
    write_route_csv(replace(read_route(path), marks=MARKS), path)
    return path


def _speed(s_m: float) -> float:
    if 1050.0 <= s_m < 1300.0:
        return 30.0
    if s_m < 2150.0:
        return 25.0
    if s_m < 2200.0:  # brakes to a stop
        return max(25.0 * (2200.0 - s_m) / 50.0, 0.3)
    return 25.0


def told_drive() -> Iterator[tuple[float, float, Inputs]]:
    """Yield time and step in s, and the inputs by field."""
    s_m = time_s = 0.0
    standing = 0
    presses = (700.0, 1500.0, 2550.0, *(3000.0 + 20.0 * k for k in range(5)))
    while s_m < 4900.0:
        hole = 1750.0 <= s_m < 1752.5
        step_s = 2.0 if hole else STEP_S
        speed = _speed(s_m)
        if 2200.0 <= s_m < 2210.0 and standing < 100:
            standing += 1
            speed = 0.0
        gas = any(a <= s_m < b for a, b in ((400, 500), (1050, 1300), (1700, 1900), (2600, 2700)))
        gas |= 40 <= standing < 50 and speed == 0.0
        gas |= s_m >= 4800.0
        lead = 3390.0 <= s_m < 3510.0
        gas |= 3400.0 <= s_m < 3500.0
        yield (
            time_s,
            step_s,
            {
                "vehicle_s_m": s_m,
                "vehicle_speed_mps": speed,
                "driver_gas_pedal": 0.3 if gas else 0.0,
                "driver_brake_pedal": 0.3 if 2100.0 <= s_m < 2200.0 else 0.0,
                "lever_resume": 0.3 < time_s < 0.5 or 20 <= standing < 25,
                "lever_up_long": any(_tip(s_m, at) for at in presses),
                "lever_down_long": _tip(s_m, 730.0),
                "lead_present": lead,
                "lead_gap_m": 20.0 if lead else 0.0,
                "lead_speed_mps": speed if lead else 0.0,
                "eligible": not (2500.0 <= s_m < 2800.0 or 440.0 <= s_m < 450.0),
            },
        )
        s_m += speed * step_s
        time_s += step_s


def _tip(s_m: float, at_m: float) -> bool:
    return at_m <= s_m < at_m + 5.0


def driven(road: Path) -> DrivingFunction:
    """Return the function after the drive, learned from; its messages hold what it said."""
    return _drive(road, {})


def told_recording(road: Path) -> Recording:
    """Return the recording of that drive, one sample per step."""
    columns: dict[str, list[float]] = {name: [] for name in ("time_s", *_FIELDS)}
    _drive(road, columns)
    return Recording({name: np.array(values) for name, values in columns.items()})


# What an observer sees at the beginning of a step: new inputs, and what was in force until then.
_FIELDS = {
    "s_m": "vehicle_s_m",
    "speed_mps": "vehicle_speed_mps",
    "mode": "mode",
    "gas_pedal": "driver_gas_pedal",
    "brake_pedal": "driver_brake_pedal",
    "set_speed_mps": "set_speed_mps",
    "set_speed_offset_mps": "set_speed_offset_mps",
    "eligible": "eligible",
    "following_limits": "following_limits",
}


def _drive(road: Path, columns: dict[str, list[float]]) -> DrivingFunction:
    made = DrivingFunction()
    made.texts.route_file = str(road)
    made.record.learn = 1
    made.initialize()
    for time_s, step_s, inputs in told_drive():
        for name, value in inputs.items():
            setattr(made.record, name, type(getattr(made.record, name))(value))
        for name, values in columns.items():
            values.append(
                time_s if name == "time_s" else float(getattr(made.record, _FIELDS[name]))
            )
        made.step(step_s)
    made.finish()
    return made
