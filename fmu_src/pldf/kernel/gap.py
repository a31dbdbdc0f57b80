"""How the gap to a car ahead is kept, and what it takes to stop behind it (section 8).

Speeds are in m/s, gaps in m from bumper to bumper, accelerations in m/s2. ``following`` says which
car counts; here it is ``lead_ahead_m`` and ``lead_mps`` of the state.
"""

from __future__ import annotations

from math import sqrt

from .state import PldfState

# Halvings of the range in which the safe request is sought: 5.5 m/s2 to 1 mm/s2 (decision).
HALVINGS = 12
# The gap that braking as hard as allowed leaves when both stand (decision): what the calculation
# does not know of vehicle and step has to fit in, and a braking that is a bit weaker than asked.
RESERVE_M = 0.5
RESERVE_SHARE = 0.015  # of the way to a stop
# What a car that is held at standstill asks for (decision): enough for every grade that it can
# stop on by itself, for the vehicle holds what is not asked to go.
HOLD_MPS2 = -0.5


def followed_request(st: PldfState, request_mps2: float, ahead_s: float, step_s: float) -> float:
    """Return the request, lowered for the car ahead, ``ahead_s`` after the sample of the inputs.

    With no car ahead it is returned as it is. ``step_s`` is how long a request is in force before
    the next one can be.
    """
    if st.standing != 0:
        return min(request_mps2, HOLD_MPS2)
    if st.lead_counts == 0:
        return request_mps2
    start = max(st.vehicle_speed_mps, 0.0)
    speed = max(start + st.vehicle_acceleration_mps2 * ahead_s, 0.0)
    gap_m = st.lead_ahead_m + (st.lead_mps - 0.5 * (start + speed)) * ahead_s
    wanted = min(request_mps2, gap_acceleration(st, gap_m, st.lead_mps, speed))
    wanted = max(wanted, st.control_request_min_mps2)
    return safe_request(st, wanted, gap_m, speed, 2.0 * step_s)


def safe_request(
    st: PldfState, request_mps2: float, gap_m: float, speed_mps: float, delay_s: float
) -> float:
    """Return the request, or the highest one from which the car can still stop behind the lead.

    While the lead brakes as hard as assumed it falls as fast as it may, and so stays kept.
    """
    stop_m = 0.5 * speed_mps * speed_mps / -st.control_request_min_mps2
    reserve_m = RESERVE_M + RESERVE_SHARE * stop_m
    if stopping_room(st, gap_m, speed_mps, request_mps2, delay_s) >= reserve_m:
        return request_mps2
    low = st.control_request_min_mps2
    high = request_mps2
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if stopping_room(st, gap_m, speed_mps, middle, delay_s) >= reserve_m:
            low = middle
        else:
            high = middle
    return low


def gap_acceleration(st: PldfState, gap_m: float, lead_mps: float, speed_mps: float) -> float:
    """Return the acceleration that brings the gap to the desired one and keeps it there.

    The law of constant time gap (Swaroop and Rajamani): the error of the gap falls as ``closing``
    says, whatever the lead does, so a disturbance becomes smaller from car to car as long as the
    vehicle's lag is below half the time gap. Of an approach it brakes no harder than it has to,
    unless that is comfortable anyhow.
    """
    time_gap_s = st.following_desired_time_gap_s
    error_m = gap_m - st.following_standstill_gap_m - time_gap_s * speed_mps
    faster = speed_mps - lead_mps
    wanted = (closing_speed(st, error_m) - faster) / time_gap_s
    if error_m <= 0.0 or faster <= 0.0:
        return wanted
    # Constant braking to the desired gap needs faster**2 / (2 * (error + time gap * faster)); this
    # is a little more, and at the desired gap the law's own.
    needed = -faster * faster / (2.0 * error_m + time_gap_s * faster)
    return max(wanted, min(needed, st.following_accel_min_mps2))


def closing_speed(st: PldfState, error_m: float) -> float:
    """Return how fast an error of the gap (m, positive: too large) shall fall, in m/s.

    In proportion to a small error; a large one as constant, comfortable braking ends it. A gap that
    is too small is opened with no more than comfortable braking, too.
    """
    gain_per_s = st.following_gap_gain_per_s
    comfort = -st.following_accel_min_mps2
    if error_m < 0.0:
        return max(gain_per_s * error_m, -comfort * st.following_desired_time_gap_s)
    proportional_to_m = comfort / (gain_per_s * gain_per_s)  # from there on the root has its slope
    if error_m < proportional_to_m:
        return gain_per_s * error_m
    return sqrt(comfort * (2.0 * error_m - proportional_to_m))


def stopping_room(
    st: PldfState, gap_m: float, speed_mps: float, request_mps2: float, delay_s: float
) -> float:
    """Return what is left of the gap (m, negative: contact) when both cars have braked to a stop.

    The lead brakes with ``following.lead_accel_min_mps2``; the request goes on for ``delay_s`` and
    then falls as fast as it may to its lowest value. The lead brakes at least as hard as the car is
    taken to, so the gap is smallest when both stand.
    """
    lead_decel = -st.following_lead_accel_min_mps2
    decel = min(-st.control_request_min_mps2, lead_decel)
    lag_s = st.following_vehicle_lag_s
    # A first-order lag: v + lag * a moves as the request says, and the car is where that is, but
    # for the lag times what it has lost of its speed.
    as_asked = speed_mps + lag_s * st.vehicle_acceleration_mps2
    own_m = stopping_distance(
        as_asked, request_mps2, decel, st.control_request_jerk_max_mps3, delay_s
    )
    lead_m = 0.5 * st.lead_mps * abs(st.lead_mps) / lead_decel
    return gap_m + lead_m - own_m - lag_s * speed_mps


def stopping_distance(
    speed_mps: float, request_mps2: float, decel_mps2: float, jerk_mps3: float, delay_s: float
) -> float:
    """Return the way (m) to a stop of a car that does as requested.

    The request stays for ``delay_s``, then falls with ``jerk_mps3`` to ``-decel_mps2``.
    """
    speed_mps = max(speed_mps, 0.0)
    if speed_mps == 0.0 and request_mps2 <= 0.0:
        return 0.0
    held_m = delay_s * (speed_mps + 0.5 * delay_s * request_mps2)
    speed = speed_mps + delay_s * request_mps2
    if speed <= 0.0:
        return 0.5 * speed_mps * speed_mps / -request_mps2
    above = max(request_mps2 + decel_mps2, 0.0)
    ramp_s = above / jerk_mps3
    after = speed + 0.5 * ramp_s * (request_mps2 - decel_mps2)
    if after < 0.0:  # it stands before the request has fallen
        root = sqrt(request_mps2 * request_mps2 + 2.0 * jerk_mps3 * speed)
        ramp_s = (request_mps2 + root) / jerk_mps3
        after = 0.0
    ramp_m = ramp_s * (speed + ramp_s * (0.5 * request_mps2 - jerk_mps3 * ramp_s / 6.0))
    return held_m + ramp_m + 0.5 * after * after / decel_mps2
