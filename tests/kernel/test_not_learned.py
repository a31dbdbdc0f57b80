"""What is not learned, and why: no intervention, holes, stops, places that are not eligible."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import (
    BASE,
    KMH,
    after,
    bent,
    changed,
    function,
    outcomes,
    override,
    play,
    play_override,
    road,
    travel_times,
)
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    ACTIVE,
    GAS_OVERRIDE,
    OUTCOME_HOLE,
    OUTCOME_LEARNED,
    OUTCOME_NOT_ELIGIBLE,
    OUTCOME_NOT_MOVED,
    OUTCOME_STOP,
)

BENT_ROAD = road(
    900.0,
    ((0.0, 100.0 * KMH), (300.0, 60.0 * KMH), (500.0, 80.0 * KMH)),
    [(120.0, 180.0, 0.008), (600.0, 680.0, 0.012)],
)
points = hs.lists(
    hs.tuples(hs.floats(0.0, 900.0), hs.floats(0.5, 50.0)), min_size=1, max_size=8
).map(lambda p: bent(*sorted(p)))


# No intervention


@settings(deadline=None, max_examples=30)
@given(points)
def test_a_deviation_without_intervention_is_never_learned(speed: object) -> None:
    made = function(BENT_ROAD)
    play_override(made, speed)  # type: ignore[arg-type]
    learned = made.learn()
    np.testing.assert_array_equal(learned.learned_mps, np.array(made.profile.base_mps))
    assert not np.any(learned.drive)
    assert not np.any(learned.offset_mps)


def test_a_drive_without_interventions_keeps_what_was_learned() -> None:
    made = override(31.0, 600.0, 1200.0)
    stored = after(made, made.learn())
    made = function(road(2000.0), stored)
    np.testing.assert_array_equal(made.profile.learned_mps, stored.iterations[-1].learned_mps)
    play_override(made, BASE)
    again = made.learn()
    np.testing.assert_array_equal(again.learned_mps, stored.iterations[-1].learned_mps)
    np.testing.assert_array_equal(again.drive, stored.iterations[-1].drive)


@pytest.mark.parametrize("apply_learned", [1, 0])
def test_what_is_still_to_be_decided_goes_with_the_profile_that_was_driven(
    apply_learned: int,
) -> None:
    """A drive of the base profile starts anew; after any other, all of it is carried over."""
    made = override(31.0, 600.0, 1200.0)
    nodes = len(made.profile.base_mps)
    pending = {"evidence_faster": np.full(nodes, 1.25), "pending_faster": np.ones(nodes)}
    stored = after(made, replace(made.learn(), **pending))
    made = function(road(2000.0), stored, apply_learned=apply_learned)
    play_override(made, BASE)
    again = made.learn()
    assert (again.number, again.kind) == (2, "drive")
    assert np.all(again.evidence_faster == 1.25 * apply_learned)
    assert np.all(again.pending_faster == apply_learned)
    assert bool(again.drive.any()) == bool(apply_learned)
    np.testing.assert_array_equal(again.base_mps, made.profile.base_mps)


def with_hole(first_m: float, last_m: float) -> DrivingFunction:
    """Overrides at 31 m/s from 600 to 800 m and 1200 to 1400 m; no sample between two places."""
    made = function(road(2000.0))
    s_m = np.arange(0.0, 2000.5, 0.5)
    speed = bent((0, BASE), (600, BASE), (601, 31), (800, 31), (801, BASE), (1200, BASE),
                 (1201, 31), (1400, 31), (1401, BASE), (2000, BASE))(s_m)  # fmt: skip
    gas = ((s_m >= 600) & (s_m < 800)) | ((s_m >= 1200) & (s_m < 1400))
    kept = (s_m <= first_m) | (s_m >= last_m)
    time = travel_times(s_m, speed)
    play(made, s_m[kept], speed[kept], time_s=time[kept], mode=np.where(gas, 3.0, 2.0)[kept])
    return made


@pytest.mark.parametrize(("hole_s", "lost"), [(1.4, False), (1.6, True)])
def test_a_hole_in_an_intervention_costs_that_one(hole_s: float, lost: bool) -> None:
    made = with_hole(650.0, 650.0 + 31.0 * hole_s)
    learned = made.learn().learned_mps
    kinds = (OUTCOME_HOLE if lost else OUTCOME_LEARNED, OUTCOME_LEARNED)
    assert tuple(outcomes(made)) == kinds
    assert np.any(learned[560:850] != BASE) == (not lost)
    np.testing.assert_allclose(learned[1250:1340], 0.5 * (BASE + 31.0), atol=0.02)


@pytest.mark.parametrize(("first_m", "last_m"), [(100.0, 150.0), (900.0, 1000.0), (1700.0, 1790.0)])
def test_a_hole_elsewhere_costs_nothing(first_m: float, last_m: float) -> None:
    whole = with_hole(0.0, 0.0).learn()
    made = with_hole(first_m, last_m)
    assert np.any(np.asarray(made.trace.gap))
    np.testing.assert_array_equal(made.learn().learned_mps, whole.learned_mps)
    assert tuple(outcomes(made)) == (OUTCOME_LEARNED, OUTCOME_LEARNED)


@pytest.mark.parametrize(("first_m", "last_m"), [(500.0, 560.0), (570.0, 640.0), (780.0, 840.0)])
def test_a_hole_where_it_began_was_stretched_to_or_ended_costs_it(
    first_m: float, last_m: float
) -> None:
    made = with_hole(first_m, last_m)
    learned = made.learn().learned_mps
    assert tuple(outcomes(made)) == (OUTCOME_HOLE, OUTCOME_LEARNED)
    np.testing.assert_array_equal(learned[:1000], BASE)


def test_a_run_ends_at_a_hole() -> None:
    """The driver is faster all the way; what lies behind the hole holds no intervention."""
    made = function(road(2000.0))
    s_m = np.arange(0.0, 2000.5, 0.5)
    kept = (s_m <= 1000.0) | (s_m >= 1060.0)
    mode = np.where((s_m >= 600) & (s_m < 700), GAS_OVERRIDE, ACTIVE)
    play(made, s_m[kept], 31.0, time_s=s_m[kept] / 31.0, mode=mode[kept])
    where = changed(made, made.learn().learned_mps)
    assert (where[0], where[-1]) == (0, 1000)


# A stop is a situation, not a wish


def test_of_a_stop_nothing_is_learned() -> None:
    made = function(road(2000.0))
    speed = bent((0, BASE), (900, BASE), (1086, 0.3), (1087, 0.3), (1500, BASE), (2000, BASE))
    play_override(made, speed, brake=[(920, 1086.5)])
    learned = made.learn().learned_mps
    np.testing.assert_array_equal(learned, made.profile.base_mps)
    assert list(outcomes(made)) == [OUTCOME_STOP]


def test_what_shares_its_run_with_a_stop_is_not_learned_either() -> None:
    """Gas to get going again: learned, it would slow down to a crawl where the car had stopped."""
    made = function(road(2000.0))
    speed = bent((0, BASE), (900, BASE), (1086, 0.3), (1087, 0.3), (1500, BASE), (1600, BASE),
                 (1601, 31), (1800, 31), (1801, BASE), (2000, BASE))  # fmt: skip
    play_override(made, speed, gas=[(1120, 1250), (1610, 1790)], brake=[(920, 1086.5)])
    learned = made.learn().learned_mps
    assert tuple(outcomes(made)) == (OUTCOME_STOP, OUTCOME_STOP, OUTCOME_LEARNED)
    np.testing.assert_array_equal(learned[:1500], BASE)
    assert learned[1700] > BASE + 0.5


def test_a_run_that_begins_at_standstill_is_not_learned() -> None:
    made = function(road(2000.0))
    play_override(made, bent((0, 0.5), (400, BASE), (2000, BASE)), gas=[(100, 300)])
    np.testing.assert_array_equal(made.learn().learned_mps, made.profile.base_mps)
    assert list(outcomes(made)) == [OUTCOME_STOP]


def test_slow_is_a_parameter() -> None:
    made = function(road(1000.0, ((0.0, 30.0 * KMH),)), learning_speed_min_mps=2.0)
    speed = bent((0, 8), (300, 8), (310, 2.5), (500, 2.5), (510, 8))
    play_override(made, speed, brake=[(250, 600)])
    assert made.learn().learned_mps[400] == pytest.approx(0.5 * (2.5 + 30.0 * KMH), abs=0.01)
    assert list(outcomes(made)) == [OUTCOME_LEARNED]


def test_nothing_is_learned_where_it_is_not_eligible() -> None:
    made = function(road(2000.0))
    s_m = np.arange(0.0, 2000.5, 0.5)
    play(
        made,
        s_m,
        np.where((s_m > 600.0) & (s_m < 1200.0), 31.0, BASE),
        mode=np.where((s_m > 600.0) & (s_m < 1200.0), GAS_OVERRIDE, ACTIVE),
        eligible=np.where((s_m > 800.0) & (s_m < 1000.0), 0.0, 1.0),
    )
    where = changed(made, made.learn().learned_mps)
    assert not np.any((where > 801) & (where < 1000))
    assert np.any(where < 800)
    assert np.any(where > 1001)
    assert list(outcomes(made)) == [OUTCOME_LEARNED]


def test_an_intervention_where_nothing_is_eligible_says_so() -> None:
    made = function(road(2000.0))
    s_m = np.arange(0.0, 2000.5, 0.5)
    gas = (s_m > 800.0) & (s_m < 900.0)
    play(made, s_m, 31.0, mode=np.where(gas, GAS_OVERRIDE, ACTIVE), eligible=0.0)
    np.testing.assert_array_equal(made.learn().learned_mps, made.profile.base_mps)
    assert list(outcomes(made)) == [OUTCOME_NOT_ELIGIBLE]


def test_a_press_whose_only_metre_the_next_one_takes_did_not_move() -> None:
    made = function(road(2000.0), learning_stretch_factor=0.0, learning_pedal_gap_s=0.0)
    s_m = np.concatenate(
        (np.arange(0.0, 500.0, 0.5), [500.0, 500.0], np.arange(500.5, 2000.0, 0.5))
    )
    mode = np.full(len(s_m), float(ACTIVE))
    mode[999] = GAS_OVERRIDE  # from 499.5 to 500 m
    mode[1001:1100] = GAS_OVERRIDE  # from 500 m on
    play(made, s_m, 29.0, time_s=np.arange(len(s_m)) / 58.0, mode=mode)
    made.learn()
    assert list(outcomes(made)) == [OUTCOME_NOT_MOVED, OUTCOME_LEARNED]


def test_a_press_in_a_standing_car_teaches_nothing_and_says_so() -> None:
    made = function(road(2000.0))
    s_m = np.concatenate((np.arange(0.0, 500.25, 0.5), np.full(20, 500.2), [501.0, 502.0]))
    mode = np.full(len(s_m), float(ACTIVE))
    mode[1005:1015] = GAS_OVERRIDE
    play(made, s_m, 10.0, time_s=0.05 * np.arange(len(s_m)), mode=mode)
    made.learn()
    assert list(outcomes(made)) == [OUTCOME_NOT_MOVED]
