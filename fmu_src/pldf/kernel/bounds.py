"""Bounds that every learned profile keeps (section 3.8)."""

from __future__ import annotations

from math import sqrt

from .arrays import Floats, RouteArrays
from .planner import cell_cap
from .state import PldfState

ROUNDING = 1e-9  # relative excess of b that is rounding, not a violation


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


def enforce_bounds(st: PldfState, route: RouteArrays, speed: Floats, first: int, last: int) -> None:
    """Bring ``speed`` (m/s) within the bounds on the nodes first..last; nothing else changes.

    The neighbours outside are kept, so the acceleration bounds work both ways: what is too fast to
    be reached or left is lowered, what is too slow is raised. The raised curve is one that the
    unchanged profile allows, so it keeps the caps.
    """
    rise = 2.0 * st.learning_accel_max_mps2
    fall = -2.0 * st.learning_accel_min_mps2
    n = len(speed)
    for i in range(first, last + 1):
        speed[i] = min(speed[i], hard_cap(st, route, i))
    # Lowered before raised: what is raised to an unchanged edge must not be lowered again.
    for i in range(max(first, 1), last + 1):
        speed[i] = lowered(speed[i], speed[i - 1], rise)
    for i in range(min(last, n - 2), first - 1, -1):
        speed[i] = lowered(speed[i], speed[i + 1], fall)
    if first > 0:
        for i in range(first, last + 1):
            speed[i] = _raised(speed[i], speed[first - 1], fall * (i - first + 1))
    if last < n - 1:
        for i in range(last, first - 1, -1):
            speed[i] = _raised(speed[i], speed[last + 1], rise * (last + 1 - i))
    # With neighbours that keep the caps only rounding is left to do. With others the caps win, and
    # the acceleration bound gives way.
    for i in range(first, last + 1):
        speed[i] = min(speed[i], hard_cap(st, route, i))


def lowered(speed: float, neighbour: float, change: float) -> float:
    """Return ``speed`` lowered until its square exceeds the neighbour's by ``change`` at most."""
    allowed = neighbour * neighbour + change
    if speed * speed > allowed * (1.0 + ROUNDING):
        return sqrt(allowed)
    return speed


def _raised(speed: float, edge: float, change: float) -> float:
    """Return ``speed`` raised until its square is at most ``change`` below the edge's."""
    allowed = edge * edge - change
    if speed * speed < allowed * (1.0 - ROUNDING):
        return sqrt(allowed)
    return speed
