"""The last check (section 9): the braking curve by hand, and cars that it alone holds back."""

from __future__ import annotations

from itertools import pairwise
from math import isfinite, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, Array, PointMass, Span, driving, function, road
from pldf.function import DrivingFunction
from pldf.kernel import tracking
from pldf.kernel.codes import ACTIVE
from pldf.kernel.interpolation import value_at
from pldf.kernel.last_check import checked_request
from pldf.roads import Route, packed_route

CAP_OVER_LIMIT = 20.0 * KMH
LATERAL_MAX = 4.0
# Of the request's -3.5 m/s2 and 2.5 m/s3, as section 9 states them.
CURVE_DECELERATION = 3.15
CURVE_JERK = 1.25
STEP_S = 0.01

# Hairpins, a short limit, limits that fall twice in a row.
HARD_LIMITS = (
    (0.0, 100.0 * KMH), (300.0, 50.0 * KMH), (330.0, 100.0 * KMH), (600.0, 50.0 * KMH),
    (640.0, 20.0 * KMH), (700.0, 80.0 * KMH),
)  # fmt: skip
HARD_ROAD = road(1100.0, HARD_LIMITS, [(420.0, 450.0, 0.08), (900.0, 930.0, 0.05)])


def caps(route: Route, s_m: Array) -> Array:
    """The hard caps at positions, from the road's knots."""
    limit = route.speed_limit_mps[np.searchsorted(route.s_m, s_m, side="right") - 1]
    curvature = np.abs(np.interp(s_m, route.s_m, route.curvature_per_m))
    return np.minimum(limit + CAP_OVER_LIMIT, np.sqrt(LATERAL_MAX / np.maximum(curvature, 1e-9)))


def braking(made: DrivingFunction) -> Array:
    return np.array(made.profile.braking_mps)


def test_curve_before_a_lower_sign() -> None:
    """120 km/h down to 70: -3.15 m/s2 up to the sign, with room for the jerk where it begins."""
    curve = braking(function(road(1500.0, ((0.0, 100.0 * KMH), (1000.0, 50.0 * KMH)))))
    assert curve[1000] == pytest.approx(70.0 * KMH)
    assert curve[990] == pytest.approx(21.0021, abs=1e-4)  # sqrt(19.4444**2 + 2 * 3.15 * 10)
    assert curve[950] == pytest.approx(26.3265, abs=1e-4)  # sqrt(19.4444**2 + 2 * 3.15 * 50)
    # Without the jerk, 120 km/h would be left 116.4 m before the sign.
    assert curve[800] == pytest.approx(120.0 * KMH)
    assert curve[884] < 120.0 * KMH - 0.5
    assert np.all(curve[1000:] == pytest.approx(70.0 * KMH))


def test_curve_before_a_bend() -> None:
    curve = braking(function(road(1000.0, curves=[(500.0, 600.0, 0.01)])))
    assert curve[500:600] == pytest.approx(20.0)  # sqrt(4 / 0.01)
    assert curve[470] == pytest.approx(24.2693, abs=1e-4)  # sqrt(20**2 + 2 * 3.15 * 30)


def test_curve_keeps_caps_deceleration_and_jerk() -> None:
    made = function(HARD_ROAD)
    curve = braking(made)
    s_m = np.arange(len(curve) - 1.0)
    assert np.all(curve[:-1] <= caps(HARD_ROAD, s_m) + 1e-9)
    acceleration = 0.5 * np.diff(curve**2)
    assert np.all(acceleration >= -CURVE_DECELERATION - 1e-9)
    jerk = np.diff(acceleration) * curve[1:-1]
    assert np.all(jerk >= -CURVE_JERK - 1e-6)


def test_a_set_speed_set_by_hand_lifts_the_limit_100_m_behind_its_sign_and_up_to_the_next() -> None:
    limits = ((0.0, 100.0 * KMH), (1000.0, 50.0 * KMH), (1600.0, 80.0 * KMH))
    made = function(road(2200.0, limits, [(300.0, 400.0, 0.005)]))
    curve = np.array(made.profile.braking_by_hand_mps)
    assert curve[350] == pytest.approx(sqrt(LATERAL_MAX / 0.005))  # curves are not lifted
    assert curve[1000] == pytest.approx(70.0 * KMH)
    assert curve[1090] == pytest.approx(70.0 * KMH)
    assert curve[600] > 160.0 * KMH
    assert curve[990] == pytest.approx(21.0021, abs=1e-4)  # as without a hand on the lever
    assert curve[1350] > 120.0 * KMH


def test_request_near_the_curve_by_hand() -> None:
    """On a cap of 33.33 m/s that goes on: the request may fall to 0 with half its jerk."""
    made = function(road(2000.0))
    st, cap = made.record, 120.0 * KMH

    def checked(request_mps2: float, speed_mps: float) -> float:
        return checked_request(st, made.profile, request_mps2, 500.0, speed_mps)

    assert checked(1.4, cap - 0.8) == 1.4  # 1.4**2 / (2 * 1.25) = 0.784 m/s are needed
    assert checked(2.0, cap - 0.8) == pytest.approx(sqrt(2.0 * 1.25 * 0.8))
    assert checked(2.0, cap) == pytest.approx(0.0, abs=1e-6)
    assert checked(2.0, cap + 0.5) == pytest.approx(-1.5)  # 3 1/s back
    assert checked(-2.0, cap + 0.5) == -2.0  # it never asks for more
    st.vehicle_acceleration_mps2 = 1.0  # in 0.4 s it is 0.4 m/s faster
    assert checked(2.0, cap - 0.8) == pytest.approx(1.0)


def greedy(route: Route, speed_mps: float, lag_s: float = 0.2) -> PointMass:
    """A car whose profile asks for 60 m/s everywhere: only the last check holds it back."""
    car = driving(route, speed_mps)
    np.asarray(car.made.profile.learned_mps)[:] = 60.0
    car.lag_s = lag_s
    return car


@pytest.mark.parametrize("lag_s", [0.05, 0.2, 0.4])
def test_the_caps_hold_whatever_the_profile_asks_for(lag_s: float) -> None:
    """Worst over cap, also where -1 m/s2 back to the profile would not do."""
    car = greedy(HARD_ROAD, 20.0, lag_s)
    seen = []
    while car.s_m < 1090.0:
        car.step()
        seen.append((car.s_m, car.speed_mps, car.made.record.acceleration_request_mps2))
    s_m, speed, request = np.array(seen).T
    assert np.max(speed - caps(HARD_ROAD, s_m)) < 0.5 * KMH
    curvature = np.abs(np.interp(s_m, HARD_ROAD.s_m, HARD_ROAD.curvature_per_m))
    assert np.max(speed**2 * curvature) < 1.02 * LATERAL_MAX
    assert np.min(request) < car.made.record.control_recovery_accel_min_mps2
    # It holds back no more than it has to: the tightest caps are nearly used.
    assert np.max(speed[(s_m > 425.0) & (s_m < 445.0)]) > sqrt(LATERAL_MAX / 0.08) - 0.3


def test_a_set_speed_set_by_hand_may_exceed_the_limit_but_not_behind_its_sign() -> None:
    limits = ((0.0, 70.0 * KMH), (1500.0, 50.0 * KMH))
    car = driving(road(1800.0, limits), 19.0)
    for _ in range(10):
        car.tip("lever_up_long")
    np.asarray(car.made.profile.learned_mps)[:] = 60.0
    fastest = 0.0
    while car.s_m < 1500.0:
        car.step()
        fastest = max(fastest, car.speed_mps)
    assert fastest > 110.0 * KMH  # 20 km/h over the limit would be 90
    assert car.speed_mps < 70.5 * KMH


def test_the_base_profile_is_driven_as_without_the_check(monkeypatch: pytest.MonkeyPatch) -> None:
    def requests() -> list[float]:
        made = function(packed_route(0))
        car = PointMass(made, made.profile.base_mps[0], 0.2)
        car.step(lever_resume=1)
        asked = []
        while car.s_m < 4480.0:
            car.step(0.02)
            asked.append(made.record.acceleration_request_mps2)
        return asked

    checked = requests()
    monkeypatch.setattr(tracking, "checked_request", lambda st, profile, request, s_m, v: request)
    assert checked == requests()


def test_above_the_caps_it_acts_in_active_only() -> None:
    car = driving(road(2000.0), 32.0)
    car.run(2.0, driver_gas_pedal=1.0)
    assert car.speed_mps > 120.0 * KMH
    assert car.made.record.acceleration_request_mps2 == 0.0  # the driver overrides
    car.run(1.0, driver_gas_pedal=0.0)
    assert car.made.record.acceleration_request_mps2 < -2.0


limit_lists = hs.lists(
    hs.tuples(hs.integers(20, 200), hs.sampled_from([20.0, 30.0, 50.0, 80.0, 100.0])),
    min_size=3, max_size=6,
)  # fmt: skip
bends = hs.lists(hs.tuples(hs.integers(10, 60), hs.floats(0.005, 0.1)), min_size=2, max_size=4)


@settings(deadline=None, max_examples=60)
@given(limit_lists, bends, hs.floats(0.3, 1.0), hs.floats(0.05, 0.4), hs.integers(0, 100))
def test_from_every_state_that_the_curve_allows_the_caps_are_kept(
    signs: list[tuple[int, float]],
    arcs: list[tuple[int, float]],
    share: float,
    lag_s: float,
    start_m: int,
) -> None:
    """Greedy from anywhere below the curve; every request finite and without a step."""
    route = drawn_road(signs, arcs)
    made = function(route)
    car = PointMass(made, 0.0, lag_s)
    car.s_m = float(start_m)
    curve = braking(made)
    car.speed_mps = share * value_at(made.profile.braking_mps, car.s_m)
    # On the curve that is: with its acceleration; the car need not be driven up to there.
    before = min(0.5 * (curve[start_m + 1] ** 2 - curve[start_m] ** 2), 0.0)
    car.acceleration_mps2 = made.record.acceleration_request_mps2 = before
    made.record.mode = ACTIVE
    np.asarray(made.profile.learned_mps)[:] = 60.0
    for _ in range(2500):
        if car.s_m >= route.length_m - 2.0:
            break
        car.step()
        request = made.record.acceleration_request_mps2
        assert isfinite(request)
        assert abs(request - before) <= 2.5 * STEP_S + 1e-9
        before = request
        cap = caps(route, np.array([car.s_m]))[0]
        assert car.speed_mps <= 1.01 * cap + 0.02  # 2 % of the lateral acceleration


@settings(deadline=None, max_examples=60)
@given(limit_lists, bends)
def test_constant_braking_from_the_curve_keeps_the_caps(
    signs: list[tuple[int, float]], arcs: list[tuple[int, float]]
) -> None:
    """By numpy alone: v**2 falls by 2 * 3.15 per metre from every node of the curve."""
    route = drawn_road(signs, arcs)
    squares = braking(function(route)) ** 2
    allowed = caps(route, np.arange(len(squares)) + 0.5) ** 2
    for i in range(0, len(squares) - 1, 7):
        metres = np.arange(len(squares) - 1 - i) + 0.5
        assert np.all(squares[i] - 2.0 * CURVE_DECELERATION * metres <= allowed[i:-1] + 1e-9)


def drawn_road(signs: list[tuple[int, float]], arcs: list[tuple[int, float]]) -> Route:
    """Limits one after the other; bends apart from each other behind the first 150 m."""
    ends = np.cumsum([length_m for length_m, _ in signs])
    limits = [(0.0, 100.0 * KMH)]
    limits += [(float(end), kmh * KMH) for end, (_, kmh) in zip(ends, signs, strict=True)]
    at, curves = 150.0, []
    for length_m, curvature in arcs:
        curves.append((at + 0.5, at + 0.5 + length_m, curvature))
        at += length_m + 30.0
    return road(at + 400.0, spaced(limits, at + 400.0), curves)


def spaced(limits: list[Span], length_m: float) -> list[Span]:
    """The limits that begin on the road, each at a place of its own."""
    kept = [a for a, b in pairwise([*limits, (length_m, 0.0)]) if a[0] < min(b[0], length_m - 1.0)]
    return kept or [limits[0]]
