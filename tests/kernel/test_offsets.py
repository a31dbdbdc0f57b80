"""Learning the set speed: where an offset begins and ends, and what the pedals taught before."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import (
    KMH,
    Array,
    after,
    bent,
    driving,
    function,
    play_override,
)
from lever_drives import LIMIT, ROAD, assert_offset, set_by
from pldf.kernel.codes import (
    ACTIVE,
    GAS_OVERRIDE,
)


def test_an_offset_holds_up_to_the_next_sign() -> None:
    learned = set_by([(1400.0, 2000.0, 85.0)]).learn()
    assert_offset(learned.offset_mps, 5.0, 1400, 2000)


def test_it_is_adopted_as_it_is_and_planned_not_averaged() -> None:
    learned = set_by([(1400.0, 2000.0, 85.0)]).learn()
    assert learned.learned_mps[1700] == pytest.approx(85.0 * KMH)
    assert learned.learned_mps[1300] == pytest.approx(LIMIT)


def test_an_offset_ended_by_the_lever_ends_there() -> None:
    learned = set_by([(1400.0, 1700.0, 85.0)]).learn()
    assert_offset(learned.offset_mps, 5.0, 1400, 1701)  # whole metres, rounded outwards


def test_of_several_presses_the_first_position_and_the_final_value_count() -> None:
    learned = set_by([(1400.0, 1410.0, 85.0), (1410.0, 1420.0, 90.0), (1420.0, 2000.0, 86.0)])
    assert_offset(learned.learn().offset_mps, 6.0, 1400, 2000)


def test_slower_wishes_count_as_well() -> None:
    learned = set_by([(1400.0, 2000.0, 70.0)]).learn()
    assert_offset(learned.offset_mps, -10.0, 1400, 2000)
    assert learned.learned_mps[1700] == pytest.approx(70.0 * KMH)


def test_two_limits_have_offsets_of_their_own() -> None:
    learned = set_by([(1400.0, 2000.0, 85.0), (2400.0, 3001.0, 97.0)]).learn()
    assert learned.offset_mps[1999] == pytest.approx(5.0 * KMH)
    assert learned.offset_mps[2399] == 0.0
    assert learned.offset_mps[2400] == pytest.approx(-3.0 * KMH)


@pytest.mark.parametrize(("seconds", "first"), [(4.8, 1000), (5.3, None)])
def test_five_seconds_after_the_sign_count_for_the_whole_limit(
    seconds: float, first: int | None
) -> None:
    at = float(round(1000.0 + seconds * LIMIT))
    # Settled from the sign on, without the three seconds of grace.
    made = set_by([(at, 2000.0, 85.0)])
    made.record.learning_offset_settled_s = 0.0
    assert_offset(made.learn().offset_mps, 5.0, int(at) if first is None else first, 2000)


def slow_arrival(settled_m: float) -> Array:
    """100 km/h at the sign, the new limit not reached before ``settled_m``."""
    s_m = np.arange(0.0, 3000.5, 0.5)
    return bent((0, 27), (1000, 27), (settled_m, LIMIT), (2000, LIMIT), (2001, 27), (3000, 27))(s_m)


@pytest.mark.parametrize(("set_at_m", "whole"), [(1150.0, True), (1205.0, True), (1290.0, False)])
def test_before_settling_plus_three_seconds_count_for_the_whole_limit(
    set_at_m: float, whole: bool
) -> None:
    # 150 m of braking take 6.1 s; three more seconds end at about 1210 m.
    made = set_by([(set_at_m, 2000.0, 85.0)], slow_arrival(1150.0))
    assert_offset(made.learn().offset_mps, 5.0, 1000 if whole else int(set_at_m), 2000)


@pytest.mark.parametrize(("set_at_m", "whole"), [(1280.0, True), (1320.0, False)])
def test_settling_counts_for_twelve_seconds_at_most(set_at_m: float, whole: bool) -> None:
    # Never settled before 1900 m: 12 s end at about 1307 m.
    made = set_by([(set_at_m, 2000.0, 85.0)], slow_arrival(1900.0))
    assert_offset(made.learn().offset_mps, 5.0, 1000 if whole else int(set_at_m), 2000)


def test_an_offset_is_capped_by_the_bound_over_the_limit() -> None:
    learned = set_by([(1400.0, 2000.0, 120.0)]).learn()
    assert_offset(learned.offset_mps, 20.0, 1400, 2000)


# With something learned before


def test_a_learned_offset_is_kept_and_counts_no_longer_as_set() -> None:
    first = set_by([(1400.0, 2000.0, 85.0)])
    made = set_by([], stored=after(first, first.learn()))
    made.refresh()
    assert made.record.rate_set_speed == 0.0
    np.testing.assert_array_equal(made.learn().offset_mps, first.learn().offset_mps)


def test_a_set_speed_at_the_limit_takes_a_learned_offset_back() -> None:
    first = set_by([(1400.0, 2000.0, 85.0)])
    made = set_by([(1600.0, 2000.0, 80.0)], stored=after(first, first.learn()))
    made.refresh()
    assert made.record.rate_set_speed > 0.0
    assert_offset(made.learn().offset_mps, 5.0, 1400, 1600)


def test_pedal_learning_averages_against_a_learned_offset() -> None:
    first = set_by([(1400.0, 2000.0, 90.0)])
    stored = after(first, first.learn())
    speed = bent((0, 27.6), (1000, 27.6), (1001, 22.2), (1400, 22.2), (1401, 25), (2000, 25),
                 (2001, 27.6), (3000, 27.6))  # fmt: skip
    made = function(ROAD, stored)
    play_override(made, speed, gas=[(1600, 1900)])
    learned = made.learn().learned_mps
    driven = stored.iterations[-1].learned_mps
    changed = np.flatnonzero(learned != driven)
    assert len(changed) == 0  # 25 m/s is 90 km/h: the offset explains it all
    made = function(ROAD, stored)
    play_override(made, lambda s_m: speed(s_m) + 1.0 * (s_m > 1300) * (s_m < 1950),
                  gas=[(1600, 1900)])  # fmt: skip
    assert made.learn().learned_mps[1850] == pytest.approx(90.0 * KMH + 0.5, abs=1e-6)


def test_what_the_pedals_taught_is_carried_on_a_new_plan() -> None:
    made = function(ROAD)
    speed = bent((0, 27), (1000, 27), (1100, LIMIT), (1400, LIMIT), (1420, 24.4), (1700, 24.4),
                 (1720, LIMIT), (2000, LIMIT), (2001, 27), (3000, 27))  # fmt: skip
    play_override(made, speed, gas=[(1400, 1700)])
    taught = made.learn()
    delta = taught.learned_mps[1500] - LIMIT
    assert delta > 0.9
    made = set_by([(1010.0, 2000.0, 83.0)], stored=after(made, taught))
    carried = made.learn()
    assert carried.learned_mps[1500] == pytest.approx(83.0 * KMH + delta, abs=1e-9)
    assert carried.learned_mps[1900] == pytest.approx(83.0 * KMH, abs=1e-9)
    # Far away, nothing changed, to the bit.
    np.testing.assert_array_equal(carried.learned_mps[:700], taught.learned_mps[:700])
    np.testing.assert_array_equal(carried.learned_mps[2400:], taught.learned_mps[2400:])


def test_carrying_a_strong_slowdown_on_a_much_lower_plan_keeps_the_car_moving() -> None:
    made = function(ROAD, learning_weight=1.0)
    speed = bent((0, 27), (1000, 27), (1001, LIMIT), (1400, LIMIT), (1450, 8), (1700, 8),
                 (1750, LIMIT), (2000, LIMIT), (2001, 27), (3000, 27))  # fmt: skip
    play_override(made, speed, brake=[(1400, 1800)])
    taught = made.learn()
    assert taught.learned_mps[1600] == pytest.approx(8.0)
    made = set_by([(1010.0, 2000.0, 25.0)], stored=after(made, taught))
    carried = made.learn().learned_mps
    assert carried.min() > 0.0
    assert carried[1600] <= 8.0


@settings(deadline=None, max_examples=12)
@given(
    hs.floats(1020.0, 1900.0),
    hs.floats(20.0, 900.0),
    hs.sampled_from([70.0, 78.0, 85.0, 99.0]),
)
def test_offsets_change_nothing_outside_their_limit_but_the_way_to_it(
    at: float, metres: float, kmh: float
) -> None:
    made = set_by([(at, min(at + metres, 2000.0), kmh)])
    learned = made.learn()
    base = np.array(made.profile.base_mps)
    assert not np.any(learned.offset_mps[:1000])
    assert not np.any(learned.offset_mps[2000:])
    np.testing.assert_array_equal(learned.learned_mps[:760], base[:760])
    np.testing.assert_array_equal(learned.learned_mps[2400:], base[2400:])
    untouched = learned.drive == 0.0
    np.testing.assert_array_equal(learned.learned_mps[untouched], base[untouched])


def test_in_the_closed_loop_the_offset_is_learned_from_where_the_lever_was_moved() -> None:
    car = driving(ROAD, 25.0)
    while car.s_m < 500.2:
        car.step()
    car.tip("lever_down_long")
    while car.s_m < 1500.0:
        car.step()
    learned = car.made.learn()
    assert_offset(learned.offset_mps, -5.0, 500, 1000)
    car = driving(ROAD, 25.0)
    car.made.follow(after(car.made, learned))
    while car.s_m < 1500.0:
        car.step()
        if 600.0 < car.s_m < 900.0:
            assert car.made.record.set_speed_mps == pytest.approx(95.0 * KMH)
            assert car.made.record.set_speed_offset_mps == 0.0
    assert car.made.record.set_speed_ns == 0


def test_an_override_at_another_set_speed_learns_both_layers() -> None:
    made = set_by(
        [(1010.0, 2000.0, 90.0)],
        bent((0, 27), (1000, 27), (1100, 25), (1400, 25), (1450, 27), (1800, 27), (1850, 25),
             (2000, 25), (2050, 27), (3000, 27))(np.arange(0.0, 3000.5, 0.5)),
        mode=np.where(
            (np.arange(0.0, 3000.5, 0.5) > 1400) & (np.arange(0.0, 3000.5, 0.5) < 1800),
            GAS_OVERRIDE, ACTIVE,
        ),
    )  # fmt: skip
    learned = made.learn()
    assert_offset(learned.offset_mps, 10.0, 1000, 2000)
    assert learned.learned_mps[1700] == pytest.approx(0.5 * (27.0 + 25.0), abs=0.01)
    assert learned.learned_mps[1300] == pytest.approx(25.0, abs=1e-9)
