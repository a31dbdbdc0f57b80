"""Learned profiles can be driven: the bounds of section 3.8, judged with numpy alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, Array, after, bent, function, play_override, road
from pldf.errors import ModelError
from pldf.function import DrivingFunction
from pldf.kernel.codes import BOUND_JERK, BOUND_LATERAL_ACCEL, BOUND_LEGAL_LIMIT, BOUND_NONE
from pldf.profiles.stored_profile import Iteration

from faults.drivable import bounded_again

BASE = 100.0 * KMH
JERK_MAX = 2.0
ROAD = road(
    900.0,
    ((0.0, 100.0 * KMH), (300.0, 60.0 * KMH), (500.0, 80.0 * KMH)),
    [(120.0, 180.0, 0.008), (600.0, 680.0, 0.012)],
)
spans = hs.tuples(hs.floats(0.0, 850.0), hs.floats(2.0, 200.0)).map(lambda x: (x[0], x[0] + x[1]))
speeds = hs.lists(
    hs.tuples(hs.floats(0.0, 900.0), hs.floats(3.0, 45.0)), min_size=1, max_size=8
).map(lambda p: bent(*sorted(p)))
drives = hs.lists(hs.tuples(speeds, spans, spans), min_size=1, max_size=3)


def jerk(learned: Array) -> Array:
    """Jerk of following a profile, per inner node: v/2 times the second difference of v^2."""
    b = learned**2
    return 0.5 * learned[1:-1] * np.abs(b[2:] - 2.0 * b[1:-1] + b[:-2])


def demanded(learned: Array, changed: Any) -> float:
    """The largest jerk whose second difference involves a node that was changed."""
    return float(jerk(learned)[changed[2:] | changed[1:-1] | changed[:-2]].max(initial=0.0))


def lesson(speed: float, first: float, last: float, **settings_: float) -> DrivingFunction:
    """2 km at 100 km/h, with the pedals at another speed between two places."""
    made = function(road(2000.0), **settings_)
    teach(made, speed, first, last)
    return made


def teach(made: DrivingFunction, speed: float, first: float, last: float) -> None:
    driven = bent((0, BASE), (first, BASE), (first + 1, speed), (last, speed), (last + 1, BASE))
    play_override(made, driven, brake=[(first, last)])


def taught_by(iteration: Iteration) -> Any:
    return iteration.drive == float(iteration.number)


@settings(deadline=None, max_examples=25)
@given(drives)
def test_following_demands_at_most_the_jerk_wherever_the_drive_taught(taught: Any) -> None:
    made = function(ROAD)
    for speed, gas, brake in taught:
        driven = np.array(made.profile.learned_mps)
        play_override(made, speed, [gas], [brake])
        iteration = made.learn()
        learned, here = iteration.learned_mps, taught_by(iteration)
        assert demanded(learned, here) <= JERK_MAX * (1.0 + 1e-3)
        np.testing.assert_array_equal(learned[~here], driven[~here])
        np.testing.assert_array_equal(bounded_again(made, learned, here), learned)
        made = function(ROAD, after(made, iteration))
        np.testing.assert_array_equal(made.profile.learned_mps, learned)


@settings(deadline=None, max_examples=15)
@given(speeds, spans, spans)
def test_the_jerk_bound_only_lowers(speed: Any, gas: Any, brake: Any) -> None:
    results = []
    for jerk_max in (0.0, JERK_MAX):
        made = function(ROAD, learning_jerk_max_mps3=jerk_max)
        play_override(made, speed, [gas], [brake])
        results.append(made.learn().learned_mps)
    without, bounded = results
    assert np.all(bounded <= without * (1.0 + 1e-12))
    assert bounded.min() >= without.min() * (1.0 - 1e-12)


def test_a_plateau_is_learned_in_full_and_its_transition_grows_beyond_the_segment() -> None:
    made = lesson(20.0, 800.0, 1400.0)
    iteration = made.learn()
    learned, segment = iteration.learned_mps, iteration.lessons > 0.0
    assert learned[1100] == pytest.approx(0.5 * (BASE + 20.0), abs=1e-9)
    grown = taught_by(iteration) & ~segment
    assert 20 < np.count_nonzero(grown) < 200
    assert np.all(iteration.bound[grown] == BOUND_JERK)
    assert np.all(iteration.intervention[grown] == 1.0)
    assert demanded(learned, taught_by(iteration)) == pytest.approx(JERK_MAX, rel=1e-3)


def test_without_a_jerk_bound_the_same_lesson_cannot_be_driven() -> None:
    learned = lesson(20.0, 800.0, 1400.0, learning_jerk_max_mps3=0.0).learn().learned_mps
    assert jerk(learned).max() > 10.0


def test_what_older_drives_taught_is_exempt() -> None:
    made = lesson(20.0, 800.0, 1100.0, learning_jerk_max_mps3=0.0)
    stored = after(made, made.learn())
    steep = stored.iterations[-1].learned_mps
    assert jerk(steep).max() > 10.0
    made = function(road(2000.0), stored)
    np.testing.assert_array_equal(made.profile.learned_mps, steep)
    teach(made, 31.0, 1600.0, 1800.0)
    iteration = made.learn()
    here = taught_by(iteration)
    assert np.flatnonzero(here)[0] > 1200
    np.testing.assert_array_equal(iteration.learned_mps[:1200], steep[:1200])
    assert demanded(iteration.learned_mps, here) <= JERK_MAX * (1.0 + 1e-3)


def test_adopting_under_a_lower_cap_cuts_and_bounds_jerk_around_the_cut() -> None:
    made = lesson(33.0, 600.0, 1400.0)
    stored = after(made, made.learn())
    fast = stored.iterations[-1].learned_mps
    bent_road = road(2000.0, curves=[(900.0, 1000.0, 0.004)])
    made = function(bent_road, replace(stored, base_mps=function(bent_road).profile.base_mps))
    followed = np.array(made.profile.learned_mps)
    assert fast[950] == pytest.approx(0.5 * (BASE + 33.0))
    np.testing.assert_array_equal(followed, fast)  # 31.6 m/s keep 4.0 m/s2
    made = function(bent_road, stored, learning_lateral_accel_max_mps2=3.0)
    followed = np.array(made.profile.learned_mps)
    assert followed[950] == pytest.approx(np.sqrt(3.0 / 0.004), abs=1e-9)
    cut = followed != fast
    assert demanded(followed, cut) <= JERK_MAX * (1.0 + 1e-3)
    assert 700 < np.flatnonzero(cut)[0] < 880
    assert set(np.array(made.profile.bound)[905:995]) == {BOUND_LATERAL_ACCEL}


def test_segments_of_one_drive_are_padded_with_the_profile_before_any_of_them() -> None:
    """15 m apart at 10 m/s: two runs, each within the other's smoothing window."""
    results = []
    for gas in ([(300.0, 400.0), (415.0, 500.0)], [(300.0, 400.0)], [(415.0, 500.0)]):
        made = function(
            road(900.0, ((0.0, 10.0),)), learning_stretch_factor=0.0, learning_jerk_max_mps3=0.0
        )
        at = np.arange(901.0)
        fast = np.any([(a <= at) & (at < b) for a, b in gas], axis=0)
        play_override(made, bent(*zip(at, np.where(fast, 12.0, 10.0), strict=True)), gas=gas)
        results.append(made.learn().learned_mps)
    both, first, second = results
    assert np.all(both[[350, 450]] > 10.5)
    np.testing.assert_array_equal(both[:407], first[:407])
    np.testing.assert_array_equal(both[408:], second[408:])


def test_each_node_keeps_how_many_lessons_shaped_it() -> None:
    made = lesson(20.0, 800.0, 1100.0)
    first = made.learn()
    assert set(first.lessons) == {0.0, 1.0}
    assert first.lessons[1000] == 1.0
    made = function(road(2000.0), after(made, first))
    at, speed = np.arange(2001.0), np.array(made.profile.learned_mps)
    speed[1000:1300] = 18.0
    play_override(made, bent(*zip(at, speed, strict=True)), brake=[(1000.0, 1300.0)])
    second = made.learn()
    assert (second.lessons[850], second.lessons[1080], second.lessons[1250]) == (1.0, 2.0, 1.0)


def test_an_offset_is_no_lesson() -> None:
    made = function(road(2000.0))
    offset = {"set_speed_mps": 110.0 * KMH, "set_speed_offset_mps": 10.0 * KMH}
    play_override(made, BASE, **offset)
    iteration = made.learn()
    assert iteration.learned_mps[1000] == pytest.approx(110.0 * KMH)
    assert not np.any(iteration.lessons)


def test_each_node_keeps_which_bound_cut_it_last() -> None:
    made = function(road(2000.0, curves=[(500.0, 1500.0, 0.010)]))
    play_override(made, 26.0, gas=[(500, 1500)])
    assert made.learn().bound[1000] == BOUND_LATERAL_ACCEL
    made = function(road(2000.0))
    play_override(made, 45.0, gas=[(500, 1500)])
    assert made.learn().bound[1000] == BOUND_LEGAL_LIMIT
    made = function(road(2000.0), after(made, made.learn()))
    teach(made, 30.0, 500.0, 1500.0)
    iteration = made.learn()
    assert iteration.lessons[1000] == 2.0
    assert iteration.bound[1000] == BOUND_NONE


@pytest.mark.parametrize(("planned", "allowed"), [(0.0, 2.0), (2.5, 2.0), (1.0, 0.5)])
def test_a_jerk_bound_below_the_planners_is_refused(planned: float, allowed: float) -> None:
    limits = {"planner_jerk_max_mps3": planned, "learning_jerk_max_mps3": allowed}
    with pytest.raises(ModelError, match=r"learning\.jerk_max_mps3 = .* planner\.jerk_max_mps3"):
        function(road(500.0), **limits)


@pytest.mark.parametrize(("planned", "allowed"), [(0.0, 0.0), (2.5, 0.0), (1.0, 1.0)])
def test_no_bound_and_one_as_strict_as_the_planners_are_taken(
    planned: float, allowed: float
) -> None:
    function(road(500.0), planner_jerk_max_mps3=planned, learning_jerk_max_mps3=allowed)
