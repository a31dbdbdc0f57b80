"""Parameters: their whole range can be driven; what is outside is refused by name."""

from __future__ import annotations

from dataclasses import asdict
from math import inf, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import PointMass, assert_sound, function, road
from pldf.errors import ModelError
from pldf.function import DrivingFunction
from pldf.kernel.signals import signals_of
from pldf.kernel.state import PldfState

SIGNALS = signals_of(PldfState())
PARAMETERS = [s for s in SIGNALS if s.causality == "parameter" and s.kind != "String"]
ROAD = road(500.0, ((0.0, 25.0),), [(200.0, 260.0, 0.01)])


def planner_is_stronger_than_bounds(chosen: dict[str, Any]) -> bool:
    """Tell whether a base profile could break the bounds that learned profiles keep."""
    whole = asdict(PldfState()) | chosen
    pairs = [
        (abs(whole[f"planner_{bound}"]), abs(whole[f"learning_{bound}"]))
        for bound in ("lateral_accel_max_mps2", "accel_max_mps2", "accel_min_mps2")
    ]
    jerks = [whole[f"{group}_jerk_max_mps3"] or inf for group in ("planner", "learning")]
    return any(used > allowed for used, allowed in (*pairs, jerks))


@settings(deadline=None, max_examples=25)
@given(hs.data())
def test_the_whole_range_of_every_parameter_can_be_driven_and_learned(data: hs.DataObject) -> None:
    chosen: dict[str, Any] = {}
    for signal in data.draw(hs.lists(hs.sampled_from(PARAMETERS), max_size=6)):
        low, high = 0, 1
        if signal.kind == "Enumeration" and signal.enumeration is not None:
            high = len(signal.enumeration.items) - 1
        elif signal.low is not None and signal.high is not None:
            low, high = signal.low, signal.high
        numbers = hs.integers if signal.kind != "Real" else hs.floats
        chosen[signal.field] = data.draw(numbers(low, high))  # type: ignore[arg-type]
    if planner_is_stronger_than_bounds(chosen):
        with pytest.raises(ModelError, match="bounds every profile"):
            function(ROAD, **chosen)
        return
    car = PointMass(function(ROAD, **chosen), 20.0)
    car.tip("lever_resume")
    car.tip("lever_down_long")
    car.run(2.0, 0.05, driver_gas_pedal=0.6)
    car.run(5.0, 0.05, driver_gas_pedal=0.0)
    car.run(1.0, 0.05, driver_brake_pedal=0.3)
    assert_sound(car.made)
    learned = car.made.learn()
    assert np.all(np.isfinite(learned.learned_mps))
    assert learned.learned_mps.min() > 0.0


@pytest.mark.parametrize("signal", PARAMETERS, ids=lambda s: s.name)
def test_a_parameter_out_of_range_is_refused_by_name(signal: Any) -> None:
    if signal.kind == "Boolean":
        bad = [2, -1]
    elif signal.kind == "Enumeration":
        bad = [len(signal.enumeration.items), -1]
    else:
        bad = [signal.low - 1, signal.high + 1]
    if signal.kind == "Real":
        bad += [nan, inf, -inf]
    for value in bad:
        made = DrivingFunction()
        setattr(made.record, signal.field, value)
        with pytest.raises(ModelError, match=f"parameter {signal.name}"):
            made.prepare(ROAD)


@pytest.mark.parametrize("number", [-1, 1, 4711])
def test_an_unknown_route_is_refused(number: int) -> None:
    made = DrivingFunction()
    made.record.route_id = number
    with pytest.raises(ModelError, match="route"):
        made.initialize()


def test_coordinates_need_a_line() -> None:
    made = DrivingFunction()
    made.texts.route_file = "no such file.csv"
    with pytest.raises(ModelError, match="no such file"):
        made.initialize()
