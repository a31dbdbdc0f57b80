"""The longitudinal vehicle against physics with known answers."""

from __future__ import annotations

from math import atan, exp, inf, nan, sqrt, tan

import numpy as np
import pytest
from car import STEP_S, car, inertia_kg, run
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_models.vehicle import LongitudinalVehicle
from vehicle_models.vehicle_kernel import GRAVITY_MPS2, drag_n_per_v2


def test_starts_in_steady_motion() -> None:
    record = car().record
    assert record.speed_mps == 80.0 / 3.6
    assert record.s_m == 0.0
    assert record.acceleration_mps2 == pytest.approx(0.0, abs=1e-12)


def test_coast_down_follows_the_analytic_solution() -> None:
    vehicle = car(start_speed_mps=40.0, body_drive_lag_s=0.01)
    run(vehicle, 1.0)  # the drive force of the steady start has died away
    start, s_start = vehicle.record.speed_mps, vehicle.record.s_m
    run(vehicle, 60.0)
    # dv/dt = -(c + d v^2): v(t) = sqrt(c/d) tan(phi - sqrt(c d) t)
    c = vehicle.record.body_rolling_coefficient * GRAVITY_MPS2 / 1.04
    d = drag_n_per_v2(vehicle.record) / inertia_kg(vehicle)
    end = sqrt(c / d) * tan(atan(start * sqrt(d / c)) - sqrt(c * d) * 60.0)
    way = np.log((c + d * start * start) / (c + d * end * end)) / (2.0 * d)
    assert vehicle.record.speed_mps == pytest.approx(end, abs=1e-6)
    assert vehicle.record.s_m - s_start == pytest.approx(way, abs=1e-3)


def test_top_speed_is_where_power_meets_road_load() -> None:
    vehicle = car(body_speed_max_mps=100.0, start_speed_mps=50.0, driver_gas_pedal=1.0)
    run(vehicle, 200.0, 0.1)
    record = vehicle.record
    roll = record.body_rolling_coefficient * record.body_mass_kg * GRAVITY_MPS2
    cubic = np.roots([drag_n_per_v2(record), 0.0, roll, -record.body_power_max_w])
    assert record.speed_mps == pytest.approx(cubic[abs(cubic.imag) < 1e-9].real[0], abs=0.01)


def test_published_acceleration_and_top_speed() -> None:
    vehicle = car(start_speed_mps=0.0, driver_gas_pedal=1.0)
    time_s = 0.0
    while vehicle.record.speed_mps < 100.0 / 3.6:
        vehicle.step(STEP_S)
        time_s += STEP_S
    assert time_s == pytest.approx(7.3, abs=0.5)  # manufacturer's 0-100 km/h
    run(vehicle, 60.0, 0.1)
    assert vehicle.record.speed_mps == pytest.approx(160.0 / 3.6, abs=0.2)


def test_braking_distance() -> None:
    vehicle = car(
        start_speed_mps=100.0 / 3.6,
        driver_brake_pedal=1.0,
        body_drag_coefficient=0.0,
        body_rolling_coefficient=0.0,
    )
    run(vehicle, 6.0)
    # The deceleration rises as a first-order lag: the way grows by v * lag - b * lag^2 / 2.
    v, b, lag = 100.0 / 3.6, 9.81, 0.2
    assert vehicle.record.speed_mps == 0.0
    assert vehicle.record.s_m == pytest.approx(
        v * v / (2 * b) + v * lag - b * lag * lag / 2, abs=0.01
    )


@pytest.mark.parametrize("grade", [-0.08, 0.0, 0.08])
def test_request_zero_holds_the_speed_on_any_grade(grade: float) -> None:
    vehicle = car(grade_constant=grade, function_active=1)
    run(vehicle, 30.0)
    assert vehicle.record.speed_mps == pytest.approx(80.0 / 3.6, abs=0.01)


def test_request_is_followed_through_a_first_order_lag() -> None:
    vehicle = car(function_active=1, acceleration_request_mps2=1.0)
    for k in range(1, 101):
        vehicle.step(STEP_S)
        # The compensation of the growing drag runs through the same lag: a few mm/s2 behind.
        assert vehicle.record.acceleration_mps2 == pytest.approx(
            1 - exp(-k * 0.01 / 0.15), abs=0.004
        )


def test_energy_balance() -> None:
    vehicle = car(driver_gas_pedal=0.4, start_speed_mps=10.0)
    record, work, energy_start = vehicle.record, 0.0, 0.5 * inertia_kg(vehicle) * 100.0
    for _ in range(20_000):
        drive, s_before, speed = record.drive_force_n, record.s_m, record.speed_mps
        vehicle.step(0.001)
        load = drag_n_per_v2(record) * (0.5 * (speed + record.speed_mps)) ** 2
        load += record.body_rolling_coefficient * record.body_mass_kg * GRAVITY_MPS2
        work += (0.5 * (drive + record.drive_force_n) - load) * (record.s_m - s_before)
    energy = 0.5 * inertia_kg(vehicle) * record.speed_mps**2
    assert energy - energy_start == pytest.approx(work, rel=1e-5)


def test_gas_adds_to_the_request() -> None:
    alone = car(driver_gas_pedal=0.2)
    added = car(driver_gas_pedal=0.2, function_active=1, acceleration_request_mps2=0.0)
    for vehicle in (alone, added):
        run(vehicle, 1.5)
    assert added.record.acceleration_mps2 > alone.record.acceleration_mps2 + 0.1


def test_brake_wins_over_gas_and_request() -> None:
    both = car(function_active=1, acceleration_request_mps2=2.0, driver_gas_pedal=1.0)
    only = car()
    for vehicle in (both, only):
        vehicle.record.driver_brake_pedal = 0.3
        run(vehicle, 2.0)
    assert both.record.speed_mps == only.record.speed_mps
    assert only.record.acceleration_mps2 == pytest.approx(-0.3 * 9.81, abs=0.4)


def test_coasting_slows_down_and_recuperation_more() -> None:
    sailing, recuperating = car(), car(body_coast_decel_mps2=1.3)
    for vehicle in (sailing, recuperating):
        run(vehicle, 3.0)
    assert -0.3 < sailing.record.acceleration_mps2 < -0.1
    assert recuperating.record.acceleration_mps2 == pytest.approx(
        sailing.record.acceleration_mps2 - 1.3, abs=0.05
    )


@pytest.mark.parametrize("grade", [-0.2, 0.0, 0.2])
def test_stands_still_until_somebody_wants_to_move(grade: float) -> None:
    vehicle = car(grade_constant=grade, start_speed_mps=5.0, driver_brake_pedal=0.5)
    run(vehicle, 10.0)
    vehicle.record.driver_brake_pedal = 0.0
    stood = vehicle.record.s_m
    run(vehicle, 10.0)
    record = vehicle.record
    assert (record.s_m, record.speed_mps, record.acceleration_mps2) == (stood, 0.0, 0.0)
    assert record.jerk_mps3 == 0.0
    record.driver_gas_pedal = 0.5
    run(vehicle, 3.0)
    assert record.speed_mps > 1.0


def test_jerk_is_the_slope_of_the_acceleration() -> None:
    vehicle = car(function_active=1, acceleration_request_mps2=1.5)
    for _ in range(50):
        before = vehicle.record.acceleration_mps2
        jerk_before = vehicle.record.jerk_mps3
        vehicle.step(0.001)
        middle = 0.5 * (jerk_before + vehicle.record.jerk_mps3)
        slope = (vehicle.record.acceleration_mps2 - before) / 0.001
        assert slope == pytest.approx(middle, abs=0.01)


def drive_pattern(step_s: float) -> LongitudinalVehicle:
    """A minute of everything; inputs change at multiples of 0.1 s."""
    vehicle = car(grade_constant=0.03)
    for k in range(round(60.0 / step_s)):
        tenth = int(k * step_s * 10.0 + 1e-6)
        record = vehicle.record
        record.function_active = int(tenth < 400)
        record.acceleration_request_mps2 = 1.5 - 0.02 * (tenth % 200)
        record.driver_gas_pedal = 0.3 if 150 <= tenth < 190 else 0.0
        record.driver_brake_pedal = 0.2 if 250 <= tenth < 280 or tenth >= 500 else 0.0
        vehicle.step(step_s)
    return vehicle


def test_the_step_hardly_matters() -> None:
    exact = drive_pattern(0.001).record
    for step_s in (0.01, 0.02, 0.1):
        record = drive_pattern(step_s).record
        assert record.s_m == pytest.approx(exact.s_m, abs=0.05)
        assert record.speed_mps == pytest.approx(exact.speed_mps, abs=0.005)
        assert record.acceleration_mps2 == pytest.approx(exact.acceleration_mps2, abs=0.005)


def test_a_vanishing_step_changes_nothing() -> None:
    vehicle = car(function_active=1, acceleration_request_mps2=1.0)
    run(vehicle, 1.0)
    before = vehicle.record.speed_mps
    vehicle.step(1.7e-13)
    assert vehicle.record.speed_mps == pytest.approx(before, abs=1e-9)


@pytest.mark.parametrize("bad", [nan, inf, -inf])
@pytest.mark.parametrize(
    "name", ["acceleration_request_mps2", "driver_gas_pedal", "driver_brake_pedal"]
)
def test_unusable_inputs_count_as_nothing_asked_for(name: str, bad: float) -> None:
    faulty, plain = car(function_active=1), car(function_active=1)
    setattr(faulty.record, name, bad)
    for vehicle in (faulty, plain):
        run(vehicle, 1.0)
    assert faulty.record.speed_mps == plain.record.speed_mps
    assert [m.level for m in faulty.messages] == ["warning"]
    assert plain.messages == []


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(width=32), st.floats(width=32), st.floats(width=32), st.booleans(),
            st.sampled_from([0.0001, 0.01, 0.05, 0.1]),
        ),
        max_size=60,
    ),
    st.floats(-0.3, 0.3),
    st.floats(0.0, 40.0),
)  # fmt: skip
def test_never_backwards_never_nan(
    inputs: list[tuple[float, float, float, bool, float]], grade: float, speed: float
) -> None:
    vehicle = car(grade_constant=grade, start_speed_mps=speed)
    record = vehicle.record
    for request, gas, brake, active, step_s in inputs:
        record.acceleration_request_mps2, record.driver_gas_pedal = request, gas
        record.driver_brake_pedal, record.function_active = brake, int(active)
        before = record.s_m
        vehicle.step(step_s)
        assert record.speed_mps >= 0.0
        assert record.s_m >= before
        assert abs(record.acceleration_mps2) < 50.0
        assert abs(record.jerk_mps3) < 1e6
