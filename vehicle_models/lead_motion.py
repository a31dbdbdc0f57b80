"""How the car ahead appears, moves and vanishes. In the numba subset (see ``pldf.kernel``)."""

from __future__ import annotations

from .lead_state import CARS_MAX, NOBODY, LeadState

# The last difference of speed is taken off with this time constant.
SETTLING_S = 0.4
# A stop ends with no less than this.
STOP_MPS2 = 0.5
# How hard a car accelerates and brakes where nothing else is said.
USUAL_MPS2 = 2.0


def appear(st: LeadState, gap_m: float, speed_mps: float) -> None:
    """Put a car ahead of ours, in steady motion, in place of one that may be there."""
    st.there = 1
    st.unseen = 0
    st.rear_m = st.ego_m + gap_m
    st.speed_mps = speed_mps
    st.acceleration_mps2 = 0.0
    st.wanted_mps = speed_mps
    st.strength_mps2 = USUAL_MPS2
    if st.lead_cars < CARS_MAX:
        st.lead_cars += 1


def vanish(st: LeadState) -> None:
    """Let the car leave the lane."""
    st.there = 0
    st.unseen = 0
    st.phase = NOBODY


def follow_wanted(st: LeadState, step_s: float) -> None:
    """Move by one internal step towards the wanted speed, within strength and jerk."""
    demand = (st.wanted_mps - st.speed_mps) / SETTLING_S
    if st.wanted_mps <= 0.0 < st.speed_mps:
        demand = min(demand, -STOP_MPS2)
    demand = max(-st.strength_mps2, min(demand, st.strength_mps2))
    change = st.traffic_jerk_max_mps3 * step_s
    acceleration = st.acceleration_mps2
    acceleration += max(-change, min(demand - acceleration, change))
    before = st.speed_mps
    after = before + acceleration * step_s
    if after > 0.0:
        st.rear_m += 0.5 * (before + after) * step_s
        st.speed_mps = after
        st.acceleration_mps2 = acceleration
        return
    if before > 0.0:  # it stops within the step, after this share of it
        st.rear_m += 0.5 * before * step_s * before / (before - after)
    st.speed_mps = 0.0
    st.acceleration_mps2 = 0.0
