"""Bounds that every learned profile keeps (section 3.8).

They are kept where ``work.b`` marks a node: where this drive taught. Everything is lowered, nothing
raised. Where a marked node would ask too much of an unmarked neighbour, the neighbour is lowered
and marked as well: the segment grows by what the transition needs. A bound is asked for wherever it
involves a marked node; so what older drives taught, and no marked node touches, is exempt.
"""

from __future__ import annotations

from math import sqrt

from .arrays import Floats, RouteArrays, Work
from .codes import BOUND_ACCEL, BOUND_DECEL, BOUND_LATERAL_ACCEL, BOUND_LEGAL_LIMIT
from .jerk import lower_jerk
from .lowering import ROUNDING, UNMARKED, lower
from .planner import cell_cap
from .state import PldfState


def hard_cap(st: PldfState, route: RouteArrays, node: int) -> float:
    """Return the speed at ``node`` that learning never exceeds: a_lat and legal limit, in m/s."""
    cap = _cell_bound(st, route, node)
    if node > 0:
        cap = min(cap, _cell_bound(st, route, node - 1))
    return cap


def _cell_bound(st: PldfState, route: RouteArrays, cell: int) -> float:
    return cell_cap(
        route.limit_mps[cell] + st.learning_over_limit_max_mps,
        route.curvature_per_m[cell],
        st.learning_lateral_accel_max_mps2,
    )


def _cap_code(st: PldfState, route: RouteArrays, node: int) -> int:
    """Return which of the two is the cap of ``node``."""
    limit = min(route.limit_mps[node], route.limit_mps[max(node - 1, 0)])
    if hard_cap(st, route, node) < limit + st.learning_over_limit_max_mps:
        return BOUND_LATERAL_ACCEL
    return BOUND_LEGAL_LIMIT


def keep_bounds(
    st: PldfState, route: RouteArrays, speed: Floats, bound: Floats, work: Work
) -> None:
    """Lower ``speed`` (m/s) until its marked nodes keep all bounds.

    Args:
        st: the parameters.
        route: limit and curvature.
        speed: per node; changed in place.
        bound: per node: which bound cut it last (BOUND); written where one does.
        work: ``b`` marks the nodes that are bounded, above 0; those lowered get the mark from which
            the segment grew. ``c`` to ``g`` are overwritten.
    """
    # What has just been marked is bounded, too. Ends when nothing is lowered: so a profile that has
    # been through this is left as it is, to the bit.
    while _lower_once(st, route, speed, bound, work) > 0:
        pass


def _lower_once(st: PldfState, route: RouteArrays, speed: Floats, bound: Floats, work: Work) -> int:
    """Apply caps, slopes and jerk one after the other; return how often something was lowered."""
    rise = 2.0 * st.learning_accel_max_mps2
    fall = -2.0 * st.learning_accel_min_mps2
    count = _lower_to_caps(st, route, speed, bound, work)
    for i in range(len(speed)):
        work.c[i] = speed[i] * speed[i]
    count += _lower_slopes(bound, work, rise, fall)
    if st.learning_jerk_max_mps3 > 0.0:
        count += lower_jerk(st.learning_jerk_max_mps3, bound, work, rise, fall)
    if count > 0:
        for i in range(len(speed)):
            if work.c[i] != speed[i] * speed[i]:
                speed[i] = sqrt(work.c[i])
    return count


def _lower_to_caps(
    st: PldfState, route: RouteArrays, speed: Floats, bound: Floats, work: Work
) -> int:
    count = 0
    for i in range(len(speed)):
        if work.b[i] != UNMARKED and speed[i] > hard_cap(st, route, i):
            speed[i] = hard_cap(st, route, i)
            bound[i] = _cap_code(st, route, i)
            count += 1
    return count


def _lower_slopes(bound: Floats, work: Work, rise: float, fall: float) -> int:
    n = len(work.c)
    count = 0
    for i in range(1, n):
        mark = max(work.b[i], work.b[i - 1])
        count += lower(work, bound, i, work.c[i - 1] + rise, mark, BOUND_ACCEL)
    for i in range(n - 2, -1, -1):
        mark = max(work.b[i], work.b[i + 1])
        count += lower(work, bound, i, work.c[i + 1] + fall, mark, BOUND_DECEL)
    return count


def mark_violations(st: PldfState, route: RouteArrays, speed: Floats, marks: Floats) -> None:
    """Mark the nodes of ``speed`` that exceed a cap or, beside a neighbour, a slope."""
    rise = 2.0 * st.learning_accel_max_mps2
    fall = -2.0 * st.learning_accel_min_mps2
    for i in range(len(speed)):
        here = speed[i] * speed[i]
        violated = speed[i] > hard_cap(st, route, i)
        if i > 0:
            before = speed[i - 1] * speed[i - 1]
            violated = violated or here > (before + rise) * (1.0 + ROUNDING)
        if i < len(speed) - 1:
            behind = speed[i + 1] * speed[i + 1]
            violated = violated or here > (behind + fall) * (1.0 + ROUNDING)
        marks[i] = 1.0 if violated else UNMARKED
