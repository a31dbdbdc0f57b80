"""Learning from pedal interventions: what changes, by how much, and where."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import (
    BASE,
    KMH,
    after,
    bent,
    changed,
    function,
    outcomes,
    override,
    plain,
    play,
    play_override,
    road,
)
from pldf.kernel.codes import (
    ACTIVE,
    GAS_OVERRIDE,
    OUTCOME_LEARNED,
)


def test_half_of_the_deviation_is_learned_where_the_driver_intervened() -> None:
    learned = override(31.0, 600.0, 1200.0).learn().learned_mps
    np.testing.assert_allclose(learned[700:1150], 0.5 * (BASE + 31.0), atol=1e-9)


def test_learning_starts_before_the_pedal_was_pressed() -> None:
    made = override(31.0, 600.0, 1200.0)
    first = changed(made, made.learn().learned_mps)[0]
    assert 600.0 - 3.0 * BASE - 1.0 <= first < 560.0


def test_the_weight_of_the_driver_is_a_parameter() -> None:
    learned = override(31.0, 600.0, 1200.0, learning_weight=1.0).learn().learned_mps
    assert learned[900] == pytest.approx(31.0)
    learned = override(31.0, 600.0, 1200.0, learning_weight=0.0).learn().learned_mps
    np.testing.assert_array_equal(learned, np.full(2001, BASE))


@pytest.mark.parametrize("kmh", [0.2, 0.9, 1.1])
def test_an_intervention_teaches_however_small_it_is(kmh: float) -> None:
    made = override(BASE + kmh * KMH, 600.0, 1200.0)
    learned = made.learn().learned_mps
    np.testing.assert_allclose(learned[700:1150], BASE + 0.5 * kmh * KMH, atol=1e-9)
    assert list(outcomes(made)) == [OUTCOME_LEARNED]


def test_a_small_deviation_beside_an_intervention_is_not_learned() -> None:
    made = function(road(2000.0))
    speed = bent((0, BASE), (600, 31), (1200, 31), (1201, BASE + 0.9 * KMH), (2000, BASE))
    play_override(made, speed, gas=[(600, 1200)])
    assert changed(made, made.learn().learned_mps)[-1] <= 1201


@pytest.mark.parametrize(("gap_s", "pieces"), [(0.8, 1), (1.2, 2)])
def test_runs_merge_over_short_gaps(gap_s: float, pieces: int) -> None:
    made = function(road(2000.0), learning_stretch_factor=0.0)
    end = 900.0 + gap_s * BASE
    speed = bent((0, BASE), (600, BASE), (601, 31), (900, 31), (900.5, BASE), (end - 0.5, BASE),
                 (end, 31), (1200, 31), (1201, BASE))  # fmt: skip
    play_override(made, speed, gas=[(600, 1200)])
    where = changed(made, made.learn().learned_mps)
    assert np.count_nonzero(np.diff(where) > 1) == pieces - 1


def test_smooth_and_joined_to_the_unchanged_profile() -> None:
    made = override(31.0, 600.0, 1200.0)
    learned = made.learn().learned_mps
    assert np.abs(np.diff(learned)).max() < 0.12
    assert learned.max() <= 0.5 * (BASE + 31.0) + 1e-9
    assert learned.min() >= BASE


def test_cross_faded_to_the_unchanged_profile_at_both_ends() -> None:
    made = function(road(2000.0), learning_smoothing_window_m=1, learning_jerk_max_mps3=0.0)
    s_m = np.arange(0.0, 2000.5, 0.5)
    play(made, s_m, BASE + 0.5, mode=GAS_OVERRIDE, eligible=(s_m >= 800.0) & (s_m <= 1000.0))
    learned = made.learn().learned_mps
    first, last = changed(made, learned)[[0, -1]]
    fade = 0.25 * np.arange(1.0, 12.0) / 11.0
    np.testing.assert_allclose(learned[first : first + 11] - BASE, fade, atol=1e-9)
    np.testing.assert_allclose(learned[last : last - 11 : -1] - BASE, fade, atol=1e-9)


# Interventions at the ends


def test_an_intervention_still_active_at_the_end_is_learned_to_the_last_node() -> None:
    made = plain(function(road(1000.0)))
    s_m = np.arange(0.0, 800.75, 0.6)
    play(made, s_m, 31.0, mode=np.where(s_m < 500.0, ACTIVE, GAS_OVERRIDE))
    learned = made.learn().learned_mps
    last = made.record.first_node + made.record.nodes - 1
    assert last == 800
    assert made.trace.end_m[0] > last
    np.testing.assert_allclose(made.work.a[420 : last + 1], 31.0, atol=1e-9)
    # From the last metres on the car has to come back to the profile, at -3 m/s2.
    np.testing.assert_allclose(learned[420:785], 0.5 * (BASE + 31.0), atol=1e-9)
    np.testing.assert_array_equal(learned[last + 1 :], BASE)


def test_a_recording_of_a_part_of_the_route_teaches_that_part() -> None:
    made = function(road(2000.0))
    s_m = np.arange(500.3, 900.0, 0.5)
    play(made, s_m, 31.0, mode=GAS_OVERRIDE)
    where = changed(made, made.learn().learned_mps)
    assert (where[0], where[-1]) == (501, 899)


# Provenance


def test_every_change_names_its_drive_and_intervention() -> None:
    made = function(road(2000.0))
    speed = bent((0, BASE), (400, BASE), (401, 31), (600, 31), (601, BASE), (1000, BASE),
                 (1001, 31), (1200, 31), (1201, BASE))  # fmt: skip
    play_override(made, speed, gas=[(400, 600), (1000, 1200)])
    first = made.learn()
    assert first.number == 1
    assert first.interventions == 2
    where = changed(made, first.learned_mps)
    assert set(first.intervention[where[where < 700]]) == {1.0}
    assert set(first.intervention[where[where > 700]]) == {2.0}
    made = function(road(2000.0), after(made, first))
    play_override(made, bent((0, BASE), (1500, BASE), (1501, 24), (1600, 24), (1601, BASE)),
                  brake=[(1500, 1600)])  # fmt: skip
    second = made.learn()
    where = changed(made, second.learned_mps)
    assert where.min() > 1300
    assert set(second.drive[where]) == {2.0}
    assert set(second.intervention[where]) == {1.0}
    kept = np.setdiff1d(np.arange(2001), where)
    np.testing.assert_array_equal(second.drive[kept], first.drive[kept])
    np.testing.assert_array_equal(second.intervention[kept], first.intervention[kept])
