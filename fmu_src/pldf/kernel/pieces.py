"""The recorded speed with the stretched pieces of the interventions inserted (section 3.4)."""

from __future__ import annotations

from .arrays import Floats, RouteArrays, TraceArrays, Work
from .codes import OUTCOME_HOLE, OUTCOME_NOT_ELIGIBLE, OUTCOME_NOT_MOVED, OUTCOME_STOP
from .interpolation import cell_at, value_at
from .state import PldfState
from .stretch import (
    joined_speed,
    largest,
    source_position,
    stretch_factor,
    stretched_position,
)

NOT_LEARNED = -1.0  # marks of a node: nothing may be learned here
FREE = 0.0  # the driver did not intervene; 1, 2, ... = number of the intervention


def insert_pieces(
    st: PldfState, route: RouteArrays, trace: TraceArrays, work: Work, outcome: Floats
) -> None:
    """Fill ``work.a`` with the preprocessed speed and ``work.b`` with the marks of the nodes.

    ``outcome`` gets, per intervention, why nothing can be learned from it, as far as that is known
    from its piece alone (OUTCOME in codes).
    """
    for i in range(st.first_node, st.first_node + st.nodes):
        work.a[i] = trace.speed_mps[i]
        work.b[i] = FREE if trace.eligible[i] > 0.0 and trace.gap[i] <= 0.0 else NOT_LEARNED
    for k in range(st.drive_interventions):
        # One without length has no weights in eq. (2): pressed and released between two samples.
        outcome[k] = OUTCOME_NOT_MOVED
        if trace.end_m[k] > max(trace.start_m[k], float(st.first_node)):
            outcome[k] = _insert_piece(st, trace, work, k, stretch_factor(st, route, trace, k))


def _insert_piece(st: PldfState, trace: TraceArrays, work: Work, k: int, alpha: float) -> int:
    """Insert the piece of intervention ``k``; return its outcome as far as the piece tells it."""
    d_n = trace.end_m[k]
    start = stretched_position(trace.start_m[k], d_n, alpha)
    end = st.first_node + st.nodes - 1
    first, last = ends_of_piece(st, trace, k, alpha)
    hole = largest(trace.gap, float(first), float(last)) > 0.0
    slowest = trace.speed_mps[last]
    if first < start:
        first += 1
    # Not eligible, unless it is where it may be learned; then a run with a node of it decides. A
    # node that the next piece takes as well belongs to that one.
    outcome = OUTCOME_NOT_MOVED if first > last else OUTCOME_NOT_ELIGIBLE
    for i in range(first, last + 1):
        # Behind the last node recorded there is no speed to read, though the drive went on a bit.
        d = min(source_position(float(i), d_n, alpha), float(end))
        # Slower than the slowest wish that is learned no piece becomes by being lifted (decision).
        work.a[i] = max(_stretched_speed(trace, start, k, d), st.learning_speed_min_mps)
        slowest = min(slowest, trace.speed_mps[i])
        barred = trace.barred[k] > 0.0 or trace.eligible[cell_at(len(work.a), d)] <= 0.0
        if hole or barred:
            work.b[i] = NOT_LEARNED
        elif work.b[i] != NOT_LEARNED:
            work.b[i] = k + 1.0
            outcome = OUTCOME_NOT_MOVED
    if hole:
        return OUTCOME_HOLE
    if trace.barred[k] > 0.0:
        return int(trace.barred[k])
    return OUTCOME_STOP if slowest < st.learning_speed_min_mps else outcome


def ends_of_piece(st: PldfState, trace: TraceArrays, k: int, alpha: float) -> tuple[int, int]:
    """Return the first and the last node that the stretched piece of intervention ``k`` touches."""
    nodes = len(trace.gap)
    start = stretched_position(trace.start_m[k], trace.end_m[k], alpha)
    first = max(cell_at(nodes, start), st.first_node)
    return first, min(cell_at(nodes, trace.end_m[k]), st.first_node + st.nodes - 1)


def _stretched_speed(trace: TraceArrays, start: float, k: int, d: float) -> float:
    """Eq. (2): return the joined speed of the sample recorded at ``d``."""
    d_0 = trace.start_m[k]
    lift = value_at(trace.speed_mps, start) - value_at(trace.speed_mps, d_0)
    return joined_speed(value_at(trace.speed_mps, d), d, (d_0, trace.end_m[k]), lift)
