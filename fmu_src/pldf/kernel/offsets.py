"""Learning the set speed: the driver's offset is adopted as it is (section 3.7)."""

from __future__ import annotations

from .arrays import Floats, ProfileArrays, RouteArrays, TraceArrays
from .state import PldfState


def adopt_offsets(
    st: PldfState,
    route: RouteArrays,
    profile: ProfileArrays,
    trace: TraceArrays,
    offset: Floats,
) -> int:
    """Write the offsets set in this drive into ``offset`` (m/s, per cell); return how many.

    An offset holds from where it was set (or from its limit's sign, if set soon after it) to where
    it ended; of several tips the first position and the final value count.
    """
    adopted = 0
    last = st.first_node + st.nodes - 1
    i = st.first_node
    while i <= last:
        if trace.set_speed_mps[i] <= 0.0:
            i += 1
            continue
        end = _end_of_run(route, trace, i, last)
        value = trace.set_speed_mps[end] - route.limit_mps[end]
        value = min(value, st.learning_over_limit_max_mps)
        for cell in range(_first_cell(st, route, profile, trace, i), end + 1):
            offset[cell] = value
        adopted += 1
        i = end + 1
    return adopted


def _end_of_run(route: RouteArrays, trace: TraceArrays, start: int, last: int) -> int:
    end = start
    while (
        end < last
        and trace.set_speed_mps[end + 1] > 0.0
        and route.limit_mps[end + 1] == route.limit_mps[start]
    ):
        end += 1
    return end


def _first_cell(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, trace: TraceArrays, node: int
) -> int:
    """Return the first cell of an offset whose first node is ``node``.

    The lever was moved in the cell before that node. If that was soon after the sign, or before
    the car had settled at the new speed, the driver meant the whole limit.
    """
    limit = route.limit_mps[node]
    sign = node
    while sign > 0 and route.limit_mps[sign - 1] == limit:
        sign -= 1
    passed = max(sign, st.first_node)
    moved = max(node - 1, passed)
    since_sign_s = trace.time_s[moved] - trace.time_s[passed]
    settled = passed
    while settled < moved and not _is_settled(st, route, profile, trace, settled):
        settled += 1
    settled_s = trace.time_s[settled] - trace.time_s[passed]
    allowed_s = min(settled_s + st.learning_offset_settled_s, st.learning_offset_settled_max_s)
    if since_sign_s <= max(allowed_s, st.learning_offset_new_limit_s):
        return sign
    return moved


def _is_settled(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, trace: TraceArrays, node: int
) -> bool:
    new_speed = route.limit_mps[node] + profile.offset_mps[node]
    return abs(trace.speed_mps[node] - new_speed) <= st.learning_offset_settled_mps
