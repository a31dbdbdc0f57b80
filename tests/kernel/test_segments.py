"""Where a learned segment ends: gaps below ``learning.segment_gap_s`` merge (section 3.4)."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import function, plain, road
from pldf.kernel.bounds import enforce_bounds, hard_cap

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
    np.asarray(made.trace.usable)[:] = 1.0
    made.trace.start_m[0], made.trace.end_m[0] = 110.0, 190.0
    made.record.nodes, made.record.drive_interventions = nodes, 1
    learned = made.learn().learned_mps
    assert np.all(learned[100:201] > SPEED_MPS)
    return bool(np.any(learned[second:] > SPEED_MPS))


@pytest.mark.parametrize(("metres", "merged"), [(15, True), (16, False), (17, False)])
def test_a_gap_of_exactly_the_limit_does_not_merge(metres: int, merged: bool) -> None:
    assert learns_behind_a_gap(metres) == merged


def test_hard_caps_win_over_neighbours_that_cannot_slow_down_in_time() -> None:
    made = function(road(900.0, curves=[(500.0, 600.0, 0.04)]))
    speed = np.full(len(made.route.limit_mps), 30.0)
    enforce_bounds(made.record, made.route, memoryview(speed), 500, 600)  # type: ignore[arg-type]
    caps = [hard_cap(made.record, made.route, i) for i in range(500, 601)]
    assert max(caps[1:-1]) == pytest.approx(10.0)  # sqrt(4.0 / 0.04)
    assert np.all(speed[500:601] <= caps)
