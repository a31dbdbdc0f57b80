"""Drives a traffic script's events: what the car ahead does now. In the numba subset."""

from __future__ import annotations

from typing import Annotated, Final, NamedTuple

from pldf.kernel.arrays import Floats
from pldf.kernel.ranges import Range

from .clock import NS_PER_S
from .lead_motion import appear, vanish
from .lead_state import LeadState
from .script_kernel import AT_POSITION

APPEAR: Final = 1
SPEED: Final = 2
LOST: Final = 3
SEEN: Final = 4
LEAVE: Final = 5


class LeadScriptArrays(NamedTuple):
    """Events, one per index, in the order of the file."""

    at: Floats  # s, or m along the route
    unit: Annotated[Floats, Range(0, 1)]  # AT_TIME or AT_POSITION of our car
    action: Annotated[Floats, Range(1, 5)]
    gap_m: Floats  # of APPEAR, else 0
    speed_mps: Floats  # of APPEAR and SPEED, else 0
    acceleration_mps2: Floats  # how hard, of SPEED, else 0
    done: Annotated[Floats, Range(0, 1)]


def follow_traffic_script(st: LeadState, script: LeadScriptArrays) -> None:
    """Do, once each, what is due at ``st.time_ns`` and ``st.ego_m``."""
    for k in range(len(script.at)):
        reached = st.time_ns / NS_PER_S
        if script.unit[k] == AT_POSITION:
            reached = st.ego_m
        if script.done[k] == 0.0 and reached >= script.at[k]:
            script.done[k] = 1.0
            _act(st, script, k)


def _act(st: LeadState, script: LeadScriptArrays, k: int) -> None:
    action = int(script.action[k])
    if action == APPEAR:
        appear(st, script.gap_m[k], script.speed_mps[k])
    elif action == SPEED:
        st.wanted_mps = script.speed_mps[k]
        st.strength_mps2 = script.acceleration_mps2[k]
    elif action == LOST:
        st.unseen = 1
    elif action == SEEN:
        st.unseen = 0
    elif action == LEAVE:
        vanish(st)
