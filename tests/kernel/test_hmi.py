"""What the cluster announces: the next speed and where the car has reached it."""

from __future__ import annotations

import numpy as np
import pytest
from pldf.kernel.arrays import FloatArray
from pldf.kernel.reasons import find_turns


def profile(acceleration_mps2: float) -> FloatArray:
    """20 m/s, from 100 to 200 m with this acceleration, then constant to 300 m."""
    driven_m = np.clip(np.arange(301.0) - 100.0, 0.0, 100.0)
    speed: FloatArray = np.sqrt(20.0**2 + 2.0 * acceleration_mps2 * driven_m)
    return speed


@pytest.mark.parametrize("acceleration_mps2", [1.0, 0.3, 0.06, -0.06, -0.3, -1.0])
def test_the_next_speed_is_that_at_the_end_of_the_next_phase(acceleration_mps2: float) -> None:
    turn_m = np.zeros(301)
    find_turns(profile(acceleration_mps2), turn_m)
    np.testing.assert_array_equal(turn_m[:200], 200.0)
    np.testing.assert_array_equal(turn_m[200:], 300.0)


@pytest.mark.parametrize("acceleration_mps2", [0.04, -0.04])
def test_a_drift_nobody_feels_is_no_phase(acceleration_mps2: float) -> None:
    turn_m = np.zeros(301)
    find_turns(profile(acceleration_mps2), turn_m)
    np.testing.assert_array_equal(turn_m, 300.0)
