"""Base profile: the fastest speed under caps, acceleration and jerk bounds (section 1).

Everything happens in ``b = v * v`` over arc length on the 1 m grid, where acceleration is half the
slope of ``b``, exactly. With ``v`` the speed of the profile without jerk limit, which is an upper
bound of the result, jerk is at most ``|second difference of b| * v / 2``, so that the jerk limit
becomes a bound on the second difference, ``bend = 2 * jerk / v``, at each node:

1. ``b = cap * cap``; one backward and one forward pass bound the slopes (time-optimal).
2. Valleys: a second pair of passes lets the slope grow from 0 by at most ``bend`` per node, away
   from the bottom. The car has finished braking AT a lower limit and starts to accelerate there.
3. Peaks: the largest curve below, whose slope falls by at most ``bend`` per node, is the lower
   convex hull of ``b`` plus a parabola with second difference ``bend`` (minus that parabola). The
   hull is found in one sweep with a stack, so planning is linear in length.

Step 3 cannot undo step 2: where the hull leaves ``b`` it bends downwards, and where it touches
``b`` the two have the same slope.
"""

from __future__ import annotations

from math import sqrt
from typing import Protocol

from .arrays import Floats, Work

# A stored offset may reach below the limit; a cap of 0 or less is no speed (its square would be).
SLOWEST_CAP_MPS = 1e-3


class PlannerSettings(Protocol):
    """The bounds of a profile, as fields of a record."""

    planner_accel_max_mps2: float
    planner_accel_min_mps2: float
    planner_jerk_max_mps3: float


def cell_cap(limit_mps: float, curvature_per_m: float, lateral_accel_max_mps2: float) -> float:
    """Return the lower of limit and curve speed, ``sqrt(a_lat / |curvature|)``, in m/s."""
    if curvature_per_m * limit_mps * limit_mps > lateral_accel_max_mps2:
        return sqrt(lateral_accel_max_mps2 / curvature_per_m)
    return limit_mps


def speed_caps(
    caps: Floats,
    limit: Floats,
    offset: Floats,
    curvature: Floats,
    lateral_accel_max_mps2: float,
) -> None:
    """Fill ``caps`` (m/s, per node) with the lower cap of the two cells that meet at each node.

    ``limit``, ``offset`` (m/s) and ``curvature`` (1/m, absolute) are per cell.
    """
    first = max(limit[0] + offset[0], SLOWEST_CAP_MPS)
    before = cell_cap(first, curvature[0], lateral_accel_max_mps2)
    for i in range(len(caps)):
        allowed = max(limit[i] + offset[i], SLOWEST_CAP_MPS)
        here = cell_cap(allowed, curvature[i], lateral_accel_max_mps2)
        caps[i] = min(before, here)
        before = here


def find_limit_ends(limit: Floats, limit_end_m: Floats) -> None:
    """Fill ``limit_end_m``: where the legal limit of each cell ends, at last the route's end."""
    n = len(limit)
    limit_end_m[n - 1] = n - 1.0
    for i in range(n - 2, -1, -1):
        limit_end_m[i] = limit_end_m[i + 1] if limit[i] == limit[i + 1] else i + 1.0


def plan_profile(st: PlannerSettings, caps: Floats, speed: Floats, work: Work) -> None:
    """Fill ``speed`` (m/s, per node) with the fastest profile under ``caps`` (m/s, per node).

    ``caps`` and ``speed`` may be the same array. ``work.a`` to ``work.c`` are overwritten.
    """
    for i in range(len(caps)):
        speed[i] = caps[i] * caps[i]
    bound_slopes(speed, 2.0 * st.planner_accel_max_mps2, -2.0 * st.planner_accel_min_mps2)
    if st.planner_jerk_max_mps3 > 0.0:
        bend = work.a
        for i in range(len(bend)):  # speeds are above 0: so are limits and curve speeds
            bend[i] = 2.0 * st.planner_jerk_max_mps3 / sqrt(speed[i])
        round_valleys(
            speed, bend, 2.0 * st.planner_accel_max_mps2, -2.0 * st.planner_accel_min_mps2
        )
        round_peaks(speed, bend, work.b, work.c, 0, len(speed) - 1)
    for i in range(len(speed)):
        speed[i] = sqrt(speed[i])


def bound_slopes(b: Floats, rise: float, fall: float) -> None:
    """Lower ``b`` until it rises by at most ``rise`` and falls by at most ``fall`` per node."""
    for i in range(len(b) - 2, -1, -1):
        b[i] = min(b[i], b[i + 1] + fall)
    for i in range(1, len(b)):
        b[i] = min(b[i], b[i - 1] + rise)


def round_valleys(b: Floats, bend: Floats, rise: float, fall: float) -> None:
    """Lower ``b`` until its slope grows by at most ``bend`` per node (convex kinks vanish)."""
    n = len(b)
    slope = fall
    for i in range(n - 2, -1, -1):
        b[i] = min(b[i], b[i + 1] + steepest_rise(slope, bend[i + 1], fall))
        slope = b[i] - b[i + 1]
    slope = rise
    for i in range(1, n):
        b[i] = min(b[i], b[i - 1] + steepest_rise(slope, bend[i - 1], rise))
        slope = b[i] - b[i - 1]


def steepest_rise(slope: float, bend: float, most: float) -> float:
    """Return how much ``b`` may rise behind a node at which it has risen by ``slope``."""
    # Half a bend on either side of the bottom, where the slope is 0 at the node itself.
    return min(max(slope, -0.5 * bend) + bend, most)


def round_peaks(
    b: Floats, bend: Floats, stack: Floats, lifted: Floats, first: int, last: int
) -> None:
    """Lower ``b`` until its slope falls by at most ``bend`` per node (concave kinks vanish).

    The nodes ``first`` and ``last``, and what lies outside, stay. ``stack`` and ``lifted`` are
    scratch space of the same length.
    """
    parabola = 0.0
    slope = 0.0
    for i in range(first, last + 1):
        lifted[i] = b[i] + parabola
        slope += bend[i]
        parabola += slope
    top = 0
    stack[0] = first
    for i in range(first + 1, last + 1):
        while top > 0 and _is_above(lifted, int(stack[top - 1]), int(stack[top]), i):
            top -= 1
        top += 1
        stack[top] = i
    for k in range(top):
        _fill_arc(b, bend, int(stack[k]), int(stack[k + 1]), lifted)


def _is_above(y: Floats, p: int, q: int, r: int) -> bool:
    """Tell whether point ``q`` lies on or above the chord from ``p`` to ``r`` (p < q < r)."""
    # Multiplied out: a division per comparison would cost and round.
    return (y[q] - y[p]) * (r - q) >= (y[r] - y[q]) * (q - p)


def _fill_arc(b: Floats, bend: Floats, p: int, q: int, drop: Floats) -> None:
    """Replace ``b`` between the nodes ``p`` and ``q`` by the arc that bends by ``-bend``."""
    drop[p] = 0.0
    slope = 0.0
    for i in range(p, q):
        drop[i + 1] = drop[i] + slope
        slope += bend[i + 1]
    chord = (b[q] - b[p] + drop[q]) / (q - p)
    start = b[p]
    for i in range(p + 1, q):
        b[i] = min(b[i], start + chord * (i - p) - drop[i])
