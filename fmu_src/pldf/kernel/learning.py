"""SPAA: from the trace of a drive to the profile of the next one (section 3).

Order: set speed, plan anew, stretch pedal interventions, segments, mean, smoothing, bounds.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .bounds import hard_cap, keep_bounds
from .codes import BOUND_NONE, OUTCOME_LEARNED
from .evidence import keep_evidence
from .lowering import UNMARKED
from .offsets import adopt_offsets
from .outcomes import tell_outcomes
from .pieces import insert_pieces
from .preparation import plan
from .segments import learn_segments
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
    keep_evidence(profile, following)
    if st.nodes < 2:
        return
    drive = st.profile_iteration + 1.0
    adopt_offsets(st, (route, profile, trace, following))
    if _adopted(st, following):
        plan_with_offsets(st, route, profile, work, following)
        carry_learned(st, route, profile, following, drive)
    insert_pieces(st, route, trace, work, following.outcome)
    learn_segments(st, trace, work, following)
    bound_segments(st, route, work, following, drive)
    tell_outcomes(st, route, profile, trace, following)


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


def _adopted(st: PldfState, following: NextArrays) -> bool:
    adopted = False
    for k in range(st.set_series):
        adopted = adopted or following.set_outcome[k] == OUTCOME_LEARNED
    return adopted


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


def bound_segments(
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
