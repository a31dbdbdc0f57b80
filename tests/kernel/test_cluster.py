"""What the cluster says in drives whose reason a person would know at once."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

import numpy as np
import pytest
from laboratory import (
    BASE,
    KMH,
    PointMass,
    after,
    bent,
    driving,
    function,
    override,
    play_override,
    road,
)
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, REASON, UNIT_MPH
from pldf.roads import Route

STEP_S = 0.02
LOWER_SIGN = ((0.0, 100.0 * KMH), (900.0, 50.0 * KMH))


class Said(NamedTuple):
    """A sentence from when it is said to the next one."""

    text: str
    reason: str
    s_m: float
    time_s: float
    speed_kmh: float
    target_kmh: float


def listen(
    car: PointMass, until_m: float, inputs: Callable[[PointMass], dict[str, float]] | None = None
) -> list[Said]:
    """Drive on and return what was said, in order."""
    said: list[Said] = []
    st = car.made.record
    while car.s_m < until_m:
        car.step(STEP_S, **(inputs(car) if inputs else {}))
        car.made.say()
        text, time_s = car.made.texts.hmi_text, 1e-9 * st.time_ns
        if not said or said[-1].text != text:
            speeds = (car.speed_mps / KMH, st.target_speed_mps / KMH)
            said.append(Said(text, REASON.items[st.hmi_reason], car.s_m, time_s, *speeds))
    return said


def texts(said: list[Said]) -> list[str]:
    return [one.text for one in said]


def taught(route: Route, made: DrivingFunction) -> PointMass:
    """Return a car on the next drive, at the profile's speed."""
    following = function(route, after(made, made.learn()))
    car = PointMass(following, float(following.profile.base_mps[0]), 0.2)
    car.tip("lever_resume")
    return car


def test_a_lower_sign_is_named_before_it_and_at_it() -> None:
    car = driving(road(1500.0, LOWER_SIGN), BASE)
    assert texts(listen(car, 1200.0)) == [
        "Speed limit 100",
        "50: limit 50 ahead",
        "New speed limit: 50",
        "Speed limit 50",
    ]


def test_only_the_next_sign_is_named() -> None:
    """30 km/h stand 20 m behind a sign of 80: nobody may be told of a limit of 30 before it."""
    limits = ((0.0, 100.0 * KMH), (900.0, 80.0 * KMH), (920.0, 30.0 * KMH))
    said = listen(driving(road(1500.0, limits), BASE), 1200.0)
    before = [one.text for one in said if 400.0 < one.s_m < 899.0]
    assert before == ["Slowing down to 30"]
    between = [one.text for one in said if 900.0 <= one.s_m < 919.0]
    assert set(between) <= {"Slowing down to 30", "New speed limit: 80", "30: limit 30 ahead"}


def test_a_curve_is_the_reason_though_a_set_speed_is_set() -> None:
    """105 set by hand, a curve of 62 km/h: the curve binds, not the lever."""
    curvature = 2.5 / (62.0 * KMH) ** 2
    car = driving(road(2500.0, curves=[(1200.0, 1300.0, curvature)]), BASE)
    car.tip("lever_up_long")
    said = listen(car, 1250.0)
    assert said[-1].text == "62 for the curve"
    assert said[-1].reason == "CURVE"
    assert car.speed_mps / KMH == pytest.approx(62.0, abs=1.0)
    assert "105: set by you" in texts(said)


def test_above_the_limit_it_slows_down_and_says_so() -> None:
    """108 km/h where 50 is the limit, the gas pedal just let go."""
    car = driving(road(3000.0, LOWER_SIGN), BASE)

    def gas(car: PointMass) -> dict[str, float]:
        return {"driver_gas_pedal": 0.5 if 700.0 < car.s_m < 950.0 else 0.0}

    said = listen(car, 1500.0, gas)
    falling = [one for one in said if one.s_m > 950.0]
    assert falling[0].reason == "SLOWING_DOWN"
    assert falling[0].speed_kmh > 80.0
    assert {one.text for one in falling if one.speed_kmh > 55.0} == {"Slowing down to 50"}
    assert falling[-1].text == "Speed limit 50"


@pytest.mark.parametrize(("kmh", "word"), [(110.0, "faster"), (85.0, "slower")])
def test_a_lesson_is_told_with_its_numbers(kmh: float, word: str) -> None:
    """The mean of 100 and the driver's speed is learned; the middle of the piece has it all."""
    made = override(kmh * KMH, 800.0, 1200.0)
    said = listen(taught(road(2000.0), made), 1900.0)
    numbers = round(0.5 * (100.0 + kmh))
    middle = [one for one in said if one.s_m < 1150.0][-1]
    assert middle.text.endswith(f" instead of 100: you drove {word} here in drive 1")
    assert abs(int(middle.text.split()[0]) - numbers) <= 1
    outside = [one.text for one in said if one.s_m > 1400.0 or one.s_m < 500.0]
    assert outside and not any(word in text for text in outside)


def test_a_lesson_that_ends_is_not_called_faster_while_the_car_goes_back() -> None:
    made = override(115.0 * KMH, 800.0, 1200.0)
    following = function(road(2000.0), after(made, made.learn()))
    learned, reason = (
        np.array(c) for c in (following.profile.learned_mps, following.profile.reason)
    )
    faster = np.flatnonzero(reason == REASON.code("LEARNED_FASTER"))
    assert len(faster) > 300
    assert np.diff(learned**2)[faster].min() >= -0.1  # twice the acceleration


def test_a_learned_set_speed_is_told_as_one() -> None:
    route = road(2000.0)
    car = driving(route, BASE)
    car.tip("lever_up_long")
    car.run(60.0)
    said = listen(taught(route, car.made), 1500.0)
    assert said[-1].text == "105 at limit 100: your learned set speed"
    assert not any("you drove" in text for text in texts(said))


def test_what_a_bound_cut_is_told_with_the_bound() -> None:
    """150 wished at 100: the mean is 125, of which 20 above the limit is the most."""
    made = override(150.0 * KMH, 800.0, 1400.0)
    said = listen(taught(road(2000.0), made), 1100.0)
    assert said[-1].text == "120 is the most at limit 100"


def test_a_new_set_speed_is_said_at_once() -> None:
    car = driving(road(4000.0), BASE)
    listen(car, 200.0)
    for kmh in (101, 102, 103):
        car.tip("lever_up")
        car.made.say()
        assert car.made.texts.hmi_text == f"{kmh}: set by you"


def test_every_mode_has_its_sentence() -> None:
    car = PointMass(function(road(3000.0)), BASE)
    assert listen(car, 30.0)[-1].text == "You drive; RESUME hands over"
    car.tip("lever_resume")
    assert listen(car, 100.0)[-1].text == "Speed limit 100"
    assert listen(car, 200.0, lambda _: {"driver_gas_pedal": 0.2})[-1].text == (
        "You drive: gas pedal"
    )
    car.step(STEP_S, driver_gas_pedal=float("nan"))
    car.made.say()
    assert car.made.texts.hmi_text == "Fault: please drive yourself"


def test_switched_off_is_said_from_the_first_moment() -> None:
    made = function(road(1000.0), main_switch=0)
    made.say()
    assert made.texts.hmi_text == "Switched off"


def test_miles_and_german() -> None:
    car = driving(road(1500.0, LOWER_SIGN), BASE, hmi_unit=UNIT_MPH, hmi_language=1)
    said = texts(listen(car, 1200.0))
    assert said == [
        "Tempolimit 62",
        "31: Tempolimit 31 voraus",
        "Neues Tempolimit: 31",
        "Tempolimit 31",
    ]


def test_a_sentence_stays_for_a_second_unless_it_is_false() -> None:
    """Numbers of a rising speed follow it, and no sentence but a wrong one goes before its time."""
    car = driving(road(3000.0, ((0.0, 50.0 * KMH), (600.0, 100.0 * KMH))), 50.0 * KMH)
    said = listen(car, 2000.0)
    lasted = np.diff([one.time_s for one in said])
    assert lasted[1:].min() > 1.0 - 1e-6  # the first began before anybody listened
    assert texts(said)[-3:] == ["New speed limit: 100", "Speeding up to 100", "Speed limit 100"]


def test_an_event_waits_and_a_warning_does_not() -> None:
    car = driving(road(3000.0), BASE)
    car.run(1.5)
    car.step(STEP_S, lever_up=1)  # "101: set by you" begins now
    car.step(STEP_S, lever_up=0, teach_pause=1)
    car.made.say()
    assert car.made.texts.hmi_text == "101: set by you"
    assert car.made.record.hmi_event != 0
    car.run(1.1)
    car.made.say()
    assert car.made.texts.hmi_text == "Paused: nothing is learned"
    car.step(STEP_S, lead_present=1, lead_gap_m=5.0, lead_speed_mps=0.0)
    car.made.say()
    assert car.made.texts.hmi_text == "Brake now!"


def test_behind_another_car() -> None:
    car = driving(road(3000.0), BASE)

    def lead(car: PointMass) -> dict[str, float]:
        return {
            "lead_present": 1,
            "lead_gap_m": max(400.0 + 15.0 * 1e-9 * car.made.record.time_ns - car.s_m, 5.0),
            "lead_speed_mps": 15.0,
        }

    said = listen(car, 1600.0, lead)
    assert said[-1].text == "Following the car ahead"
    assert not any("limit" in one.text for one in said if one.s_m > 1200.0)


def test_a_temporary_limit_is_said() -> None:
    car = driving(road(3000.0), BASE)
    listen(car, 300.0)
    said = listen(car, 1200.0, lambda _: {"limit_override_mps": 60.0 * KMH})
    assert said[-1].text == "Temporary limit 60"
    assert car.speed_mps / KMH == pytest.approx(60.0, abs=1.0)


@pytest.mark.parametrize(
    ("gas", "text"), [(0.3, "Learned from this drive"), (0.0, "Speed limit 100")]
)
def test_behind_a_drive_it_says_whether_it_taught(gas: float, text: str) -> None:
    car = driving(road(2000.0), BASE, learn=1)
    listen(car, 1500.0, lambda c: {"driver_gas_pedal": gas * (800.0 < c.s_m < 1000.0)})
    car.run(3.0)
    car.made.learn()
    car.made.say()
    assert car.made.texts.hmi_text == text


def test_confidence_halves_the_doubt_with_every_lesson() -> None:
    speed = bent((0, BASE), (800, BASE), (801, 1.15 * BASE), (1200, 1.15 * BASE), (1201, BASE),
                 (2000, BASE))  # fmt: skip
    made = function(road(2000.0))
    for lessons in (1, 2, 3):
        play_override(made, speed, gas=[(800.0, 1200.0)])
        made = function(road(2000.0), after(made, made.learn()))
        told = []
        for place_m in (1000.0, 100.0):
            made.record.vehicle_s_m = place_m
            made.refresh()
            told.append((made.record.hmi_learned_in_drives, made.record.hmi_confidence))
        assert told == [(lessons, 1.0 - 0.5**lessons), (0, 0.0)]


def test_reasons_of_the_base_profile_are_its_caps() -> None:
    """Where the profile is at its set speed or at the curve's speed, that is the reason."""
    curvature = 2.5 / (70.0 * KMH) ** 2
    made = function(road(2000.0, LOWER_SIGN, [(300.0, 400.0, curvature)]))
    reason = np.array(made.profile.reason)
    speed = np.array(made.profile.base_mps)
    limit = np.where(np.arange(2001) < 900, 100.0 * KMH, 50.0 * KMH)
    assert np.all(reason[np.abs(speed - limit) < 0.1] == REASON.code("LIMIT"))
    assert np.all(reason[301:399] == REASON.code("CURVE"))
    braking = sqrt((50.0 * KMH) ** 2 + 2.0 * 0.5)  # half a metre at -1 m/s2 before the sign
    assert speed[899] == pytest.approx(braking, abs=0.2)
    assert reason[890] == REASON.code("COASTING_TO_LIMIT")
    assert reason[450] == REASON.code("SPEEDING_UP")
    assert made.record.mode != ACTIVE
