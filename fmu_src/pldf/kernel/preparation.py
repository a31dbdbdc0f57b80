"""What is planned once, before a drive: base profile, open profile, and the profile to follow."""

from __future__ import annotations

from .arrays import Floats, ProfileArrays, RouteArrays, Work
from .bounds import keep_bounds, mark_violations
from .codes import OFF, STANDBY
from .hmi import begin_cluster
from .last_check import find_braking_curves
from .planner import find_limit_ends, plan_profile, speed_caps
from .reasons import find_reasons, find_turns
from .state import PldfState


def start_drive(st: PldfState, route: RouteArrays, profile: ProfileArrays, work: Work) -> None:
    """Begin a drive with the base profile; the arrays of ``route`` are filled, the rest is zero."""
    stand_by(st)
    plan_base(st, route, profile, work)


def stand_by(st: PldfState) -> None:
    """Begin a drive ready to be activated, or switched off."""
    st.mode = STANDBY if st.main_switch != 0 else OFF
    begin_cluster(st)


def plan_base(st: PldfState, route: RouteArrays, profile: ProfileArrays, work: Work) -> None:
    """Fill base and open profile, and make the base profile the one to follow."""
    plan_legal(st, route, profile.base_mps, work)
    fill(work.d, st.control_set_speed_max_mps)
    fill(work.c, 0.0)
    plan(st, (work.d, work.c, route.curvature_per_m), profile.open_mps, work)
    for i in range(len(profile.base_mps)):
        profile.planned_mps[i] = profile.base_mps[i]
        profile.learned_mps[i] = profile.base_mps[i]
    find_limit_ends(route.limit_mps, profile.limit_end_m)
    find_braking_curves(st, route, profile, work)
    find_turns(profile.learned_mps, profile.turn_m)
    find_reasons(st, route, profile)


def plan_legal(st: PldfState, route: RouteArrays, speed: Floats, work: Work) -> None:
    """Fill ``speed`` with the base profile: planned from legal limits and curvature alone."""
    fill(work.c, 0.0)
    plan(st, (route.limit_mps, work.c, route.curvature_per_m), speed, work)


def adopt_learned(st: PldfState, route: RouteArrays, profile: ProfileArrays, work: Work) -> None:
    """Make the learned profile and offsets in ``profile`` usable: plan, bounds, turns.

    Caps and slopes hold whatever was stored, since their parameters may have changed in between;
    around what they cut, jerk is bounded, too. A profile that was learned with these parameters is
    followed as it was stored, to the bit.
    """
    plan(
        st, (route.limit_mps, profile.offset_mps, route.curvature_per_m), profile.planned_mps, work
    )
    mark_violations(st, route, profile.learned_mps, work.b)
    keep_bounds(st, route, profile.learned_mps, profile.bound, work)
    find_turns(profile.learned_mps, profile.turn_m)
    find_reasons(st, route, profile)


def plan(st: PldfState, road: tuple[Floats, Floats, Floats], speed: Floats, work: Work) -> None:
    """Fill ``speed`` with the profile under ``road``: limit and offset (m/s), curvature (1/m)."""
    speed_caps(speed, road[0], road[1], road[2], st.planner_lateral_accel_max_mps2)
    plan_profile(st, speed, speed, work)


def fill(values: Floats, value: float) -> None:
    """Set every element to ``value``."""
    for i in range(len(values)):
        values[i] = value
