"""Following what was learned: the judge sees what it has to; a short campaign."""

from __future__ import annotations

import numpy as np
from laboratory import KMH, Array, road

from faults.following import EXPERIMENTS, can_be_saved, counted_steps, events, judge, road_of
from faults.hard_roads import hard_road
from faults.watched_drive import Seen

STEP_S = 0.01
BEND = road_of(road(1500.0, ((0.0, 100.0 * KMH),), [(700.0, 900.0, 0.01)]))  # cap 20 m/s
SIGN = road_of(road(1500.0, ((0.0, 100.0 * KMH), (700.0, 50.0 * KMH))))  # cap 70 km/h


def cruise(
    speed_mps: float, from_m: float = 0.0, to_m: float = 1400.0, manual: float = 0.0
) -> Seen:
    """A drive in ACTIVE at constant speed; the driver's hands were on for its first second."""
    s_m = np.arange(from_m, to_m, speed_mps * STEP_S)
    zero: Array = np.zeros(len(s_m))
    driver = np.where(np.arange(len(s_m)) < 100, 1.0, 0.0)
    return Seen(s_m, zero + speed_mps, zero, zero, zero + 2.0, driver, zero + manual)


def test_a_bend_taken_too_fast_is_a_violation() -> None:
    counts = judge(BEND, cruise(20.3), 0.2, STEP_S)
    assert counts["lateral_violations"] == 1.0
    assert counts["speed_violations"] == 0.0
    assert abs(counts["largest_lateral_mps2"] - 4.1209) < 1e-9
    assert judge(BEND, cruise(20.1), 0.2, STEP_S)["lateral_violations"] == 0.0  # 4.04, within 2 %


def test_a_lower_limit_passed_too_fast_is_a_violation() -> None:
    counts = judge(SIGN, cruise(71.0 * KMH), 0.2, STEP_S)
    assert counts["speed_violations"] == 1.0
    assert abs(counts["largest_over_cap_mps"] - 1.0 * KMH) < 1e-9
    assert judge(SIGN, cruise(70.4 * KMH), 0.2, STEP_S)["speed_violations"] == 0.0
    assert judge(SIGN, cruise(71.0 * KMH, manual=1.0), 0.2, STEP_S)["speed_violations"] == 0.0


def test_what_nobody_could_save_is_not_counted() -> None:
    """Hands off 1 s before a bend that is 10 m/s too fast: counted only from its end on."""
    seen = cruise(30.0, 640.0)
    counted = counted_steps(BEND, seen, 0.2, STEP_S)
    assert not np.any(counted[seen.s_m < 880.0])
    assert np.all(counted[seen.s_m > 905.0])


def test_full_braking_by_hand() -> None:
    """30 to 20 m/s takes 98.2 m: 6 m until the car answers, 40.9 m while the request falls."""
    seen = cruise(30.0, 500.0, 700.0)
    last = max(k for k in range(len(seen.s_m)) if can_be_saved(BEND, seen, k, 0.2))
    falling_m = 30.0 * 1.4 - 2.5 * 1.4**3 / 6.0
    speed = 30.0 - 2.5 * 1.4**2 / 2.0
    needed_m = 0.2 * 30.0 + falling_m + (speed**2 - 20.0**2) / 7.0
    assert abs(needed_m - 98.15) < 0.05
    assert abs(700.0 - seen.s_m[last] - needed_m) < 1.0


def test_events_are_counted_once() -> None:
    assert events(np.array([True, True, False, True, False, False, True])) == 3.0


def test_hard_roads_are_hard_and_always_the_same() -> None:
    roads = [hard_road(seed) for seed in range(20)]
    assert np.max([np.max(np.abs(r.curvature_per_m)) for r in roads]) > 1.0 / 16.0
    assert min(np.min(r.speed_limit_mps) for r in roads) == 20.0 * KMH
    assert max(np.max(np.abs(r.grade)) for r in roads) > 0.05
    np.testing.assert_array_equal(roads[3].curvature_per_m, hard_road(3).curvature_per_m)


def test_a_run_is_counted_for_most_of_its_way() -> None:
    (experiment,) = EXPERIMENTS
    done: list[int] = []
    counts = experiment.run(2, 2, done.append)
    assert done == [1, 2]
    assert counts["drives"] == 2 * 2 * 20
    assert counts["counted_steps"] > 0.5 * counts["active_steps"]
    assert counts["violations"] == 0.0, counts
