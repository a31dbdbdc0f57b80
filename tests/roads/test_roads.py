"""Routes on the 1 m grid, geometry against independent truth, the shipped study road."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pldf.instance import ModelError
from pldf.roads import (
    Route,
    fingerprint,
    open_route,
    packed_route,
    read_route,
    route_arrays,
    write_route_csv,
)
from pldf.roads.geometry import Cubic, LinearCurvature, Polynomial, Pose, param_poly3, poly3
from pldf.roads.load import DATA
from pldf.roads.make_study_road import write_study_road
from pldf.route_facts import route_facts
from scipy.special import fresnel

KMH = 1.0 / 3.6
POSE = Pose(10.0, -20.0, 0.7)


def make_route(
    s_m: list[float], curvature: list[float], limit: list[float], name: str = "made"
) -> Route:
    s, zero = np.array(s_m), np.zeros(len(s_m))
    return Route(name, s, np.array(curvature), np.array(limit), zero, s, zero)


# Geometry


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


# The grid


def test_a_sign_and_a_jump_at_a_node_belong_to_the_cell_behind_it() -> None:
    route = make_route([0, 3, 3, 5, 6.5], [0, 0, 0.01, 0.01, 0.01], [20, 20, 10, 30, 30])
    arrays = route_arrays(route)
    assert list(arrays.limit_mps) == [20, 20, 20, 10, 10, 30, 30]
    assert list(arrays.curvature_per_m) == [0, 0, 0, 0.01, 0.01, 0.01, 0.01]


def test_a_short_low_limit_inside_a_cell_is_kept() -> None:
    route = make_route([0, 1.2, 1.4, 4], [0, 0.02, 0, 0], [20, 5, 20, 20])
    arrays = route_arrays(route)
    assert list(arrays.limit_mps) == [20, 5, 20, 20, 20]
    assert arrays.curvature_per_m[1] == 0.02


def test_the_number_of_nodes_is_the_whole_metres_plus_one() -> None:
    assert make_route([0, 2], [0, 0], [10, 10]).nodes == 3
    assert make_route([0, 4.999], [0, 0], [10, 10]).nodes == 5


def test_grade_and_line_are_linear_between_knots() -> None:
    s = np.array([0.0, 4.0, 10.0])
    route = Route("g", s, 0 * s, s + 10, np.array([0.0, 0.04, -0.02]), 2 * s, -s)
    arrays = route_arrays(route)
    np.testing.assert_allclose(
        np.asarray(arrays.grade)[[0, 2, 4, 7, 10]], [0, 0.02, 0.04, 0.01, -0.02]
    )
    np.testing.assert_allclose(arrays.x_m, 2.0 * np.arange(11))
    np.testing.assert_allclose(arrays.y_m, -1.0 * np.arange(11))


@st.composite
def routes(draw: st.DrawFn) -> Route:
    steps = draw(
        st.lists(st.sampled_from([0.0, 0.25, 0.5, 1.0, 1.3, 4.7]), min_size=4, max_size=25)
    )
    s = [0.0]
    for step in steps:
        jump_used = len(s) > 1 and s[-1] == s[-2]
        s.append(s[-1] + (0.5 if step == 0.0 and jump_used else step))
    s += [s[-1] + 1.9, s[-1] + 3.0]
    count = len(s)
    curvature = draw(st.lists(st.floats(-0.05, 0.05), min_size=count, max_size=count))
    limit = draw(st.lists(st.floats(5.0, 40.0), min_size=count, max_size=count))
    return make_route(s, curvature, limit)


def _at(route: Route, s: float) -> tuple[float, float]:
    """Limit and curvature at ``s``, knot by knot, straight from their definition."""
    k = max(i for i in range(len(route.s_m)) if route.s_m[i] <= s)
    if k + 1 == len(route.s_m):
        return route.speed_limit_mps[k], route.curvature_per_m[k]
    share = (s - route.s_m[k]) / (route.s_m[k + 1] - route.s_m[k])
    bend = route.curvature_per_m[k] * (1 - share) + route.curvature_per_m[k + 1] * share
    return route.speed_limit_mps[k], bend


@settings(max_examples=60, deadline=None)
@given(routes())
def test_cells_hold_the_extremes_of_a_dense_sampling(route: Route) -> None:
    arrays = route_arrays(route)
    assert all(len(array) == route.nodes for array in arrays)
    for cell in range(route.nodes - 1):
        knots = [s for s in route.s_m if cell <= s < cell + 1]
        near = [s - 1e-9 for s in [*knots, cell + 1.0] if s - 1e-9 >= cell]
        samples = [_at(route, s) for s in [*np.arange(cell, cell + 0.999, 0.05), *knots, *near]]
        limits, bends = zip(*samples, strict=True)
        assert arrays.limit_mps[cell] == min(limits)
        assert arrays.curvature_per_m[cell] == pytest.approx(np.max(np.abs(bends)), abs=1e-8)
    assert arrays.limit_mps[route.nodes - 1] == arrays.limit_mps[route.nodes - 2]
    assert arrays.curvature_per_m[route.nodes - 1] == arrays.curvature_per_m[route.nodes - 2]


@settings(max_examples=40, deadline=None)
@given(routes())
def test_a_written_route_reads_back_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory, route: Route
) -> None:
    path = tmp_path_factory.mktemp("routes") / "route.csv"
    write_route_csv(route, path)
    again = read_route(path)
    for name, values in route.knots.items():
        np.testing.assert_array_equal(values, again.knots[name])
    assert fingerprint(again) == fingerprint(route)


# The fingerprint


def test_the_fingerprint_knows_what_shapes_a_profile() -> None:
    base = make_route([0, 5, 10], [0, 0.01, 0], [20, 20, 20])
    assert len(fingerprint(base)) == 16
    assert int(fingerprint(base), 16) >= 0
    changed = (
        make_route([0, 5, 10.01], [0, 0.01, 0], [20, 20, 20]),
        make_route([0, 5, 10], [0, 0.010002, 0], [20, 20, 20]),
        make_route([0, 5, 10], [0, 0.01, 0], [20, 20.01, 20]),
    )
    assert len({fingerprint(route) for route in (base, *changed)}) == 4


def test_the_fingerprint_ignores_name_line_grade_and_rounding() -> None:
    s = np.array([0.0, 5.0, 10.0])
    bend, limit = np.array([0.0, 0.01, 0.0]), np.full(3, 20.0)
    one = Route("one", s, bend, limit, 0 * s, s, 0 * s)
    two = Route("two", s, -bend, limit + 1e-9, 0 * s + 0.01, -s, s, has_line=False)
    assert fingerprint(one) == fingerprint(two)


@pytest.mark.parametrize(
    ("s_m", "curvature", "limit", "text"),
    [
        ([], [], [], "no knots"),
        ([0, 1.5], [0, 0], [10, 10], "at least 2 m"),
        ([0, 0], [0, 0], [10, 10], "at least 2 m"),
        ([0, 5, 4], [0, 0, 0], [10, 10, 10], "knot 2: s_m = 4 lies before"),
        ([0, 5, 5, 5, 9], [0] * 5, [10] * 5, "third time"),
        ([3, 9], [0, 0], [10, 10], "subtract 3"),
        ([0, 9], [0, np.nan], [10, 10], "curvature_per_m = nan"),
        ([0, np.inf], [0, 0], [10, 10], "s_m = inf"),
        ([0, 9], [0, 0], [0, 10], "knot 0: speed_limit_mps = 0"),
        ([0, 9], [0, 0], [10, -3], "knot 1: speed_limit_mps = -3"),
        ([0, 9], [0, 0], [100, 10], "is the unit right"),
        ([0, 1e12], [0, 0], [10, 10], "knot 1: s_m = 1e.12 is beyond 10 000 km"),
        ([0, 9], [0, 2.0], [10, 10], "tighter than 1 m"),
    ],
)
def test_unusable_knots_are_refused(
    s_m: list[float], curvature: list[float], limit: list[float], text: str
) -> None:
    with pytest.raises(ModelError, match=text):
        make_route(s_m, curvature, limit)


# The study road


def test_the_study_road_is_what_its_script_writes(tmp_path: Path) -> None:
    write_study_road(tmp_path)
    for name in ("study_road.xodr", "study_road.csv"):
        assert (tmp_path / name).read_bytes() == (DATA / name).read_bytes()


def test_both_files_of_the_study_road_are_the_same_road() -> None:
    xodr, csv = packed_route(0), read_route(DATA / "study_road.csv")
    assert fingerprint(xodr) == fingerprint(csv)
    for name in ("s_m", "curvature_per_m", "speed_limit_mps", "grade"):
        np.testing.assert_array_equal(xodr.knots[name], csv.knots[name])
    np.testing.assert_allclose(xodr.x_m, csv.x_m, atol=6e-5)
    np.testing.assert_allclose(xodr.y_m, csv.y_m, atol=6e-5)


def test_the_study_road_is_the_papers() -> None:
    facts = route_facts(packed_route(0))
    assert facts.route.length_m == 4500.0
    assert facts.route.has_line
    assert 200.0 <= facts.driving_time_s <= 220.0
    assert len(facts.curves) >= 6
    assert {round(limit / KMH) for _, limit in facts.limits} == {50, 60, 80, 100}
    long_limits = np.diff([s for s, _ in facts.limits] + [4500.0])
    assert np.sum(long_limits >= 600.0) >= 3
    limit = np.asarray(facts.arrays.limit_mps) / KMH
    assert np.mean(limit > 79.0) > 0.8
    assert np.max(np.abs(facts.arrays.grade)) < 0.04
    assert np.all(facts.base_mps <= facts.arrays.limit_mps)


def test_the_study_roads_line_turns_as_its_curvature_says() -> None:
    arrays = route_arrays(packed_route(0))
    heading = np.unwrap(np.angle(np.diff(np.asarray(arrays.x_m) + 1j * np.asarray(arrays.y_m))))
    route = packed_route(0)
    turn = np.interp(np.arange(1.0, 4500.0), route.s_m, route.curvature_per_m)
    np.testing.assert_allclose(np.diff(heading), turn, atol=4e-5)
    steps = np.hypot(np.diff(arrays.x_m), np.diff(arrays.y_m))
    np.testing.assert_allclose(steps, 1.0, atol=1e-5)


def test_packed_routes_load_at_once_and_unknown_ones_are_named() -> None:
    best = min(_time_of_loading() for _ in range(5))
    assert best < 0.03
    with pytest.raises(ModelError, match=r"route_id 7 is unknown.*0 = study_road"):
        packed_route(7)
    with pytest.raises(ModelError, match="route_id -1 is unknown"):
        packed_route(-1)


def _time_of_loading() -> float:
    start = time.perf_counter()
    packed_route(0)
    return time.perf_counter() - start


def test_study_names_the_shipped_road(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert fingerprint(open_route("study")) == fingerprint(packed_route(0))
