"""The last check: nothing is requested that braking could not make good again (section 9).

It knows the hard caps and the car, and nothing of planner, learner or lead. A braking curve is the
highest speed from which the caps ahead are kept by a deceleration that stays below the strongest
request and builds up with a share of its jerk. What is left of the jerk takes a car that comes
from below onto the curve: while the request falls to the curve's own acceleration, the car gains
speed, and for that there has to be room. So a car that keeps to the curve can always go on doing
so, whatever the caps do behind it.
"""

from __future__ import annotations

from math import sqrt

from .arrays import Floats, ProfileArrays, RouteArrays, Work
from .interpolation import place_at, value_of
from .planner import cell_cap, round_peaks
from .state import PldfState

# Shares (decisions) of the request's strongest deceleration and of its jerk that the curve is made
# of. With all of either, nothing would be left for a vehicle that does not do exactly as told.
DECELERATION_SHARE = 0.9
JERK_SHARE = 0.5
# A vehicle may answer later than control.preview_s says by as much (decision).
LATER_S = 0.1
# Above the curve the request falls below the curve's acceleration, by this per speed (decision).
BACK_PER_S = 3.0
# A set speed set by hand lifts the legal cap from here on behind the last sign (decision). Nearer
# to signs it stays: the curve in front of a sign, where the set speed is dropped, knows of it so.
LIFTED_FROM_M = 100


def find_braking_curves(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, work: Work
) -> None:
    """Fill both braking curves of ``profile``; ``work.a`` to ``work.c`` are overwritten."""
    _square_caps(st, route, profile.braking_mps, False)
    _find_curve(st, profile.braking_mps, work)
    _square_caps(st, route, profile.braking_by_hand_mps, True)
    _find_curve(st, profile.braking_by_hand_mps, work)


def _square_caps(st: PldfState, route: RouteArrays, b: Floats, by_hand: bool) -> None:
    """Fill ``b`` (m2/s2, per node) with the squares of the hard caps."""
    metres = 0  # since the last sign
    before = st.control_set_speed_max_mps + route.limit_mps[0] + st.learning_over_limit_max_mps
    for i in range(len(b)):
        metres = metres + 1 if i == 0 or route.limit_mps[i] == route.limit_mps[i - 1] else 0
        legal = route.limit_mps[i] + st.learning_over_limit_max_mps
        if by_hand and metres >= LIFTED_FROM_M:
            legal = max(legal, st.control_set_speed_max_mps)
        here = cell_cap(legal, route.curvature_per_m[i], st.learning_lateral_accel_max_mps2)
        cap = min(before, here)
        b[i] = cap * cap
        before = here


def _find_curve(st: PldfState, curve: Floats, work: Work) -> None:
    """Make the braking curve (m/s) of squared caps, in place."""
    fall = -2.0 * DECELERATION_SHARE * st.control_request_min_mps2
    jerk = JERK_SHARE * st.control_request_jerk_max_mps3
    n = len(curve)
    for i in range(n - 2, -1, -1):
        curve[i] = min(curve[i], curve[i + 1] + fall)
    for i in range(n):
        work.a[i] = 2.0 * jerk / sqrt(curve[i])
    round_peaks(curve, work.a, work.b, work.c, 0, n - 1)
    for i in range(n):
        curve[i] = sqrt(curve[i])


def checked_request(
    st: PldfState, profile: ProfileArrays, request_mps2: float, s_m: float, speed_mps: float
) -> float:
    """Return ``request_mps2``, lowered to what the braking curve allows a car at ``s_m``.

    Both the car as it will be when a change of the request has reached it and the car as it is now
    have to keep to the curve: a late vehicle needs the first, a quick one would let go too early.
    """
    curve = profile.braking_mps
    if st.manual_set_mps > 0.0 and s_m < st.manual_end_m:
        curve = profile.braking_by_hand_mps
    jerk = (1.0 - JERK_SHARE) * st.control_request_jerk_max_mps3
    delay_s = st.control_preview_s + LATER_S
    soon_m = s_m + delay_s * speed_mps
    soon_mps = speed_mps + delay_s * st.vehicle_acceleration_mps2
    request = _lowered_request(curve, jerk, request_mps2, soon_m, soon_mps)
    return _lowered_request(curve, jerk, request, s_m, speed_mps)


def _lowered_request(
    curve: Floats, jerk_mps3: float, request_mps2: float, s_m: float, speed_mps: float
) -> float:
    """Return the request with which a car comes onto ``curve`` with that jerk, or stays below."""
    place = place_at(len(curve), s_m)
    first = curve[place[0]]
    second = curve[place[1]]
    allowed = 0.5 * (second * second - first * first)  # the curve's own acceleration
    room = value_of(curve, place) - speed_mps
    if room < 0.0:
        return min(request_mps2, allowed + BACK_PER_S * room)
    above = request_mps2 - allowed
    if above <= 0.0 or above * above <= 2.0 * jerk_mps3 * room:
        return request_mps2
    return allowed + sqrt(2.0 * jerk_mps3 * room)
