"""What the instrument cluster tells the driver: why this speed, and what comes next."""

from __future__ import annotations

from .arrays import Floats, ProfileArrays, RouteArrays
from .codes import (
    EVENT_NEW_LIMIT,
    EVENT_NONE,
    FAULT,
    GAS_OVERRIDE,
    OFF,
    REASON_CAP_CURVE,
    REASON_CAP_LEGAL,
    REASON_COASTING_TO_LIMIT,
    REASON_CURVE,
    REASON_FAULT,
    REASON_LEARNED_FASTER,
    REASON_LEARNED_OFFSET,
    REASON_LEARNED_SLOWER,
    REASON_LIMIT,
    REASON_MANUAL_SET,
    REASON_OVERRIDE,
    REASON_STANDBY,
    STANDBY,
)
from .interpolation import Place, value_of
from .state import PldfState

PHASE_MPS2 = 0.05  # weaker accelerations of the profile count as cruising
CAP_MPS = 0.01  # nearer to a hard bound than this: the bound is the reason


EVENT_NS = 1_000_000_000  # an event is shown for a second


def start_event(st: PldfState, event: int) -> None:
    """Show ``event`` (EVENT in codes) for a second; a newer one takes its place."""
    st.hmi_event = event
    st.event_ns = st.time_ns


def show_event(st: PldfState) -> None:
    """Take down the event whose second is over."""
    if st.hmi_event != EVENT_NONE and st.time_ns - st.event_ns > EVENT_NS:
        st.hmi_event = EVENT_NONE


def notice_new_limit(st: PldfState) -> None:
    """Show that the legal limit is another one than at the end of the last step."""
    if st.noticed_limit_mps > 0.0 and st.limit_mps != st.noticed_limit_mps:
        start_event(st, EVENT_NEW_LIMIT)
    st.noticed_limit_mps = st.limit_mps


def find_turns(speed: Floats, turn_m: Floats) -> None:
    """Fill ``turn_m``: where the present acceleration phase of ``speed``, else the next, ends."""
    n = len(speed)
    turn_m[n - 1] = n - 1.0
    after = 0  # phase of the metre behind this one; cruising (0) lasts until the next phase ends
    for i in range(n - 2, -1, -1):
        acceleration = 0.5 * (speed[i + 1] * speed[i + 1] - speed[i] * speed[i])
        phase = 0
        if acceleration > PHASE_MPS2:
            phase = 1
        elif acceleration < -PHASE_MPS2:
            phase = -1
        turn_m[i] = turn_m[i + 1] if phase in (0, after) else i + 1.0
        after = phase


def reason(st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place) -> int:
    """Return the code of the reason for the present speed."""
    if st.mode == FAULT:
        return REASON_FAULT
    if st.mode in (OFF, STANDBY):
        return REASON_STANDBY
    if st.mode == GAS_OVERRIDE:
        return REASON_OVERRIDE
    if st.manual_set_mps > 0.0:
        return REASON_MANUAL_SET
    return _reason_of_profile(st, route, profile, place)


def _reason_of_profile(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> int:
    i = place[0]
    learned = value_of(profile.learned_mps, place)
    delta = learned - value_of(profile.planned_mps, place)
    if delta > 0.0 and _at_curve_bound(st, route.curvature_per_m[i], learned):
        return REASON_CAP_CURVE
    if delta > 0.0 and learned > route.limit_mps[i] + st.learning_over_limit_max_mps - CAP_MPS:
        return REASON_CAP_LEGAL
    if delta > st.learning_deviation_min_mps:
        return REASON_LEARNED_FASTER
    if delta < -st.learning_deviation_min_mps:
        return REASON_LEARNED_SLOWER
    return _reason_of_plan(route, profile, i, learned)


def _at_curve_bound(st: PldfState, curvature_per_m: float, speed: float) -> bool:
    near = speed + CAP_MPS
    return curvature_per_m * near * near > st.learning_lateral_accel_max_mps2


def _reason_of_plan(route: RouteArrays, profile: ProfileArrays, i: int, speed: float) -> int:
    set_speed = route.limit_mps[i] + profile.offset_mps[i]
    if speed > set_speed - CAP_MPS:
        return REASON_LEARNED_OFFSET if profile.offset_mps[i] != 0.0 else REASON_LIMIT
    turn = int(profile.turn_m[i])
    if turn > i and profile.planned_mps[turn] < speed:
        behind = route.limit_mps[turn] + profile.offset_mps[turn]
        if profile.planned_mps[turn] > behind - CAP_MPS:
            return REASON_COASTING_TO_LIMIT
        return REASON_CURVE
    if profile.open_mps[i] < set_speed - CAP_MPS:
        return REASON_CURVE
    return REASON_LIMIT
