"""Which runs of a drive are learned, and what they become (section 3.4 to 3.6).

``work`` holds, per node: a = speed wished; b = marks of the pieces; c = the profile before the
pedals' lessons; d = scratch; e = of which intervention's run the node is, 0 = of none; f =
AS_PLANNED where nothing is smoothed; g = mean of wish and profile.
"""

from __future__ import annotations

from .arrays import NextArrays, TraceArrays, Work
from .codes import OUTCOME_LEARNED, OUTCOME_STOP
from .pieces import NOT_LEARNED
from .smoothing import smoothed_at
from .state import PldfState

IN_STOP = -1.0  # of a run in which the car stopped
AS_PLANNED = 3.0  # in ``work.f``: the plan comes back as it is, not smoothed


def find_segments(st: PldfState, trace: TraceArrays, work: Work, following: NextArrays) -> None:
    """Find each run that the driver caused, by marks and speeds in ``work``, and number its nodes.

    The numbers go into ``work.e``; ``work.c`` gets the profile that deviations are judged against.
    """
    end = st.first_node + st.nodes
    i = st.first_node
    # Deviations are judged against the profile before any segment of this drive is learned, and
    # smoothing is padded with it: so the order of the segments does not matter.
    for j in range(len(work.c)):
        work.c[j] = following.learned_mps[j]
        work.e[j] = 0.0
        work.f[j] = 0.0
    while i < end:
        if not _is_wish(st, work, i):
            i += 1
            continue
        last = _end_of_segment(st, trace, work, i, end)
        if _was_caused_by_driver(work, i, last):
            _judge_segment(st, trace, work, following, (i, last))
        i = last + 1


def average(st: PldfState, work: Work) -> None:
    """Eq. (3): fill ``work.g`` with the mean of wish and profile in all runs found."""
    for i in range(len(work.a)):
        if work.e[i] > 0.0:
            work.g[i] = work.c[i] + st.learning_weight * (work.a[i] - work.c[i])


def learn_segments(st: PldfState, work: Work, following: NextArrays) -> None:
    """Learn the means in ``work.g`` on each run of nodes that ``work.e`` numbers."""
    n = len(work.e)
    i = 0
    while i < n:
        last = i
        while last < n and work.e[last] > 0.0:
            last += 1
        if last > i:
            _learn_segment(st, work, following, i, last - 1)
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
    """Take the nodes between ``ends``, both included, unless the car stopped among them.

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
    _number_nodes(work, ends, stop)


def _number_nodes(work: Work, ends: tuple[int, int], stop: bool) -> None:
    """Write into ``work.e`` to which intervention each node between ``ends`` belongs.

    Nodes before the first intervention belong to it, nodes behind one to the one just ended.
    """
    number = 0.0
    for i in range(ends[1], ends[0] - 1, -1):
        number = work.b[i] if work.b[i] > 0.0 else number
    for i in range(ends[0], ends[1] + 1):
        number = work.b[i] if work.b[i] > 0.0 else number
        work.e[i] = IN_STOP if stop else number


def _learn_segment(st: PldfState, work: Work, following: NextArrays, first: int, last: int) -> None:
    """Smooth the nodes first..last and cross-fade them to the unchanged profile."""
    half = int(0.5 * (st.learning_smoothing_window_m - 1))
    n = len(work.a)
    for i in range(max(first - half, 0), min(last + half, n - 1) + 1):
        work.d[i] = work.c[i]
    for i in range(first, last + 1):
        work.d[i] = work.g[i]
    for i in range(first, last + 1):
        share = _share(st, n, i, (first, last))
        driven = work.c[i]
        wished = work.g[i] if work.f[i] == AS_PLANNED else smoothed_at(work.d, i, half)
        following.learned_mps[i] = driven + share * (wished - driven)
        following.drive[i] = st.profile_iteration + 1.0
        following.intervention[i] = work.e[i]
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
