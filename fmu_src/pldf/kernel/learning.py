"""SPAA: from the trace of a drive to the profile of the next one (section 3).

Order: set speed, plan anew, stretch pedal interventions, segments, mean, smoothing, bounds. Where
only what is consistent is learned (section 6), evidence decides between segments and mean.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .bounds import hard_cap, keep_bounds
from .codes import BOUND_NONE, OUTCOME_LEARNED
from .evidence import copy_evidence
from .evidence_places import find_places
from .lever_evidence import drop_offset_evidence, recognize_offsets, weigh_offsets
from .lowering import UNMARKED
from .offsets import Drive, adopt_offsets, approach_offsets
from .outcomes import tell_outcomes
from .pedal_evidence import accept_pedals, drop_evidence, recognize_lessons, weigh_pedals
from .pieces import insert_pieces
from .preparation import plan
from .recorder import learns_consistent
from .segments import AS_PLANNED, average, find_segments, learn_segments
from .speech import say_learned
from .state import PldfState

SAME_PLAN_MPS = 1e-9  # plans nearer than this are the same plan, rounded differently


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
    lever = (route, profile, trace, following, work.h)
    adopt_offsets(st, lever)
    _follow_offsets(st, route, profile, work, following)
    insert_pieces(st, route, trace, work, following.outcome)
    find_segments(st, trace, work, following)
    if learns_consistent(st):
        _weigh(st, lever, work)
    else:
        st.evidence_places = 0
        average(st, work)
        drop_evidence(work, following)
        drop_offset_evidence(lever)
    _go_part_of_the_way(st, lever, work)
    learn_segments(st, work, following)
    bound_segments(st, route, work, following)
    tell_outcomes(st, route, profile, trace, following)
    if learns_consistent(st):
        find_places(st, profile, following)
    say_learned(st, following)


def _weigh(st: PldfState, lever: Drive, work: Work) -> None:
    """Let evidence decide what is learned (section 6).

    The pedals are judged against the plan with every offset set in this drive, whether it is
    adopted or has to wait: else the lever's wish would count as the pedals', too.
    """
    route, profile, trace, following, _ = lever
    recognize_lessons(st, profile, following)
    recognize_offsets(st, profile, following)
    weigh_pedals(st, trace, work, following)
    weigh_offsets(st, lever)
    if st.set_series > 0:
        _follow_offsets_anew(st, route, profile, work, following)
        for i in range(len(work.c)):
            work.c[i] = following.learned_mps[i]
    accept_pedals(st, work, following)


def _go_part_of_the_way(st: PldfState, lever: Drive, work: Work) -> None:
    """Plan with the share of the adopted offsets that ``learning_set_speed_gain`` says.

    What the pedals teach was judged against all of them, the set speed that the driver drove with:
    it is carried to this plan, so that what the lever still lacks is not learned from the pedals.
    """
    route, profile, _, following, _ = lever
    if st.learning_set_speed_gain < 1.0 and _adopted(st, following):
        approach_offsets(st, profile, following)
        for i in range(len(work.c)):
            work.d[i] = work.c[i]  # planning overwrites it
        _follow_offsets_anew(st, route, profile, work, following)
        for i in range(len(work.c)):
            work.g[i] += following.learned_mps[i] - work.d[i]
            if work.f[i] == AS_PLANNED:
                work.g[i] = following.planned_mps[i]
            work.c[i] = following.learned_mps[i]


def copy_profile(profile: ProfileArrays, following: NextArrays) -> None:
    """Start from the profile driven: what is not learned stays as it is, to the bit."""
    for i in range(len(profile.planned_mps)):
        following.planned_mps[i] = profile.planned_mps[i]
    copy_lessons(profile, following)


def copy_lessons(known: ProfileArrays | NextArrays, kept: ProfileArrays | NextArrays) -> None:
    """Copy all that is kept from drive to drive."""
    for i in range(len(known.learned_mps)):
        kept.learned_mps[i] = known.learned_mps[i]
        kept.offset_mps[i] = known.offset_mps[i]
        kept.drive[i] = known.drive[i]
        kept.intervention[i] = known.intervention[i]
        kept.lessons[i] = known.lessons[i]
        kept.bound[i] = known.bound[i]
    copy_evidence(known, kept)


def _adopted(st: PldfState, following: NextArrays) -> bool:
    adopted = False
    for k in range(st.set_series):
        adopted = adopted or following.set_outcome[k] == OUTCOME_LEARNED
    return adopted


def _follow_offsets(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Plan anew with the offsets that were adopted, if any were."""
    if _adopted(st, following):
        plan_with_offsets(st, route, profile, work, following)
        carry_learned(st, route, profile, following)


def _follow_offsets_anew(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Plan with other offsets than ``following`` was planned with before in this lesson."""
    for i in range(len(profile.learned_mps)):
        following.planned_mps[i] = profile.planned_mps[i]
        following.learned_mps[i] = profile.learned_mps[i]
        following.drive[i] = profile.drive[i]
        following.intervention[i] = profile.intervention[i]
    _follow_offsets(st, route, profile, work, following)


def plan_with_offsets(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    work: Work,
    following: NextArrays,
) -> None:
    """Plan ``following`` with its offsets; where that is as in ``profile``, to the bit."""
    road = (route.limit_mps, following.offset_mps, route.curvature_per_m)
    plan(st, road, following.planned_mps, work)
    for i in range(len(following.planned_mps)):
        # The hull of the planner rounds differently with other numbers far away.
        if abs(following.planned_mps[i] - profile.planned_mps[i]) <= SAME_PLAN_MPS:
            following.planned_mps[i] = profile.planned_mps[i]


def carry_learned(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    following: NextArrays,
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
            following.drive[i] = st.profile_iteration + 1.0
            following.intervention[i] = 0.0


def bound_segments(st: PldfState, route: RouteArrays, work: Work, following: NextArrays) -> None:
    """Keep the bounds, once, on all that this drive changed; what that lowers around it joins."""
    drive = st.profile_iteration + 1.0
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
