"""Which car is ahead, whether it limits, and standing behind it (section 8).

``look_ahead`` is called once per sample, before the request. It leaves in the state what ``gap``
needs to lower the request, and tells what the driver and the recorder have to know.
"""

from __future__ import annotations

from .arrays import ProfileArrays, RouteArrays
from .codes import ACTIVE, EVENT_TAKE_OVER, FAULT, GAS_OVERRIDE, INPUT_INVALID, OFF
from .gap import followed_request, gap_acceleration, stopping_room
from .hmi import start_event
from .state import PldfState
from .tracking import profile_request

# Slower than this behind a lead that does not go on, the car comes to its stop and is held; when
# following asks for more than that, it goes on (decisions).
STOPPING_MPS = 0.4
RESTART_MPS2 = 0.3
STANDS_MPS = 0.05  # vehicles at rest may tell a little speed
# Behind a lead that has left, the car is back at its profile this close to it (decision).
CAUGHT_UP_MPS = 1.0
TIME_GAP_MAX_S = 100.0


def look_ahead(st: PldfState, route: RouteArrays, profile: ProfileArrays, step_s: float) -> None:
    """Take the car ahead into account; ``step_s`` is how long the next request is in force."""
    if st.input_state == INPUT_INVALID:  # whose gap is not known is not followed
        st.lead_counts = 0
        st.standing = 0
        st.less_ns = -1
        st.lead_acts = 0
        st.following_limits = 0
        st.following_time_gap_s = 0.0
        tell_take_over(st, st.lead_present != 0 and st.mode == FAULT)
        return
    find_lead(st)
    _update_limits(st, route, profile, step_s)
    _update_standing(st)
    tell_take_over(st, _may_touch(st, step_s))


def find_lead(st: PldfState) -> None:
    """Take over the lead of the inputs; one that is lost drives on with its speed for a while."""
    st.following_time_gap_s = 0.0
    if st.lead_present != 0:
        st.lead_counts = 1
        st.lead_seen_ns = st.time_ns
        st.lead_ahead_m = st.lead_gap_m
        st.lead_mps = st.lead_speed_mps
        st.following_time_gap_s = _time_gap(st.lead_gap_m, st.vehicle_speed_mps)
    elif st.lead_counts != 0:
        passed_s = 1e-9 * (st.time_ns - st.lead_ns)
        st.lead_ahead_m += (st.lead_mps - st.vehicle_speed_mps) * passed_s
        if st.time_ns - st.lead_seen_ns > 1e9 * st.following_lost_s:
            st.lead_counts = 0
    st.lead_ns = st.time_ns


def _time_gap(gap_m: float, speed_mps: float) -> float:
    """Return the time (s) in which a car drives through the gap, within 0 and the longest told."""
    if gap_m <= 0.0:
        return 0.0
    if gap_m >= TIME_GAP_MAX_S * speed_mps:
        return TIME_GAP_MAX_S
    return gap_m / speed_mps


def _update_limits(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, step_s: float
) -> None:
    """Tell whether following asks for less than the profile, or did a short while ago.

    What the lead has done lasts until the car is back at its profile: who helps with the gas there
    wishes the profile, not the speed of the car that has left.
    """
    if st.mode in (OFF, FAULT):
        st.less_ns = -1
    elif st.standing != 0:
        st.less_ns = st.time_ns
    elif st.lead_counts != 0:
        request = profile_request(st, route, profile, 0.0)
        if followed_request(st, request, 0.0, step_s) < request:
            st.less_ns = st.time_ns
    recent = st.less_ns >= 0 and st.time_ns - st.less_ns <= 1e9 * st.following_limits_s
    slow = st.vehicle_speed_mps < st.target_speed_mps - CAUGHT_UP_MPS
    catching_up = st.less_ns >= 0 and st.following_limits != 0 and slow
    st.lead_acts = 1 if recent else 0
    st.following_limits = 1 if recent or catching_up else 0


def _update_standing(st: PldfState) -> None:
    """Hold a car that has come to its stop behind the lead, until it may go on."""
    speed = st.vehicle_speed_mps
    goes = True
    if st.lead_counts != 0:
        goes = gap_acceleration(st, st.lead_ahead_m, st.lead_mps, 0.0) > RESTART_MPS2
    if st.mode != ACTIVE:
        st.standing = 0
    elif st.standing != 0:
        if speed > STANDS_MPS:
            st.standing_ns = st.time_ns
        if goes and not waits_for_driver(st):
            st.standing = 0
    elif speed < STOPPING_MPS and not goes:
        st.standing = 1
        st.standing_ns = st.time_ns


def waits_for_driver(st: PldfState) -> bool:
    """Tell whether the car stands for so long that it goes on by RESUME or gas only."""
    held_ns = st.time_ns - st.standing_ns
    return st.standing != 0 and held_ns > 1e9 * st.following_restart_s


def confirm_restart(st: PldfState) -> None:
    """RESUME behind a lead: from now on the car may go on by itself for as long again."""
    st.standing_ns = st.time_ns


def _may_touch(st: PldfState, step_s: float) -> bool:
    """Tell whether the car, braking from now on as hard as it may, could touch a braking lead."""
    if st.lead_present == 0 or st.mode not in (ACTIVE, GAS_OVERRIDE):
        return False
    speed = max(st.vehicle_speed_mps, 0.0)
    request = st.acceleration_request_mps2
    # A faster lead leaves room at its stop even if they touch now.
    room_m = min(st.lead_gap_m, stopping_room(st, st.lead_gap_m, speed, request, step_s))
    return room_m < 0.0


def tell_take_over(st: PldfState, needed: bool) -> None:
    """Show whether the driver has to brake; the moment it begins is an event."""
    if needed and st.hmi_take_over == 0:
        start_event(st, EVENT_TAKE_OVER)
    st.hmi_take_over = 1 if needed else 0
