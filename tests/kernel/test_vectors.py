"""Every number that the specification of the algorithm works out, section by section."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import KMH, after, bent, function, plain, play, play_override, road
from numpy.testing import assert_allclose
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.kernel.smoothing import parabola_at, smoothed_at
from pldf.kernel.stretch import stretch_factor, stretched_position

LENGTH_M = 1000.0


def free_road(speed_mps: float = 40.0, curve: tuple[tuple[float, float, float], ...] = ()):
    """A function without smoothing whose profile is ``speed_mps`` everywhere."""
    made = plain(function(road(LENGTH_M, ((0.0, 40.0),), curve)))
    np.asarray(made.profile.learned_mps)[:] = speed_mps
    return made


def alpha(made: DrivingFunction, k: int = 0) -> float:
    return stretch_factor(made.record, made.route, made.trace, k)


def preprocessed(made: DrivingFunction) -> np.ndarray:
    """The recorded speed with the stretched pieces inserted, per node."""
    made.learn()
    return np.array(made.work.a)


# Section 1


@pytest.mark.parametrize(("accel_min", "start_m"), [(-1.0, 710.65), (-1.5, 807.10)])
def test_braking_starts_where_it_must_for_a_lower_sign(accel_min: float, start_m: float) -> None:
    limits = ((0.0, 100.0 * KMH), (1000.0, 50.0 * KMH))
    made = function(
        road(2000.0, limits),
        planner_accel_min_mps2=accel_min,
        planner_jerk_max_mps3=0.0,
        learning_jerk_max_mps3=0.0,
    )
    base = np.array(made.profile.base_mps)
    first = int(np.flatnonzero(base < 100.0 * KMH)[0])
    since_m = ((100.0 * KMH) ** 2 - base[first] ** 2) / (-2.0 * accel_min)
    assert first - since_m == pytest.approx(start_m, abs=0.005)
    assert base[1000] == pytest.approx(50.0 * KMH, abs=1e-12)
    assert np.all(np.diff(base[first:1000]) < 0.0)


# Section 3.1


def test_resampling_drops_what_does_not_advance_and_keeps_the_lowest_speed_at_standstill() -> None:
    made = free_road()
    play(
        made,
        np.array([0.0, 10.0, 10.0, 10.0, 8.0, 12.0, 20.0]),
        np.array([10.0, 5.0, 0.0, 0.0, -0.5, 3.0, 8.0]),
        time_s=np.arange(7.0),
    )
    expected = np.interp(np.arange(21), [0, 10, 12, 20], [10, 0, 3, 8])
    assert (made.record.first_node, made.record.nodes) == (0, 21)
    assert_allclose(np.array(made.trace.speed_mps)[:21], expected, atol=1e-9)


# Section 3.2


def test_stretching_reaches_back_three_seconds_of_recorded_travel() -> None:
    made = free_road(40.0)
    # Braked at -1.5 m/s2 from far before until 25 m/s at 500 m.
    approach = np.arange(300.0, 500.0, 0.5)
    s_m = np.concatenate((approach, np.arange(500.0, 900.5, 0.5)))
    speed = np.concatenate(
        (
            np.sqrt(25.0**2 + 2.0 * 1.5 * (500.0 - approach)),
            np.interp(np.arange(500.0, 900.5, 0.5), [500, 600, 700, 800], [25, 27, 28, 26]),
        )
    )
    play(made, s_m, speed, mode=np.where((s_m >= 500) & (s_m < 800), GAS_OVERRIDE, ACTIVE))
    assert alpha(made) == pytest.approx(0.2725, abs=1e-5)
    places = [stretched_position(d, 800.0, alpha(made)) for d in (500, 600, 700, 800)]
    assert_allclose(places, [418.25, 545.5, 672.75, 800.0], atol=0.003)
    assert 500.0 - places[0] == pytest.approx(81.75, abs=0.003)
    v = preprocessed(made)
    assert_allclose(np.interp(places[1:], np.arange(len(v)), v), [30.0, 29.5, 26.0], atol=0.01)
    # The first sample lies between two nodes: the recorded approach joins the stretched piece.
    assert v[419] == pytest.approx(29.5 + 0.75 * 0.5 / 127.25, abs=0.01)


def test_constant_speed_option_reaches_back_three_seconds_times_the_first_speed() -> None:
    made = free_road()
    made.record.learning_stretch_time_mode = 1
    play_override(made, bent((0, 35), (500, 25), (600, 27), (700, 28), (800, 26)), gas=[(500, 800)])
    assert alpha(made) == pytest.approx(3.0 * 25.0 / 300.0)


def test_curvature_halves_the_stretching_and_the_piece_joins_the_recorded_speed() -> None:
    made = free_road(15.0, curve=((60.0, 160.0, 0.010),))
    play_override(
        made,
        bent((0, 20.5), (90, 20.5), (100, 20), (140, 24), (1000, 24)),
        gas=[(100, 140)],
    )
    assert alpha(made) == pytest.approx(0.25)
    places = [stretched_position(d, 140.0, alpha(made)) for d in range(100, 150, 10)]
    assert_allclose(places, [90, 102.5, 115, 127.5, 140])
    v = preprocessed(made)
    found = np.interp(places, np.arange(len(v)), v)
    assert_allclose(found, [20.5, 21.375, 22.25, 23.125, 24], atol=1e-9)


def test_stretching_does_not_reach_into_the_previous_intervention() -> None:
    made = free_road()
    play_override(made, 20.0, gas=[(100, 140), (150, 190)])
    assert made.record.drive_interventions == 2
    assert alpha(made, 1) == pytest.approx(0.25)
    assert stretched_position(150.0, 190.0, alpha(made, 1)) == pytest.approx(140.0)


# Sections 3.3 and 3.5


def offset_example(profile_mps: float) -> DrivingFunction:
    made = free_road(profile_mps)
    play_override(made, bent((0, 21), (80, 21), (100, 20), (140, 24), (1000, 24)), gas=[(100, 140)])
    return made


def test_offset_of_eq_2_joins_the_recorded_speed() -> None:
    v = preprocessed(offset_example(20.0))
    assert_allclose(v[[80, 95, 110, 125, 140]], [21, 21.75, 22.5, 23.25, 24], atol=1e-9)


def test_mean_of_eq_3_after_gas() -> None:
    learned = offset_example(20.0).learn().learned_mps
    places = [80, 95, 110, 125, 140]
    assert_allclose(learned[places], [20.5, 20.875, 21.25, 21.625, 22], atol=1e-9)


def test_mean_of_eq_3_after_braking() -> None:
    made = free_road(25.0)
    # No bounds: the example brakes harder than a learned profile may.
    made.record.learning_accel_min_mps2 = -10.0
    play_override(
        made, bent((0, 25), (200, 25), (230, 20), (260, 16), (1000, 16)), brake=[(200, 260)]
    )
    assert alpha(made) == pytest.approx(0.5)
    learned = made.learn().learned_mps
    assert_allclose(learned[[170, 215, 260]], [25, 22.5, 20.5], atol=1e-9)


# Section 3.6


def test_savitzky_golay_of_a_step_and_its_clamp() -> None:
    values = memoryview(np.array([20, 20, 20, 20, 22, 24, 24, 24, 24], dtype=float))
    smooth = [parabola_at(values, i, 2) for i in range(2, 7)]  # type: ignore[arg-type]
    assert_allclose(smooth, [19.8286, 20.3429, 22, 23.6571, 24.1714], atol=5e-5)
    clamped = [smoothed_at(values, i, 2) for i in range(2, 7)]  # type: ignore[arg-type]
    assert_allclose(clamped, [20, 20.3429, 22, 23.6571, 24], atol=5e-5)


# Section 3.7


@pytest.mark.parametrize(("set_at_m", "from_m"), [(1060.0, 1000), (1400.0, 1400)])
def test_set_speed_counts_from_the_sign_if_set_soon_after_it(set_at_m: float, from_m: int) -> None:
    made = function(road(2000.0, ((0.0, 100.0 * KMH), (1000.0, 80.0 * KMH))))
    s_m = np.arange(0.0, 2000.5, 0.5)
    play(
        made,
        s_m,
        np.where(s_m < 1000.0, 22.3, 22.2),
        set_speed_mps=np.where(s_m < set_at_m, 80.0 * KMH, 85.0 * KMH),
        set_speed_offset_mps=np.where(s_m < set_at_m, 0.0, 5.0 * KMH),
    )
    offset = made.learn().offset_mps
    assert np.all(offset[:from_m] == 0.0)
    assert_allclose(offset[from_m:], 5.0 * KMH, atol=1e-12)


def test_pedal_learning_averages_against_the_plan_with_the_new_offset() -> None:
    made = function(road(2000.0))
    play_override(
        made,
        bent((0, 30.5), (500, 30.5), (501, 33), (1500, 33), (1501, 30.5), (2000, 30.5)),
        gas=[(500, 1500)],
        set_speed_mps=110.0 * KMH,
        set_speed_offset_mps=10.0 * KMH,
    )
    learned = made.learn().learned_mps
    assert learned[1900] == pytest.approx(30.556, abs=5e-4)
    assert learned[1000] == pytest.approx(31.778, abs=5e-4)


# Section 3.8


def test_lateral_acceleration_bounds_what_is_learned() -> None:
    made = function(road(2000.0, curves=[(500.0, 1500.0, 0.010)]))
    assert made.profile.learned_mps[1000] == pytest.approx(15.811, abs=5e-4)
    play_override(made, 22.0, gas=[(500, 1500)])
    assert made.learn().learned_mps[1000] == pytest.approx(18.906, abs=5e-4)
    made = function(road(2000.0, curves=[(500.0, 1500.0, 0.010)]))
    play_override(made, 26.0, gas=[(500, 1500)])
    assert made.learn().learned_mps[1000] == pytest.approx(20.0, abs=1e-9)


# Section 3.9


def test_a_constant_wish_is_approached_by_halving() -> None:
    route = road(2000.0)
    made = function(route)
    missing = [10.0]
    for _ in range(3):
        play_override(made, 110.0 * KMH, gas=[(300, 1700)])
        stored = after(made, made.learn())
        made = function(route, stored)
        missing.append(110.0 - made.profile.learned_mps[1000] * 3.6)
    assert_allclose(missing, [10.0, 5.0, 2.5, 1.25], atol=1e-9)


# Section 4


def test_intervention_rates_are_shares_of_time() -> None:
    made = function(road(4500.0))
    time = np.linspace(0.0, 200.0, 2001)
    braked = (time >= 50.0) & (time < 58.0)
    gas = ((time >= 10.0) & (time < 14.0)) | ((time >= 30.0) & (time < 33.0))
    adjusted = (time >= 25.0) & (time < 60.0)
    play(
        made,
        20.0 * time,
        20.0,
        time_s=time,
        mode=np.where(gas, GAS_OVERRIDE, np.where(braked, STANDBY, ACTIVE)),
        brake_pedal=0.5 * braked,
        set_speed_mps=np.where(adjusted, 110.0 * KMH, 100.0 * KMH),
        set_speed_offset_mps=np.where(adjusted, 10.0 * KMH, 0.0),
    )
    made.refresh()
    st = made.record
    found = (st.rate_pedal, st.rate_set_speed, st.rate_combined)
    assert_allclose(found, (0.075, 0.175, 0.195), atol=1e-9)
