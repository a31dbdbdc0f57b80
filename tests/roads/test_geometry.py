"""Geometry of the reference line against independent truth."""

from __future__ import annotations

import numpy as np
import pytest
from pldf.kernel.arrays import FloatArray
from pldf.roads.opendrive.geometry import Geometries, Points
from pldf.roads.opendrive.polynomials import GeometryError, Polynomials
from scipy.special import fresnel

Cubic = tuple[float, float, float, float]
LINE: Cubic = (0.0, 1.0, 0.0, 0.0)
POSE = (10.0, -20.0, 0.7)


def _at(piece: Geometries, ds: FloatArray) -> Points:
    return piece.points(np.zeros(len(ds), dtype=np.intp), ds)


def test_an_arc_is_a_circle() -> None:
    ds = np.linspace(0.0, 150.0, 40)
    arc = _at(Geometries.linear(0.0, 0.0, 0.0, 150.0, -0.01, -0.01), ds)
    np.testing.assert_allclose(arc.x_m, 100.0 * np.sin(ds / 100.0), atol=1e-10)
    np.testing.assert_allclose(arc.y_m, -100.0 * (1.0 - np.cos(ds / 100.0)), atol=1e-10)
    np.testing.assert_allclose(arc.heading_rad, -ds / 100.0, atol=1e-14)
    np.testing.assert_array_equal(arc.curvature_per_m, -0.01)


def test_a_line_goes_where_its_heading_points() -> None:
    line = _at(Geometries.linear(*POSE, 80.0, 0.0, 0.0), np.array([0.0, 80.0]))
    np.testing.assert_allclose(line.x_m, [10.0, 10.0 + 80.0 * np.cos(0.7)], atol=1e-12)
    np.testing.assert_allclose(line.y_m, [-20.0, -20.0 + 80.0 * np.sin(0.7)], atol=1e-12)


@pytest.mark.parametrize("end", [0.004, -0.02, 0.02, 0.1, 0.5])
def test_a_spiral_from_a_straight_is_a_fresnel_integral_to_a_nanometre(end: float) -> None:
    length = 123.4
    ds = np.linspace(0.0, length, 557)
    spiral = _at(Geometries.linear(0.0, 0.0, 0.0, length, 0.0, end), ds)
    scale = np.sqrt(np.pi * length / abs(end))
    sine, cosine = fresnel(ds / scale)
    np.testing.assert_allclose(spiral.x_m, scale * cosine, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(spiral.y_m, np.sign(end) * scale * sine, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(spiral.curvature_per_m, end * ds / length, atol=1e-15)


def _traced(u: Cubic, v: Cubic, p_end: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arc length, heading and points of a cubic from its dense polygon alone."""
    p = np.linspace(0.0, p_end, 400_001)
    points = np.polyval(u[::-1], p) + 1j * np.polyval(v[::-1], p)
    steps = np.diff(points)
    arc = np.concatenate(([0.0], np.cumsum(np.abs(steps))))
    return arc, np.unwrap(np.angle(steps)), points


def _polynomial(u: Cubic, v: Cubic, p_end: float, length: float, *, scaled: bool) -> Polynomials:
    return Polynomials(
        np.array([[*u, *v]]), np.array([p_end]), np.array([length]), np.array([scaled]),
        np.array([7], dtype=np.intc),
    )  # fmt: skip


def _check_polynomial(
    u: Cubic, v: Cubic, p_end: float, length: float, *, scaled: bool = True
) -> None:
    """Compare with the polygon; ``scaled``: its arc length is stretched to ``length``."""
    piece = _polynomial(u, v, p_end, length, scaled=scaled)
    arc, heading, points = _traced(u, v, p_end)
    ds = np.linspace(0.02, 0.98, 50) * length
    along, h = ds * (arc[-1] / length if scaled else 1.0), 0.05
    middle = 0.5 * (arc[1:] + arc[:-1])
    turned = np.interp(along + h, middle, heading) - np.interp(along - h, middle, heading)
    curvature, angle, x, y = piece.points(np.zeros(50, dtype=np.intp), ds)
    placed = np.interp(along, arc, points.real) + 1j * np.interp(along, arc, points.imag)
    np.testing.assert_allclose(x + 1j * y, placed, atol=1e-3)
    np.testing.assert_allclose(angle, np.interp(along, middle, heading), atol=1e-4)
    np.testing.assert_allclose(curvature, turned / (2.0 * h), atol=2e-6)


def test_poly3_curvature_is_the_turn_of_its_line() -> None:
    _check_polynomial(LINE, (0.3, 0.1, 0.004, -0.00005), 60.0, 60.0, scaled=False)


@pytest.mark.parametrize("length", [52.0, 53.0])  # the curve is 52.6 m long
def test_normalized_param_poly3_curvature_is_the_turn_of_its_line(length: float) -> None:
    _check_polynomial((0.0, 50.0, -1.0, 2.0), (0.0, 0.0, 12.0, -1.0), 1.0, length)


def test_arc_length_param_poly3_curvature_is_the_turn_of_its_line() -> None:
    _check_polynomial((0.0, 1.0, 0.0, -1e-6), (0.0, 0.0, 0.002, -0.000004), 40.0, 40.0)


def test_a_polynomial_that_does_not_fit_its_length_is_refused() -> None:
    piece = _polynomial((0.0, 50.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), 50.0, 50.0, scaled=True)
    with pytest.raises(GeometryError, match="check length and pRange"):
        piece.points(np.zeros(1, dtype=np.intp), np.zeros(1))
    assert [line for line, _ in piece.faults()] == [7]
