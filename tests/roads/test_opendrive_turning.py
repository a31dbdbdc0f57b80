"""Polynomials whose curvature at the knots says nothing about the road between them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import geometry, road
from pldf.roads import Route
from pldf.roads.knots import knots
from scipy.integrate import quad

Reader = Callable[..., Route]
Points = tuple[tuple[float, float], ...]

# By Bézier's four points, as drawing programs make them; a fillet of 3 m is a clean bend.
CUSP_BEHIND: Points = ((0, 0), (10, 0), (15, 5), (15, 5))
CUSP_BEFORE: Points = ((0, 0), (0, 0), (10, 0), (15, 5))
FILLET: Points = ((0, 0), (1.65, 0), (3, 1.35), (3, 3))


def _road(points: Points) -> tuple[str, float, float]:
    """Return a road of one cubic, its length, and by how much its heading changes."""
    p0, p1, p2, p3 = (complex(*point) for point in points)
    cubic = (p0, 3 * (p1 - p0), 3 * (p0 - 2 * p1 + p2), p3 - 3 * p2 + 3 * p1 - p0)
    slope = np.poly1d(cubic[::-1]).deriv()
    length = quad(lambda p: abs(slope(p)), 0.0, 1.0, epsabs=1e-10)[0]
    inner = np.angle(slope(np.linspace(1e-6, 1.0 - 1e-6, 10_001)))
    turn = float(np.sum(np.diff(np.unwrap(inner))))
    numbers = " ".join(
        f'{name}{axis}="{part!r}"'
        for axis, parts in (("U", np.real(cubic)), ("V", np.imag(cubic)))
        for name, part in zip("abcd", parts.tolist(), strict=True)
    )
    shape = f'<paramPoly3 {numbers} pRange="normalized"/>'
    return road("7", geometry(0, length, shape), length=length), length, turn


@pytest.mark.parametrize("points", [CUSP_BEHIND, CUSP_BEFORE])
def test_at_a_cusp_the_road_turns_as_its_heading_does(
    read: Reader, monkeypatch: pytest.MonkeyPatch, points: Points
) -> None:
    text, length, turn = _road(points)
    route = read(text)
    assert route.length_m == pytest.approx(length)
    assert np.trapezoid(route.curvature_per_m, route.s_m) == pytest.approx(turn, abs=0.01)
    assert np.max(np.abs(route.curvature_per_m)) < 0.5
    (note,) = route.notes
    assert note.severity == "note"
    assert str(note).startswith(str(note.file) + ", line 7, road 7, s = ")
    assert "a polynomial's infinite curvature is no turn of its line" in str(note)
    monkeypatch.setattr(knots, "_AT_ONCE", 3)
    np.testing.assert_array_equal(read(text).curvature_per_m, route.curvature_per_m)


def test_a_tight_bend_of_a_junction_keeps_its_curvature(read: Reader) -> None:
    text, _, turn = _road(FILLET)
    route = read(text)
    assert route.notes == ()
    assert np.trapezoid(route.curvature_per_m, route.s_m) == pytest.approx(turn, abs=2e-3)
    np.testing.assert_allclose(route.curvature_per_m, 1.0 / 3.0, rtol=0.05)
