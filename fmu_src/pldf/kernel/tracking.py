"""From profile and set speed to an acceleration request (section 2).

The request is a state that moves by at most the jerk limit in EVERY mode. While the driver drives
(STANDBY, OFF) it follows the measured acceleration, during a gas override it glides to 0; so there
is no step in it when the driver hands over.
"""

from __future__ import annotations

from math import sqrt

from .arrays import ProfileArrays, RouteArrays
from .codes import ACTIVE, FAULT, GAS_OVERRIDE, INPUT_INVALID
from .gap import followed_request
from .interpolation import Place, place_at, value_of
from .last_check import checked_request
from .lever import automatic_set_speed, temporary_limit
from .state import PldfState
from .substeps import substep_count

# A car slower than this share of its profile does not brake because the profile does (decision):
# else one that has been braked to a stop where the profile falls steeply would stand for ever.
SLOW_SHARE = 0.5


def target_speed(st: PldfState, route: RouteArrays, profile: ProfileArrays, s_m: float) -> float:
    """Return the speed to drive at ``s_m`` in m/s: the profile, changed by a manual set speed.

    A manual set speed below the automatic one caps the profile. Above it, curves still count
    (``open_mps``, or the learned speed where that is higher), the speed behind the next sign is
    approached at the planner's deceleration, and places learned slower stay slower by as much; but
    a set speed that was raised never makes the car slower than its profile.
    """
    return target_of(st, route, profile, s_m, place_at(len(profile.learned_mps), s_m))


def target_of(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, s_m: float, place: Place
) -> float:
    """Return the same for ``s_m``, whose place is known.

    A temporary limit caps it, until the driver sets another speed.
    """
    target = _planned_target(st, route, profile, s_m, place)
    temporary = temporary_limit(st, route, place[0])
    if temporary > 0.0:
        by_hand = st.manual_set_mps > 0.0 and s_m < st.manual_end_m
        return min(target, st.manual_set_mps if by_hand else temporary)
    return target


def _planned_target(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, s_m: float, place: Place
) -> float:
    """Return the target under the legal limits of the route alone."""
    learned = value_of(profile.learned_mps, place)
    if st.manual_set_mps <= 0.0 or s_m >= st.manual_end_m:
        return learned
    if st.manual_set_mps <= automatic_set_speed(route, profile, place[0]):
        return min(learned, st.manual_set_mps)
    speed = min(st.manual_set_mps, max(learned, value_of(profile.open_mps, place)))
    if st.manual_end_m < len(profile.learned_mps) - 1:  # at the end of the route stands no sign
        behind = st.manual_behind_mps
        approach = behind * behind - 2.0 * st.planner_accel_min_mps2 * (st.manual_end_m - s_m)
        speed = min(speed, max(learned, sqrt(approach)))
    slower = learned - value_of(profile.planned_mps, place)
    return max(speed + min(slower, 0.0), learned)


def update_request(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, step_s: float
) -> None:
    """Move the request over one communication step, in equal internal steps of at most 10 ms."""
    substeps = substep_count(step_s)
    change = st.control_request_jerk_max_mps3 * step_s / substeps
    # Each part aims at where the car then is, so the result hardly depends on the importer's step.
    for k in range(substeps):
        wanted = _wanted(st, route, profile, step_s * k / substeps, step_s)
        wanted = min(max(wanted, st.control_request_min_mps2), st.control_request_max_mps2)
        low = st.acceleration_request_mps2 - change
        high = st.acceleration_request_mps2 + change
        st.acceleration_request_mps2 = min(max(wanted, low), high)


def _wanted(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, ahead_s: float, step_s: float
) -> float:
    """Return the acceleration to aim at, ``ahead_s`` after the sample of the inputs."""
    # The gas pedal adds to the request; and of a car that is not known nothing can be asked.
    if st.mode in (GAS_OVERRIDE, FAULT) or st.input_state == INPUT_INVALID:
        return 0.0
    if st.mode != ACTIVE:
        return st.vehicle_acceleration_mps2
    return followed_request(st, profile_request(st, route, profile, ahead_s), ahead_s, step_s)


def profile_request(
    st: PldfState, route: RouteArrays, profile: ProfileArrays, ahead_s: float
) -> float:
    """Return the acceleration that profile and set speed ask for, after the last check.

    It is that for ``ahead_s`` after the sample of the inputs, whatever the mode.
    """
    acceleration = st.vehicle_acceleration_mps2
    start = max(st.vehicle_speed_mps, 0.0)
    speed = max(start + acceleration * ahead_s, 0.0)
    s_m = st.s_m + 0.5 * (start + speed) * ahead_s
    # Recovery is bounded apart from the profile's own acceleration: far from the profile the car
    # comes back comfortably, on it the full slope is followed.
    error = target_speed(st, route, profile, s_m) - speed
    correction = st.control_speed_gain_per_s * error
    correction = min(correction, st.control_recovery_accel_max_mps2)
    correction = max(correction, st.control_recovery_accel_min_mps2)
    # The slope of v*v/2 over the next metre, one vehicle delay ahead, is the profile's own
    # acceleration there.
    preview = s_m + speed * st.control_preview_s
    first = target_speed(st, route, profile, preview)
    second = target_speed(st, route, profile, preview + 1.0)
    slope = 0.5 * (second * second - first * first)
    if speed < SLOW_SHARE * first:
        slope = max(slope, 0.0)
    return checked_request(st, profile, slope + correction, s_m, speed)
