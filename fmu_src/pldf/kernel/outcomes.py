"""What a drive taught, told per intervention: where, how much, and held by which bound."""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays
from .codes import OUTCOME_NOT_MOVED
from .interpolation import cell_at
from .pieces import ends_of_piece
from .state import PldfState
from .stretch import source_position, stretch_factor


def tell_outcomes(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    following: NextArrays,
) -> None:
    """Fill what ``following`` tells per pedal intervention and per place that a bound held.

    ``profile`` holds the profile driven: changes are told against it. The number of holds goes
    into ``st.holds``.
    """
    for k in range(st.drive_interventions):
        following.taught_m[k] = 0.0
        following.taught_from_m[k] = 0.0
        following.taught_to_m[k] = 0.0
        following.mean_change_mps[k] = 0.0
        following.largest_change_mps[k] = 0.0
        following.hole_s[k] = 0.0
        following.hole_m[k] = 0.0
        following.barred_m[k] = 0.0
        if following.outcome[k] != OUTCOME_NOT_MOVED:
            alpha = stretch_factor(st, route, trace, k)
            _measure_holes(st, trace, following, k, alpha)
            _count_barred(st, trace, following, k, alpha)
    for k in range(st.set_series):
        _count_barred_by_lever(st, trace, following, k)
    _sum_changes(st, profile, following)
    _find_holds(st, following)


def _measure_holes(
    st: PldfState, trace: TraceArrays, following: NextArrays, k: int, alpha: float
) -> None:
    """Measure the holes that touch the stretched piece of intervention ``k``, in s and m.

    The samples around a hole are not known, only the nodes: each up to a metre before them.
    """
    end = st.first_node + st.nodes - 1
    i, last = ends_of_piece(st, trace, k, alpha)
    while i > st.first_node and trace.gap[i] > 0.0 and trace.gap[i - 1] > 0.0:
        i -= 1
    # A hole that begins behind the piece does not touch it.
    while i <= last or (i <= end and min(trace.gap[i], trace.gap[i - 1]) > 0.0):
        if trace.gap[i] > 0.0:
            following.hole_m[k] += 1.0
            following.hole_s[k] += trace.time_s[i] - trace.time_s[max(i - 1, st.first_node)]
        i += 1


def _count_barred(
    st: PldfState, trace: TraceArrays, following: NextArrays, k: int, alpha: float
) -> None:
    """Count the nodes of the stretched piece where learning was not allowed, there or recorded."""
    end = st.first_node + st.nodes - 1
    first, last = ends_of_piece(st, trace, k, alpha)
    for i in range(first, last + 1):
        recorded = min(source_position(float(i), trace.end_m[k], alpha), float(end))
        eligible = trace.eligible[cell_at(len(trace.gap), recorded)]
        if min(trace.eligible[i], eligible) <= 0.0:
            following.barred_m[k] += 1.0


def _count_barred_by_lever(
    st: PldfState, trace: TraceArrays, following: NextArrays, k: int
) -> None:
    """Count the recorded cells of series ``k`` where learning was not allowed."""
    following.set_barred_m[k] = 0.0
    behind = min(int(following.set_to_m[k]), st.first_node + st.nodes)
    for cell in range(max(int(following.set_from_m[k]), st.first_node), behind):
        if trace.eligible[cell] <= 0.0:
            following.set_barred_m[k] += 1.0


def _sum_changes(st: PldfState, profile: ProfileArrays, following: NextArrays) -> None:
    """Sum up, per intervention, how the nodes that it shaped last differ from those driven."""
    drive = st.profile_iteration + 1.0
    for i in range(len(following.learned_mps)):
        k = int(following.intervention[i]) - 1
        if following.drive[i] == drive and k >= 0:
            change = following.learned_mps[i] - profile.learned_mps[i]
            if following.taught_m[k] == 0.0:
                following.taught_from_m[k] = float(i)
            following.taught_to_m[k] = float(i)
            following.taught_m[k] += 1.0
            following.mean_change_mps[k] += change
            if abs(change) > abs(following.largest_change_mps[k]):
                following.largest_change_mps[k] = change
    for k in range(st.drive_interventions):
        following.mean_change_mps[k] /= max(following.taught_m[k], 1.0)


def _find_holds(st: PldfState, following: NextArrays) -> None:
    """Note each run of nodes of one intervention (0: of the lever) that the same bound cut last."""
    st.holds = 0
    for i in range(len(following.bound)):
        if following.drive[i] != st.profile_iteration + 1.0 or following.bound[i] <= 0.0:
            continue
        if i == 0 or st.holds == 0 or not _goes_on(following, st.holds - 1, i):
            _begin_hold(following, st.holds, i)
            st.holds += 1
        _extend_hold(following, st.holds - 1, i)


def _goes_on(following: NextArrays, hold: int, i: int) -> bool:
    return (
        following.hold_to_m[hold] == i - 1.0
        and following.hold_bound[hold] == following.bound[i]
        and following.hold_intervention[hold] == following.intervention[i]
    )


def _begin_hold(following: NextArrays, hold: int, i: int) -> None:
    following.hold_bound[hold] = following.bound[i]
    following.hold_intervention[hold] = following.intervention[i]
    following.hold_from_m[hold] = float(i)
    following.hold_low_mps[hold] = following.learned_mps[i]
    following.hold_high_mps[hold] = following.learned_mps[i]


def _extend_hold(following: NextArrays, hold: int, i: int) -> None:
    speed = following.learned_mps[i]
    following.hold_to_m[hold] = float(i)
    following.hold_low_mps[hold] = min(following.hold_low_mps[hold], speed)
    following.hold_high_mps[hold] = max(following.hold_high_mps[hold], speed)
