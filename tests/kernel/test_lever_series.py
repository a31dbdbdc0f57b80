"""Learning the set speed: series of presses, ends of a recording, holes, rounded logs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from laboratory import KMH, Array, function, play, travel_times
from lever_drives import ROAD, assert_offset, set_by
from pldf.function import DrivingFunction
from pldf.kernel.codes import OUTCOME_LEARNED, OUTCOME_NOT_ELIGIBLE, OUTCOME_TAKEN_BACK


def series(made: DrivingFunction) -> list[tuple[int, int, float, int]]:
    """From and to in m, offset in km/h and outcome of each series, after learning."""
    f, count = made.following, made.record.set_series
    columns = (f.set_from_m, f.set_to_m, f.set_offset_mps, f.set_outcome)
    rows = np.array([list(column)[:count] for column in columns]).T
    return [(int(a), int(b), round(v / KMH, 6), int(kind)) for a, b, v, kind in rows]


def test_presses_minutes_apart_are_two_wishes() -> None:
    made = set_by([(1400.0, 1700.0, 90.0), (1700.0, 2000.0, 82.0)])
    offset = made.learn().offset_mps / KMH
    np.testing.assert_allclose(offset[1400:1700], 10.0)
    np.testing.assert_allclose(offset[1701:2000], 2.0)
    assert not np.any(offset[:1400])
    assert not np.any(offset[2000:])
    learned = OUTCOME_LEARNED
    assert series(made) == [(1400, 1701, 10.0, learned), (1700, 2000, 2.0, learned)]


@pytest.mark.parametrize(("apart_m", "wishes"), [(105.0, 1), (115.0, 2)])
def test_presses_up_to_five_seconds_apart_are_one_series(apart_m: float, wishes: int) -> None:
    # 22.2 m/s: five seconds are 111 m. Three presses, each as far behind the one before.
    places = [1400.0 + k * apart_m for k in range(3)] + [2000.0]
    made = set_by([(a, b, 81.0 + k) for k, (a, b) in enumerate(pairwise(places))])
    offset = made.learn().offset_mps / KMH
    assert len(np.unique(offset[1450:2000].round(6))) == (1 if wishes == 1 else 3)
    assert offset[1900] == pytest.approx(3.0)


def test_an_offset_taken_back_within_its_series_teaches_nothing_and_says_so() -> None:
    made = set_by([(1400.0, 1440.0, 85.0)])
    assert not np.any(made.learn().offset_mps)
    assert series(made) == [(1400, 1441, 0.0, OUTCOME_TAKEN_BACK)]


def test_a_press_and_its_correction_are_one_series() -> None:
    made = set_by([(1400.0, 1440.0, 85.0), (1500.0, 2000.0, 90.0)])
    assert_offset(made.learn().offset_mps, 10.0, 1400, 2000)


# Where the recording begins and ends


def part(first_m: float, last_m: float, pieces: list[tuple[float, float, float]]) -> Array:
    """Learned offsets in km/h of a recording of a part of the road."""
    made = function(ROAD)
    s_m = np.arange(first_m, last_m, 0.5)
    automatic = np.array(made.route.limit_mps)[s_m.astype(int)]
    set_speed = automatic.copy()
    for first, last, kmh in pieces:
        set_speed[(s_m >= first) & (s_m < last)] = kmh * KMH
    speed = np.minimum(automatic, 27.0)
    offset = set_speed - automatic
    play(made, s_m, speed, set_speed_mps=set_speed, set_speed_offset_mps=offset)
    return made.learn().offset_mps / KMH


def test_an_offset_still_active_when_the_recording_ends_holds_to_the_end_of_the_limit() -> None:
    offset = part(0.0, 1600.0, [(1400.0, 3000.0, 85.0)])
    np.testing.assert_allclose(offset[1400:2000], 5.0)
    assert not np.any(offset[:1400])
    assert not np.any(offset[2000:])


def test_at_the_last_limit_it_holds_to_the_end_of_the_road() -> None:
    learned = set_by([(2400.0, 3001.0, 110.0)]).learn()
    np.testing.assert_allclose(learned.offset_mps[2400:] / KMH, 10.0)
    assert learned.learned_mps[-1] == pytest.approx(110.0 * KMH)


@pytest.mark.parametrize("first_m", [1010.0, 1300.0])
def test_a_recording_that_begins_is_no_new_limit(first_m: float) -> None:
    offset = part(first_m, 1990.0, [(first_m + 40.0, 3000.0, 85.0)])
    assert not np.any(offset[: int(first_m) + 40])
    np.testing.assert_allclose(offset[int(first_m) + 40 : 2000], 5.0)


def test_one_that_begins_where_the_limit_does_knows_all_of_it() -> None:
    offset = part(0.0, 900.0, [(40.0, 3000.0, 105.0)])
    np.testing.assert_allclose(offset[:1000], 5.0)


def test_an_offset_active_from_the_first_sample_on_is_adopted_from_there() -> None:
    offset = part(1300.0, 1990.0, [(0.0, 3000.0, 85.0)])
    assert not np.any(offset[:1300])
    np.testing.assert_allclose(offset[1301:2000], 5.0)


# Where nothing may be learned, and where the recording has a hole


def test_metres_that_are_not_eligible_take_no_offset() -> None:
    s_m = np.arange(0.0, 3000.5, 0.5)
    eligible = np.where((s_m > 1600.0) & (s_m < 1700.0), 0.0, 1.0)
    offset = set_by([(1400.0, 2000.0, 85.0)], eligible=eligible).learn().offset_mps / KMH
    np.testing.assert_allclose(offset[1400:1600], 5.0)
    assert not np.any(offset[1602:1700])
    np.testing.assert_allclose(offset[1702:2000], 5.0)


def test_a_series_begun_where_it_is_not_eligible_teaches_nothing() -> None:
    s_m = np.arange(0.0, 3000.5, 0.5)
    eligible = np.where((s_m > 1350.0) & (s_m < 1500.0), 0.0, 1.0)
    made = set_by([(1400.0, 2000.0, 85.0)], eligible=eligible)
    learned = made.learn()
    assert not np.any(learned.offset_mps)
    np.testing.assert_array_equal(learned.learned_mps, made.profile.base_mps)
    assert series(made) == [(1400, 2000, 0.0, OUTCOME_NOT_ELIGIBLE)]


def with_hole(pieces: list[tuple[float, float, float]], first_m: float, last_m: float) -> Array:
    """Learned offsets in km/h of a recording without samples between two places."""
    whole, made = set_by([]), function(ROAD)
    s_m = np.arange(0.0, 3000.5, 0.5)
    kept = (s_m <= first_m) | (s_m >= last_m)
    automatic = np.array(made.route.limit_mps)[s_m.astype(int)]
    set_speed = automatic.copy()
    for first, last, kmh in pieces:
        set_speed[(s_m >= first) & (s_m < last)] = kmh * KMH
    speed = np.minimum(automatic, 27.0)
    columns = {"time_s": travel_times(s_m, speed), "set_speed_mps": set_speed}
    columns["set_speed_offset_mps"] = set_speed - automatic
    play(made, s_m[kept], speed[kept], **{name: c[kept] for name, c in columns.items()})
    assert whole.record.nodes == made.record.nodes
    return made.learn().offset_mps / KMH


def test_a_set_speed_that_is_the_same_behind_a_hole_has_held() -> None:
    offset = with_hole([(1400.0, 2000.0, 85.0)], 1600.0, 1680.0)
    np.testing.assert_allclose(offset[1400:2000], 5.0)


def test_a_set_speed_changed_within_a_hole_counts_from_behind_it() -> None:
    offset = with_hole([(1400.0, 1640.0, 85.0), (1640.0, 2000.0, 90.0)], 1600.0, 1680.0)
    np.testing.assert_allclose(offset[1400:1600], 5.0)
    assert not np.any(offset[1602:1679])
    np.testing.assert_allclose(offset[1682:2000], 10.0)


# Logs that are rounded


@pytest.mark.parametrize("decimals", [1, 2, 4])
def test_a_rounded_set_speed_teaches_what_the_exact_one_does(decimals: int) -> None:
    def learned(rounded: bool) -> tuple[Array, float]:
        made = function(ROAD)
        s_m = np.arange(0.0, 3000.5, 0.5)
        automatic = np.array(made.route.limit_mps)[s_m.astype(int)]
        set_speed = np.where((s_m >= 1500.0) & (s_m < 2000.0), 95.0 * KMH, automatic)
        if rounded:
            set_speed = set_speed.round(decimals)
        play(made, s_m, np.minimum(automatic, 27.0), set_speed_mps=set_speed,
             set_speed_offset_mps=set_speed - automatic)  # fmt: skip
        return made.learn().offset_mps, made.record.set_speed_ns / made.record.total_ns

    (exact, rate), (seen, seen_rate) = learned(False), learned(True)
    np.testing.assert_allclose(seen, exact, atol=0.5 * 10.0**-decimals + 1e-9)
    assert seen_rate == rate
    assert 0.1 < rate < 0.3
