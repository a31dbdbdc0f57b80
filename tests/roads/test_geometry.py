"""Geometry of the reference line against independent truth."""

from __future__ import annotations

import numpy as np
import pytest
from pldf.roads.geometry import Cubic, LinearCurvature, Polynomial, Pose, param_poly3, poly3
from scipy.special import fresnel

POSE = Pose(10.0, -20.0, 0.7)


def test_an_arc_is_a_circle() -> None:
    ds = np.linspace(0.0, 150.0, 40)
    arc = LinearCurvature(Pose(0.0, 0.0, 0.0), 150.0, -0.01, -0.01)
    x, y = arc.line(ds)
    np.testing.assert_allclose(x, 100.0 * np.sin(ds / 100.0), atol=1e-10)
    np.testing.assert_allclose(y, -100.0 * (1.0 - np.cos(ds / 100.0)), atol=1e-10)
    np.testing.assert_array_equal(arc.curvature(ds), -0.01)


def test_a_line_goes_where_its_heading_points() -> None:
    x, y = LinearCurvature(POSE, 80.0, 0.0, 0.0).line(np.array([0.0, 80.0]))
    np.testing.assert_allclose(x, [10.0, 10.0 + 80.0 * np.cos(0.7)], atol=1e-12)
    np.testing.assert_allclose(y, [-20.0, -20.0 + 80.0 * np.sin(0.7)], atol=1e-12)


@pytest.mark.parametrize("end", [0.02, -0.02])
def test_a_spiral_from_a_straight_is_a_fresnel_integral(end: float) -> None:
    length = 123.4
    ds = np.linspace(0.0, length, 57)
    spiral = LinearCurvature(Pose(0.0, 0.0, 0.0), length, 0.0, end)
    scale = np.sqrt(np.pi * length / abs(end))
    sine, cosine = fresnel(ds / scale)
    x, y = spiral.line(ds)
    np.testing.assert_allclose(x, scale * cosine, atol=1e-9)
    np.testing.assert_allclose(y, np.sign(end) * scale * sine, atol=1e-9)
    np.testing.assert_allclose(spiral.curvature(ds), end * ds / length, atol=1e-15)


@pytest.mark.parametrize("curvature_per_m", [0.004, 0.1, 0.5])
def test_a_spiral_is_fresnel_s_to_a_nanometre(curvature_per_m: float) -> None:
    length_m = 60.0
    spiral = LinearCurvature(Pose(0.0, 0.0, 0.0), length_m, 0.0, curvature_per_m)
    ds = np.linspace(0.0, length_m, 500)
    scale = np.sqrt(np.pi * length_m / curvature_per_m)
    sine, cosine = fresnel(ds / scale)
    for found, expected in zip(spiral.line(ds), (scale * cosine, scale * sine), strict=True):
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9)


def _traced(u: Cubic, v: Cubic, p_end: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arc length, heading and points of a cubic from its dense polygon alone."""
    p = np.linspace(0.0, p_end, 400_001)
    points = np.polyval(u[::-1], p) + 1j * np.polyval(v[::-1], p)
    steps = np.diff(points)
    arc = np.concatenate(([0.0], np.cumsum(np.abs(steps))))
    return arc, np.unwrap(np.angle(steps)), points


def _check_polynomial(
    piece: Polynomial, p_end: float, length: float, *, scaled: bool = True
) -> None:
    """Compare with the polygon; ``scaled``: its arc length is stretched to ``length``."""
    arc, heading, points = _traced(piece.u, piece.v, p_end)
    ds = np.linspace(0.02, 0.98, 50) * length
    along, h = ds * (arc[-1] / length if scaled else 1.0), 0.05
    middle = 0.5 * (arc[1:] + arc[:-1])
    turned = np.interp(along + h, middle, heading) - np.interp(along - h, middle, heading)
    x, y = piece.line(ds)
    placed = complex(POSE.x_m, POSE.y_m) + np.exp(1j * POSE.heading_rad) * (
        np.interp(along, arc, points.real) + 1j * np.interp(along, arc, points.imag)
    )
    np.testing.assert_allclose(x + 1j * y, placed, atol=1e-3)
    np.testing.assert_allclose(piece.curvature(ds), turned / (2.0 * h), atol=2e-6)


def test_poly3_curvature_is_the_turn_of_its_line() -> None:
    piece = poly3(POSE, 60.0, (0.3, 0.1, 0.004, -0.00005))
    _check_polynomial(piece, 60.0, 60.0, scaled=False)


@pytest.mark.parametrize("length", [52.0, 53.0])  # the curve is 52.6 m long
def test_normalized_param_poly3_curvature_is_the_turn_of_its_line(length: float) -> None:
    u: Cubic = (0.0, 50.0, -1.0, 2.0)
    v: Cubic = (0.0, 0.0, 12.0, -1.0)
    _check_polynomial(param_poly3(POSE, length, u, v, normalized=True), 1.0, length)


def test_arc_length_param_poly3_curvature_is_the_turn_of_its_line() -> None:
    u: Cubic = (0.0, 1.0, 0.0, -1e-6)
    v: Cubic = (0.0, 0.0, 0.002, -0.000004)
    _check_polynomial(param_poly3(POSE, 40.0, u, v, normalized=False), 40.0, 40.0)


def test_a_polynomial_that_does_not_fit_its_length_is_refused() -> None:
    with pytest.raises(ValueError, match="check length and pRange"):
        param_poly3(POSE, 50.0, (0.0, 50.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), normalized=False)
