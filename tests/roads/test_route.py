"""The route: knots, the 1 m grid, the fingerprint, what is no route."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pldf.errors import ModelError
from pldf.roads import (
    Route,
    fingerprint,
    read_route,
    route_arrays,
    write_route_csv,
)


def make_route(
    s_m: list[float], curvature: list[float], limit: list[float], name: str = "made"
) -> Route:
    s, zero = np.array(s_m), np.zeros(len(s_m))
    return Route(name, s, np.array(curvature), np.array(limit), zero, s, zero)


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


@pytest.mark.parametrize("axis", ["x_m", "y_m"])
def test_a_road_where_no_car_can_be_is_refused(axis: str) -> None:
    good = make_route([0, 9], [0, 0], [10, 10])
    with pytest.raises(ModelError, match=rf"knot 1: {axis} = -2e\+08 is beyond 100 000 km"):
        replace(good, **{axis: np.array([0.0, -2e8])})
