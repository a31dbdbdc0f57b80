"""Where the car is along the route, from arc length or from coordinates."""

from __future__ import annotations

from math import sqrt

from .arrays import RouteArrays
from .codes import INPUT_OK, OFF_ROUTE, POSITION_JUMP, XY
from .state import PldfState

# How far from the expected place the line is searched; further away lie roads that cross it.
SEARCH_MARGIN_M = 20.0
SEARCH_GROWTH_MPS = 100.0  # a car that has left the route is looked for further away, later


def locate(st: PldfState, route: RouteArrays) -> None:
    """Set ``st.s_m`` and ``st.input_state`` from the position inputs."""
    missing_s = 1e-9 * (st.time_ns - st.valid_ns)
    expected = st.s_m + max(st.vehicle_speed_mps, 0.0) * missing_s
    distance = 0.0
    s_m = st.vehicle_s_m
    if st.localization == XY:
        reach = SEARCH_MARGIN_M + SEARCH_GROWTH_MPS * missing_s
        if st.localized == 0:
            reach = float(len(route.x_m))
        s_m, distance = project(route, st, expected, reach)
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


def project(
    route: RouteArrays, st: PldfState, near_m: float, reach_m: float
) -> tuple[float, float]:
    """Return arc length and distance of the nearest point of the route's line, both in m.

    Only the line within ``reach_m`` of ``near_m`` counts, so that a road that crosses or runs
    beside itself does no harm. Ties go to the smaller arc length.
    """
    n = len(route.x_m)
    first = int(min(max(near_m - reach_m, 0.0), n - 2.0))
    last = int(min(max(near_m + reach_m, 0.0), n - 2.0))
    best = -1.0
    best_s = float(first)
    for i in range(first, last + 1):
        dx = route.x_m[i + 1] - route.x_m[i]
        dy = route.y_m[i + 1] - route.y_m[i]
        ax = st.vehicle_x_m - route.x_m[i]
        ay = st.vehicle_y_m - route.y_m[i]
        length = dx * dx + dy * dy
        part = (ax * dx + ay * dy) / length if length > 0.0 else 0.0
        part = min(max(part, 0.0), 1.0)
        ex = ax - part * dx
        ey = ay - part * dy
        square = ex * ex + ey * ey
        if best < 0.0 or square < best:
            best = square
            best_s = i + part
    return best_s, sqrt(best)
