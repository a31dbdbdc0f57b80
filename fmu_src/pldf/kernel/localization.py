"""Where the car is along the route, from arc length or from coordinates."""

from __future__ import annotations

from math import sqrt

from .arrays import RouteArrays
from .codes import INPUT_OK, OFF_ROUTE, POSITION_JUMP, XY
from .state import PldfState

# How far from the expected place the line is searched; further away lie roads that cross it.
SEARCH_MARGIN_M = 20.0
SEARCH_GROWTH_MPS = 100.0  # a car that has left the route is looked for further away, later
# Where a way passes a place more than once, distances that differ by less do not tell which pass it
# is, since a car beside the line of its own pass may stand on the line of another. A car that is
# expected somewhere stays there unless it is a whole lane nearer to another pass; where it was not
# known before, a parallel lane must not be taken for its own.
SAME_DISTANCE_M = 4.0
SAME_DISTANCE_FIRST_M = 2.0
SAME_PASS_M = 5.0  # nearest points less than a car's length apart are of one pass
# A metre of the way whose ends lie further apart is a sideways jump of the line. Nobody drives it,
# and who is more than a metre beyond its ends is not there: the car goes on along the other line.
JUMP_M = 3.0
BEYOND_M = 1.0
FAR = 1e300  # beyond all squares of distances


def expected_place(st: PldfState) -> float:
    """Return where the car is by now (m) if it went on from its last place at the present speed."""
    return st.s_m + max(st.vehicle_speed_mps, 0.0) * missing_s(st)


def missing_s(st: PldfState) -> float:
    """Return for how long the place has not been known (s)."""
    return 1e-9 * (st.time_ns - st.valid_ns)


def locate(st: PldfState, route: RouteArrays, expected: float) -> None:
    """Set ``st.s_m`` and ``st.input_state`` from the position inputs and the expected place (m)."""
    distance = 0.0
    s_m = st.vehicle_s_m
    if st.localization == XY:
        if st.localized != 0:
            reach = SEARCH_MARGIN_M + SEARCH_GROWTH_MPS * missing_s(st)
            s_m, distance = project(route, st, (expected, reach), SAME_DISTANCE_M)
        else:
            s_m, distance = first_place(route, st)
    end = len(route.limit_mps) - 1.0
    if distance > st.control_route_tolerance_m or s_m < 0.0 or s_m > end:
        st.input_state = OFF_ROUTE
        if st.localization != XY:
            # An arc length off the route is still one: recorder and outputs follow it over the end.
            st.s_m = s_m
        return
    st.input_state = INPUT_OK
    if st.localized != 0 and abs(s_m - expected) > st.control_position_jump_max_m:
        st.input_state = POSITION_JUMP
    st.s_m = s_m
    st.localized = 1
    st.valid_ns = st.time_ns


def first_place(route: RouteArrays, st: PldfState) -> tuple[float, float]:
    """Return arc length and distance of a car that was nowhere before, both in m.

    Near the start of the way it is there, even if the way ends or passes there as well; else it is
    in the earliest of the passes that ``project`` cannot tell apart.
    """
    near_m = st.control_route_tolerance_m
    s_m, distance = project(route, st, (0.0, near_m), SAME_DISTANCE_FIRST_M)
    if s_m >= near_m or distance > near_m:
        s_m, distance = project(route, st, (0.0, float(len(route.x_m))), SAME_DISTANCE_FIRST_M)
    return s_m, distance


def project(
    route: RouteArrays, st: PldfState, near: tuple[float, float], same_m: float
) -> tuple[float, float]:
    """Return arc length and distance of the nearest point of the route's line, both in m.

    Only the line around ``near``, a place and how far from it (m), counts, so that a road that
    crosses or runs beside itself does no harm. Of several passes whose distances differ by less
    than ``same_m``, the one nearest to that place counts. Ties go to the smaller arc length.
    """
    near_m, reach_m = near
    n = len(route.x_m)
    first = int(min(max(near_m - reach_m, 0.0), n - 2.0))
    last = int(min(max(near_m + reach_m, 0.0), n - 2.0))
    cells = (first, last)
    best_s, best, s_m, square = _search(route, st, cells, near_m, FAR)
    if abs(s_m - best_s) > SAME_PASS_M:
        worst = sqrt(best) + same_m
        best_s, best, s_m, square = _search(route, st, cells, near_m, worst * worst)
    if abs(s_m - best_s) > SAME_PASS_M:
        return s_m, sqrt(square)
    return best_s, sqrt(best)


def _search(
    route: RouteArrays, st: PldfState, cells: tuple[int, int], near_m: float, worst: float
) -> tuple[float, float, float, float]:
    """Return the nearest point of the line, and among the nearest of each pass that at ``near_m``.

    A pass is where the distance has a minimum.

    Args:
        route: the line.
        st: where the car is.
        cells: the first and the last of the line that count.
        near_m: place that decides between passes.
        worst: square of the distance up to which a pass counts, m2.

    Returns:
        Arc length and square of the distance of the former and of the latter (m, m2).
    """
    any_s = float(cells[0])  # if there is no pass, since the line jumps: the nearest point of all
    any_square = FAR
    best_s = -1.0
    best = FAR
    chosen_s = -1.0
    chosen = FAR
    before = FAR  # square of the cell before the last, then of the last cell, which is judged now
    here = FAR
    here_s = 0.0
    here_part = 0.0
    here_jumps = False
    behind_jump = False  # whether the car has not reached the last cell, which follows on a jump
    for i in range(cells[0], cells[1] + 2):  # one more, so that the last cell is judged
        part = 0.0
        square = FAR
        jumps = False
        if i <= cells[1]:
            part, square, jumps = _foot(route, st, i)
        s_m = i + min(max(part, 0.0), 1.0)
        if square < any_square:
            any_square = square
            any_s = s_m
        if jumps:
            square = FAR
        beyond = behind_jump or (jumps and here_part > 1.0 + BEYOND_M)
        if here < before and here <= square and not beyond:
            if here < best:
                best = here
                best_s = here_s
            nearer = abs(here_s - near_m) < abs(chosen_s - near_m)
            if here <= worst and (chosen_s < 0.0 or nearer):
                chosen = here
                chosen_s = here_s
        before = here
        here = square
        here_s = s_m
        here_part = part
        behind_jump = here_jumps and part < -BEYOND_M
        here_jumps = jumps
    if best_s < 0.0:
        return any_s, any_square, any_s, any_square
    if chosen_s < 0.0:
        return best_s, best, best_s, best
    return best_s, best, chosen_s, chosen


def _foot(route: RouteArrays, st: PldfState, i: int) -> tuple[float, float, bool]:
    """Return where in cell ``i`` the car is, square of the distance, whether the line jumps there.

    That is the share of the cell, below 0 or above 1 if the car is before or behind it; then the
    distance is that of the cell's end.
    """
    dx = route.x_m[i + 1] - route.x_m[i]
    dy = route.y_m[i + 1] - route.y_m[i]
    ax = st.vehicle_x_m - route.x_m[i]
    ay = st.vehicle_y_m - route.y_m[i]
    length = dx * dx + dy * dy
    part = (ax * dx + ay * dy) / length if length > 0.0 else 0.0
    inside = min(max(part, 0.0), 1.0)
    ex = ax - inside * dx
    ey = ay - inside * dy
    return part, ex * ex + ey * ey, length > JUMP_M * JUMP_M
