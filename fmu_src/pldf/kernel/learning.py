"""SPAA: from the trace of a drive to the profile of the next one (section 3).

Order: set speed, plan anew, stretch pedal interventions, segments, mean, smoothing, bounds.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .bounds import hard_cap, keep_bounds
from .codes import BOUND_NONE
from .interpolation import cell_at, value_at
from .lowering import UNMARKED
from .offsets import adopt_offsets
from .preparation import plan
from .smoothing import smoothed_at
from .state import PldfState
from .stretch import joined_speed, source_position, stretch_factor, stretched_position

SAME_PLAN_MPS = 1e-9  # plans nearer than this are the same plan, rounded differently

NOT_LEARNED = -1.0  # marks of a node: nothing may be learned here
FREE = 0.0  # the driver did not intervene; 1, 2, ... = number of the intervention


def learn_drive(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Fill ``following`` with what this drive leaves for the next one.

    ``profile`` holds the profile driven. ``work`` is overwritten: a = preprocessed speed,
    b = marks, c = profile before the pedals' lessons, d = their mean, all else scratch.
    """
    copy_profile(profile, following)
    if st.nodes < 2:
        return
    drive = st.profile_iteration + 1.0
    if adopt_offsets(st, route, profile, trace, following.offset_mps) > 0:
        _plan_with_offsets(st, route, profile, work, following)
        _carry_learned(st, route, profile, following, drive)
    _preprocess(st, route, trace, work)
    _learn_segments(st, trace, work, following)
    _bound_segments(st, route, work, following, drive)


def copy_profile(profile: ProfileArrays, following: NextArrays) -> None:
    """Start from the profile driven: what is not learned stays as it is, to the bit."""
    for i in range(len(profile.learned_mps)):
        following.planned_mps[i] = profile.planned_mps[i]
        following.learned_mps[i] = profile.learned_mps[i]
        following.offset_mps[i] = profile.offset_mps[i]
        following.drive[i] = profile.drive[i]
        following.intervention[i] = profile.intervention[i]
        following.lessons[i] = profile.lessons[i]
        following.bound[i] = profile.bound[i]


def _plan_with_offsets(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    work: Work,
    following: NextArrays,
) -> None:
    road = (route.limit_mps, following.offset_mps, route.curvature_per_m)
    plan(st, road, following.planned_mps, work)
    for i in range(len(following.planned_mps)):
        # The hull of the planner rounds differently with other numbers far away.
        if abs(following.planned_mps[i] - profile.planned_mps[i]) <= SAME_PLAN_MPS:
            following.planned_mps[i] = profile.planned_mps[i]


def _carry_learned(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    following: NextArrays,
    drive: float,
) -> None:
    """Where the plan changed, put what the pedals taught on top of the new plan (decision).

    A slowdown taught at a much higher set speed ends at the lowest speed that may be learned, and
    what was taught at a lower one at the caps.
    """
    for i in range(len(following.planned_mps)):
        if following.planned_mps[i] != profile.planned_mps[i]:
            taught = profile.learned_mps[i] - profile.planned_mps[i]
            slowest = min(following.planned_mps[i], st.learning_speed_min_mps)
            carried = max(following.planned_mps[i] + taught, slowest)
            following.learned_mps[i] = min(carried, hard_cap(st, route, i))
            following.drive[i] = drive
            following.intervention[i] = 0.0


def _preprocess(st: PldfState, route: RouteArrays, trace: TraceArrays, work: Work) -> None:
    """Fill ``work.a`` with the recorded speed, stretched pieces inserted, and ``work.b``: marks."""
    for i in range(st.first_node, st.first_node + st.nodes):
        work.a[i] = trace.speed_mps[i]
        work.b[i] = FREE if trace.usable[i] > 0.0 else NOT_LEARNED
    for k in range(st.drive_interventions):
        # One without length has no weights in eq. (2): pressed and released between two samples.
        if trace.end_m[k] > max(trace.start_m[k], float(st.first_node)):
            _insert_stretched(st, trace, work, k, stretch_factor(st, route, trace, k))


def _insert_stretched(st: PldfState, trace: TraceArrays, work: Work, k: int, alpha: float) -> None:
    d_0 = trace.start_m[k]
    d_n = trace.end_m[k]
    start = stretched_position(d_0, d_n, alpha)
    lift = value_at(trace.speed_mps, start) - value_at(trace.speed_mps, d_0)
    first = max(cell_at(len(work.a), start), st.first_node)
    end = st.first_node + st.nodes - 1
    last = min(cell_at(len(work.a), d_n), end)
    for i in range(first, last + 1):
        if i < start:
            continue
        # Behind the last node recorded there is no speed to read, though the drive went on a bit.
        d = min(source_position(float(i), d_n, alpha), float(end))
        speed = joined_speed(value_at(trace.speed_mps, d), d, (d_0, d_n), lift)
        usable = trace.usable[cell_at(len(trace.usable), d)] > 0.0 and work.b[i] != NOT_LEARNED
        work.a[i] = speed
        work.b[i] = k + 1.0 if usable and speed >= st.learning_speed_min_mps else NOT_LEARNED


def _learn_segments(st: PldfState, trace: TraceArrays, work: Work, following: NextArrays) -> None:
    """Find each run that deviates because of the driver, and learn it."""
    end = st.first_node + st.nodes
    i = st.first_node
    # Deviations are judged against the profile before any segment of this drive is learned, and
    # smoothing is padded with it: so the order of the segments does not matter.
    for j in range(len(work.c)):
        work.c[j] = following.learned_mps[j]
    while i < end:
        if not _deviates(st, work, i):
            i += 1
            continue
        last = _end_of_segment(st, trace, work, i, end)
        if _was_caused_by_driver(trace, work, i, last):
            _learn_segment(st, work, following, i, last)
        i = last + 1


def _deviates(st: PldfState, work: Work, i: int) -> bool:
    return work.b[i] != NOT_LEARNED and abs(work.a[i] - work.c[i]) > st.learning_deviation_min_mps


def _end_of_segment(st: PldfState, trace: TraceArrays, work: Work, start: int, end: int) -> int:
    """Return the last node of the run from ``start``; gaps below the segment gap merge."""
    last = start
    for i in range(start + 1, end):
        gap_s = trace.time_s[i] - trace.time_s[last]
        if work.b[i] == NOT_LEARNED or (i > last + 1 and gap_s >= st.learning_segment_gap_s):
            break
        if _deviates(st, work, i):
            last = i
    return last


def _was_caused_by_driver(trace: TraceArrays, work: Work, first: int, last: int) -> bool:
    """Tell whether the run holds an intervention and no hole of the recording."""
    intervened = False
    for i in range(first, last + 1):
        if trace.gap[i] > 0.0:
            return False
        intervened = intervened or work.b[i] > 0.0
    return intervened


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
        # Counted from the unchanged neighbours, so that not even the outermost node jumps.
        edge = min(i - first + 1, last - i + 1)
        share = min(edge / (st.learning_fade_m + 1.0), 1.0)
        driven = work.c[i]
        following.learned_mps[i] = driven + share * (smoothed_at(work.d, i, half) - driven)
        number = work.b[i] if work.b[i] > 0.0 else number
        following.drive[i] = st.profile_iteration + 1.0
        following.intervention[i] = number
        following.lessons[i] += 1.0


def _bound_segments(
    st: PldfState, route: RouteArrays, work: Work, following: NextArrays, drive: float
) -> None:
    """Keep the bounds, once, on all that this drive changed; what that lowers around it joins."""
    for i in range(len(work.b)):
        work.b[i] = UNMARKED
        if following.drive[i] == drive:
            work.b[i] = following.intervention[i] + 1.0
            following.bound[i] = BOUND_NONE
    keep_bounds(st, route, following.learned_mps, following.bound, work)
    for i in range(len(work.b)):
        if work.b[i] != UNMARKED:
            following.drive[i] = drive
            following.intervention[i] = work.b[i] - 1.0
