"""Recording by metre, pedal interventions and the rates of a drive."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import (
    KMH,
    Array,
    PointMass,
    driving,
    function,
    play,
    play_override,
    road,
    within,
)
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, FAULT, GAS_OVERRIDE, OFF, STANDBY

quick = settings(deadline=None, max_examples=30)


def spans(made: DrivingFunction) -> list[tuple[float, float]]:
    """Positions of the recorded pedal interventions."""
    count = made.record.drive_interventions
    return list(zip(made.trace.start_m[:count], made.trace.end_m[:count], strict=True))


def rates(made: DrivingFunction) -> tuple[float, float, float]:
    made.refresh()
    st = made.record
    return st.rate_pedal, st.rate_set_speed, st.rate_combined


def timed(mode_at: dict[float, int], seconds: float = 60.0, **columns: Array) -> DrivingFunction:
    """20 m/s for a while, sampled at 50 Hz; ``mode_at`` says from when (s) which mode holds."""
    made = function(road(4000.0))
    time = np.linspace(0.0, seconds, round(50 * seconds) + 1)
    since = np.array(sorted(mode_at))
    codes = np.array([mode_at[t] for t in since])
    mode = codes[np.searchsorted(since, time + 1e-6, side="right") - 1]
    play(made, 20.0 * time, 20.0, time_s=time, mode=mode, **columns)
    return made


def pressed(first_s: float, last_s: float, seconds: float = 60.0) -> Array:
    time = np.linspace(0.0, seconds, round(50 * seconds) + 1)
    return 0.3 * within(time + 1e-6, [(first_s, last_s)])


# Interventions


def test_gas_counts_from_press_to_release() -> None:
    made = timed({0.0: ACTIVE, 10.0: GAS_OVERRIDE, 14.0: ACTIVE})
    assert spans(made) == [pytest.approx((200.0, 280.0))]
    assert rates(made) == pytest.approx((4 / 60, 0.0, 4 / 60))


def test_brake_counts_from_press_to_reactivation() -> None:
    made = timed({0.0: ACTIVE, 10.0: STANDBY, 15.0: ACTIVE}, brake_pedal=pressed(10.0, 11.0))
    assert spans(made) == [pytest.approx((200.0, 300.0))]
    assert rates(made)[0] == pytest.approx(5 / 60)


def test_brake_seen_one_sample_before_the_mode_counts_too() -> None:
    # In a co-simulation the mode answers to the pedal one communication step later.
    made = timed({0.0: ACTIVE, 10.0: STANDBY, 15.0: ACTIVE}, brake_pedal=pressed(9.98, 10.0))
    assert spans(made) == [pytest.approx((200.0, 300.0))]


def test_brake_out_of_an_override_is_one_intervention() -> None:
    modes = {0.0: ACTIVE, 10.0: GAS_OVERRIDE, 12.0: STANDBY, 15.0: ACTIVE}
    made = timed(modes, brake_pedal=pressed(12.0, 13.0))
    assert spans(made) == [pytest.approx((200.0, 300.0))]


@pytest.mark.parametrize(("gap_s", "count"), [(0.1, 1), (0.28, 1), (0.3, 2), (0.5, 2)])
def test_pedal_bounce_merges(gap_s: float, count: int) -> None:
    made = timed({0.0: ACTIVE, 10.0: GAS_OVERRIDE, 12.0: ACTIVE, 12.0 + gap_s: GAS_OVERRIDE,
                  14.0: ACTIVE})  # fmt: skip
    assert len(spans(made)) == count
    assert spans(made)[0][0] == pytest.approx(200.0)
    assert spans(made)[-1][1] == pytest.approx(280.0)
    # A merged gap belongs to the intervention, and so to the rate.
    pedal_s = 4.0 - (gap_s if count == 2 else 0.0)
    assert rates(made) == pytest.approx((pedal_s / 60, 0.0, pedal_s / 60))


def test_there_is_none_before_the_first_activation() -> None:
    made = timed({0.0: STANDBY, 20.0: ACTIVE}, brake_pedal=pressed(3.0, 5.0))
    assert spans(made) == []
    assert rates(made) == (0.0, 0.0, 0.0)


def test_the_cancel_lever_is_no_pedal_intervention() -> None:
    made = timed({0.0: ACTIVE, 10.0: STANDBY, 20.0: ACTIVE}, brake_pedal=pressed(12.0, 13.0))
    assert spans(made) == []


def test_the_cancel_lever_ends_an_override() -> None:
    made = timed({0.0: ACTIVE, 10.0: GAS_OVERRIDE, 12.0: STANDBY, 20.0: ACTIVE})
    assert spans(made) == [pytest.approx((200.0, 240.0))]


@pytest.mark.parametrize("mode", [OFF, FAULT])
def test_other_reasons_for_inactivity_are_no_pedal_intervention(mode: int) -> None:
    assert spans(timed({0.0: ACTIVE, 10.0: mode, 20.0: STANDBY, 30.0: ACTIVE})) == []


def test_still_active_at_the_end_is_closed_there_and_flagged() -> None:
    made = timed({0.0: ACTIVE, 50.0: GAS_OVERRIDE})
    assert spans(made) == [pytest.approx((1000.0, 1200.0))]
    assert rates(made)[0] == pytest.approx(10 / 60)
    assert "truncated" in made.learn().note
    assert "truncated" not in timed({0.0: ACTIVE}).learn().note


def test_lever_cancel_then_brake_in_the_closed_loop_is_no_intervention() -> None:
    car = driving(road(1000.0))
    car.step(lever_cancel=1)
    car.run(0.5, lever_cancel=0)
    car.run(0.5, driver_brake_pedal=0.3)
    assert car.made.record.drive_interventions == 0


# Rates


def test_rates_of_the_closed_loop_are_those_of_the_script() -> None:
    car = PointMass(function(road(4500.0), learning_deviation_min_mps=20.0), 22.0)
    for k in range(10_000):
        t = k * 0.01
        car.step(
            0.01,
            lever_resume=int(k < 10 or 28.95 < t < 29.05),
            lever_up=int(12.495 < t < 12.6),
            lever_down=int(29.995 < t < 30.1),
            driver_gas_pedal=0.05 * (4.995 < t < 6.995 or 14.995 < t < 16.495),
            driver_brake_pedal=0.1 * (24.995 < t < 25.2),
        )
    st = car.made.record
    assert st.rate_pedal == pytest.approx((2.0 + 1.5 + 3.96) / 100, abs=2e-4)
    assert st.rate_set_speed == pytest.approx(17.5 / 100, abs=2e-4)
    assert st.rate_combined == pytest.approx(19.5 / 100, abs=2e-4)
    assert st.drive_interventions == 3


@quick
@given(hs.lists(hs.tuples(hs.floats(0.0, 55.0), hs.floats(0.4, 5.0)), min_size=1, max_size=6))
def test_combined_rate_is_the_union(pieces: list[tuple[float, float]]) -> None:
    time = np.linspace(0.0, 60.0, 3001)
    gas = within(time, [(t, t + d) for t, d in pieces[::2]])
    adjusted = within(time, [(t, t + d) for t, d in pieces[1::2]])
    made = function(road(1300.0), learning_pedal_gap_s=0.0)
    play(
        made,
        20.0 * time,
        20.0,
        time_s=time,
        mode=np.where(gas, GAS_OVERRIDE, ACTIVE),
        set_speed_mps=np.where(adjusted, 30.0, 100.0 * KMH),
        set_speed_offset_mps=np.where(adjusted, 30.0 - 100.0 * KMH, 0.0),
    )
    expected = [np.mean(x[:-1]) for x in (gas, adjusted, gas | adjusted)]
    assert rates(made) == pytest.approx(tuple(expected), abs=1e-6)


# Trace


def rounded(low: float, high: float) -> hs.SearchStrategy[float]:
    return hs.floats(low, high).map(lambda x: round(x, 3))


@quick
@given(
    hs.lists(hs.tuples(rounded(-2.0, 8.0), rounded(0.0, 40.0)), min_size=1, max_size=40),
    rounded(0.0, 50.0),
)
def test_trace_is_the_resampled_recording(steps: list[tuple[float, float]], start: float) -> None:
    """Against section 3.1 written down with lists."""
    places = np.round(start + np.cumsum([d for d, _ in steps]), 3)
    speeds = np.array([v for _, v in steps])
    made = function(road(400.0))
    time = 0.1 * np.arange(len(steps))
    play(made, places, speeds, time_s=time)
    d, v, t = [places[0]], [speeds[0]], [0.0]
    for place, speed, now in zip(places[1:], speeds[1:], time[1:], strict=True):
        if place > d[-1]:
            d, v, t = [*d, place], [*v, speed], [*t, now]
        elif place == d[-1]:
            v[-1] = min(v[-1], speed)
    first, count = made.record.first_node, made.record.nodes
    nodes = np.arange(max(np.ceil(d[0]), 0.0), np.floor(d[-1]) + 1.0)
    assert count == len(nodes)
    if count:
        assert first == nodes[0]
        seen = slice(first, first + count)
        np.testing.assert_allclose(
            np.array(made.trace.speed_mps)[seen], np.interp(nodes, d, v), atol=1e-6
        )
        found = np.array(made.trace.time_s)[seen]
        np.testing.assert_allclose(found, np.interp(nodes, d, t), atol=1e-6)
        assert np.all(np.diff(found) >= 0.0)


def test_samples_without_progress_of_time_are_ignored() -> None:
    made = function(road(100.0))
    time = np.array([0.0, 1.0, 1.0, 0.5, 2.0])
    play(made, np.array([0.0, 10.0, 50.0, 60.0, 20.0]), 10.0, time_s=time)
    assert made.record.nodes == 21


def test_nodes_that_are_not_eligible_are_marked() -> None:
    made = function(road(300.0))
    s_m = np.arange(0.0, 300.5, 0.5)
    play(made, s_m, 2.7, eligible=np.where(s_m > 200.0, 0.0, 1.0))
    eligible = np.array(made.trace.eligible)
    assert np.all(eligible[:200] == 1.0)
    assert np.all(eligible[202:] == 0.0)


@pytest.mark.parametrize(("hole_s", "marked"), [(0.9, False), (1.6, True)])
def test_holes_in_the_recording_are_marked(hole_s: float, marked: bool) -> None:
    made = function(road(400.0))
    time = np.concatenate((np.arange(0.0, 5.0, 0.1), np.arange(5.0 + hole_s, 12.0, 0.1)))
    play(made, 20.0 * time, 20.0, time_s=time)
    gap = np.array(made.trace.gap)
    assert np.all(gap[101:117] == marked)
    assert not gap[:98].any()
    assert not gap[133:].any()


def test_standing_still_is_no_hole() -> None:
    made = function(road(400.0))
    time = np.arange(0.0, 30.0, 0.1)
    s_m = np.interp(time, [0, 10, 20, 30], [0, 100, 100, 200])
    play(made, s_m, np.where((time >= 10) & (time < 20), 0.0, 10.0), time_s=time)
    assert not np.any(made.trace.gap)
    assert made.trace.speed_mps[100] == 0.0


def test_a_second_drive_starts_with_an_empty_memory() -> None:
    route = road(400.0)
    made = function(route)
    play_override(made, 20.0, gas=[(100, 200)])
    made.prepare(route)
    assert made.record.drive_interventions == 0
    assert made.record.nodes == 0
    assert not np.any(made.trace.speed_mps)


def test_a_car_that_drives_over_the_end_is_recorded_up_to_the_last_node() -> None:
    made = function(road(100.0))
    s_m = np.arange(0.5, 103.0, 2.0)
    gas = s_m > 90.0
    play(made, s_m, 25.0, mode=np.where(gas, GAS_OVERRIDE, ACTIVE))
    st = made.record
    assert (st.first_node, st.first_node + st.nodes) == (0 if s_m[0] == 0.0 else 1, 101)
    assert spans(made) == [(90.5, 100.5)]  # behind the end nothing is recorded
