"""A driver with constant inputs, and what hands and feet do meanwhile."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from pldf.kernel.codes import ACTIVE, STANDBY

from vehicle_models.driver import ScriptedDriver

STEP_S = 0.01
KMH = 1.0 / 3.6
LEVER = (
    "lever_resume",
    "lever_cancel",
    "lever_up",
    "lever_down",
    "lever_up_long",
    "lever_down_long",
)
BUTTONS = ("teach_pause", "teach_forget_here", "teach_undo")
PEDALS = ("driver_gas_pedal", "driver_brake_pedal")


def straight(folder: Path, *limits_kmh: float) -> str:
    """A straight road with a new limit each 1000 m; returns its file name."""
    path = folder / "straight.csv"
    lines = ["s_m,curvature_per_m,speed_limit_mps"]
    lines += [f"{1000 * i},0,{limit / 3.6!r}" for i, limit in enumerate(limits_kmh)]
    lines.append(f"{1000 * len(limits_kmh)},0,{limits_kmh[-1] / 3.6!r}")
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def driver(route_file: str = "", script_file: str = "", **values: float) -> ScriptedDriver:
    """An initialized driver."""
    someone = ScriptedDriver()
    someone.texts.route_file = route_file
    someone.texts.script_file = script_file
    for name, value in values.items():
        assert hasattr(someone.record, name)
        setattr(someone.record, name, value)
    someone.initialize()
    return someone


def watch(someone: ScriptedDriver, seconds: float, **inputs: float) -> list[dict[str, float]]:
    """Hold the inputs and return all outputs after each step."""
    for name, value in inputs.items():
        assert hasattr(someone.record, name)
        setattr(someone.record, name, value)
    seen = []
    for _ in range(round(seconds / STEP_S)):
        someone.step(STEP_S)
        seen.append({name: getattr(someone.record, name) for name in (*PEDALS, *LEVER, *BUTTONS)})
    return seen


def first(seen: list[dict[str, float]], name: str) -> float:
    """Time of the first step in which an output is not 0."""
    return next(STEP_S * (k + 1) for k, row in enumerate(seen) if row[name] != 0)


def presses(seen: list[dict[str, float]], name: str) -> int:
    values = [0.0, *(row[name] for row in seen)]
    return sum(a == 0 and b != 0 for a, b in pairwise(values))


def cruising(route_file: str, speed_kmh: float, **values: float) -> ScriptedDriver:
    """A driver who watches an active function that keeps a speed."""
    someone = driver(route_file, driver_spread=0.0, driver_uses_lever=0, **values)
    keep = {"vehicle_speed_mps": speed_kmh * KMH, "target_speed_mps": speed_kmh * KMH}
    watch(someone, 1.1, mode=STANDBY, vehicle_s_m=200.0, **keep)
    watch(someone, 0.3, mode=ACTIVE)
    return someone
