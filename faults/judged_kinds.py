"""Roads, recordings and scripts: a sound one, the project's reader, and what it should say.

What each kind of file says is written down here once more, from its documentation.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isnan
from pathlib import Path
from typing import Any, Final

from pldf.recordings.recording import read_recording
from pldf.roads import read_route

from vehicle_models.driver_script import read_script

from .sheets import Sheet, Unclear

Values = dict[str, Any]  # lists of numbers (NaN: missing) and texts
MODES: Final = ("OFF", "STANDBY", "ACTIVE", "GAS_OVERRIDE", "FAULT")
CONTROLS: Final = ("gas", "brake", "resume", "cancel", "up", "down", "up_long", "down_long")


@dataclass(frozen=True)
class Answer:
    """What a reader says: values, and what it told about them."""

    values: Values
    told: str = ""


@dataclass(frozen=True)
class Kind:
    """One kind of table.

    Attributes:
        name: of its file.
        columns: known name -> what its cells are: number, text, place (a number of which any may
            be meant, -99 as well), or the words that it may hold.
        needed: names without which a file must be refused.
        sheet: returns a sound one.
        read: the project's reader.
        judge: columns as understood -> what the reader should say; Unclear if nobody knows.
        rows_min: a table with fewer rows says nothing.
    """

    name: str
    columns: Mapping[str, tuple[str, ...] | str]
    needed: tuple[str, ...]
    sheet: Callable[[random.Random], Sheet]
    read: Callable[[Path], Answer]
    judge: Callable[[Values], Values]
    rows_min: int = 1


def texts(*columns: Sequence[str | float]) -> list[list[str]]:
    """Return the rows of these columns."""
    rows = zip(*columns, strict=True)
    return [[c if isinstance(c, str) else f"{c:.10g}" for c in row] for row in rows]


def notes(of: Any) -> str:
    """Return what a reader told beside its values."""
    return " ".join(map(str, getattr(of, "notes", ())))


# Routes: six columns; grade, x_m and y_m are 0 where they are not there.

_ROUTE: Final = ("s_m", "curvature_per_m", "speed_limit_mps", "grade", "x_m", "y_m")


def _route_sheet(chance: random.Random) -> Sheet:
    # So far apart that no bend is a spike: what curves are repaired to is judged with the roads.
    inner = sorted(chance.sample(range(20, 3000, 20), 24))
    s_m = [0.0, *(round(s + chance.uniform(-4.0, 4.0), 2) for s in inner), 3000.5]
    bends = [round(chance.uniform(-0.01, 0.01), 6) for _ in s_m]
    limits = [chance.choice((13.89, 19.44, 27.78)) for _ in s_m]
    grades = [round(chance.uniform(-0.06, 0.06), 4) for _ in s_m]
    rows = texts(s_m, bends, limits, grades, s_m, [round(s * 0.01 - 7, 3) for s in s_m])
    return Sheet(list(_ROUTE), rows)


def _read_route(path: Path) -> Answer:
    route = read_route(path)
    return Answer({name: values.tolist() for name, values in route.knots.items()}, notes(route))


def _judge_route(columns: Values) -> Values:
    if ("x_m" in columns) != ("y_m" in columns):
        raise Unclear("half a line")
    zeros = [0.0] * len(columns["s_m"])
    return {name: columns.get(name, zeros) for name in _ROUTE}


# Recordings: as they stand; absent columns are derived later.

_RECORDING: Final = (
    "time_s", "s_m", "speed_mps", "acceleration_mps2", "mode", "gas_pedal", "brake_pedal",
    "set_speed_mps", "set_speed_offset_mps", "profile_mps", "base_mps", "limit_mps", "eligible",
)  # fmt: skip


def _recording_sheet(chance: random.Random) -> Sheet:
    time = [round(0.1 * n, 1) for n in range(40)]
    n, start = len(time), chance.randrange(2000)
    rows = texts(
        time, [round(start + 20.5 * t, 2) for t in time], [20.5] * n, [0.25] * n,
        [MODES[3] if 10 < at < 20 else MODES[2] for at in range(n)],
        [0.5 if 10 < at < 20 else 0.0 for at in range(n)], [0.0] * n, [27.78] * n,
        [0.0 if at < 25 else 2.5 for at in range(n)], [20.25] * n, [20.25] * n,
        [27.78] * n, [1] * n,
    )  # fmt: skip
    return Sheet(list(_RECORDING), rows)


def _read_recording(path: Path) -> Answer:
    recording = read_recording(path)
    return Answer({n: v.tolist() for n, v in recording.columns.items()}, notes(recording))


def _judge_recording(columns: Values) -> Values:
    time = columns["time_s"]
    if any(not b > a for a, b in pairwise(time)):
        raise Unclear("time does not run forwards")
    if any(value not in (0.0, 1.0) for value in columns.get("eligible", ()) if not isnan(value)):
        raise Unclear("eligible is no flag")
    return columns


# Driver scripts: events in the order of the file; a lever's value is 1.


def _script_sheet(chance: random.Random) -> Sheet:
    n = 12
    controls = [chance.choice(CONTROLS) for _ in range(n)]
    rows = texts(
        [round(chance.uniform(0, 4000), 1) for _ in range(n)],
        [chance.choice("sm") for _ in range(n)],
        controls,
        [f"{chance.uniform(0.1, 1.0):.2f}" if c in ("gas", "brake") else "" for c in controls],
        [round(chance.uniform(0.1, 9.0), 2) for _ in range(n)],
    )
    return Sheet(["at", "unit", "control", "value", "duration_s"], rows)


def _read_script(path: Path) -> Answer:
    events = read_script(path)
    names = ("at", "unit", "control", "value", "duration_s")
    values: Values = {name: [float(getattr(e, name)) for e in events] for name in names}
    codes = [code - 1.0 for code in values["control"]]
    return Answer(values | {"control": codes}, notes(events))


def _judge_script(columns: Values) -> Values:
    for control, value in zip(columns["control"], columns["value"], strict=True):
        pedal = control in (0.0, 1.0)
        if not (0.0 <= value <= 1.0 if pedal else isnan(value) or value == 1.0):
            raise Unclear("a value that the control cannot have")
    return columns | {"value": [1.0 if isnan(v) else v for v in columns["value"]]}


KINDS: Final = (
    Kind(
        "route.csv", dict.fromkeys(_ROUTE, "number") | {"x_m": "place", "y_m": "place"}, _ROUTE[:3],
        _route_sheet, _read_route, _judge_route,
    ),
    Kind(
        "recording.csv", dict.fromkeys(_RECORDING, "number") | {"mode": MODES},
        ("time_s", "s_m", "speed_mps", "mode"), _recording_sheet, _read_recording,
        _judge_recording,
    ),
    Kind(
        "script.csv",
        {"at": "number", "unit": ("s", "m"), "control": CONTROLS, "value": "number",
         "duration_s": "number"},
        ("at", "unit", "control", "value", "duration_s"), _script_sheet, _read_script,
        _judge_script,
    ),
)  # fmt: skip
