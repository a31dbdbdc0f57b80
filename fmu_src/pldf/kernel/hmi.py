"""What the instrument cluster tells the driver: the reason, the sentence, events, confidence.

The reason is the constraint that binds now: the mode, another car, a temporary limit, a set speed
by hand, else that of the profile (``reasons``); and where the car is off the speed to drive, that
it goes there. A reason stays for a second, and so does a sentence, unless it has become false.
"""

from __future__ import annotations

from math import sqrt

from .arrays import ProfileArrays, RouteArrays
from .codes import (
    ACTIVE,
    EVENT_NEW_LIMIT,
    EVENT_NONE,
    EVENT_TAKE_OVER,
    FAULT,
    GAS_OVERRIDE,
    LEARN_CONSISTENT,
    OFF,
    REASON_CAP_LEGAL,
    REASON_COASTING_TO_LIMIT,
    REASON_CURVE,
    REASON_FAULT,
    REASON_FOLLOWING,
    REASON_LEARNED_FASTER,
    REASON_LEARNED_OFFSET,
    REASON_LEARNED_SLOWER,
    REASON_LIMIT,
    REASON_MANUAL_SET,
    REASON_OFF,
    REASON_OVERRIDE,
    REASON_SLOWING_DOWN,
    REASON_SPEEDING_UP,
    REASON_STANDBY,
    REASON_TEMPORARY_LIMIT,
    UNIT_MPH,
)
from .interpolation import Place, place_at, value_of
from .lever import automatic_set_speed
from .ranges import EVIDENCE_MAX
from .reasons import AT_SET_MPS, CURVE_SHARE
from .sentences import EVENT_SENTENCES
from .state import PldfState
from .units import KMH_PER_MPS, MPH_PER_MPS

HOLD_NS = 1_000_000_000  # an event, a reason and a sentence are shown for a second
# Further from the speed to drive than this, the car goes there, and that is what is said.
AWAY_MPS = 1.0
# Requests below this are none: so a sentence does not follow the trembling of a controller.
STILL_MPS2 = 0.1
# Twice as far is what makes a reason false that holds for its second.
FALSE_SHARE = 2.0
# Whole km/h or mph by which a speed in a sentence may be off for its second.
NEARLY = 2

# A reason (REASON in codes) and the speed that its sentence names, m/s.
Reason = tuple[int, float]


def start_event(st: PldfState, event: int) -> None:
    """Show ``event`` (EVENT in codes) for a second; a newer one takes its place."""
    st.hmi_event = event
    st.event_ns = st.time_ns
    st.event_untold = event


def show_event(st: PldfState) -> None:
    """Take down the event whose second is over."""
    if st.hmi_event != EVENT_NONE and st.time_ns - st.event_ns > HOLD_NS:
        st.hmi_event = EVENT_NONE


def notice_new_limit(st: PldfState) -> None:
    """Show that the legal limit is another one than at the end of the last step."""
    if st.noticed_limit_mps > 0.0 and st.limit_mps != st.noticed_limit_mps:
        start_event(st, EVENT_NEW_LIMIT)
    st.noticed_limit_mps = st.limit_mps


def begin_cluster(st: PldfState) -> None:
    """Say before the first step what does not depend on any input: whether it is switched on."""
    st.hmi_reason = REASON_STANDBY if st.mode != OFF else REASON_OFF
    st.hmi_reason_code = st.hmi_reason
    st.hmi_sentence = st.hmi_reason


def update_cluster(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Update reason and sentence at the end of a step, when all other outputs are known."""
    place = place_at(len(route.limit_mps), st.s_m + st.ahead_m)
    asked = _asked_by(st, route, profile, place)
    now = _as_driven(st, asked)
    young = st.time_ns - st.reason_ns < HOLD_NS
    if now[0] == st.hmi_reason:
        st.reason_speed_mps = now[1]
    elif not (young and _is_still_true(st, asked[0])):
        st.hmi_reason = now[0]
        st.reason_ns = st.time_ns
        st.reason_speed_mps = now[1]
    st.hmi_reason_code = st.hmi_reason
    _update_sentence(st, route, profile, place)


# Reasons


def _asked_by(st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place) -> Reason:
    """Return what asks for the present target speed, and the speed asked for."""
    if st.mode != ACTIVE:
        return _reason_of_mode(st.mode), 0.0
    if st.following_limits != 0:
        return REASON_FOLLOWING, 0.0
    if st.manual_set_mps > 0.0 and st.s_m + st.ahead_m < st.manual_end_m:
        return _asked_by_hand(st, route, profile, place)
    return _asked_by_profile(st, profile, place)


def _reason_of_mode(mode: int) -> int:
    if mode == FAULT:
        return REASON_FAULT
    if mode == GAS_OVERRIDE:
        return REASON_OVERRIDE
    return REASON_OFF if mode == OFF else REASON_STANDBY


def _asked_by_profile(st: PldfState, profile: ProfileArrays, place: Place) -> Reason:
    reason = int(profile.reason[place[0]])
    if reason in (REASON_LEARNED_FASTER, REASON_LEARNED_SLOWER):
        return reason, st.target_speed_mps
    return reason, profile.learned_mps[int(profile.aim_m[place[0]])]


def _asked_by_hand(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> Reason:
    """Return the same under a set speed set by hand (``target_of`` in tracking)."""
    target = st.target_speed_mps
    learned = value_of(profile.learned_mps, place)
    manual = st.manual_set_mps
    if target >= manual - AT_SET_MPS:
        return REASON_MANUAL_SET, manual
    if target <= learned:
        return _asked_by_profile(st, profile, place)
    behind = st.manual_behind_mps
    left_m = st.manual_end_m - st.s_m - st.ahead_m
    approach = sqrt(behind * behind - 2.0 * st.planner_accel_min_mps2 * left_m)
    before_sign = st.manual_end_m < len(profile.learned_mps) - 1
    if before_sign and target >= approach - AT_SET_MPS:
        lower = route.limit_mps[int(st.manual_end_m)] < route.limit_mps[place[0]]
        return (REASON_COASTING_TO_LIMIT if lower else REASON_SLOWING_DOWN), behind
    curve = route.curvature_per_m[place[0]] * target * target
    falls = profile.open_mps[place[1]] <= profile.open_mps[place[0]]
    if falls or curve >= CURVE_SHARE * st.planner_lateral_accel_max_mps2:
        return REASON_CURVE, target
    return REASON_SPEEDING_UP, manual


def _as_driven(st: PldfState, asked: Reason) -> Reason:
    """Return ``asked``, or that the car goes to the speed asked for, if it is far from it."""
    if st.mode != ACTIVE or asked[0] == REASON_FOLLOWING:
        return asked
    speed = st.vehicle_speed_mps
    target = st.target_speed_mps
    request = st.acceleration_request_mps2
    slows = asked[0] in (REASON_COASTING_TO_LIMIT, REASON_CURVE, REASON_SLOWING_DOWN)
    if request < STILL_MPS2 and speed > target + AWAY_MPS and not (slows and asked[1] < speed):
        return REASON_SLOWING_DOWN, target
    if request < -STILL_MPS2 and speed > target and asked[0] == REASON_SPEEDING_UP:
        return REASON_SLOWING_DOWN, target
    if request > -STILL_MPS2 and speed < target - AWAY_MPS and asked[0] != REASON_SPEEDING_UP:
        return REASON_SPEEDING_UP, target
    return asked


def _is_still_true(st: PldfState, asked: int) -> bool:
    """Tell whether the reason shown is not contradicted by what is ``asked`` for and done now."""
    shown = st.hmi_reason
    if st.mode != ACTIVE or asked == REASON_FOLLOWING:
        return False
    speed = st.vehicle_speed_mps
    request = st.acceleration_request_mps2
    if shown == REASON_SPEEDING_UP:
        return request > -STILL_MPS2 and speed < st.reason_speed_mps
    if shown == REASON_SLOWING_DOWN:
        return request < STILL_MPS2 and speed > st.reason_speed_mps
    return shown == asked and abs(speed - st.target_speed_mps) < FALSE_SHARE * AWAY_MPS


# Sentences


def _update_sentence(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> None:
    """Say the event not told yet, or the reason, once the sentence before has had its second."""
    young = st.time_ns - st.sentence_ns < HOLD_NS
    told = st.hmi_sentence - EVENT_SENTENCES  # event that is being told; below 0: none
    if st.hmi_take_over != 0:
        st.event_untold = EVENT_NONE
        _say(st, EVENT_SENTENCES + EVENT_TAKE_OVER, (0, 0, 0, 0))
    elif told >= 0 and told != EVENT_TAKE_OVER and young:
        return
    elif st.event_untold != EVENT_NONE and not (young and st.hmi_sentence == st.hmi_reason):
        limit = _whole(st, st.limit_mps) if st.event_untold == EVENT_NEW_LIMIT else 0
        _say(st, EVENT_SENTENCES + st.event_untold, (0, 0, limit, 0))
        st.event_untold = EVENT_NONE
    else:
        if told >= 0:  # the reason has its second from now on
            st.reason_ns = st.time_ns
        _say(st, st.hmi_reason, _numbers_of(st, route, profile, place))


def _say(st: PldfState, sentence: int, numbers: tuple[int, int, int, int]) -> None:
    """Show a sentence; the same one with other numbers once a second, or where they are false."""
    same = st.hmi_sentence == sentence
    old = st.time_ns - st.numbers_ns >= HOLD_NS
    if same and not old and not _are_false(st, numbers):
        return
    if not same:
        st.hmi_sentence = sentence
        st.sentence_ns = st.time_ns
    if not same or _differ(st, numbers):
        st.hmi_sentence_speed = numbers[0]
        st.hmi_sentence_base = numbers[1]
        st.hmi_sentence_limit = numbers[2]
        st.hmi_sentence_drive = numbers[3]
        st.numbers_ns = st.time_ns


def _differ(st: PldfState, numbers: tuple[int, int, int, int]) -> bool:
    speeds = st.hmi_sentence_speed != numbers[0] or st.hmi_sentence_base != numbers[1]
    return speeds or st.hmi_sentence_limit != numbers[2] or st.hmi_sentence_drive != numbers[3]


def _are_false(st: PldfState, numbers: tuple[int, int, int, int]) -> bool:
    """Tell whether the numbers shown are no longer these: speeds may be off by NEARLY."""
    speed = abs(st.hmi_sentence_speed - numbers[0])
    base = abs(st.hmi_sentence_base - numbers[1])
    far = max(speed, base) > NEARLY
    return far or st.hmi_sentence_limit != numbers[2] or st.hmi_sentence_drive != numbers[3]


def _numbers_of(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> tuple[int, int, int, int]:
    """Return speed, base, limit and drive for the sentence of the reason, in the unit chosen.

    What the sentence does not name is 0.
    """
    cell = place[0]
    reason = st.hmi_reason
    speed = _whole(st, st.reason_speed_mps)
    base = 0
    limit = 0
    drive = 0
    if reason == REASON_LEARNED_OFFSET:
        speed = _whole(st, automatic_set_speed(route, profile, cell))
    if reason in (REASON_LIMIT, REASON_LEARNED_OFFSET, REASON_CAP_LEGAL):
        limit = _whole(st, st.limit_mps)
    if reason == REASON_COASTING_TO_LIMIT:
        limit = _whole(st, route.limit_mps[int(profile.limit_end_m[cell])])
    if reason == REASON_TEMPORARY_LIMIT:
        limit = _whole(st, st.limit_override_mps)
    if reason in (REASON_LEARNED_FASTER, REASON_LEARNED_SLOWER):
        base = _whole(st, st.base_speed_mps)
        drive = int(profile.drive[cell])
        # They differ by 1 km/h or more; in the coarser mph they must not come out equal.
        faster = reason == REASON_LEARNED_FASTER
        speed = max(speed, base + 1) if faster else min(speed, base - 1)
    if reason in (REASON_LIMIT, REASON_TEMPORARY_LIMIT):
        speed = 0
    return speed, base, limit, drive


def _whole(st: PldfState, speed_mps: float) -> int:
    """Return the nearest whole number of km/h or mph."""
    per_mps = MPH_PER_MPS if st.hmi_unit == UNIT_MPH else KMH_PER_MPS
    return int(per_mps * max(speed_mps, 0.0) + 0.5)


# What is known of a place


def confidence_at(st: PldfState, profile: ProfileArrays, place: Place) -> float:
    """Return how sure the function is of what it learned at ``place``, 0 to 1.

    Where consistency is asked for, what the evidence is of what would be enough; else ``1 - 2^-n``
    after ``n`` lessons, of which each halves the deviation.
    """
    i = place[0]
    if st.learn == LEARN_CONSISTENT or st.learn_consistent != 0:
        pedals = max(profile.evidence_faster[i], profile.evidence_slower[i])
        lever = max(profile.offset_evidence_faster[i], profile.offset_evidence_slower[i])
        return max(pedals, lever) / EVIDENCE_MAX
    doubt = 1.0
    for _ in range(min(int(profile.lessons[i]), 60)):  # behind that it is 1, to the bit
        doubt *= 0.5
    return 1.0 - doubt
