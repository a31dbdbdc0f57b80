"""Bad inputs while driving: a defined answer, never a NaN."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import assert_sound, driving, function, road
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, FAULT, GAS_OVERRIDE, REASON_FAULT, STANDBY, XY
from pldf.kernel.signals import signals_of
from pldf.kernel.state import PldfState

SIGNALS = signals_of(PldfState())
REAL_INPUTS = [
    "vehicle_s_m",
    "vehicle_speed_mps",
    "vehicle_acceleration_mps2",
    "driver_gas_pedal",
    "driver_brake_pedal",
]
ROAD = road(500.0, ((0.0, 25.0),), [(200.0, 260.0, 0.01)])


def test_the_inputs_listed_here_are_all_there_are() -> None:
    real = {s.field for s in SIGNALS if s.causality == "input" and s.kind == "Real"}
    of_traffic = {"lead_gap_m", "lead_speed_mps", "limit_override_mps"}
    assert real == {*REAL_INPUTS, "vehicle_x_m", "vehicle_y_m", *of_traffic}


@pytest.mark.parametrize("name", REAL_INPUTS)
@pytest.mark.parametrize("value", [nan, inf, -inf, 1e300, -1e300])
def test_an_impossible_number_is_a_fault_with_a_gliding_request(name: str, value: float) -> None:
    car = driving(ROAD, 20.0)
    car.run(1.0)
    before = car.made.record.acceleration_request_mps2
    st = car.made.record
    inputs = {field: getattr(st, field) for field in REAL_INPUTS}
    setattr(st, name, value)
    for _ in range(100):
        car.made.step(0.01)
        assert st.mode == FAULT
        assert st.function_active == 0
        assert abs(st.acceleration_request_mps2) <= max(abs(before), 1e-12)
        assert_sound(car.made) if st.time_ns % 100_000_000 == 0 else None
    assert st.acceleration_request_mps2 == 0.0
    assert st.hmi_reason == REASON_FAULT
    assert [m.level for m in car.made.messages if "plausible" in m.text] == ["warning"]
    for field, good in inputs.items():
        setattr(st, field, good)
    assert_sound(car.made)


def test_a_fault_ends_in_standby_after_the_hold_time() -> None:
    car = driving(ROAD, 10.0)
    car.step(driver_brake_pedal=nan)
    assert car.made.record.mode == FAULT
    car.step(driver_brake_pedal=0.0, lever_resume=1)
    assert car.made.record.mode == FAULT
    car.run(0.97, lever_resume=0)
    assert car.made.record.mode == FAULT
    car.run(0.03)
    assert car.made.record.mode == STANDBY
    car.step(lever_resume=1)
    assert car.made.record.mode == ACTIVE


def test_the_hold_time_starts_anew_with_every_bad_input() -> None:
    car = driving(ROAD, 5.0)
    for _ in range(5):
        car.step(driver_gas_pedal=nan)
        car.run(0.9, driver_gas_pedal=0.0)
        assert car.made.record.mode == FAULT
    car.run(0.2)
    assert car.made.record.mode == STANDBY


def test_what_is_recorded_around_a_fault_is_still_learned_from() -> None:
    car = driving(ROAD, 20.0)
    car.run(3.0)
    car.step(driver_gas_pedal=nan)
    car.run(3.0, driver_gas_pedal=0.0)
    assert_sound(car.made)
    assert car.made.record.nodes > 100
    learned = car.made.learn()
    np.testing.assert_array_equal(learned.learned_mps, car.made.profile.base_mps)


@pytest.mark.parametrize("s_m", [-30.0, -1e6, 500.5, 501.0, 1e7])
def test_off_the_route_the_function_is_inactive(s_m: float) -> None:
    car = driving(ROAD, 20.0)
    car.s_m = s_m
    car.step()
    assert car.made.record.mode == STANDBY
    assert any("off the route" in m.text for m in car.made.messages)
    car.run(0.5, lever_resume=1)
    assert car.made.record.mode == STANDBY
    assert_sound(car.made)


def test_reaching_the_end_of_the_route_is_no_fault() -> None:
    car = driving(ROAD, 20.0)
    while car.s_m < 520.0:
        car.step()
        assert_sound(car.made)
    assert car.made.record.mode == STANDBY
    assert car.made.record.nodes >= 500


@pytest.mark.parametrize("jump_m", [-100.0, -25.0, 25.0, 200.0])
@pytest.mark.parametrize("asked", [False, True])
def test_a_jump_of_the_position_deactivates(jump_m: float, asked: bool) -> None:
    car = driving(ROAD, 20.0)
    car.run(6.0)
    car.s_m += jump_m
    if asked:  # the simulator reads outputs between setting inputs and the step
        car.made.record.vehicle_s_m = car.s_m
        car.made.refresh()
    car.step()
    assert car.made.record.mode == STANDBY
    assert any("jumped" in m.text for m in car.made.messages)
    car.tip("lever_resume")
    assert car.made.record.mode == ACTIVE
    assert_sound(car.made)


def test_small_corrections_of_the_position_are_no_jump() -> None:
    car = driving(ROAD, 20.0)
    for k in range(300):
        car.s_m += 3.0 * (-1) ** k
        car.step()
        assert car.made.record.mode == ACTIVE


@pytest.mark.parametrize("glitch_m", [1e6, 700.0, -1e6])
def test_a_glitch_of_the_position_does_not_spoil_the_recording(glitch_m: float) -> None:
    car = driving(ROAD, 20.0)
    car.run(4.0, driver_gas_pedal=0.1)
    here = car.s_m
    for _ in range(20):
        car.s_m = glitch_m
        car.step()
    car.s_m = here
    car.step(driver_gas_pedal=0.0)
    car.tip("lever_resume")
    while car.s_m < 300.0:
        car.step()
    trace = car.made.trace
    assert trace.eligible[250] == 1.0
    assert trace.gap[250] == 0.0
    assert trace.time_s[250] > trace.time_s[150] > trace.time_s[50]
    assert car.made.record.drive_interventions == 1
    assert trace.end_m[0] == pytest.approx(here, abs=1.0)


@pytest.mark.parametrize(
    ("gas", "brake", "mode"),
    [(1.7, 0.0, GAS_OVERRIDE), (-0.5, 0.0, ACTIVE), (0.0, 5.0, STANDBY), (0.0, -5.0, ACTIVE),
     (1.0, 1.0, STANDBY), (7.0, 7.0, STANDBY)],
)  # fmt: skip
def test_pedals_outside_their_range_count_as_pressed_or_released(
    gas: float, brake: float, mode: int
) -> None:
    car = driving(ROAD, 20.0)
    car.step(driver_gas_pedal=gas, driver_brake_pedal=brake)
    assert car.made.record.mode == mode
    assert_sound(car.made)


def test_driving_backwards_is_survived() -> None:
    car = driving(ROAD, 10.0)
    car.run(5.0)
    st = car.made.record
    for k in range(300):
        st.vehicle_speed_mps = -3.0
        st.vehicle_s_m = car.s_m - 0.03 * k
        car.made.step(0.01)
        assert st.acceleration_request_mps2 >= -3.5
    assert_sound(car.made)
    car.made.learn()


any_number = hs.one_of(
    hs.floats(-100.0, 600.0), hs.floats(), hs.sampled_from([nan, inf, -inf, 0.0, -0.0, 5e-324])
)


@settings(deadline=None, max_examples=25)
@given(hs.data())
def test_any_sequence_of_any_numbers_is_survived(data: hs.DataObject) -> None:
    made = function(ROAD, localization=data.draw(hs.sampled_from([0, XY])))
    st = made.record
    flags = [s.field for s in SIGNALS if s.causality == "input" and s.kind == "Boolean"]
    for _ in range(data.draw(hs.integers(1, 25))):
        for name in (*REAL_INPUTS, "vehicle_x_m", "vehicle_y_m"):
            if data.draw(hs.booleans()):
                setattr(st, name, data.draw(any_number))
        for name in flags:
            setattr(st, name, data.draw(hs.integers(0, 1)))
        if data.draw(hs.booleans()):
            made.refresh()
        before = st.acceleration_request_mps2
        step_s = data.draw(hs.sampled_from([1e-4, 0.01, 0.1, 1.0, 60.0]))
        made.step(step_s)
        assert abs(st.acceleration_request_mps2 - before) <= 2.5 * step_s + 1e-9
        assert_sound(made)
    learned = made.learn()
    for array in (learned.learned_mps, learned.offset_mps, learned.drive, learned.intervention):
        assert np.all(np.isfinite(array))
    assert learned.learned_mps.min() > 0.0


def test_outputs_are_sound_when_the_first_inputs_are_bad() -> None:
    made = DrivingFunction()
    made.record.vehicle_speed_mps = nan
    made.prepare(ROAD)
    made.refresh()
    assert_sound(made)
