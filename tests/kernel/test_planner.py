"""The base profile: caps, bounds, optimality, and what a change of the caps may change."""

from __future__ import annotations

import sys
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, Array
from pldf.compiled import kernel, pack
from pldf.instance import view, views, zeros
from pldf.kernel import planner
from pldf.kernel.arrays import Work
from pldf.kernel.parameters import PlannerParameters
from pldf.kernel.state import PldfState
from pldf.roads import packed_route, route_arrays

ACCEL_MAX, ACCEL_MIN, JERK_MAX = 1.2, -1.0, 1.0
quick = settings(deadline=None, max_examples=30)


def planned(caps: Array, **changes: float) -> Array:
    """The profile under ``caps``, by the kernel in CPython."""
    settings_ = PlannerParameters(**changes)  # type: ignore[arg-type]
    speed = np.empty_like(caps)
    planner.plan_profile(settings_, view(caps), view(speed), views(zeros(Work, len(caps))))
    return speed


def planned_natively(caps: Array, **changes: float) -> Array:
    """The same by the compiled kernel."""
    state = PldfState(**changes)  # type: ignore[arg-type]
    speed = np.empty_like(caps)
    kernel()["plan_profile"](pack(state).view(np.recarray)[0], caps, speed, zeros(Work, len(caps)))
    return speed


def accelerations(speed: Array) -> Array:
    return 0.5 * np.diff(speed * speed)


def jerks(speed: Array) -> Array:
    """At every inner node: the change of acceleration over the time between two metres."""
    return np.diff(accelerations(speed)) * speed[1:-1]


def travel_time(speed: Array) -> float:
    return float(np.sum(2.0 / (speed[1:] + speed[:-1])))


def assert_planned_well(caps: Array, speed: Array, jerk_max: float = JERK_MAX) -> None:
    assert np.all(speed <= caps * (1.0 + 1e-12))
    assert np.all(speed > 0.0)
    assert np.all(accelerations(speed) <= ACCEL_MAX + 1e-7)
    assert np.all(accelerations(speed) >= ACCEL_MIN - 1e-7)
    assert np.all(np.abs(jerks(speed)) <= jerk_max * (1.0 + 1e-3))


@hs.composite
def random_caps(draw: hs.DrawFn, low: float = 3.0) -> Array:
    """Caps of a road of up to 600 m, in pieces of one speed each."""
    speeds = hs.floats(low, 40.0)
    pieces = draw(hs.lists(hs.tuples(hs.integers(1, 150), speeds), min_size=1, max_size=8))
    return np.concatenate([np.full(metres + 1, speed) for metres, speed in pieces])


@cache
def study_caps() -> Array:
    route = route_arrays(packed_route(0))
    caps = np.zeros(len(route.limit_mps))
    nothing = np.zeros_like(caps)
    planner.speed_caps(
        view(caps), *map(view, (route.limit_mps, nothing, route.curvature_per_m)), 2.5
    )  # type: ignore[arg-type, misc]
    return caps


def test_caps_are_the_lowest_of_limit_and_curve_speed_in_both_cells_at_a_node() -> None:
    limit, nothing = np.array([20.0, 20.0, 10.0, 30.0, 30.0]), np.zeros(5)
    curvature = np.array([0.0, 0.01, 0.0, 0.0, 0.1])
    caps = np.zeros(5)
    planner.speed_caps(*map(view, (caps, limit, nothing, curvature)), 2.5)  # type: ignore[misc]
    np.testing.assert_allclose(caps, [20.0, 250**0.5, 10.0, 10.0, 5.0])


@quick
@given(random_caps(), hs.sampled_from([0.3, 1.0, 5.0]))
def test_keeps_cap_acceleration_and_jerk_at_every_node(caps: Array, jerk_max: float) -> None:
    assert_planned_well(caps, planned(caps, planner_jerk_max_mps3=jerk_max), jerk_max)


def test_keeps_its_bounds_over_1000_km() -> None:
    random = np.random.default_rng(1)
    pieces = random.integers(5, 800, 3000)
    caps = np.repeat(random.uniform(5.0, 40.0, 3000), pieces)[:1_000_001]
    assert len(caps) == 1_000_001
    assert_planned_well(caps, planned_natively(caps))


def test_keeps_its_bounds_far_behind_1000_km_of_walking_pace() -> None:
    # The hull adds a parabola that grows with the square of the distance, fastest at low speed.
    caps = np.full(1_000_001, 3.0)
    caps[-2000:-1000] = 40.0
    assert_planned_well(caps, planned_natively(caps))


@quick
@given(random_caps())
def test_without_jerk_limit_nothing_faster_exists(caps: Array) -> None:
    speed = planned(caps, planner_jerk_max_mps3=0.0)
    assert_planned_well(caps, speed, np.inf)
    # The fastest: at every node some cap, however far away, explains the speed exactly.
    squares = caps * caps
    at = np.arange(len(caps))
    away = at[:, None] - at[None, :]
    reach = squares[None, :] + np.where(away >= 0, 2.0 * ACCEL_MAX * away, 2.0 * ACCEL_MIN * away)
    np.testing.assert_allclose(speed, np.sqrt(reach.min(axis=1)), rtol=1e-12)


@pytest.mark.skipif(sys.platform != "linux", reason="toppra is on PyPI for Linux only")
def test_equals_toppra_without_jerk_limit() -> None:
    import toppra  # noqa: PLC0415 - not there elsewhere
    from toppra import algorithm, constraint  # noqa: PLC0415

    caps = study_caps()
    ours = planned(caps, planner_jerk_max_mps3=0.0)
    toppra.setup_logging("ERROR")
    at = np.arange(len(caps), dtype=float)
    path = toppra.SplineInterpolator([0.0, 0.5 * at[-1], at[-1]], [[0.0], [0.5 * at[-1]], [at[-1]]])

    def bounds(s_m: float) -> Array:
        return np.array([[0.0, np.interp(s_m, at, caps)]])

    instance = algorithm.TOPPRA(
        [
            constraint.JointVelocityConstraintVarying(bounds),
            constraint.JointAccelerationConstraint(np.array([[ACCEL_MIN, ACCEL_MAX]])),
        ],
        path,
        gridpoints=at,
    )
    _, speed, _ = instance.compute_parameterization(ours[0], ours[-1])
    np.testing.assert_allclose(ours, speed, atol=1e-3)


def test_jerk_limit_costs_at_most_one_percent_on_the_study_road() -> None:
    caps = study_caps()
    smooth, hard = planned(caps), planned(caps, planner_jerk_max_mps3=0.0)
    assert_planned_well(caps, smooth)
    assert np.all(smooth <= hard * (1.0 + 1e-12))
    assert travel_time(smooth) <= 1.01 * travel_time(hard)


@quick
@given(random_caps(), hs.data())
def test_raising_a_cap_never_makes_the_drive_slower(caps: Array, data: hs.DataObject) -> None:
    first = data.draw(hs.integers(0, len(caps) - 1))
    higher = caps.copy()
    higher[first : first + data.draw(hs.integers(1, 100))] += data.draw(hs.floats(0.1, 10.0))
    before = planned(caps, planner_jerk_max_mps3=0.0)
    assert np.all(planned(higher, planner_jerk_max_mps3=0.0) >= before)


@quick
@given(random_caps())
def test_planning_the_plan_changes_nothing(caps: Array) -> None:
    once = planned(caps, planner_jerk_max_mps3=0.0)
    np.testing.assert_allclose(planned(once, planner_jerk_max_mps3=0.0), once, rtol=1e-12)
    # With jerk limit the second plan takes its bounds from the lower, rounded speed: those are
    # wider, so it may change a little, but only where rounding the first plan left a corner.
    smooth = planned(caps)
    np.testing.assert_allclose(planned(smooth), smooth, rtol=2e-3)


@pytest.mark.parametrize("jerk_max", [0.0, 1.0])
def test_a_change_of_a_cap_has_no_effect_far_away(jerk_max: float) -> None:
    caps = np.full(4000, 100.0 * KMH)
    caps[500:900] = 60.0 * KMH
    caps[3000:3300] = 50.0 * KMH
    lower = caps.copy()
    lower[600:700] = 30.0 * KMH
    before = planned(caps, planner_jerk_max_mps3=jerk_max)
    changed = planned(lower, planner_jerk_max_mps3=jerk_max)
    np.testing.assert_allclose(changed[1500:], before[1500:], rtol=1e-12)
    np.testing.assert_allclose(changed[:200], before[:200], rtol=1e-12)
    assert np.all(changed[600:700] <= 30.0 * KMH)


def test_a_valley_is_as_narrow_as_the_bend_allows() -> None:
    """Its square of speed is the parabola whose second difference is the bend, bottom included."""
    squares, bend = np.full(101, 400.0), np.full(101, 2.0)
    squares[50] = 0.0
    planner.round_valleys(view(squares), view(bend), np.inf, np.inf)
    away = np.abs(np.arange(101.0) - 50.0)
    np.testing.assert_array_equal(squares, np.minimum(away * away, 400.0))


def test_an_offset_that_reaches_below_the_limit_plans_no_speed_from_its_square():
    """It made 20 m/s - 200 m/s to 180 m/s, and 20 m/s - 20 m/s to a division by 0."""
    nodes = 5
    caps, limit, curvature = np.zeros(nodes), np.full(nodes, 20.0), np.zeros(nodes)
    for offset in (-20.0, -200.0):
        arrays = (caps, limit, np.full(nodes, offset), curvature)
        planner.speed_caps(*map(view, arrays), 2.5)  # type: ignore[misc]
        assert (caps == planner.SLOWEST_CAP_MPS).all()
