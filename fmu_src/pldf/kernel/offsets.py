"""Learning the set speed: the driver's offset is adopted as it is (section 3.7).

The lever is pressed in series: presses at most ``learning_offset_series_s`` apart are one wish. It
holds from where the series began (or from the limit's sign, if that was soon after it) with the
value that the series ended with, up to the next series or the end of its limit. That a recording
begins or ends is no sign and no press.
"""

from __future__ import annotations

from .arrays import Floats, NextArrays, ProfileArrays, RouteArrays, TraceArrays
from .codes import OUTCOME_LEARNED, OUTCOME_NOT_ELIGIBLE, OUTCOME_TAKEN_BACK
from .state import PldfState

# What the offsets of a drive are read from, and where they go; at last, per cell, the number of
# the series of presses that counts there, 0 = none.
Drive = tuple[RouteArrays, ProfileArrays, TraceArrays, NextArrays, Floats]


def adopt_offsets(st: PldfState, drive: Drive) -> None:
    """Write the offsets set in this drive into ``offset_mps`` of what follows (m/s, per cell).

    What became of each series is written beside, their number into ``st.set_series``.
    """
    following, series = drive[3], drive[4]
    for cell in range(len(series)):
        series[cell] = 0.0
    _find_series(st, drive)
    for cell in range(len(series)):
        if series[cell] > 0.0:
            following.offset_mps[cell] = following.set_offset_mps[int(series[cell]) - 1]


def approach_offsets(st: PldfState, profile: ProfileArrays, following: NextArrays) -> None:
    """Go the share ``learning_set_speed_gain`` of the way from the offsets driven to those adopted.

    Where no other offset was adopted nothing changes, to the bit.
    """
    gain = st.learning_set_speed_gain
    for cell in range(len(following.offset_mps)):
        driven, adopted = profile.offset_mps[cell], following.offset_mps[cell]
        following.offset_mps[cell] = driven + gain * (adopted - driven)


def _find_series(st: PldfState, drive: Drive) -> None:
    route = drive[0]
    st.set_series = 0
    last = st.first_node + st.nodes - 1
    node = st.first_node
    while node <= last:
        end = end_of_limit(route, node, last)
        _adopt_in_limit(st, drive, node, end)
        node = end + 1


def begin_of_limit(route: RouteArrays, node: int) -> int:
    """Return the first node from which the limit at ``node`` holds: that of its sign."""
    begin = node
    while begin > 0 and route.limit_mps[begin - 1] == route.limit_mps[node]:
        begin -= 1
    return begin


def end_of_limit(route: RouteArrays, node: int, last: int) -> int:
    """Return the last node, at most ``last``, up to which the limit at ``node`` holds."""
    end = node
    while end < last and route.limit_mps[end + 1] == route.limit_mps[node]:
        end += 1
    return end


def _adopt_in_limit(st: PldfState, drive: Drive, first: int, last: int) -> None:
    """Adopt the series of the nodes ``first`` to ``last``, all under one limit."""
    trace, following = drive[2], drive[3]
    before = 0.0  # the manual set speed in force before the series, 0 = none
    node = _next_press(st, trace, first, last, before)
    while node <= last:
        behind = _end_of_series(st, trace, node, last)
        value = trace.set_speed_mps[behind - 1]
        press = _next_press(st, trace, behind, last, value)
        end = press - 1
        # Where in a hole the next series began is not known.
        while press <= last and trace.gap[end] > 0.0:
            end -= 1
        if value > 0.0:
            _adopt_series(st, drive, node, end, last)
        elif before <= 0.0:
            ends_m = (float(_place_of(st, trace, node)), behind - 1.0)
            _note(st, following, ends_m, (0.0, 0.0), OUTCOME_TAKEN_BACK)
        before = value
        node = press


def _next_press(st: PldfState, trace: TraceArrays, node: int, last: int, set_mps: float) -> int:
    """Return the first node from ``node`` on with another set speed, ``last + 1`` if there is none.

    A node within a hole of the recording says nothing of the lever.
    """
    at = node
    while at <= last and (trace.gap[at] > 0.0 or _is_same(st, trace.set_speed_mps[at], set_mps)):
        at += 1
    return at


def _is_same(st: PldfState, one_mps: float, other_mps: float) -> bool:
    if one_mps <= 0.0 or other_mps <= 0.0:
        return one_mps <= 0.0 and other_mps <= 0.0
    return abs(one_mps - other_mps) <= st.learning_offset_tolerance_mps


def _end_of_series(st: PldfState, trace: TraceArrays, first: int, last: int) -> int:
    """Return the node behind the last press of the series that begins at ``first``."""
    end = first + 1
    press = _next_press(st, trace, end, last, trace.set_speed_mps[first])
    while press <= last and (
        trace.time_s[press] - trace.time_s[end - 1] <= st.learning_offset_series_s
    ):
        end = press + 1
        press = _next_press(st, trace, end, last, trace.set_speed_mps[press])
    return end


def _adopt_series(st: PldfState, drive: Drive, node: int, end: int, last: int) -> None:
    """Adopt the series that begins at ``node``; its value holds to ``end``.

    Beyond the last recorded node the driver has not ended it: it holds to the end of its limit.
    """
    route, _, trace, following, series = drive
    nodes = len(route.limit_mps)
    wish = trace.set_speed_mps[end] - route.limit_mps[node]
    value = min(wish, st.learning_over_limit_max_mps)
    first = _first_cell(st, drive, node)
    if end == st.first_node + st.nodes - 1:
        end = end_of_limit(route, end, nodes - 1)
    ends_m = (float(first), min(end + 1.0, nodes - 1.0))
    place = _place_of(st, trace, node)
    if trace.set_barred[place] > 0.0:
        _note(st, following, ends_m, (wish, 0.0), int(trace.set_barred[place]))
    elif trace.eligible[place] <= 0.0:
        _note(st, following, ends_m, (wish, 0.0), OUTCOME_NOT_ELIGIBLE)
    else:
        _note(st, following, ends_m, (wish, value), OUTCOME_LEARNED)
        for cell in range(first, end + 1):
            if cell > last or trace.eligible[cell] > 0.0:
                series[cell] = float(st.set_series)


def _note(
    st: PldfState,
    following: NextArrays,
    ends_m: tuple[float, float],
    wish_and_value_mps: tuple[float, float],
    outcome: int,
) -> None:
    """Write down what became of a series."""
    k = st.set_series
    following.set_from_m[k] = ends_m[0]
    following.set_to_m[k] = ends_m[1]
    following.set_wish_mps[k] = wish_and_value_mps[0]
    following.set_offset_mps[k] = wish_and_value_mps[1]
    following.set_outcome[k] = outcome
    st.set_series = k + 1


def _place_of(st: PldfState, trace: TraceArrays, node: int) -> int:
    """Return the cell in which the lever was moved, if ``node`` is the first that shows it."""
    before = max(node - 1, st.first_node)
    return node if trace.gap[before] > 0.0 else before


def _first_cell(st: PldfState, drive: Drive, node: int) -> int:
    """Return the first cell of a series whose first node is ``node``.

    If the lever was moved soon after the sign, or before the car had settled at the new speed, the
    driver meant the whole limit. A limit whose beginning was not recorded has no sign.
    """
    route, profile, trace, _, _ = drive
    sign = begin_of_limit(route, node)
    moved = max(_place_of(st, trace, node), sign)
    if sign < st.first_node:
        return moved
    since_sign_s = trace.time_s[moved] - trace.time_s[sign]
    settled = sign
    while settled < moved and not _is_settled(st, route, profile, trace, settled):
        settled += 1
    settled_s = trace.time_s[settled] - trace.time_s[sign]
    allowed_s = min(settled_s + st.learning_offset_settled_s, st.learning_offset_settled_max_s)
    if since_sign_s <= max(allowed_s, st.learning_offset_new_limit_s):
        return sign
    return moved


def _is_settled(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, trace: TraceArrays, node: int
) -> bool:
    new_speed = route.limit_mps[node] + profile.offset_mps[node]
    return abs(trace.speed_mps[node] - new_speed) <= st.learning_offset_settled_mps
