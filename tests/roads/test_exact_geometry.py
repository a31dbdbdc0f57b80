"""What a clean map says comes out of a whole reading as it is, driven along and against it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from opendrive_text import geometry, lane, lanes, road
from pldf.roads import Route
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import fresnel

Reader = Callable[..., Route]
BOTH_WAYS = lanes(
    '<laneSection s="0">' + lane("", side="left", lane_id=1) + lane("") + "</laneSection>"
)


class Part(NamedTuple):
    """Length, and the curvature at both ends."""

    length_m: float
    first: float
    last: float


# Nothing ends at a whole metre.
PARTS = (
    Part(13.7, 0.0, 0.0), Part(41.31, 0.0, 0.021), Part(27.93, 0.021, 0.021),
    Part(33.337, 0.021, -0.015), Part(19.007, -0.015, 0.0), Part(0.83, 0.0, 0.0012),
    Part(150.019, 0.0012, 0.0012), Part(1.401, 0.0012, 0.0), Part(22.222, 0.0, 0.0),
)  # fmt: skip


def _way(part: Part, heading: float, ds: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the way from the start of a part: Fresnel's integrals, a circle or a straight."""
    rate = (part.last - part.first) / part.length_m
    if rate != 0.0:
        scale = np.sqrt(np.pi / abs(rate))
        sines, cosines = fresnel((np.append(ds, 0.0) + part.first / rate) / scale)
        curve = cosines + 1j * np.sign(rate) * sines
        turn = heading - 0.5 * part.first**2 / rate
        return scale * np.exp(1j * turn) * (curve[:-1] - curve[-1])
    if part.first != 0.0:
        return np.exp(1j * heading) * (np.exp(1j * part.first * ds) - 1.0) / (1j * part.first)
    return ds * np.exp(1j * heading)


def _shape(part: Part) -> str:
    if part.first != part.last:
        return f'<spiral curvStart="{part.first!r}" curvEnd="{part.last!r}"/>'
    return f'<arc curvature="{part.first!r}"/>' if part.first else "<line/>"


@pytest.mark.parametrize("reverse", [False, True])
def test_clothoids_arcs_and_lines_are_exact_to_a_nanometre(read: Reader, reverse: bool) -> None:
    s_m, at, heading, plan = 0.0, 5e3 - 7e3j, 2.1, ""
    starts = []
    for part in PARTS:
        starts.append((s_m, at, heading))
        pose = f'x="{at.real!r}" y="{at.imag!r}" hdg="{heading!r}"'
        plan += geometry(s_m, part.length_m, _shape(part), pose)
        at += complex(_way(part, heading, np.array([part.length_m]))[0])
        heading += 0.5 * (part.first + part.last) * part.length_m
        s_m += part.length_m
    route = read(road("1", plan, length=s_m, inside=BOTH_WAYS), start_road="1", reverse=reverse)
    assert route.notes == ()
    own_m = s_m - route.s_m if reverse else route.s_m
    # The middles between knots tell which part a knot belongs to, the last one to the last part.
    along = np.minimum(own_m[:-1], own_m[1:])
    part_of = np.searchsorted([s for s, _, _ in starts], along + 1e-7, side="right") - 1
    for k, part in enumerate(PARTS):
        knots = np.flatnonzero(part_of == k) + (1 if reverse else 0)
        ds = own_m[knots] - starts[k][0]
        line = starts[k][1] + _way(part, starts[k][2], ds)
        np.testing.assert_allclose(route.x_m[knots], line.real, rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(route.y_m[knots], line.imag, rtol=0.0, atol=1e-9)
        curvature = part.first + (part.last - part.first) * ds / part.length_m
        curvature = -curvature if reverse else curvature
        np.testing.assert_allclose(route.curvature_per_m[knots], curvature, rtol=0.0, atol=1e-12)
    assert set(range(1, int(s_m))) <= set(route.s_m.tolist())


CUBIC = {"aU": 0.0, "bU": 38.0, "cU": 1.5, "dU": -0.7, "aV": 0.0, "bV": 0.0, "cV": 9.0, "dV": -3.0}


@pytest.mark.parametrize("reverse", [False, True])
def test_a_cubic_has_its_curvature_at_its_arc_length(read: Reader, reverse: bool) -> None:
    """Against quadrature of the arc length, whose inverse is searched for each knot."""
    u, v = np.poly1d([-0.7, 1.5, 38.0, 0.0]), np.poly1d([-3.0, 9.0, 0.0, 0.0])

    def pace(p: float) -> float:
        return float(np.hypot(u.deriv()(p), v.deriv()(p)))

    def arc(p: float) -> float:
        return float(quad(pace, 0.0, p, epsabs=1e-12)[0])

    length = arc(1.0)
    numbers = " ".join(f'{name}="{value}"' for name, value in CUBIC.items())
    plan = geometry(
        0, length, f'<paramPoly3 {numbers} pRange="normalized"/>', 'x="0" y="0" hdg="0"'
    )
    route = read(road("1", plan, length=length, inside=BOTH_WAYS), start_road="1", reverse=reverse)
    assert route.notes == ()
    own_m = length - route.s_m if reverse else route.s_m
    p = np.array([brentq(lambda p, s=s: arc(p) - s, -0.1, 1.1, xtol=1e-14) for s in own_m])
    turn = u.deriv()(p) * v.deriv(2)(p) - v.deriv()(p) * u.deriv(2)(p)
    curvature = turn / np.hypot(u.deriv()(p), v.deriv()(p)) ** 3
    curvature = -curvature if reverse else curvature
    # Between the quarter metres at which the arc length is known it is linear in the parameter.
    np.testing.assert_allclose(route.x_m, u(p), rtol=0.0, atol=2e-5)
    np.testing.assert_allclose(route.y_m, v(p), rtol=0.0, atol=2e-5)
    np.testing.assert_allclose(route.curvature_per_m, curvature, rtol=0.0, atol=1e-7)
