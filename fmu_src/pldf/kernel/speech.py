"""Which sentence the instrument cluster shows, with which numbers (``sentences``).

A sentence stays for a second, unless it has become false. An event waits until the sentence before
has had its second; a warning does not.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays
from .codes import (
    EVENT_LEARNED,
    EVENT_NEW_LIMIT,
    EVENT_NONE,
    EVENT_PAUSED,
    EVENT_RESUMED,
    EVENT_TAKE_OVER,
    OUTCOME_LEARNED,
    REASON_CAP_LEGAL,
    REASON_COASTING_TO_LIMIT,
    REASON_LEARNED_FASTER,
    REASON_LEARNED_OFFSET,
    REASON_LEARNED_SLOWER,
    REASON_LIMIT,
    REASON_MANUAL_SET,
    REASON_SLOWING_DOWN,
    REASON_SPEEDING_UP,
    REASON_TEMPORARY_LIMIT,
    UNIT_MPH,
)
from .hmi import HOLD_NS, start_event
from .interpolation import Place
from .lever import automatic_set_speed
from .sentences import EVENT_SENTENCES
from .state import PldfState
from .units import KMH_PER_MPS, MPH_PER_MPS

# Whole km/h or mph by which a speed that changes by the metre may be off for its second.
NEARLY = 2


def update_sentence(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, place: Place
) -> None:
    """Say the event not told yet, or the reason, once the sentence before has had its second."""
    young = st.time_ns - st.numbers_ns < HOLD_NS
    told = st.hmi_sentence - EVENT_SENTENCES  # event that is being told; below 0: none
    numbers = _numbers_of(st, route, profile, place)
    true = st.hmi_sentence == st.hmi_reason and not _are_false(st, numbers)
    if st.hmi_take_over != 0:
        st.event_untold = EVENT_NONE
        _say(st, EVENT_SENTENCES + EVENT_TAKE_OVER, (0, 0, 0, 0))
    elif young and (true or _is_event_true(st, told)):
        return
    elif st.event_untold != EVENT_NONE:
        limit = _whole(st, st.limit_mps) if st.event_untold == EVENT_NEW_LIMIT else 0
        _say(st, EVENT_SENTENCES + st.event_untold, (0, 0, limit, 0))
        st.event_untold = EVENT_NONE
    else:
        _say(st, st.hmi_reason, numbers)


def say_learned(st: PldfState, following: NextArrays) -> None:
    """Say behind a drive that something was learned from it, if so."""
    learned = False
    for k in range(st.drive_interventions):
        learned = learned or following.outcome[k] == OUTCOME_LEARNED
    for k in range(st.set_series):
        learned = learned or following.set_outcome[k] == OUTCOME_LEARNED
    if learned:
        start_event(st, EVENT_LEARNED)
        st.event_untold = EVENT_NONE
        _say(st, EVENT_SENTENCES + EVENT_LEARNED, (0, 0, 0, 0))


def _is_event_true(st: PldfState, told: int) -> bool:
    """Tell whether the sentence of an event, below 0 none, is true still."""
    if told == EVENT_PAUSED:
        return st.teach_pause != 0
    if told == EVENT_RESUMED:
        return st.teach_pause == 0
    if told == EVENT_NEW_LIMIT:
        return st.hmi_sentence_limit == _whole(st, st.limit_mps)
    return told >= 0 and told != EVENT_TAKE_OVER


def _say(st: PldfState, sentence: int, numbers: tuple[int, int, int, int]) -> None:
    if st.hmi_sentence == sentence and not _differ(st, numbers):
        return
    st.hmi_sentence = sentence
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
    near = NEARLY
    if st.hmi_reason in (REASON_MANUAL_SET, REASON_LEARNED_OFFSET):
        near = 0
    if st.hmi_reason == REASON_SLOWING_DOWN:
        return st.hmi_sentence_speed > _whole(st, st.vehicle_speed_mps)
    if st.hmi_reason == REASON_SPEEDING_UP:
        return st.hmi_sentence_speed < _whole(st, st.vehicle_speed_mps)
    far = max(speed, base) > near
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
        limit = speed
    if reason in (REASON_LEARNED_FASTER, REASON_LEARNED_SLOWER):
        base = _whole(st, st.reason_base_mps)
        # What a set speed or a word of the driver moved, a drive by pedals has taught before.
        drive = int(profile.drive[cell]) if profile.intervention[cell] > 0.0 else 0
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
