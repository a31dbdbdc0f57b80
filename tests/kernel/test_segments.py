"""Where a learned segment ends: gaps below ``learning.segment_gap_s`` merge (section 3.4)."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import function, plain, road
from pldf.kernel.bounds import hard_cap, keep_bounds
from pldf.kernel.codes import BOUND_JERK, BOUND_LATERAL_ACCEL

SPEED_MPS = 16.0  # a metre takes 1/16 s: times are exact


def learns_behind_a_gap(metres: int) -> bool:
    """Tell whether a run without intervention is learned ``metres`` behind one with it."""
    made = plain(function(road(600.0, ((0.0, SPEED_MPS),)), learning_stretch_factor=0.0))
    nodes = len(made.route.limit_mps)
    second = 200 + metres
    np.asarray(made.trace.time_s)[:] = np.arange(nodes) / SPEED_MPS
    speed = np.asarray(made.trace.speed_mps)
    speed[:] = SPEED_MPS
    speed[100:201] = speed[second:401] = SPEED_MPS + 3.0
    np.asarray(made.trace.eligible)[:] = 1.0
    made.trace.start_m[0], made.trace.end_m[0] = 110.0, 190.0
    made.record.nodes, made.record.drive_interventions = nodes, 1
    learned = made.learn().learned_mps
    assert np.all(learned[100:201] > SPEED_MPS)
    return bool(np.any(learned[second:] > SPEED_MPS))


@pytest.mark.parametrize(("metres", "merged"), [(15, True), (16, False), (17, False)])
def test_a_gap_of_exactly_the_limit_does_not_merge(metres: int, merged: bool) -> None:
    assert learns_behind_a_gap(metres) == merged


def test_a_segment_grows_where_its_neighbours_could_not_slow_down_in_time() -> None:
    made = function(road(900.0, curves=[(500.0, 600.0, 0.04)]))
    speed, bound = np.full(len(made.route.limit_mps), 30.0), np.zeros(len(made.route.limit_mps))
    np.asarray(made.work.b)[:] = 0.0
    np.asarray(made.work.b)[500:601] = 1.0
    columns = (memoryview(speed), memoryview(bound))
    keep_bounds(made.record, made.route, *columns, made.work)  # type: ignore[arg-type]
    caps = [hard_cap(made.record, made.route, i) for i in range(500, 601)]
    assert max(caps[1:-1]) == pytest.approx(10.0)  # sqrt(4.0 / 0.04)
    assert np.all(speed[500:601] <= caps)
    slopes = 0.5 * np.diff(speed * speed)
    assert slopes.max() <= 2.0 + 1e-5
    assert slopes.min() >= -3.0 - 1e-5
    grown = np.flatnonzero(np.asarray(made.work.b) > 0.0)
    np.testing.assert_array_equal(np.flatnonzero(speed != 30.0), grown)
    # From 30 to 10 m/s at -3 m/s2 it takes 133 m; rounding both ends takes more.
    assert 500 - 200 < grown[0] < 500 - 133
    assert np.all(bound[501:600] == BOUND_LATERAL_ACCEL)
    assert np.all(bound[grown[(grown < 500) | (grown > 601)]] == BOUND_JERK)
    assert np.all(bound[speed == 30.0] == 0.0)
