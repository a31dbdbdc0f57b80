"""The car ahead from step to step: how it moves, and what a sensor sees of it.

Where it comes from and what it goes for is decided by one car's parameters (here), by a script
(``lead_script_kernel``) or by traffic that drives the road (``traffic_kernel``). In the numba
subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from math import floor

from pldf.kernel.substeps import substep_count

from .chance import sow
from .clock import NS_PER_S, to_ns
from .lead_motion import appear, follow_wanted, vanish
from .lead_script_kernel import LeadScriptArrays, follow_traffic_script
from .lead_state import (
    BY_SCRIPT,
    CONTACT,
    INVALID_INPUT,
    NO_TROUBLE,
    ONE_CAR,
    LeadState,
)
from .traffic_kernel import RoadArrays, drive_traffic, first_car

# Beyond these no car is.
POSITION_BOUND = 1e8
SPEED_BOUND = 1e3
# A car that ours is farther ahead of than this has been driven through.
PASSED_M = -5.0
# How many of the one car's events have happened.
APPEARED = 1
CHANGED = 2
LEFT = 3


def lead_start(st: LeadState) -> None:
    """Begin with nobody ahead."""
    sow(st, st.seed)
    first_car(st)


def lead_step(st: LeadState, road: RoadArrays, script: LeadScriptArrays, step_s: float) -> None:
    """Advance by ``step_s`` seconds in equal internal steps of at most 10 ms.

    Between two communication points our car is taken to keep its speed.
    """
    _read_ego(st)
    count = substep_count(step_s)
    begin_ns = st.time_ns
    end_ns = begin_ns + to_ns(step_s)
    for k in range(count):
        now_ns = begin_ns + floor((end_ns - begin_ns) * (k + 1.0) / count + 0.5)
        passed_s = (now_ns - st.time_ns) / NS_PER_S
        st.time_ns = now_ns
        st.ego_m += st.ego_mps * passed_s
        if st.there != 0:
            follow_wanted(st, passed_s)
        if st.kind == ONE_CAR:
            _follow_parameters(st)
        elif st.kind == BY_SCRIPT:
            follow_traffic_script(st, script)
        else:
            drive_traffic(st, road)
    _sense(st)


def _read_ego(st: LeadState) -> None:
    """Take our car's position over; without a usable one it drives on as it did."""
    if abs(st.vehicle_s_m) < POSITION_BOUND and abs(st.vehicle_speed_mps) < SPEED_BOUND:
        st.ego_m = st.vehicle_s_m
        st.ego_mps = st.vehicle_speed_mps
        st.trouble = NO_TROUBLE
    else:
        st.trouble = INVALID_INPUT


def _follow_parameters(st: LeadState) -> None:
    if st.scene_done == 0 and st.time_ns >= st.scene_appear_s * NS_PER_S:
        appear(st, st.scene_gap_m, st.scene_speed_mps)
        st.scene_done = APPEARED
    if st.scene_done == APPEARED and _is_over(st, st.scene_change_s):
        st.wanted_mps = st.scene_next_speed_mps
        st.strength_mps2 = st.scene_change_mps2
        st.scene_done = CHANGED
    if 0 < st.scene_done < LEFT and _is_over(st, st.scene_leave_s):
        vanish(st)
        st.scene_done = LEFT


def _is_over(st: LeadState, time_s: float) -> bool:
    """Tell whether this time has come; 0 never comes."""
    return 0.0 < time_s * NS_PER_S <= st.time_ns


def _sense(st: LeadState) -> None:
    gap_m = st.rear_m - st.ego_m
    if st.there != 0 and gap_m < PASSED_M:
        vanish(st)
    elif st.there != 0 and gap_m <= 0.0 and st.trouble == NO_TROUBLE:
        st.trouble = CONTACT
    seen = st.there != 0 and st.unseen == 0 and gap_m <= st.traffic_reach_m
    st.lead_present = int(seen)
    st.lead_gap_m = gap_m if seen else 0.0
    st.lead_speed_mps = st.speed_mps if seen else 0.0
    st.lead_acceleration_mps2 = st.acceleration_mps2 if seen else 0.0
