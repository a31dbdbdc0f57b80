"""Drives in a row that only learn what is consistent, in which everything becomes of evidence."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pldf.function import DrivingFunction

STEP_S = 0.1
GAS, BRAKE, LEVER_UP, LEVER_DOWN = "gas", "brake", "up", "down"

ROAD = """s_m,curvature_per_m,speed_limit_mps
0,0,27.7777777777777786
5000,0,27.7777777777777786
"""

# Per drive: what is done at which metre. Pedals are held for 200 m.
DRIVES: Final = (
    ((400.0, GAS), (2000.0, BRAKE), (3000.0, LEVER_UP)),
    ((400.0, GAS), (3000.0, LEVER_UP)),  # both are accepted; what was braked for loses
    ((400.0, BRAKE), (3500.0, LEVER_DOWN)),  # what was braked for first is dropped
    ((400.0, BRAKE), (3500.0, LEVER_DOWN)),  # what the gas taught goes back
    ((1500.0, GAS), (2500.0, BRAKE)),
)

Inputs = dict[str, float | bool]


def write_straight_road(folder: Path) -> Path:
    """Write the road: straight, 100 km/h."""
    path = folder / "straight.csv"
    path.write_text(ROAD)
    return path


def inputs_of(done: tuple[tuple[float, str], ...]) -> Iterator[tuple[float, float, Inputs]]:
    """Yield time and step in s, and the inputs by field, of a drive."""
    s_m = time_s = 0.0
    while s_m < 4900.0:
        pressed = {what for at, what in done if at <= s_m < at + 200.0}
        tipped = {what for at, what in done if at <= s_m < at + 5.0}
        speed = 27.7 + 3.0 * (GAS in pressed) - 7.0 * (BRAKE in pressed)
        released = any(what == BRAKE and at + 200.0 <= s_m < at + 215.0 for at, what in done)
        yield (
            time_s,
            STEP_S,
            {
                "vehicle_s_m": s_m,
                "vehicle_speed_mps": speed,
                "driver_gas_pedal": 0.3 * (GAS in pressed),
                "driver_brake_pedal": 0.3 * (BRAKE in pressed),
                "lever_resume": 0.3 < time_s < 0.5 or released,
                "lever_up_long": LEVER_UP in tipped,
                "lever_down_long": LEVER_DOWN in tipped,
            },
        )
        s_m += speed * STEP_S
        time_s += STEP_S


def told_in_python(road: Path, store: Path, set_speed_gain: float = 1.0) -> list[list[str]]:
    """Return what the function says at the end of each drive; profiles go into ``store``."""
    told = []
    for done in DRIVES:
        made = DrivingFunction()
        made.texts.route_file = str(road)
        made.texts.profile_store = str(store)
        made.record.learn_consistent = 1
        made.record.learning_set_speed_gain = set_speed_gain
        made.initialize()
        for _, step_s, inputs in inputs_of(done):
            for name, value in inputs.items():
                setattr(made.record, name, type(getattr(made.record, name))(value))
            made.step(step_s)
        made.finish()
        told.append([message.text for message in made.messages if message.level == "info"])
    return told
