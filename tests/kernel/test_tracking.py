"""The acceleration request: bounds, continuity, tracking and comfortable recovery."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, PointMass, driving, function, road
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.kernel.interpolation import value_at
from pldf.kernel.substeps import substep_count
from pldf.kernel.tracking import target_speed
from pldf.roads import packed_route

# ISO 15622, as the specification states them.
REQUEST_MIN, REQUEST_MAX, REQUEST_JERK = -3.5, 2.0, 2.5
ROUNDING = 1e-9

LIMITS = ((0.0, 80.0 * KMH), (250.0, 50.0 * KMH), (400.0, 100.0 * KMH))
ROAD = road(800.0, LIMITS, [(120.0, 180.0, 0.012), (500.0, 560.0, 0.02)])

pedal = hs.sampled_from([0.0, 0.0, 0.1, 0.5, 1.0])
lever = hs.sampled_from(
    ["", "", "lever_resume", "lever_cancel", "lever_up_long", "lever_down_long", "main_switch"]
)
phases = hs.lists(hs.tuples(hs.floats(0.02, 3.0), pedal, pedal, lever), min_size=1, max_size=10)


class Watch:
    """Checks every request against the one before; knows nothing about how it came about."""

    def __init__(self, car: PointMass) -> None:
        self.car = car
        self.request = car.made.record.acceleration_request_mps2

    def step(self, step_s: float, **inputs: float) -> None:
        """One step of the car, checked."""
        self.car.step(step_s, **inputs)
        request = self.car.made.record.acceleration_request_mps2
        assert REQUEST_MIN - ROUNDING <= request <= REQUEST_MAX + ROUNDING
        assert abs(request - self.request) <= REQUEST_JERK * step_s + ROUNDING
        self.request = request


@settings(deadline=None, max_examples=25)
@given(phases, hs.floats(0.0, 40.0), hs.sampled_from([0.01, 0.02, 0.1]))
def test_request_keeps_its_bounds_and_has_no_steps_whatever_the_driver_does(
    sequence: list[tuple[float, float, float, str]], speed_mps: float, step_s: float
) -> None:
    watch = Watch(driving(ROAD, speed_mps))
    for seconds, gas, brake, contact in sequence:
        inputs = {"driver_gas_pedal": gas, "driver_brake_pedal": brake}
        if contact:
            inputs[contact] = 0 if contact == "main_switch" else 1
        for _ in range(max(round(seconds / step_s), 1)):
            watch.step(step_s, **inputs)
        if contact:
            watch.step(step_s, **{contact: 1 if contact == "main_switch" else 0})


@settings(deadline=None, max_examples=20)
@given(hs.data())
def test_request_keeps_its_bounds_with_arbitrary_inputs(data: hs.DataObject) -> None:
    made = function(ROAD)
    st = made.record
    for _ in range(30):
        st.vehicle_s_m = data.draw(hs.floats(-50.0, 900.0))
        st.vehicle_speed_mps = data.draw(hs.floats(-5.0, 60.0))
        st.vehicle_acceleration_mps2 = data.draw(hs.floats(-20.0, 20.0))
        st.driver_gas_pedal = data.draw(pedal)
        st.driver_brake_pedal = data.draw(pedal)
        st.lever_resume = 1 - st.lever_resume
        before = st.acceleration_request_mps2
        made.step(0.06)
        assert REQUEST_MIN <= st.acceleration_request_mps2 <= REQUEST_MAX
        assert abs(st.acceleration_request_mps2 - before) <= REQUEST_JERK * 0.06 + ROUNDING


def test_request_is_the_cars_own_acceleration_when_the_driver_hands_over() -> None:
    car = PointMass(function(road(2000.0)), 15.0)
    car.run(2.0, driver_gas_pedal=0.4)  # 1.2 m/s2 by pedal, function not active
    assert car.made.record.acceleration_request_mps2 == pytest.approx(1.2, abs=0.03)
    car.step(driver_gas_pedal=0.0, lever_resume=1)
    assert car.made.record.mode == ACTIVE
    assert car.made.record.acceleration_request_mps2 == pytest.approx(1.2, abs=0.06)


def test_request_glides_to_zero_during_an_override() -> None:
    car = driving(road(2000.0), 15.0)
    car.run(2.0, driver_gas_pedal=0.3)
    assert car.made.record.mode == GAS_OVERRIDE
    assert car.made.record.acceleration_request_mps2 == 0.0


@pytest.mark.parametrize(
    ("step_s", "lag_s", "tolerance_mps"),
    [(0.01, 0.0, 0.1), (0.01, 0.3, 0.1), (0.1, 0.3, 0.25), (0.01, 0.6, 0.4)],
)
def test_tracks_the_base_profile_of_the_study_road(
    step_s: float, lag_s: float, tolerance_mps: float
) -> None:
    # The look-ahead makes up for a lag of 0.3 s; with 0.6 s it is wrong by half.
    made = function(packed_route(0), control_preview_s=min(lag_s, 0.3))
    car = PointMass(made, made.profile.base_mps[0], lag_s)
    car.step(step_s, lever_resume=1)
    errors = []
    while car.s_m < len(made.profile.base_mps) - 20:
        car.step(step_s)
        errors.append(car.speed_mps - value_at(made.profile.base_mps, car.s_m))
    assert np.abs(errors).max() < tolerance_mps
    assert np.sqrt(np.mean(np.square(errors))) < 0.4 * tolerance_mps


def test_lower_limits_are_reached_at_their_sign() -> None:
    car = driving(road(900.0, ((0.0, 100.0 * KMH), (600.0, 50.0 * KMH))), 27.0)
    car.lag_s = 0.3
    while car.s_m < 600.0:
        car.step()
    assert car.speed_mps * 3.6 == pytest.approx(50.0, abs=0.4)


@pytest.mark.parametrize("excess_mps", [-8.0, 8.0])
def test_recovery_after_an_override_is_comfortable_and_complete(excess_mps: float) -> None:
    car = driving(road(3000.0), 27.0)
    car.run(3.0)
    if excess_mps > 0.0:
        while car.speed_mps < 100.0 * KMH + excess_mps:
            car.step(driver_gas_pedal=0.5)
        car.step(driver_gas_pedal=0.0)
    else:
        while car.speed_mps > 100.0 * KMH + excess_mps:
            car.step(driver_brake_pedal=0.4)
        car.step(driver_brake_pedal=0.0)
        car.run(1.0)
        car.tip("lever_resume")
    requests, errors = [], []
    for _ in range(3000):
        car.step()
        requests.append(car.made.record.acceleration_request_mps2)
        errors.append(car.speed_mps - 100.0 * KMH)
    st = car.made.record
    assert st.mode == ACTIVE
    low, high = st.control_recovery_accel_min_mps2, st.control_recovery_accel_max_mps2
    # The request starts where the driver left it; from then on it stays within the comfortable.
    settled = requests[200:]
    assert low - ROUNDING <= min(settled)
    assert max(settled) <= high + ROUNDING
    assert abs(errors[-1]) < 0.05
    # No overshoot to the other side.
    assert max(np.sign(-excess_mps) * np.array(errors)) < 0.2


def test_brake_never_leaves_the_function_pushing() -> None:
    car = driving(road(2000.0), 20.0)
    car.run(1.0)
    car.run(1.0, driver_brake_pedal=0.5)
    assert car.made.record.mode == STANDBY
    assert car.made.record.function_active == 0


def test_a_raised_set_speed_never_makes_the_car_slower_than_its_profile() -> None:
    made = function(road(2000.0, ((0.0, 100.0 / 3.6),)))
    np.asarray(made.profile.learned_mps)[:] = 115.0 / 3.6
    made.record.manual_set_mps = 105.0 / 3.6
    made.record.manual_end_m = 2000.0
    assert target_speed(made.record, made.route, made.profile, 500.0) == 115.0 / 3.6


@given(hs.floats(1e-9, 60.0))
def test_substeps_are_as_few_as_10_ms_allow(step_s: float) -> None:
    count = substep_count(step_s)
    assert step_s / count <= 0.01 * (1.0 + 1e-6)
    assert count == 1 or step_s / (count - 1) > 0.01


@pytest.mark.parametrize(("step_s", "count"), [(0.004, 1), (0.01, 1), (0.015, 2), (0.1, 10)])
def test_substeps_of_usual_steps(step_s: float, count: int) -> None:
    assert substep_count(step_s) == count
    assert substep_count(step_s * (1.0 + 1e-12)) == count  # steps are differences of times


def test_a_raised_set_speed_approaches_the_learned_speed_behind_the_sign() -> None:
    car = driving(road(2000.0, ((0.0, 30.0), (1000.0, 20.0))))
    np.asarray(car.made.profile.learned_mps)[1000:] = 25.0
    car.s_m, car.speed_mps = 900.0, 30.0
    car.made.record.vehicle_s_m = car.s_m
    car.tip("lever_up_long")
    car.run(1.0)
    assert car.made.record.manual_set_mps > 30.0
    speed = target_speed(car.made.record, car.made.route, car.made.profile, 990.0)
    assert speed == pytest.approx(sqrt(25.0**2 + 2.0 * 1.0 * 10.0))  # 1.0 m/s2 over 10 m


def test_a_car_that_stands_where_its_profile_falls_steeply_drives_on() -> None:
    made = function(road(300.0))
    falling = np.sqrt(np.maximum(25.0**2 - 6.0 * np.arange(301.0), 100.0))  # -3 m/s2 down to 10 m/s
    np.asarray(made.profile.learned_mps)[:] = falling
    car = PointMass(made, 0.0, 0.2)
    car.s_m = 20.0
    car.step(lever_resume=1)
    car.run(10.0)
    assert car.speed_mps > 5.0


def test_a_raised_set_speed_holds_up_to_the_end_of_the_route() -> None:
    """There is no sign at its end: the last limit and the set speed go on."""
    car = driving(road(2000.0), 27.0)
    for _ in range(2):
        car.tip("lever_up_long")
    while car.s_m < 1000.0:
        car.step()
    while car.s_m < 1998.0:
        assert car.speed_mps == pytest.approx(110.0 * KMH, abs=0.01)
        car.step()
