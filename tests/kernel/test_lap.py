"""A drive ends at the road's end, or where the car is set back: nothing behind is mixed into it."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import PointMass, driving, function, play, road, within
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    ACTIVE,
    GAS_OVERRIDE,
    LAP_ARRIVED,
    LAP_BEGUN_ANEW,
    LAP_RECORDED,
    LAP_SET_BACK,
    STANDBY,
    XY,
)

STEP_S = 0.02
LENGTH_M = 1000.0
SPEED_MPS = 20.0


def played(
    *pieces: tuple[float, float, int], gas: tuple[float, float] = (0.0, 0.0)
) -> DrivingFunction:
    """Pieces of a drive at 20 m/s, each (from m, seconds, mode), one sample per 20 ms.

    The driver's gas overrides between two times of the whole drive.
    """
    made = function(road(LENGTH_M))
    counts = [round(seconds / STEP_S) for _, seconds, _ in pieces]
    s_m = np.concatenate(
        [p[0] + SPEED_MPS * STEP_S * np.arange(n) for p, n in zip(pieces, counts, strict=True)]
    )
    mode = np.repeat([p[2] for p in pieces], counts)
    time_s = STEP_S * np.arange(len(s_m))
    mode = np.where(within(time_s, [gas]), GAS_OVERRIDE, mode)
    play(made, s_m, SPEED_MPS, time_s=time_s, mode=mode)
    made.refresh()
    return made


def what_was_learned(made: DrivingFunction) -> tuple[bytes, ...]:
    iteration = made.learn()
    return iteration.learned_mps.tobytes(), iteration.lessons.tobytes()


def rates(made: DrivingFunction) -> tuple[float, float]:
    return made.record.rate_pedal, made.record.rate_combined


def test_no_stop_time_lowers_a_rate() -> None:
    to_the_end = played((0.0, 50.02, ACTIVE), gas=(10.0, 15.0))
    long_after = played((0.0, 50.02, ACTIVE), (1000.4, 100.0, STANDBY), gas=(10.0, 15.0))
    assert to_the_end.record.lap == long_after.record.lap == LAP_ARRIVED
    assert rates(to_the_end) == rates(long_after) == pytest.approx((0.1, 0.1), rel=1e-3)
    assert what_was_learned(to_the_end) == what_was_learned(long_after)


def test_an_override_over_the_end_ends_there() -> None:
    made = played((0.0, 80.0, ACTIVE), gas=(40.0, 70.0))
    assert made.record.drive_interventions == 1
    assert made.trace.end_m[0] == pytest.approx(LENGTH_M, abs=SPEED_MPS * STEP_S)
    assert rates(made)[0] == pytest.approx(10.0 / 50.0, rel=1e-3)


def test_a_car_that_stays_on_the_road_has_not_arrived() -> None:
    assert played((0.0, 49.0, ACTIVE)).record.lap == LAP_RECORDED


@pytest.mark.parametrize("first_s", [30.0, 49.0, 60.0])
def test_a_lap_after_the_car_was_set_back_is_not_mixed_into_the_first(first_s: float) -> None:
    """Set back in the middle, near the end, and behind it; then a lap with other interventions."""
    one = played((0.0, first_s, ACTIVE), gas=(10.0, 15.0))
    two = played(
        (0.0, first_s, ACTIVE),
        (0.0, 15.0, ACTIVE),
        (300.0, 40.0, GAS_OVERRIDE),
        gas=(10.0, 15.0),
    )
    assert two.record.lap == LAP_SET_BACK
    assert rates(two) == rates(one)
    assert two.record.drive_interventions == 1
    assert what_was_learned(two) == what_was_learned(one)


def test_a_glitch_of_the_position_is_none_that_ends_a_lap() -> None:
    """A second at position 0 costs what a hole of a second costs: nothing."""
    clean = played((0.0, 49.0, ACTIVE), gas=(10.0, 15.0))
    glitch = played(
        (0.0, 30.0, ACTIVE), (0.0, 1.0, ACTIVE), (620.0, 18.0, ACTIVE), gas=(10.0, 15.0)
    )
    assert glitch.record.lap == LAP_RECORDED
    assert glitch.record.nodes == clean.record.nodes
    assert rates(glitch) == pytest.approx(rates(clean))
    assert not np.any(glitch.trace.gap)


def test_a_car_brought_to_the_start_begins_there() -> None:
    """Nothing was driven before: the function had not been active."""
    direct = played((0.0, 45.0, ACTIVE), gas=(5.0, 10.0))
    brought = played((500.0, 10.0, STANDBY), (0.0, 45.0, ACTIVE), gas=(15.0, 20.0))
    assert brought.record.lap == LAP_BEGUN_ANEW
    # It takes 1.5 s until a jump is known to be none of the position alone.
    assert brought.record.first_node == pytest.approx(31, abs=1)
    assert brought.record.first_node + brought.record.nodes == direct.record.nodes
    assert rates(brought)[0] == pytest.approx(5.0 / 43.5, rel=1e-2)
    assert brought.trace.start_m[0] == pytest.approx(direct.trace.start_m[0])


def test_a_lap_by_hand_stays_when_the_next_begins() -> None:
    made = played((0.0, 55.0, STANDBY), (0.0, 20.0, ACTIVE))
    assert made.record.lap == LAP_SET_BACK
    assert made.record.nodes == round(LENGTH_M) + 1


def arrive(car: PointMass, seconds: float) -> None:
    for _ in range(round(seconds / STEP_S)):
        st = car.made.record
        st.vehicle_x_m, st.vehicle_y_m = car.s_m, 0.5  # the road lies along x
        car.step(STEP_S)


def test_coordinates_behind_the_end_are_no_drive_either() -> None:
    made: list[DrivingFunction] = []
    for seconds in (40.0, 100.0):
        car = driving(road(600.0), localization=XY)
        arrive(car, seconds)
        made.append(car.made)
    assert [one.record.lap for one in made] == [LAP_ARRIVED, LAP_ARRIVED]
    assert made[0].record.total_ns == made[1].record.total_ns
    assert made[0].record.nodes == 601


def told(made: DrivingFunction) -> list[tuple[str, str]]:
    return [(m.level, m.text.split(": ", 1)[1]) for m in made.messages if m.text.startswith("t = ")]


def test_a_car_that_is_set_back_is_told_once() -> None:
    car = driving(road(LENGTH_M), learn=1)
    car.run(20.0)
    assert car.made.record.hmi_learning == 1
    car.s_m = 0.0
    car.tip("lever_resume")
    car.run(5.0)
    levels = [level for level, text in told(car.made) if "set back without a reset" in text]
    assert levels == ["warning"]
    assert car.made.record.hmi_learning == 0


def test_a_car_that_arrives_is_no_reason_for_a_warning() -> None:
    car = driving(road(LENGTH_M))
    car.run(60.0)
    assert (
        "info",
        "the road's end: nothing behind it is recorded, learned or counted in the rates",
    ) in told(car.made)
