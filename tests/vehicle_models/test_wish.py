"""The hidden wish as a speed over the route."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from pldf.instance import zeros
from pldf.kernel.arrays import RouteArrays, Work

from vehicle_models.driver_state import DriverState
from vehicle_models.wish_kernel import WishArrays, prepare_wish


def route_arrays_of(limit: NDArray[np.float64], curvature: NDArray[np.float64]) -> RouteArrays:
    return RouteArrays(limit, curvature, np.zeros(0), np.zeros(0), np.zeros(0))


def wish_of(
    limit: NDArray[np.float64], curvature: NDArray[np.float64], **values: float
) -> WishArrays:
    wish, work = zeros(WishArrays, len(limit)), zeros(Work, len(limit))
    record = replace(DriverState(), **values)  # type: ignore[arg-type]
    prepare_wish(record, route_arrays_of(limit, curvature), wish, work)
    return wish


def test_wish_has_offset_anticipation_and_curve_speed() -> None:
    limit = np.where(np.arange(2000) < 1000, 20.0, 30.0)
    curvature = np.where(abs(np.arange(2000) - 1700) < 50, 0.01, 0.0)
    early = wish_of(limit, curvature, wish_offset_mps=2.0, wish_anticipation_s=3.0).wish_mps
    late = wish_of(limit, curvature, wish_offset_mps=2.0, wish_anticipation_s=0.0).wish_mps
    assert early[500] == late[500] == 22.0
    assert late[1000] == pytest.approx(22.0, abs=1e-9)
    assert early[936] > 22.0 + 0.001  # 3 s at 22 m/s are 66 m
    assert early[933] == pytest.approx(22.0, abs=1e-9)
    assert early[1700] == pytest.approx(np.sqrt(2.9 / 0.01), abs=1e-6)
    assert np.all(np.diff(np.square(early)) <= 2 * 1.5 + 1e-9)
    assert np.all(np.diff(np.square(early)) >= -2 * 1.3 - 1e-9)


def test_anticipation_does_not_skip_a_short_lower_limit() -> None:
    limit = np.full(1000, 30.0)
    limit[500:520] = 15.0
    wish = wish_of(limit, np.zeros(1000), wish_offset_mps=0.0, wish_anticipation_s=10.0).wish_mps
    assert wish[500] == pytest.approx(30.0, abs=1e-6)  # the whole of the short limit is ignored
    limit[400:500] = 20.0
    wish = wish_of(limit, np.zeros(1000), wish_offset_mps=0.0, wish_anticipation_s=10.0).wish_mps
    assert wish[499] <= 20.0
