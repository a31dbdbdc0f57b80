"""Stretching an intervention to where the wish arose: eq. (1) and eq. (2) (section 3.2 and 3.3).

A driver intervenes later than the wish arises. The recorded piece, from position ``d_0`` to
``d_n``, is stretched to the left, ``d' = d - alpha * (d_n - d)``, and lifted so that its new start
joins the recorded speed there.
"""

from __future__ import annotations

from .arrays import Floats, RouteArrays, TraceArrays
from .codes import STRETCH_CONSTANT_SPEED
from .interpolation import cell_at, position_of, value_at
from .state import PldfState


def stretched_position(d: float, d_n: float, alpha: float) -> float:
    """Eq. (1): return the place of the sample at ``d`` after stretching, in m."""
    return d - alpha * (d_n - d)


def source_position(d_stretched: float, d_n: float, alpha: float) -> float:
    """Inverse of eq. (1): return where the sample now at ``d_stretched`` was recorded, in m."""
    return (d_stretched + alpha * d_n) / (1.0 + alpha)


def joined_speed(v: float, d: float, ends: tuple[float, float], lift_mps: float) -> float:
    """Eq. (2): return ``v`` plus the share of ``lift_mps`` that falls to ``d``.

    ``ends`` is ``(d_0, d_n)``; the share is 1 at d_0 and 0 at d_n. The map of eq. (1) is affine,
    so the share is the same before and after stretching, whatever alpha.
    """
    return v + (ends[1] - d) / (ends[1] - ends[0]) * lift_mps


def curvature_factor(curvature_per_m: float, low_per_m: float, high_per_m: float) -> float:
    """Return r: 1 up to ``low_per_m``, falling linearly to 0 at ``high_per_m`` (decision)."""
    if curvature_per_m <= low_per_m:
        return 1.0
    if curvature_per_m >= high_per_m:
        return 0.0
    return (high_per_m - curvature_per_m) / (high_per_m - low_per_m)


def stretch_factor(st: PldfState, route: RouteArrays, trace: TraceArrays, k: int) -> float:
    """Return alpha of intervention ``k`` (0-based) after the three limits, in their order."""
    d_0 = trace.start_m[k]
    d_n = trace.end_m[k]
    length = d_n - d_0
    alpha = min(st.learning_stretch_factor, _reach(st, trace, d_0) / length)
    curvature = largest(route.curvature_per_m, stretched_position(d_0, d_n, alpha), d_n)
    alpha = alpha * curvature_factor(
        curvature,
        st.learning_stretch_curvature_low_per_m,
        st.learning_stretch_curvature_high_per_m,
    )
    bound = float(st.first_node)
    if k > 0:
        bound = max(bound, trace.end_m[k - 1])
    return max(min(alpha, (d_0 - bound) / length), 0.0)


def _reach(st: PldfState, trace: TraceArrays, d_0: float) -> float:
    """Return how far back ``learning_stretch_time_s`` of travel reaches from ``d_0``, in m."""
    if st.learning_stretch_time_mode == STRETCH_CONSTANT_SPEED:
        return st.learning_stretch_time_s * value_at(trace.speed_mps, d_0)
    last = st.first_node + st.nodes - 1
    earlier = value_at(trace.time_s, min(d_0, float(last))) - st.learning_stretch_time_s
    end = min(cell_at(len(trace.time_s), d_0) + 1, last)
    return max(d_0 - position_of(trace.time_s, earlier, st.first_node, end), 0.0)


def largest(values: Floats, from_m: float, to_m: float) -> float:
    """Return the largest of the per-cell ``values`` between two positions."""
    n = len(values)
    result = 0.0
    for i in range(cell_at(n, from_m), cell_at(n, to_m) + 1):
        result = max(result, values[i])
    return result
