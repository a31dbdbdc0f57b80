"""Why the car drives at this speed, for the instrument cluster, and how sure the function is.

The reason is the constraint that binds now: the mode, another car, a temporary limit, a set speed
by hand, else that of the profile (``reasons``); and where the car is off the speed to drive, that
it goes there. A reason stays for a second, unless it has become false.
"""

from __future__ import annotations

from math import sqrt

from .arrays import ProfileArrays, RouteArrays
from .codes import (
    ACTIVE,
    FAULT,
    GAS_OVERRIDE,
    OFF,
    REASON_CAP_CURVE,
    REASON_CAP_LEGAL,
    REASON_COASTING_TO_LIMIT,
    REASON_CURVE,
    REASON_FAULT,
    REASON_FOLLOWING,
    REASON_HELD,
    REASON_LEARNED_FASTER,
    REASON_LEARNED_SLOWER,
    REASON_LIMIT,
    REASON_MANUAL_SET,
    REASON_OFF,
    REASON_OVERRIDE,
    REASON_SLOWING_DOWN,
    REASON_SPEEDING_UP,
    REASON_STANDBY,
    REASON_TEMPORARY_LIMIT,
)
from .following import waits_for_driver
from .hmi import HOLD_NS
from .interpolation import Place, place_at, value_of
from .lever import temporary_limit
from .ranges import EVIDENCE_MAX
from .reasons import AT_SET_MPS, CURVE_SHARE
from .recorder import learns_consistent
from .speech import update_sentence
from .state import PldfState
from .units import MPS_PER_KMH

# Further from the speed to drive than this, the car goes there, and that is what is said.
AWAY_MPS = 1.0
# Nearer to a speed than this the car neither slows down nor speeds up to it.
NEAR_MPS = 0.3
# Requests below this are none: so a sentence does not follow the trembling of a controller.
STILL_MPS2 = 0.1
# Twice as far is what makes a reason false that holds for its second.
FALSE_SHARE = 2.0
# A lesson whose numbers have changed by no more than this may go on being told for its second.
AT_NUMBERS_MPS = 0.4
# A reason (REASON in codes), the speed that its sentence names and that without lessons, m/s.
Reason = tuple[int, float, float]


def update_cluster(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Update reason and sentence at the end of a step, when all other outputs are known."""
    place = place_at(len(route.limit_mps), st.s_m + st.ahead_m)
    asked = _asked_by(st, route, profile, place)
    now = _as_driven(st, profile, place, asked)
    young = st.time_ns - max(st.reason_ns, st.numbers_ns) < HOLD_NS
    if now[0] == st.hmi_reason or not (young and _is_still_true(st, asked[0])):
        if now[0] != st.hmi_reason:
            st.reason_ns = st.time_ns
        st.hmi_reason = now[0]
        st.reason_speed_mps = now[1]
        st.reason_base_mps = now[2]
    elif asked[0] == st.hmi_reason:
        st.reason_speed_mps = asked[1]
        st.reason_base_mps = asked[2]
    st.hmi_reason_code = st.hmi_reason
    update_sentence(st, route, profile, place)


# Reasons


def _asked_by(st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place) -> Reason:
    """Return what asks for the present target speed, and the speed asked for."""
    if st.mode != ACTIVE:
        return _reason_of_mode(st.mode), 0.0, 0.0
    if st.lead_acts != 0:
        return (REASON_HELD if waits_for_driver(st) else REASON_FOLLOWING), 0.0, 0.0
    if st.manual_set_mps > 0.0 and st.s_m + st.ahead_m < st.manual_end_m:
        return _asked_by_hand(st, route, profile, place)
    temporary = temporary_limit(st, route, place[0])
    if temporary > 0.0 and st.target_speed_mps >= temporary - AT_SET_MPS:
        return REASON_TEMPORARY_LIMIT, temporary, 0.0
    return _asked_by_profile(st, profile, place)


def _reason_of_mode(mode: int) -> int:
    if mode == FAULT:
        return REASON_FAULT
    if mode == GAS_OVERRIDE:
        return REASON_OVERRIDE
    return REASON_OFF if mode == OFF else REASON_STANDBY


def _asked_by_profile(st: PldfState, profile: ProfileArrays, place: Place) -> Reason:
    reason = int(profile.reason[place[0]])
    if reason in (
        REASON_LEARNED_FASTER,
        REASON_LEARNED_SLOWER,
        REASON_CAP_CURVE,
        REASON_CAP_LEGAL,
    ):
        return reason, st.target_speed_mps, st.base_speed_mps
    return reason, profile.learned_mps[int(profile.aim_m[place[0]])], 0.0


def _asked_by_hand(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> Reason:
    """Return the same under a set speed set by hand (``target_of`` in tracking)."""
    target = st.target_speed_mps
    learned = value_of(profile.learned_mps, place)
    manual = st.manual_set_mps
    lesson = learned - value_of(profile.planned_mps, place)
    if abs(target - manual) <= AT_SET_MPS:
        return REASON_MANUAL_SET, manual, 0.0
    if target <= learned:
        return _asked_by_profile(st, profile, place)
    least = max(st.learning_deviation_min_mps, MPS_PER_KMH)
    if lesson < -least and target < st.base_speed_mps - least:  # as much lower as the profile
        return REASON_LEARNED_SLOWER, target, st.base_speed_mps
    behind = st.manual_behind_mps
    left_m = st.manual_end_m - st.s_m - st.ahead_m
    approach = sqrt(behind * behind - 2.0 * st.planner_accel_min_mps2 * left_m)
    before_sign = st.manual_end_m < len(profile.learned_mps) - 1
    if before_sign and target >= approach - AT_SET_MPS:
        lower = route.limit_mps[int(st.manual_end_m)] < route.limit_mps[place[0]]
        return (REASON_COASTING_TO_LIMIT if lower else REASON_SLOWING_DOWN), behind, 0.0
    curve = route.curvature_per_m[place[0]] * target * target
    binds = curve >= CURVE_SHARE * st.planner_lateral_accel_max_mps2
    falls = profile.open_mps[place[1]] < profile.open_mps[place[0]]
    if (binds or falls) and value_of(profile.open_mps, place) < manual - AT_SET_MPS:
        return REASON_CURVE, target, 0.0
    return REASON_SPEEDING_UP, manual, 0.0


def _as_driven(st: PldfState, profile: ProfileArrays, place: Place, asked: Reason) -> Reason:
    """Return ``asked``, or what the car does instead, if it does not do as ``asked`` says.

    Where the profile is steep, the request may lead away from the target. Where it does not even
    that, as in the moment in which the request turns, the limit is what is said.
    """
    reason = asked[0]
    stays = st.mode != ACTIVE or reason in (REASON_FOLLOWING, REASON_HELD)
    if stays or _does_so(st, asked):
        return asked
    speed = st.vehicle_speed_mps
    target = st.target_speed_mps
    goes = reason in (REASON_SLOWING_DOWN, REASON_SPEEDING_UP)
    off = NEAR_MPS if goes else AWAY_MPS
    if st.acceleration_request_mps2 < STILL_MPS2 and speed > target + off:
        return REASON_SLOWING_DOWN, target, 0.0
    if st.acceleration_request_mps2 > -STILL_MPS2 and speed < target - off:
        return REASON_SPEEDING_UP, target, 0.0
    if not goes:
        return asked
    aim = profile.learned_mps[int(profile.aim_m[place[0]])]
    fastest = max(aim, st.set_speed_mps)
    if st.acceleration_request_mps2 < 0.0 and speed > aim - AWAY_MPS:
        return REASON_SLOWING_DOWN, aim, 0.0
    speeds_up = st.acceleration_request_mps2 >= 0.0 and speed < fastest - NEAR_MPS
    return (REASON_SPEEDING_UP, fastest, 0.0) if speeds_up else (REASON_LIMIT, 0.0, 0.0)


def _does_so(st: PldfState, asked: Reason) -> bool:
    """Tell whether the car goes to the speed that is asked for."""
    speed = st.vehicle_speed_mps
    if asked[0] == REASON_SPEEDING_UP:
        return st.acceleration_request_mps2 > -STILL_MPS2 and speed < asked[1]
    slows = st.acceleration_request_mps2 < STILL_MPS2 and speed > asked[1]
    return slows and asked[0] in (REASON_SLOWING_DOWN, REASON_COASTING_TO_LIMIT, REASON_CURVE)


def _is_still_true(st: PldfState, asked: int) -> bool:
    """Tell whether the reason shown is not contradicted by what is ``asked`` for and done now."""
    shown = st.hmi_reason
    request = st.acceleration_request_mps2
    if st.mode != ACTIVE:
        return False
    if shown == REASON_LIMIT and abs(st.vehicle_speed_mps - st.limit_mps) < AWAY_MPS:
        return request > -2.0 * STILL_MPS2
    if asked in (REASON_FOLLOWING, REASON_HELD):
        return False
    if shown == REASON_SPEEDING_UP:
        return request > -STILL_MPS2 and st.vehicle_speed_mps < st.reason_speed_mps + NEAR_MPS
    if shown == REASON_SLOWING_DOWN:
        return request < STILL_MPS2 and st.vehicle_speed_mps > st.reason_speed_mps - NEAR_MPS
    return _is_place_still_so(st, asked)


def _is_place_still_so(st: PldfState, asked: int) -> bool:
    """Tell the same of a reason that belongs to a place or to the lever."""
    shown = st.hmi_reason
    target = st.target_speed_mps
    if shown in (REASON_LEARNED_FASTER, REASON_LEARNED_SLOWER):
        faster = shown == REASON_LEARNED_FASTER
        lesson = target - st.base_speed_mps if faster else st.base_speed_mps - target
        near = abs(target - st.reason_speed_mps) < AT_NUMBERS_MPS
        return lesson > AT_SET_MPS and near
    if shown == REASON_CURVE and st.acceleration_request_mps2 < STILL_MPS2:
        return shown == asked
    far = abs(st.vehicle_speed_mps - target) >= FALSE_SHARE * AWAY_MPS
    return shown == asked and (shown == REASON_MANUAL_SET or not far)


# What is known of a place


def confidence_at(st: PldfState, profile: ProfileArrays, place: Place) -> float:
    """Return how sure the function is of what it learned at ``place``, 0 to 1.

    Where consistency is asked for, what the evidence is of what would be enough; else ``1 - 2^-n``
    after ``n`` lessons, of which each halves the deviation.
    """
    i = place[0]
    if learns_consistent(st):
        pedals = max(profile.evidence_faster[i], profile.evidence_slower[i])
        lever = max(profile.offset_evidence_faster[i], profile.offset_evidence_slower[i])
        return max(pedals, lever) / EVIDENCE_MAX
    doubt = 1.0
    for _ in range(min(int(profile.lessons[i]), 60)):  # behind that it is 1, to the bit
        doubt *= 0.5
    return 1.0 - doubt
