"""Drives of a road with three limits whose driver moves the set speed."""

from __future__ import annotations

from typing import Any

import numpy as np
from laboratory import KMH, Array, function, play, road
from pldf.function import DrivingFunction
from pldf.profiles.stored_profile import StoredProfile

LIMIT = 80.0 * KMH
# A sign at 1000 m that matters, and one at 2000 m that ends it.
ROAD = road(3000.0, ((0.0, 100.0 * KMH), (1000.0, LIMIT), (2000.0, 100.0 * KMH)))


def set_by(
    pieces: list[tuple[float, float, float]],
    speed: Array | None = None,
    stored: StoredProfile | None = None,
    **columns: Any,
) -> DrivingFunction:
    """Drive the road; ``pieces`` are (from m, to m, absolute set speed in km/h)."""
    made = function(ROAD, stored)
    s_m = np.arange(0.0, 3000.5, 0.5)
    cells = s_m.astype(int)
    automatic = (np.array(made.route.limit_mps) + np.array(made.profile.offset_mps))[cells]
    set_speed = automatic.copy()
    for first, last, kmh in pieces:
        set_speed[(s_m >= first) & (s_m < last)] = kmh * KMH
    driven = np.minimum(automatic, 27.0) if speed is None else speed
    play(
        made,
        s_m,
        driven,
        set_speed_mps=set_speed,
        set_speed_offset_mps=set_speed - automatic,
        **columns,
    )
    return made


def assert_offset(offset: Array, kmh: float, first: int, last: int) -> None:
    """Offset of ``kmh`` in the cells from ``first`` up to the one that ends at ``last``."""
    expected = np.zeros(len(offset))
    expected[first:last] = kmh * KMH
    np.testing.assert_allclose(offset, expected, atol=1e-9)
