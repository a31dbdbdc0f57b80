"""Modes: every event in every state, their order within a step, lever and manual set speed."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, PointMass, driving, function, road
from pldf.kernel import modes
from pldf.kernel.codes import ACTIVE, FAULT, GAS_OVERRIDE, MODE, OFF, STANDBY

# Written down from the specification, not from the code: what each event does in each state.
# An event that is not listed for a state changes nothing there.
TABLE = {
    "OFF": {"SWITCH_ON": "STANDBY"},
    "STANDBY": {"SWITCH_OFF": "OFF", "RESUME": "ACTIVE", "FAIL": "FAULT"},
    "ACTIVE": {
        "SWITCH_OFF": "OFF",
        "CANCEL": "STANDBY",
        "GAS_PRESS": "GAS_OVERRIDE",
        "BRAKE_PRESS": "STANDBY",
        "LOST": "STANDBY",
        "FAIL": "FAULT",
    },
    "GAS_OVERRIDE": {
        "SWITCH_OFF": "OFF",
        "CANCEL": "STANDBY",
        "GAS_RELEASE": "ACTIVE",
        "BRAKE_PRESS": "STANDBY",
        "LOST": "STANDBY",
        "FAIL": "FAULT",
    },
    "FAULT": {"SWITCH_OFF": "OFF", "RECOVER": "STANDBY"},
}


def test_the_table_of_states_and_events_is_complete() -> None:
    assert set(TABLE) == set(MODE.items)
    assert modes.TRANSITIONS.shape == (len(MODE.items), len(modes.EVENTS))
    assert {event for row in TABLE.values() for event in row} == set(modes.EVENTS)


@pytest.mark.parametrize("state", MODE.items)
@pytest.mark.parametrize("event", modes.EVENTS)
def test_every_event_in_every_state(state: str, event: str) -> None:
    expected = TABLE[state].get(event, state)
    found = modes.next_mode(MODE.code(state), modes.EVENTS.index(event))
    assert MODE.items[found] == expected


def cruising() -> PointMass:
    return driving(road(3000.0), 25.0)


def mode_after(car: PointMass, **inputs: float) -> int:
    car.step(**inputs)
    return car.made.record.mode


def test_is_in_standby_after_start_and_active_after_resume() -> None:
    car = PointMass(function(road(3000.0)))
    assert car.made.record.mode == STANDBY
    assert mode_after(car) == STANDBY
    assert mode_after(car, lever_resume=1) == ACTIVE


def test_is_off_without_main_switch_whatever_the_lever_says() -> None:
    car = PointMass(function(road(3000.0), main_switch=0))
    assert mode_after(car, lever_resume=1, driver_gas_pedal=0.5) == OFF
    car.made.record.main_switch = 1
    assert mode_after(car) == STANDBY  # the lever is still held: that is no new press


def test_gas_overrides_until_it_is_released() -> None:
    car = cruising()
    assert mode_after(car, driver_gas_pedal=0.3) == GAS_OVERRIDE
    assert mode_after(car) == GAS_OVERRIDE
    assert mode_after(car, driver_gas_pedal=0.0) == ACTIVE


@pytest.mark.parametrize("before", [{}, {"driver_gas_pedal": 0.4}])
def test_brake_ends_in_standby_until_the_driver_resumes(before: dict[str, float]) -> None:
    car = cruising()
    car.step(**before)
    assert mode_after(car, driver_brake_pedal=0.3, driver_gas_pedal=0.0) == STANDBY
    assert mode_after(car, driver_brake_pedal=0.0) == STANDBY
    assert mode_after(car, driver_gas_pedal=0.4) == STANDBY
    assert mode_after(car, driver_gas_pedal=0.0) == STANDBY
    assert mode_after(car, lever_resume=1) == ACTIVE


def test_brake_wins_over_gas_over_cancel_over_resume_in_one_step() -> None:
    car = cruising()
    assert mode_after(car, driver_gas_pedal=0.5, driver_brake_pedal=0.5) == STANDBY
    car.step(driver_gas_pedal=0.0, driver_brake_pedal=0.0)
    assert mode_after(car, lever_resume=1, driver_brake_pedal=0.5) == STANDBY
    car.run(0.1, lever_resume=0)
    assert mode_after(car, lever_resume=1, driver_brake_pedal=0.0, driver_gas_pedal=0.5) == (
        GAS_OVERRIDE
    )
    assert mode_after(car, driver_gas_pedal=0.0) == ACTIVE
    car.run(0.1, lever_resume=0)
    assert mode_after(car, lever_resume=1, lever_cancel=1) == STANDBY


def test_resume_while_braking_has_to_be_repeated_after_it() -> None:
    car = cruising()
    car.run(0.5, driver_brake_pedal=0.3)
    car.run(0.5, lever_resume=1)
    assert mode_after(car, driver_brake_pedal=0.0) == STANDBY
    car.run(0.1, lever_resume=0)
    assert mode_after(car, lever_resume=1) == ACTIVE


def test_cancel_ends_an_override_for_good() -> None:
    car = cruising()
    car.step(driver_gas_pedal=0.3)
    assert mode_after(car, lever_cancel=1) == STANDBY
    assert mode_after(car, driver_gas_pedal=0.0, lever_cancel=0) == STANDBY


def test_pedals_below_the_threshold_are_not_pressed() -> None:
    car = cruising()
    assert mode_after(car, driver_gas_pedal=0.02, driver_brake_pedal=0.02) == ACTIVE


EVENTS_BY_INPUT = {
    "lever_resume": "RESUME",
    "lever_cancel": "CANCEL",
    "driver_gas_pedal": "GAS_PRESS",
    "driver_brake_pedal": "BRAKE_PRESS",
}


@settings(deadline=None, max_examples=30)
@given(hs.lists(hs.sampled_from(sorted(EVENTS_BY_INPUT)), max_size=12))
def test_any_sequence_of_inputs_follows_the_table(sequence: list[str]) -> None:
    car = PointMass(function(road(300.0)))
    state = "STANDBY"
    for name in sequence:
        car.step(**{name: 1})
        state = TABLE[state].get(EVENTS_BY_INPUT[name], state)
        assert MODE.items[car.made.record.mode] == state
        car.run(0.06, **{name: 0})
        state = TABLE[state].get("GAS_RELEASE", state)
        assert MODE.items[car.made.record.mode] == state


# Lever and set speed


def set_kmh(car: PointMass) -> float:
    return car.made.record.set_speed_mps * 3.6


def test_the_legal_limit_is_the_set_speed_until_the_lever_changes_it() -> None:
    car = driving(road(3000.0, ((0.0, 80.0 * KMH), (200.0, 60.0 * KMH))), 15.0)
    assert set_kmh(car) == pytest.approx(80.0)
    while car.s_m < 201.0:
        car.step()
    assert set_kmh(car) == pytest.approx(60.0)
    assert car.made.record.set_speed_offset_mps == 0.0


@pytest.mark.parametrize(
    ("lever", "kmh"),
    [("lever_up", 1), ("lever_down", -1), ("lever_up_long", 5), ("lever_down_long", -5)],
)
def test_tips_add_up(lever: str, kmh: float) -> None:
    car = cruising()
    car.tip(lever)
    assert set_kmh(car) == pytest.approx(100.0 + kmh)
    car.tip(lever)
    assert set_kmh(car) == pytest.approx(100.0 + 2 * kmh)
    assert car.made.record.set_speed_offset_mps * 3.6 == pytest.approx(2 * kmh)


def test_a_held_or_chattering_contact_is_one_tip() -> None:
    car = cruising()
    car.run(2.0, lever_up=1)
    assert set_kmh(car) == pytest.approx(101.0)
    car.run(0.2, lever_up=0)
    for k in range(5):
        car.step(lever_up_long=(k + 1) % 2)
    assert set_kmh(car) == pytest.approx(106.0)


def test_chatter_does_not_resume_after_cancel() -> None:
    car = cruising()
    for k in range(5):
        car.step(lever_cancel=(k + 1) % 2)
    assert car.made.record.mode == STANDBY


def test_up_and_down_together_cancel_out() -> None:
    car = cruising()
    car.run(0.1, lever_up=1, lever_down=1)
    assert set_kmh(car) == pytest.approx(100.0)


def test_a_manual_set_speed_is_dropped_at_the_next_change_of_the_limit() -> None:
    limits = ((0.0, 80.0 * KMH), (300.0, 60.0 * KMH), (500.0, 80.0 * KMH))
    car = driving(road(1000.0, limits), 20.0)
    car.tip("lever_up_long")
    while car.s_m < 299.0:
        car.step()
        assert set_kmh(car) == pytest.approx(85.0)
    while car.s_m < 301.0:
        car.step()
    assert set_kmh(car) == pytest.approx(60.0)
    while car.s_m < 600.0:
        car.step()
    assert set_kmh(car) == pytest.approx(80.0)
    assert car.made.record.set_speed_offset_mps == 0.0


def test_a_manual_set_speed_survives_brake_and_override() -> None:
    car = cruising()
    car.tip("lever_up_long")
    car.run(0.5, driver_gas_pedal=0.5)
    car.run(0.5, driver_gas_pedal=0.0, driver_brake_pedal=0.5)
    car.run(0.1, driver_brake_pedal=0.0)
    car.tip("lever_resume")
    assert set_kmh(car) == pytest.approx(105.0)


def test_the_manual_set_speed_stays_between_its_bounds() -> None:
    car = driving(road(5000.0), 25.0)
    for _ in range(20):
        car.tip("lever_up_long")
    assert set_kmh(car) == pytest.approx(180.0)
    for _ in range(40):
        car.tip("lever_down_long")
    assert set_kmh(car) == pytest.approx(20.0)


def test_tips_in_off_and_fault_do_nothing() -> None:
    car = PointMass(function(road(3000.0), main_switch=0))
    car.tip("lever_up_long")
    assert car.made.record.mode == OFF
    assert car.made.record.set_speed_offset_mps == 0.0
    car = cruising()
    car.step(driver_gas_pedal=float("nan"))
    car.step(driver_gas_pedal=0.0)
    assert car.made.record.mode == FAULT
    car.tip("lever_up_long")
    assert car.made.record.set_speed_offset_mps == 0.0


def test_curves_and_the_next_sign_still_count_above_the_limit() -> None:
    limits = ((0.0, 80.0 * KMH), (800.0, 50.0 * KMH))
    car = driving(road(1500.0, limits, [(300.0, 400.0, 0.01)]), 22.0, control_preview_s=0.0)
    car.tip("lever_up_long")
    car.tip("lever_up_long")
    highest = 0.0
    while car.s_m < 1000.0:
        car.step()
        highest = max(highest, car.speed_mps)
        if 300.0 < car.s_m < 400.0:
            assert car.speed_mps < 250.0**0.5 + 0.3
        if car.s_m > 801.0:
            assert car.speed_mps < 50.0 * KMH + 0.3
    assert highest * 3.6 > 85.0
