"""Traffic that drives the road by itself: who is ahead of us when, at which pace, with which stops.

One car at a time: it cuts in or is caught up with, drives at its own pace what limits and curves
allow, may stop once, and leaves the lane. In the numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from typing import NamedTuple

from pldf.kernel.arrays import Floats, RouteArrays, Work
from pldf.kernel.interpolation import value_at
from pldf.kernel.planner import plan_profile, speed_caps

from .chance import draw, draw_between
from .clock import to_ns
from .lead_motion import USUAL_MPS2, appear, vanish
from .lead_state import DRIVING, NOBODY, STANDING, STOPPING, LeadState

# How the road's speed is planned: as an ordinary driver accelerates and brakes.
PLANNED_MPS2 = 1.3
PLANNED_MPS3 = 1.0
# Who cuts in does so at this time gap, not slower than this below our speed.
CUT_IN_NEAR_S = 0.9
CUT_IN_FAR_S = 1.6
CUT_IN_SPACE_M = 3.0
CUT_IN_SLOWER_MPS = 3.0
# Nobody cuts in before a car that is slower than this.
CUT_IN_SLOWEST_MPS = 5.0
# A car that is caught up with comes into sight no nearer than this share of the sensor's reach.
SIGHT_SHARE = 0.5
# Stops: how hard, how long, and how long the car stays ahead afterwards.
STOP_WEAK_MPS2 = 1.5
STOP_HARD_MPS2 = 3.5
STOP_SHORT_S = 2.0
STOP_LONG_S = 8.0
STAY_ON_S = 5.0


class RoadArrays(NamedTuple):
    """What the traffic knows of the road."""

    road_mps: Floats  # node: speed that limits and curves allow


def prepare_road(st: LeadState, route: RouteArrays, road: RoadArrays, work: Work) -> None:
    """Fill ``road`` from the route; ``work`` is scratch space of the same length."""
    st.planner_accel_max_mps2 = PLANNED_MPS2
    st.planner_accel_min_mps2 = -PLANNED_MPS2
    st.planner_jerk_max_mps3 = PLANNED_MPS3
    for i in range(len(work.c)):
        work.c[i] = 0.0
    lateral = st.traffic_lateral_accel_max_mps2
    speed_caps(road.road_mps, route.limit_mps, work.c, route.curvature_per_m, lateral)
    plan_profile(st, road.road_mps, road.road_mps, work)


def first_car(st: LeadState) -> None:
    """Draw when the first car comes."""
    st.until_ns = to_ns(_about(st, st.traffic_free_s))


def drive_traffic(st: LeadState, road: RoadArrays) -> None:
    """Decide who is ahead at ``st.time_ns`` and what that car goes for."""
    if st.phase == NOBODY:
        if st.time_ns >= st.until_ns and st.there == 0:
            _next_car(st, road)
    elif st.phase == DRIVING:
        st.wanted_mps = st.pace * value_at(road.road_mps, st.rear_m)
        if st.stop_ns > 0 and st.time_ns >= st.stop_ns:
            st.phase = STOPPING
            st.wanted_mps = 0.0
            st.strength_mps2 = draw_between(st, STOP_WEAK_MPS2, STOP_HARD_MPS2)
        elif st.time_ns >= st.until_ns:
            _leave(st)
    elif st.phase == STOPPING:
        if st.speed_mps <= 0.0:
            st.phase = STANDING
            st.stop_ns = st.time_ns + to_ns(draw_between(st, STOP_SHORT_S, STOP_LONG_S))
    elif st.time_ns >= st.stop_ns:
        st.phase = DRIVING
        st.stop_ns = 0
        st.strength_mps2 = USUAL_MPS2
        st.until_ns = max(st.until_ns, st.time_ns + to_ns(STAY_ON_S))


def _about(st: LeadState, seconds: float) -> float:
    """A time of about ``seconds``: half to one and a half."""
    return seconds * draw_between(st, 0.5, 1.5)


def _leave(st: LeadState) -> None:
    vanish(st)
    st.until_ns = st.time_ns + to_ns(_about(st, st.traffic_free_s))


def _next_car(st: LeadState, road: RoadArrays) -> None:
    """Let a car come, unless the road ends before it."""
    st.pace = draw_between(st, st.traffic_pace_low, st.traffic_pace_high)
    cuts_in = draw(st) < st.traffic_cut_in_share and st.ego_mps >= CUT_IN_SLOWEST_MPS
    if cuts_in:
        gap_m = CUT_IN_SPACE_M + st.ego_mps * draw_between(st, CUT_IN_NEAR_S, CUT_IN_FAR_S)
        speed_mps = st.ego_mps - draw_between(st, 0.0, CUT_IN_SLOWER_MPS)
    else:
        gap_m = st.traffic_reach_m * draw_between(st, SIGHT_SHARE, 1.0)
        speed_mps = st.pace * value_at(road.road_mps, st.ego_m + gap_m)
    stay_s = _about(st, st.traffic_stay_s)
    st.until_ns = st.time_ns + to_ns(stay_s)
    st.stop_ns = 0
    if draw(st) < st.traffic_stop_share:
        st.stop_ns = st.time_ns + to_ns(stay_s * draw(st))
    if st.ego_m + gap_m < len(road.road_mps) - 1.0:
        appear(st, gap_m, speed_mps)
        st.phase = DRIVING
