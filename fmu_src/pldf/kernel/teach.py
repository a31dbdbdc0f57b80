"""The driver's last word, as a step hears it: pause, forget here, undo (section 7).

What the last two ask for plans the road anew, and an undo needs the history in the file: so the
runtime answers them behind the step (``last_word``).
"""

from __future__ import annotations

from .arrays import ProfileArrays, RouteArrays, TraceArrays
from .codes import (
    EVENT_PAUSED,
    EVENT_RESUMED,
    EVENT_UNDONE,
    OUTCOME_UNDONE,
    WORD_FORGET,
    WORD_UNDO,
)
from .hmi import start_event
from .interpolation import cell_at
from .recorder import learns, may_learn
from .state import PldfState
from .tracking import target_speed

# Bits of ``teach_was``.
PAUSE_SWITCH = 1
FORGET_BUTTON = 2
UNDO_BUTTON = 4


def hear_driver(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, trace: TraceArrays
) -> None:
    """Notice the presses of this sample; ``st.teach_wanted`` gets what the runtime has to answer.

    An undo that takes back what this drive recorded is answered here.
    """
    now = (
        PAUSE_SWITCH * (st.teach_pause != 0)
        + FORGET_BUTTON * (st.teach_forget_here != 0)
        + UNDO_BUTTON * (st.teach_undo != 0)
    )
    pressed = now & ~st.teach_was
    released = st.teach_was & ~now
    st.teach_was = now
    st.teach_wanted = 0
    if pressed & PAUSE_SWITCH:
        start_event(st, EVENT_PAUSED)
    if released & PAUSE_SWITCH:
        start_event(st, EVENT_RESUMED)
    if pressed & FORGET_BUTTON:
        st.teach_wanted = WORD_FORGET
    if pressed & UNDO_BUTTON:
        if _has_recorded_lesson(st, trace):
            _take_back_recorded(st, trace)
            start_event(st, EVENT_UNDONE)
        else:
            st.teach_wanted += WORD_UNDO
    if st.settling != 0:
        _notice_settled(st, route, profile)


def _notice_settled(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Learning goes on once the car drives what is in force: until then its speed is no wish."""
    error = st.vehicle_speed_mps - target_speed(st, route, profile, st.s_m)
    if error * st.settling <= st.learning_deviation_min_mps:
        st.settling = 0


def _has_recorded_lesson(st: PldfState, trace: TraceArrays) -> bool:
    """Tell whether this drive, as recorded so far, would teach something by pedal or lever."""
    if not learns(st):
        return False
    for k in range(st.drive_interventions):
        if trace.barred[k] <= 0.0 and _is_somewhere_eligible(st, trace, k):
            return True
    last = st.first_node + st.nodes - 1
    before = 0.0
    for i in range(st.first_node, last + 1):
        if _is_press(st, trace, i, before):
            return True
        before = trace.set_speed_mps[i]
    set_now = st.shown_set_mps > 0.0 and may_learn(st)
    return set_now and abs(st.shown_set_mps - before) > st.learning_offset_tolerance_mps


def _is_somewhere_eligible(st: PldfState, trace: TraceArrays, k: int) -> bool:
    """Tell whether learning was allowed on some metre of intervention ``k``, or is now in it."""
    found = st.intervening != 0 and k == st.drive_interventions - 1 and may_learn(st)
    first = max(cell_at(len(trace.gap), trace.start_m[k]), st.first_node)
    for i in range(first, cell_at(len(trace.gap), trace.end_m[k]) + 1):
        found = found or trace.eligible[i] > 0.0
    return found


def _is_press(st: PldfState, trace: TraceArrays, node: int, before_mps: float) -> bool:
    """Tell whether the lever was moved at ``node``, behind a set speed of ``before_mps``."""
    place = max(node - 1, st.first_node)
    open_to_lessons = trace.eligible[place] > 0.0 and trace.set_barred[place] <= 0.0
    set_mps = trace.set_speed_mps[node]
    moved = abs(set_mps - before_mps) > st.learning_offset_tolerance_mps
    return open_to_lessons and set_mps > 0.0 and moved


def _take_back_recorded(st: PldfState, trace: TraceArrays) -> None:
    """Let nothing be learned of what was recorded so far; it counts as no pass, either."""
    for k in range(st.drive_interventions):
        if trace.barred[k] <= 0.0:
            trace.barred[k] = float(OUTCOME_UNDONE)
    for i in range(st.first_node, st.first_node + st.nodes):
        trace.eligible[i] = 0.0
        trace.set_barred[i] = float(OUTCOME_UNDONE)
