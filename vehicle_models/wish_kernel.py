"""The hidden wish of the preference driver as a speed over the route.

Planned by the driving function's own planner, with the driver's numbers: a driver who wants what
the function does has nothing to correct. In the numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from typing import NamedTuple

from pldf.kernel.arrays import Floats, RouteArrays, Work
from pldf.kernel.planner import find_limit_ends, plan_profile, speed_caps

from .driver_state import DriverState
from .variation_kernel import fill_lateral_accels, fill_offsets

# A wish below walking pace would stop the car at a very negative offset.
SLOWEST_MPS = 2.0


class WishArrays(NamedTuple):
    """What the driver knows of the route."""

    wish_mps: Floats  # node: wished speed
    offset_mps: Floats  # cell: wished speed above the legal limit where nothing else binds
    limit_end_m: Floats  # node: position of the next change of the legal limit
    straight_end_m: Floats  # node: end of the straight road (the node itself: not straight)


def prepare_wish(st: DriverState, route: RouteArrays, wish: WishArrays, work: Work) -> None:
    """Fill ``wish`` from the route; ``work`` is scratch space of the same length."""
    st.planner_accel_max_mps2 = st.wish_accel_max_mps2
    st.planner_accel_min_mps2 = st.wish_accel_min_mps2
    st.planner_jerk_max_mps3 = st.wish_jerk_max_mps3
    find_limit_ends(route.limit_mps, wish.limit_end_m)
    fill_offsets(st, route.limit_mps, wish.offset_mps)
    _fill_plateau(st, route.limit_mps, wish.offset_mps, work.d)
    _fill_bends(st, route.curvature_per_m, work.e)
    for i in range(len(work.c)):
        work.c[i] = 0.0
    speed_caps(wish.wish_mps, work.d, work.c, work.e, st.wish_lateral_accel_max_mps2)
    plan_profile(st, wish.wish_mps, wish.wish_mps, work)
    _fill_straight_ends(st, route.curvature_per_m, wish.straight_end_m)


def _fill_bends(st: DriverState, curvature: Floats, bend: Floats) -> None:
    """Curvature (per cell) that feels at the usual lateral acceleration as this one does here."""
    fill_lateral_accels(st, curvature, bend)
    for i in range(len(curvature)):
        bend[i] = curvature[i] * (st.wish_lateral_accel_max_mps2 / bend[i])


def _fill_plateau(st: DriverState, limit: Floats, offset: Floats, plateau: Floats) -> None:
    """Wished speed where only limits bind (per cell): higher limits count before their sign."""
    for i in range(len(limit)):
        plateau[i] = max(limit[i] + offset[i], SLOWEST_MPS)
    for sign in range(1, len(limit)):
        if limit[sign] > limit[sign - 1]:
            _anticipate(st, limit, plateau, sign)


def _anticipate(st: DriverState, limit: Floats, plateau: Floats, sign: int) -> None:
    """Let the limit from cell ``sign`` on count earlier, but not before the limit it ends."""
    before = limit[sign - 1]
    reach = st.wish_anticipation_s * plateau[sign - 1]
    raised = plateau[sign]
    i = sign - 1
    while i >= 0 and sign - i <= reach and limit[i] == before:
        plateau[i] = raised
        i -= 1


def _fill_straight_ends(st: DriverState, curvature: Floats, end: Floats) -> None:
    last = len(end) - 1
    end[last] = last
    for i in range(last - 1, -1, -1):
        straight = abs(curvature[i]) <= st.driver_lever_curvature_per_m
        end[i] = end[i + 1] if straight else i


def wish_acceleration(wish: WishArrays, s_m: float) -> float:
    """Acceleration of a car that follows the wish exactly at ``s_m``; 0 beyond both ends."""
    last = len(wish.wish_mps) - 1
    if s_m < 0.0 or s_m >= last:
        return 0.0
    here = wish.wish_mps[int(s_m)]
    there = wish.wish_mps[int(s_m) + 1]
    return 0.5 * (there * there - here * here)
