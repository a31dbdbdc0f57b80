"""The line of a spiral against its closed form."""

from __future__ import annotations

import numpy as np
import pytest
from pldf.roads.geometry import LinearCurvature, Pose
from scipy.special import fresnel


@pytest.mark.parametrize("curvature_per_m", [0.004, 0.1, 0.5])
def test_a_spiral_is_fresnel_s_to_a_nanometre(curvature_per_m: float) -> None:
    length_m = 60.0
    spiral = LinearCurvature(Pose(0.0, 0.0, 0.0), length_m, 0.0, curvature_per_m)
    ds = np.linspace(0.0, length_m, 500)
    scale = np.sqrt(np.pi * length_m / curvature_per_m)
    sine, cosine = fresnel(ds / scale)
    for found, expected in zip(spiral.line(ds), (scale * cosine, scale * sine), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9)
