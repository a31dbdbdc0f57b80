"""The driver's last word, as the runtime answers it behind a step: forget here, undo (section 7).

Each answer that changed something is a word, noted in the trace. At the end of the drive the
runtime says all words again, and keeps what was known behind each as an iteration of its own.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .codes import (
    BOUND_NONE,
    EVENT_FORGOTTEN,
    EVENT_NOTHING_TO_FORGET,
    EVENT_NOTHING_TO_UNDO,
    EVENT_UNDONE,
    INPUT_OK,
    OUTCOME_FORGOTTEN,
    OUTCOME_UNDONE,
    WORD_FORGET,
    WORD_UNDO,
)
from .drive import update_outputs
from .evidence import FASTER, SLOWER, of_lever, of_pedals, settle
from .hmi import start_event
from .interpolation import cell_at, value_at
from .learning import (
    bound_segments,
    carry_learned,
    copy_lessons,
    copy_profile,
    plan_with_offsets,
)
from .offsets import begin_of_limit, end_of_limit
from .preparation import adopt_learned
from .recorder import note_set_speed
from .state import PldfState
from .tracking import target_speed
from .undo import merge_before

# First and last node or cell, both included; the last lies before the first: there is none.
Ends = tuple[int, int]


def forget_here(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Put back to base what was learned where the car is, at once; ``work`` is overwritten.

    That is the pedal piece around the car and, of the limit there, offset, evidence and pending
    demonstrations. What this drive recorded of it before is not learned.
    """
    piece = piece_around(st, profile, cell_at(len(profile.learned_mps), st.s_m))
    cell = cell_at(len(route.limit_mps), st.s_m)
    limit = begin_of_limit(route, cell), end_of_limit(route, cell, len(route.limit_mps) - 1)
    room = st.input_state == INPUT_OK and st.words < len(trace.word_kind)
    if not (room and _is_known(profile, piece, limit)):
        start_event(st, EVENT_NOTHING_TO_FORGET)
        update_outputs(st, route, profile)
        return
    copy_profile(profile, following)
    _forget_limit(st, route, profile, work, following, limit)
    _forget_piece(st, following, piece)
    bound_segments(st, route, work, following)
    _bar_forgotten(st, trace, piece, limit)
    _bar_changed(st, profile, trace, following, OUTCOME_FORGOTTEN)
    _put_in_force(st, route, profile, work, following)
    _note_word(st, trace, WORD_FORGET, st.s_m)
    start_event(st, EVENT_FORGOTTEN)


def piece_around(st: PldfState, profile: ProfileArrays, node: int) -> Ends:
    """Return the run of nodes around ``node`` that a pedal lesson holds off the plan."""
    if not _is_off_plan(st, profile, node):
        return 1, 0
    first, last = node, node
    while first > 0 and _is_off_plan(st, profile, first - 1):
        first -= 1
    while last < len(profile.learned_mps) - 1 and _is_off_plan(st, profile, last + 1):
        last += 1
    return first, last


def _is_off_plan(st: PldfState, profile: ProfileArrays, i: int) -> bool:
    off_mps = profile.learned_mps[i] - profile.planned_mps[i]
    return abs(off_mps) > st.learning_deviation_min_mps


def _is_known(profile: ProfileArrays, piece: Ends, limit: Ends) -> bool:
    """Tell whether there is anything to forget."""
    known = piece[0] <= piece[1]
    for i in range(limit[0], limit[1] + 1):
        known = known or profile.offset_mps[i] != 0.0
        known = known or profile.evidence_faster[i] + profile.evidence_slower[i] > 0.0
        known = known or profile.pending_faster[i] + profile.pending_slower[i] > 0.0
        by_lever = profile.offset_evidence_faster[i] + profile.offset_evidence_slower[i]
        by_lever += profile.offset_pending_faster[i] + profile.offset_pending_slower[i]
        known = known or by_lever > 0.0
    return known


def _forget_limit(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    work: Work,
    following: NextArrays,
    limit: Ends,
) -> None:
    """Drop offsets, evidence and demonstrations; pedal lessons are carried to the new plan."""
    had_offset = False
    for i in range(limit[0], limit[1] + 1):
        had_offset = had_offset or following.offset_mps[i] != 0.0
        following.offset_mps[i] = 0.0
        _clear_evidence(following, i)
    if had_offset:
        plan_with_offsets(st, route, profile, work, following)
        carry_learned(st, route, profile, following)


def _forget_piece(st: PldfState, following: NextArrays, piece: Ends) -> None:
    for i in range(piece[0], piece[1] + 1):
        following.learned_mps[i] = following.planned_mps[i]
        following.drive[i] = st.profile_iteration + 1.0
        following.intervention[i] = 0.0
        following.lessons[i] = 0.0
        following.bound[i] = float(BOUND_NONE)
        _clear_evidence(following, i)


def _clear_evidence(following: NextArrays, i: int) -> None:
    """Forget what waits for more evidence at node and cell ``i``, and the evidence."""
    for sign in (FASTER, SLOWER):
        settle(of_pedals(following, sign), i, 0.0)
        settle(of_lever(following, sign), i, 0.0)


def _bar_forgotten(st: PldfState, trace: TraceArrays, piece: Ends, limit: Ends) -> None:
    """Let no intervention be learned that began before the press and overlaps what is forgotten."""
    for k in range(st.drive_interventions):
        if piece[0] <= piece[1] and trace.start_m[k] <= piece[1] and trace.end_m[k] >= piece[0]:
            trace.barred[k] = float(OUTCOME_FORGOTTEN)
    first = max(limit[0], st.first_node)
    for i in range(first, min(limit[1] + 1, st.first_node + st.nodes)):
        trace.set_barred[i] = float(OUTCOME_FORGOTTEN)


def _bar_changed(
    st: PldfState, profile: ProfileArrays, trace: TraceArrays, following: NextArrays, outcome: int
) -> None:
    """Let no metre be learned that was driven with a profile that is no longer in force."""
    for i in range(st.first_node, st.first_node + st.nodes):
        if following.learned_mps[i] != profile.learned_mps[i]:
            trace.eligible[i] = 0.0
        if following.offset_mps[i] != profile.offset_mps[i]:
            trace.set_barred[i] = float(outcome)


def _put_in_force(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, work: Work, following: NextArrays
) -> None:
    """Drive ``following`` from now on; the request follows as usual, within its limits."""
    copy_lessons(following, profile)
    adopt_learned(st, route, profile, work)
    if st.manual_set_mps > 0.0:
        st.manual_behind_mps = value_at(profile.learned_mps, st.manual_end_m)
    error = st.vehicle_speed_mps - target_speed(st, route, profile, st.s_m)
    st.settling = 0
    if abs(error) > st.learning_deviation_min_mps:
        st.settling = 1 if error > 0.0 else -1
    update_outputs(st, route, profile)
    note_set_speed(st)


def _note_word(st: PldfState, trace: TraceArrays, kind: int, at: float) -> None:
    trace.word_kind[st.words] = float(kind)
    trace.word_at[st.words] = at
    st.words += 1
    st.profile_iteration += 1


def take_back_lesson(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Take back iteration ``st.taken_back``, at once; 0: there is nothing to take back.

    ``following`` holds the iteration before it, ``work`` what ``mark_lesson`` found; both are
    overwritten.
    """
    if st.taken_back == 0:
        start_event(st, EVENT_NOTHING_TO_UNDO)
        update_outputs(st, route, profile)
        return
    merge_before(profile, following, work)
    _bar_changed(st, profile, trace, following, OUTCOME_UNDONE)
    _put_in_force(st, route, profile, work, following)
    _note_word(st, trace, WORD_UNDO, float(st.taken_back))
    start_event(st, EVENT_UNDONE)
