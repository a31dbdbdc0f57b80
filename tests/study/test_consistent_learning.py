"""The study of slips: what it puts into a drive, and what it counts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pldf.instance import zeros
from pldf.kernel.arrays import ProfileArrays, RouteArrays, TraceArrays
from pldf.kernel.codes import LEARN_CONSISTENT
from pldf.study.loop import ModelArrays

from studies.consistent_learning import (
    HELD_S,
    PLACE_M,
    PRESSED_M,
    Run,
    press,
    slip_at,
    summaries,
    waits,
)


def drive_at(speed_mps: float) -> ModelArrays:
    nodes = 4 * PLACE_M
    trace = zeros(TraceArrays, nodes)
    trace.speed_mps[:] = speed_mps  # type: ignore[index]
    trace.active[:] = 1.0  # type: ignore[index]
    nothing: Any = None
    return ModelArrays(
        nothing, nothing, zeros(RouteArrays, nodes), zeros(ProfileArrays, nodes), trace
    )


@pytest.mark.parametrize("sign", [1, -1])
def test_a_slip_is_one_press_and_the_way_back(sign: int) -> None:
    """2.5 s of constant acceleration: distance and final speed by the textbook."""
    arrays = drive_at(20.0)
    start_m, end_m, _ = slip_at(arrays, 1, sign)
    strength = 2.0 if sign > 0 else -1.0
    assert start_m == PLACE_M + PRESSED_M
    assert end_m - start_m == pytest.approx(20.0 * HELD_S + 0.5 * strength * HELD_S**2)
    press(arrays, start_m, end_m, sign)
    speed = np.asarray(arrays.trace.speed_mps)
    assert speed[int(end_m)] == pytest.approx(20.0 + strength * HELD_S, abs=0.15)
    assert np.all(speed[: int(start_m) + 1] == 20.0)
    assert speed[-1] == 20.0
    assert np.all(sign * (speed - 20.0) >= 0.0)
    assert not np.asarray(arrays.trace.active)[int(start_m) + 1 : int(end_m) + 1].any()


def run_of(wished: list[list[int]], taught: list[list[int]]) -> Run:
    as_flags = [[np.array(row, dtype=bool) for row in rows] for rows in (wished, taught)]
    return Run(wished=as_flags[0], taught=as_flags[1], known=as_flags[0])


def test_waiting_is_counted_from_the_first_intervention_to_the_lesson() -> None:
    run = run_of([[0, 1, 0], [1, 1, 0], [1, 0, 0]], [[0, 0, 0], [0, 1, 0], [1, 0, 0]])
    assert sorted(waits(run)) == [2, 2]
    assert list(waits(run_of([[1]], [[0]]))) == []


def test_a_place_is_taught_wrongly_once_and_for_all() -> None:
    drives = [np.array([True, False, False]), np.array([False, False, False])]
    slips = [np.array([1, 0, -1]), np.array([0, 0, 0])]
    run = run_of([[1, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 0, 0]])
    run.wrong, run.accident = drives, slips
    run.rates = [(0.1, 0.0, 0.1), (0.2, 0.0, 0.2)]
    twin = run_of([[1, 0, 0], [0, 1, 0]], [[1, 0, 0], [0, 1, 0]])
    first, second = summaries([run], [twin], LEARN_CONSISTENT, 0.02)
    for row in (first, second):
        assert row["wrong_percent"] == pytest.approx(100.0 / 3.0)
        assert row["content_percent"] == pytest.approx(100.0 / 3.0)
        assert row["wrong_content_percent"] == 0.0
        assert row["pressed_percent"] == pytest.approx(200.0 / 3.0)
        assert row["passes_to_learn"] == 1.0
    assert second["pedal_percent"] == pytest.approx(20.0)
