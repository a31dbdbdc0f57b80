"""Why a profile is no faster than it is, found per metre once it is known which one is driven.

What holds the speed at a node is what bounds it there (the set speed, a curve, a lesson) or, while
the profile falls, what bounds it where the fall ends. Where it rises, nothing holds it but the
comfort of the plan.
"""

from __future__ import annotations

from .arrays import Floats, ProfileArrays, RouteArrays
from .codes import (
    REASON_CAP_CURVE,
    REASON_CAP_LEGAL,
    REASON_COASTING_TO_LIMIT,
    REASON_CURVE,
    REASON_LEARNED_FASTER,
    REASON_LEARNED_OFFSET,
    REASON_LEARNED_SLOWER,
    REASON_LIMIT,
    REASON_SLOWING_DOWN,
    REASON_SPEEDING_UP,
)
from .state import PldfState
from .units import MPS_PER_KMH

PHASE_MPS2 = 0.05  # weaker accelerations of the profile count as cruising
CAP_MPS = 0.01  # nearer to a hard bound than this: the bound is the reason
AT_SET_MPS = 0.5 * MPS_PER_KMH  # nearer to the set speed than this: it is driven
NOTABLE_MPS = 2.0 * MPS_PER_KMH  # a profile that rises by less does not speed the car up
CURVE_SHARE = 0.95  # from this share of the planned lateral acceleration on, the curve binds
NOTHING = -1  # no bound of its own holds a node


def find_turns(speed: Floats, turn_m: Floats) -> None:
    """Fill ``turn_m``: where the present acceleration phase of ``speed``, else the next, ends."""
    n = len(speed)
    turn_m[n - 1] = n - 1.0
    after = 0  # phase of the metre behind this one; cruising (0) lasts until the next phase ends
    for i in range(n - 2, -1, -1):
        acceleration = slope(speed, i)
        phase = 0
        if acceleration > PHASE_MPS2:
            phase = 1
        elif acceleration < -PHASE_MPS2:
            phase = -1
        turn_m[i] = turn_m[i + 1] if phase in (0, after) else i + 1.0
        after = phase


def slope(speed: Floats, i: int) -> float:
    """Return the acceleration of a profile on the metre behind node ``i``, in m/s2."""
    j = min(i + 1, len(speed) - 1)
    return 0.5 * (speed[j] * speed[j] - speed[i] * speed[i])


def find_reasons(st: PldfState, route: RouteArrays, profile: ProfileArrays) -> None:
    """Fill ``reason`` and ``aim_m`` of ``profile`` for the learned speeds in it."""
    learned = profile.learned_mps
    last = len(learned) - 1
    hold = last  # the node whose speed a fall in front of it goes to, and what holds it there
    bound = NOTHING
    top = last  # where the rise ends that the metre behind this one belongs to
    why = REASON_LIMIT
    for i in range(last, -1, -1):
        rise = slope(learned, i)
        if rise <= PHASE_MPS2:
            top = i
        own = _own_bound(st, route, profile, i)
        if own == REASON_LIMIT:
            hold = i
            bound = own
            why = REASON_LIMIT if profile.offset_mps[i] == 0.0 else REASON_LEARNED_OFFSET
        elif rise > PHASE_MPS2 and (
            learned[top] > learned[i] + NOTABLE_MPS or learned[hold] < learned[i]
        ):
            hold = i
            bound = NOTHING
            why = REASON_SPEEDING_UP
        elif own == REASON_CURVE:
            hold = hold if bound == REASON_CURVE and rise < 0.0 else i
            bound = own
            why = REASON_CURVE
        elif rise < -PHASE_MPS2:
            why = _reason_to_slow(route, profile, i, hold, bound)
        elif learned[hold] > learned[i]:
            hold = i
            bound = NOTHING
        profile.aim_m[i] = top if why == REASON_SPEEDING_UP else hold
        profile.reason[i] = _reason_by_lesson(st, route, profile, i, why)


def _own_bound(st: PldfState, route: RouteArrays, profile: ProfileArrays, i: int) -> int:
    """Return LIMIT where the set speed is driven, CURVE at a curve's speed, else NOTHING."""
    speed = profile.learned_mps[i]
    if abs(speed - route.limit_mps[i] - profile.offset_mps[i]) <= AT_SET_MPS:
        return REASON_LIMIT
    curvature = max(route.curvature_per_m[i], route.curvature_per_m[max(i - 1, 0)])
    if curvature * speed * speed >= CURVE_SHARE * st.planner_lateral_accel_max_mps2:
        return REASON_CURVE
    return NOTHING


def _reason_to_slow(
    route: RouteArrays, profile: ProfileArrays, i: int, aim: int, bound: int
) -> int:
    """Return why the profile falls from node ``i`` to node ``aim``, whose speed ``bound`` holds."""
    if bound == REASON_CURVE:
        return REASON_CURVE
    sign = int(profile.limit_end_m[i])
    # Another than the next sign cannot be named: the driver would take it for that.
    ahead = sign <= aim and route.limit_mps[sign] == route.limit_mps[aim]
    if bound == REASON_LIMIT and ahead and route.limit_mps[aim] < route.limit_mps[i]:
        return REASON_COASTING_TO_LIMIT
    return REASON_SLOWING_DOWN


def _reason_by_lesson(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, i: int, why: int
) -> int:
    """Return the reason at node ``i`` if the pedals taught it, else ``why``."""
    learned = profile.learned_mps[i]
    lesson = learned - profile.planned_mps[i]
    change = learned - profile.base_mps[i]
    if profile.drive[i] <= 0.0:
        return why
    if lesson > CAP_MPS and _at_curve_bound(st, route.curvature_per_m[i], learned):
        return REASON_CAP_CURVE
    if lesson > CAP_MPS and (
        learned > route.limit_mps[i] + st.learning_over_limit_max_mps - CAP_MPS
    ):
        return REASON_CAP_LEGAL
    # Both against the plan and against the limit's profile; and where the lesson ends and the car
    # goes back, that is what it does.
    least = max(st.learning_deviation_min_mps, MPS_PER_KMH)
    rise = slope(profile.learned_mps, i)
    more = rise - slope(profile.base_mps, i)
    if min(lesson, change) > least and (rise >= -PHASE_MPS2 or more >= -PHASE_MPS2):
        return REASON_LEARNED_FASTER
    if max(lesson, change) < -least and (rise <= PHASE_MPS2 or more <= PHASE_MPS2):
        return REASON_LEARNED_SLOWER
    return why


def _at_curve_bound(st: PldfState, curvature_per_m: float, speed: float) -> bool:
    near = speed + CAP_MPS
    return curvature_per_m * near * near > st.learning_lateral_accel_max_mps2
