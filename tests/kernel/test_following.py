"""A car ahead: approach, cut-in, braking, stop and go, strings of cars (ISO 15622, section 8)."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest
from laboratory import KMH, PointMass, function, road
from lead_cars import LONG_ROAD, Lead, Motion, desired_gap_m, follow, follower, platoon
from pldf.kernel.codes import ACTIVE, EVENT_TAKE_OVER, FAULT, GAS_OVERRIDE, STANDBY

ROUNDING = 1e-9
JERK = 2.5  # m/s3, of the request


def assert_continuous(motion: Motion, step_s: float = 0.02) -> None:
    """No step in the request, whatever happened."""
    assert np.max(np.abs(np.diff(motion.request_mps2))) <= JERK * step_s + ROUNDING
    assert np.min(motion.request_mps2) >= -3.5 - ROUNDING
    assert np.max(motion.request_mps2) <= 2.0 + ROUNDING


def behind(car: PointMass, gap_m: float, speed_mps: float) -> Lead:
    """A lead ``gap_m`` ahead of ``car``."""
    return Lead(car.s_m + gap_m, speed_mps)


@pytest.mark.parametrize("time_gap_s", [0.8, 1.8, 3.0])
def test_a_slower_lead_is_approached_comfortably_and_followed_at_the_desired_gap(
    time_gap_s: float,
) -> None:
    car = follower(30.0, following_desired_time_gap_s=time_gap_s)
    motion = follow(car, behind(car, 350.0, 20.0), 90.0)
    assert np.min(motion.request_mps2) > -1.3
    # At 0.8 s the promise takes more room than the desired gap has.
    more_m = 1.0 if time_gap_s < 1.0 else 0.0
    assert motion.gap_m[-1] == pytest.approx(3.0 + time_gap_s * 20.0 + more_m, abs=0.5)
    assert np.min(motion.gap_m) > 3.0 + time_gap_s * 20.0 - 0.5  # never nearer on the way
    assert motion.speed_mps[-1] == pytest.approx(20.0, abs=0.1)
    assert not np.any(motion.take_over)
    assert_continuous(motion)


def test_who_drives_faster_than_the_profile_is_not_followed() -> None:
    car = follower(20.0)
    motion = follow(car, behind(car, 45.0, 40.0), 30.0)
    assert motion.speed_mps[-1] > 33.0
    assert not np.any(motion.limits)


@pytest.mark.parametrize(("distance_m", "strongest"), [(150.0, 3.5), (250.0, 2.3), (600.0, 1.1)])
def test_a_standing_lead_is_approached_with_what_its_distance_needs(
    distance_m: float, strongest: float
) -> None:
    car = follower(100.0 * KMH, route=road(5000.0))
    motion = follow(car, behind(car, distance_m, 0.0), 60.0)
    assert motion.speed_mps[-1] == 0.0
    assert 3.0 <= motion.gap_m[-1] < 4.5
    assert -np.min(motion.request_mps2) < strongest + ROUNDING
    assert not np.any(motion.take_over)
    assert_continuous(motion)


@pytest.mark.parametrize("decel_mps2", [2.0, 3.5, 6.0])
@pytest.mark.parametrize("speed_mps", [10.0, 20.0, 30.0])
def test_a_lead_that_brakes_to_a_stop(decel_mps2: float, speed_mps: float) -> None:
    """No contact up to 3.5 m/s2; behind a harder braking the driver is called before contact."""
    car = follower(speed_mps)
    lead = behind(car, desired_gap_m(speed_mps), speed_mps)
    motion = follow(car, lead, 40.0, lambda t: -decel_mps2 if t >= 2.0 else 0.0)
    assert_continuous(motion)
    touched = np.flatnonzero(motion.gap_m < 0.0)
    if decel_mps2 <= 3.5:
        assert touched.size == 0
        assert not np.any(motion.take_over)
        assert 2.5 < motion.gap_m[-1] < 5.0
    elif touched.size:
        called = np.flatnonzero(motion.take_over)
        assert motion.time_s[touched[0]] - motion.time_s[called[0]] > 1.0


def test_the_hardest_braking_that_is_promised_is_survived_from_the_edge_of_the_promise() -> None:
    """As near as take-over allows, behind a lead that brakes from the first sample on."""
    for speed_mps, lead_mps in ((30.0, 20.0), (20.0, 20.0), (30.0, 5.0), (10.0, 12.0)):
        nearest = inf
        for gap_m in np.arange(0.5, 200.0, 0.5):
            car = follower(speed_mps)
            follow(car, behind(car, gap_m, lead_mps), 0.02)
            if not car.made.record.hmi_take_over:
                nearest = gap_m
                break
        car = follower(speed_mps)
        motion = follow(car, behind(car, nearest, lead_mps), 15.0, lambda _: -3.5)
        assert 0.0 < np.min(motion.gap_m) < 1.5  # held, and not by far
        assert np.min(motion.request_mps2) < -3.4


def test_take_over_is_told_where_a_simulated_full_braking_touches() -> None:
    """Judged by integrating both cars in steps of a millisecond."""
    rng = np.random.default_rng(8)
    told = 0
    for _ in range(150):
        speed, lead = rng.uniform(2.0, 36.0, 2)
        request, acceleration = rng.uniform(-3.0, 1.5, 2)
        room = simulated_room(speed, lead, request, acceleration)
        for margin_m, needed in ((-0.3, 1), (0.4, 0)):
            gap_m = margin_m - room
            if gap_m <= 0.3:
                continue
            car = follower(speed)
            car.acceleration_mps2 = acceleration
            car.made.record.acceleration_request_mps2 = request
            follow(car, behind(car, gap_m, lead), 0.01, step_s=0.01)
            assert car.made.record.hmi_take_over == needed
            told += needed
    assert told > 50


def simulated_room(
    speed: float, lead: float, request: float, acceleration: float, step_s: float = 0.01
) -> float:
    """Smallest gap of full braking behind one with 3.5 m/s2, of a gap of 0 m at the start."""
    h, time_s, gap, least = 0.001, 0.0, 0.0, 0.0
    while speed > 0.0:
        if time_s >= step_s:
            request = max(request - JERK * h, -3.5)
        acceleration += h / 0.2 * (request - acceleration)
        after, lead_after = max(speed + h * acceleration, 0.0), max(lead - 3.5 * h, 0.0)
        gap += 0.5 * h * (lead + lead_after - speed - after)
        speed, lead = after, lead_after
        least = min(least, gap)
        time_s += h
    return least


@pytest.mark.parametrize("share", [0.6, 0.8, 1.0])
def test_a_cut_in_at_the_same_speed_is_met_without_harsh_braking(share: float) -> None:
    car = follower(30.0, route=road(5000.0, ((0.0, 30.0),)))
    lead = behind(car, share * desired_gap_m(30.0), 30.0)
    motion = follow(car, lead, 60.0, present=lambda t: t > 2.0)
    assert np.min(motion.request_mps2) > -1.3
    assert not np.any(motion.take_over)
    assert motion.gap_m[-1] == pytest.approx(desired_gap_m(30.0), abs=1.5)
    assert_continuous(motion)


def test_a_cut_in_that_is_too_near_calls_the_driver_in_the_same_step() -> None:
    car = follower(30.0)
    motion = follow(car, behind(car, 30.0, 15.0), 3.0, present=lambda t: t >= 0.99)
    appeared = np.flatnonzero(motion.time_s >= 0.99)[0]
    assert not np.any(motion.take_over[:appeared])
    assert motion.take_over[appeared] == 1
    assert_continuous(motion)


def test_take_over_is_an_event_once() -> None:
    car = follower(30.0)
    st = car.made.record
    lead = behind(car, 20.0, 15.0)
    follow(car, lead, 0.02)
    assert (st.hmi_take_over, st.hmi_event) == (1, EVENT_TAKE_OVER)
    follow(car, lead, 0.5, driver_brake_pedal=0.8)
    assert (st.mode, st.hmi_take_over) == (STANDBY, 0)  # the driver brakes


def test_a_lead_that_is_lost_for_half_a_second_is_not_felt() -> None:
    seen = follower(25.0)
    lost = follower(25.0)
    lead = [behind(car, desired_gap_m(25.0), 20.0) for car in (seen, lost)]
    reference = follow(seen, lead[0], 20.0)
    motion = follow(lost, lead[1], 20.0, present=lambda t: not 5.0 <= t < 5.5)
    assert np.max(np.abs(motion.request_mps2 - reference.request_mps2)) < 0.02
    assert np.max(np.abs(motion.gap_m - reference.gap_m)) < 0.05
    assert np.all(motion.limits[200:300])


def test_behind_a_cut_out_the_car_returns_to_its_profile_without_a_step() -> None:
    car = follower(20.0)
    motion = follow(car, behind(car, desired_gap_m(20.0), 20.0), 40.0, present=lambda t: t < 5.0)
    assert_continuous(motion)
    assert motion.speed_mps[-1] > 33.0
    assert np.all(motion.limits[(motion.time_s > 1.0) & (motion.time_s < 5.9)])
    # What the lead has done lasts until the car is back at its profile.
    profile_mps = car.made.record.target_speed_mps
    assert np.all(motion.limits[(motion.time_s > 1.0) & (motion.speed_mps < profile_mps - 1.1)])
    assert not np.any(motion.limits[(motion.time_s > 6.7) & (motion.speed_mps > profile_mps - 0.9)])
    assert motion.speed_mps[-1] > profile_mps - 0.9


def test_gas_behind_a_lead_overrides_and_its_release_follows_again_without_a_step() -> None:
    car = follower(20.0)
    lead = behind(car, desired_gap_m(20.0), 20.0)
    steady = follow(car, lead, 5.0)
    gas = follow(car, lead, 2.0, driver_gas_pedal=0.2)
    assert car.made.record.mode == GAS_OVERRIDE
    after = follow(car, lead, 40.0, driver_gas_pedal=0.0)
    assert car.made.record.mode == ACTIVE
    requests = [m.request_mps2 for m in (steady, gas, after)]
    assert np.max(np.abs(np.diff(np.concatenate(requests)))) <= JERK * 0.02 + ROUNDING
    assert np.min(after.gap_m) > 10.0
    assert after.gap_m[-1] == pytest.approx(desired_gap_m(20.0), abs=1.0)


def test_set_speed_and_time_gap_change_behind_a_lead_without_a_step() -> None:
    car = follower(25.0)
    st = car.made.record
    lead = behind(car, desired_gap_m(25.0), 25.0)
    parts = [follow(car, lead, 3.0)]
    parts.append(follow(car, lead, 3.0, lever_down_long=1))
    parts.append(follow(car, lead, 3.0, lever_down_long=0))
    st.following_desired_time_gap_s = 0.8
    parts.append(follow(car, lead, 10.0))
    st.following_desired_time_gap_s = 3.0
    parts.append(follow(car, lead, 30.0))
    request = np.concatenate([part.request_mps2 for part in parts])
    assert np.max(np.abs(np.diff(request))) <= JERK * 0.02 + ROUNDING
    assert parts[-1].gap_m[-1] > 60.0


def stopped_behind(seconds: float, **settings: float) -> tuple[PointMass, Lead]:
    """A car that has been held behind a standing lead for so long."""
    car = follower(10.0, **settings)
    lead = behind(car, 60.0, 0.0)
    while car.speed_mps > 0.0:
        follow(car, lead, 0.02)
    follow(car, lead, seconds)
    assert (car.speed_mps, car.made.record.mode) == (0.0, ACTIVE)
    return car, lead


def drives_off(t: float) -> float:
    return 1.0 if t < 5.0 else 0.0


def test_it_goes_on_by_itself_within_three_seconds_of_standing() -> None:
    car, lead = stopped_behind(1.0)
    motion = follow(car, lead, 20.0, drives_off)
    assert motion.speed_mps[-1] == pytest.approx(5.0, abs=0.6)
    assert_continuous(motion)


@pytest.mark.parametrize("by", ["lever_resume", "driver_gas_pedal"])
def test_later_it_waits_for_resume_or_gas(by: str) -> None:
    car, lead = stopped_behind(4.0)
    motion = follow(car, lead, 10.0, drives_off)
    assert np.all(motion.speed_mps == 0.0)
    assert np.all(motion.limits)  # it waits because of that car
    follow(car, lead, 0.3, **{by: 0.2 if by.endswith("pedal") else 1})
    follow(car, lead, 10.0, **{by: 0})
    assert car.speed_mps > 3.0


def test_resume_while_the_lead_still_stands_is_good_for_three_more_seconds() -> None:
    car, lead = stopped_behind(4.0)
    follow(car, lead, 0.1, lever_resume=1)
    follow(car, lead, 2.0, lever_resume=0)
    assert car.speed_mps == 0.0
    follow(car, lead, 5.0, drives_off)
    assert car.speed_mps > 1.0


def test_a_lead_that_turns_off_in_front_of_a_standing_car_frees_it_as_one_that_drives_off() -> None:
    for waited_s, goes in ((1.0, True), (5.0, False)):
        car, lead = stopped_behind(waited_s)
        follow(car, lead, 10.0, present=lambda _: False)
        assert (car.speed_mps > 3.0) is goes


def test_a_lead_that_creeps_does_not_make_the_car_jerk() -> None:
    car, lead = stopped_behind(1.0)
    motion = follow(car, lead, 30.0, lambda t: 0.4 if t % 6.0 < 1.0 else -0.4)
    starts = np.sum((motion.speed_mps[:-1] == 0.0) & (motion.speed_mps[1:] > 0.0))
    assert starts <= 3  # the lead makes five starts
    assert np.min(motion.gap_m) > 2.5


def test_braking_by_the_driver_ends_the_hold_and_resume_follows_anew() -> None:
    car, lead = stopped_behind(5.0)
    follow(car, lead, 0.5, driver_brake_pedal=0.5)
    assert (car.made.record.mode, car.made.record.standing) == (STANDBY, 0)
    follow(car, lead, 0.1, driver_brake_pedal=0.0, lever_resume=1)
    follow(car, lead, 2.0, lever_resume=0)
    assert car.speed_mps == 0.0
    follow(car, lead, 5.0, drives_off)
    assert car.speed_mps > 1.0


@pytest.mark.parametrize(("frequency_hz", "seconds"), [(0.05, 60.0), (0.12, 40.0), (0.5, 30.0)])
def test_a_wave_becomes_smaller_from_car_to_car(frequency_hz: float, seconds: float) -> None:
    """Peak deviations of the speed; the cars differ in how late they answer."""
    swing = min(4.0, 3.0 / (2.0 * np.pi * frequency_hz))  # up to 3 m/s2
    speeds = platoon(
        lambda t: 22.0 + swing * np.sin(2.0 * np.pi * frequency_hz * t),
        seconds,
        step_s=0.05,
        lags_s=(0.2, 0.1, 0.4),
    )
    peaks = np.max(np.abs(speeds - 22.0), axis=0)
    assert np.all(peaks[1:] <= peaks[:-1] + 0.001)
    assert peaks[-1] < 0.9 * peaks[0]


def test_a_stop_is_not_passed_on_any_harder() -> None:
    """A lead brakes with 3 m/s2 from 20 to 5 m/s: nobody behind falls below 5 or brakes harder."""
    speeds = platoon(lambda t: max(min(20.0, 20.0 - 3.0 * (t - 2.0)), 5.0), 60.0, step_s=0.05)
    lowest = np.min(speeds, axis=0)
    assert np.all(lowest[1:] >= 5.0 - 0.02)
    braking = -np.min(np.diff(speeds, axis=0), axis=0) / 0.05
    assert np.all(braking[2:] <= braking[1:-1] + 0.02)
    assert braking[-1] < 0.6 * braking[0]


def test_without_a_lead_its_numbers_mean_nothing() -> None:
    """Requests, outputs and memory are the same to the bit, whatever stands in gap and speed."""
    traces = []
    for gap_m, speed_mps in ((0.0, 0.0), (nan, nan), (-5.0, inf)):
        car = PointMass(function(road(600.0, ((0.0, 100.0 * KMH), (300.0, 50.0 * KMH)))), 25.0, 0.2)
        car.step(lever_resume=1)
        requests = []
        while car.s_m < 590.0:
            gas = 0.3 if 100.0 < car.s_m < 150.0 else 0.0
            car.step(lead_gap_m=gap_m, lead_speed_mps=speed_mps, driver_gas_pedal=gas)
            requests.append(car.made.record.acceleration_request_mps2)
        traces.append((requests, [array.tobytes() for array in car.made.arrays]))
    assert traces[0] == traces[1] == traces[2]


@pytest.mark.parametrize("field", ["lead_gap_m", "lead_speed_mps"])
@pytest.mark.parametrize("value", [nan, inf, -inf, 1e9])
def test_a_lead_whose_numbers_are_none_is_a_fault_and_calls_the_driver(
    field: str, value: float
) -> None:
    car = follower(20.0)
    lead = behind(car, 30.0, 20.0)
    follow(car, lead, 1.0)
    seen = {"lead_present": 1, "lead_gap_m": 30.0, "lead_speed_mps": 20.0, field: value}
    car.step(**seen)
    st = car.made.record
    assert (st.mode, st.hmi_take_over, st.following_limits) == (FAULT, 1, 0)
    car.step(lead_present=0, lead_gap_m=0.0, lead_speed_mps=0.0)
    assert st.hmi_take_over == 0


def test_the_time_gap_is_told() -> None:
    car = follower(20.0)
    st = car.made.record
    follow(car, behind(car, 50.0, 20.0), 0.02)
    assert st.following_time_gap_s == pytest.approx(2.5)
    car.step(lead_gap_m=-1.0)
    assert st.following_time_gap_s == 0.0
    car.step(lead_present=0)
    assert st.following_time_gap_s == 0.0


@pytest.mark.parametrize("step_s", [0.001, 0.01, 0.1])
def test_the_step_of_the_importer_hardly_matters(step_s: float) -> None:
    car = follower(20.0, route=LONG_ROAD)
    lead = behind(car, desired_gap_m(20.0), 20.0)
    motion = follow(car, lead, 15.0, lambda t: -3.5 if 1.0 <= t < 4.0 else 0.0, step_s)
    assert np.min(motion.gap_m) == pytest.approx(20.2, abs=0.2)
    assert not np.any(motion.take_over)
