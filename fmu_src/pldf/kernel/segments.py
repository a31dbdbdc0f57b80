"""Which runs of a drive are learned, and what they become (section 3.4 to 3.6)."""

from __future__ import annotations

from .arrays import NextArrays, TraceArrays, Work
from .codes import OUTCOME_LEARNED, OUTCOME_STOP
from .pieces import NOT_LEARNED
from .smoothing import smoothed_at
from .state import PldfState


def learn_segments(st: PldfState, trace: TraceArrays, work: Work, following: NextArrays) -> None:
    """Find each run that the driver caused, by marks and speeds in ``work``, and learn it."""
    end = st.first_node + st.nodes
    i = st.first_node
    # Deviations are judged against the profile before any segment of this drive is learned, and
    # smoothing is padded with it: so the order of the segments does not matter.
    for j in range(len(work.c)):
        work.c[j] = following.learned_mps[j]
    while i < end:
        if not _is_wish(st, work, i):
            i += 1
            continue
        last = _end_of_segment(st, trace, work, i, end)
        if _was_caused_by_driver(work, i, last):
            _judge_segment(st, trace, work, following, (i, last))
        i = last + 1


def _is_wish(st: PldfState, work: Work, i: int) -> bool:
    """Tell whether node ``i`` deviates, or lies in the stretched piece of an intervention.

    Inside a piece the smallest deviation counts: a wrong lesson that is nearly undone would stay
    for ever otherwise.
    """
    if work.b[i] == NOT_LEARNED:
        return False
    return work.b[i] > 0.0 or abs(work.a[i] - work.c[i]) > st.learning_deviation_min_mps


def _end_of_segment(st: PldfState, trace: TraceArrays, work: Work, start: int, end: int) -> int:
    """Return the last node of the run from ``start``; gaps below the segment gap merge."""
    last = start
    for i in range(start + 1, end):
        gap_s = trace.time_s[i] - trace.time_s[last]
        if work.b[i] == NOT_LEARNED or (i > last + 1 and gap_s >= st.learning_segment_gap_s):
            break
        if _is_wish(st, work, i):
            last = i
    return last


def _was_caused_by_driver(work: Work, first: int, last: int) -> bool:
    intervened = False
    for i in range(first, last + 1):
        intervened = intervened or work.b[i] > 0.0
    return intervened


def _judge_segment(
    st: PldfState, trace: TraceArrays, work: Work, following: NextArrays, ends: tuple[int, int]
) -> None:
    """Learn the nodes between ``ends``, both included, unless the car stopped among them.

    Half a stop learned would accelerate into the place, so its run is not learned at all.
    """
    stop = False
    for i in range(ends[0], ends[1] + 1):
        stop = stop or trace.speed_mps[i] < st.learning_speed_min_mps
        if work.b[i] > 0.0:
            stop = stop or following.outcome[int(work.b[i]) - 1] == OUTCOME_STOP
    for i in range(ends[0], ends[1] + 1):
        k = int(work.b[i]) - 1
        if k >= 0 and following.outcome[k] != OUTCOME_LEARNED:
            following.outcome[k] = OUTCOME_STOP if stop else OUTCOME_LEARNED
    if not stop:
        _learn_segment(st, work, following, ends[0], ends[1])


def _learn_segment(st: PldfState, work: Work, following: NextArrays, first: int, last: int) -> None:
    """Eq. (3) and smoothing on the nodes first..last, cross-faded to the unchanged profile."""
    half = int(0.5 * (st.learning_smoothing_window_m - 1))
    n = len(work.a)
    for i in range(max(first - half, 0), min(last + half, n - 1) + 1):
        work.d[i] = work.c[i]
    for i in range(first, last + 1):
        driven = work.c[i]
        work.d[i] = driven + st.learning_weight * (work.a[i] - driven)
    # Nodes before the first intervention belong to it, nodes behind one to the one just ended.
    number = 0.0
    for i in range(last, first - 1, -1):
        number = work.b[i] if work.b[i] > 0.0 else number
    for i in range(first, last + 1):
        share = _share(st, n, i, (first, last))
        driven = work.c[i]
        following.learned_mps[i] = driven + share * (smoothed_at(work.d, i, half) - driven)
        number = work.b[i] if work.b[i] > 0.0 else number
        following.drive[i] = st.profile_iteration + 1.0
        following.intervention[i] = number
        following.lessons[i] += 1.0


def _share(st: PldfState, n: int, i: int, ends: tuple[int, int]) -> float:
    """Return how much of the lesson node ``i`` gets: less than all near what does not change.

    At an end of the route there is nothing to come back to: the road goes on as it was.
    """
    # Counted from the unchanged neighbours, so that not even the outermost node jumps.
    edge = st.learning_fade_m + 1
    if ends[0] > 0:
        edge = min(edge, i - ends[0] + 1)
    if ends[1] < n - 1:
        edge = min(edge, ends[1] - i + 1)
    return edge / (st.learning_fade_m + 1.0)
