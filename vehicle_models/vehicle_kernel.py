"""Longitudinal dynamics of a car, its pedals and the control that follows a request.

Equation of motion, with mass ``m``, rotating factor ``e``, drive and brake force at the wheels::

    m * e * dv/dt = drive - brake - road_load(s, v)

Drive and brake force each follow their demand as a first-order lag, solved exactly per internal
step. In the numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from math import sqrt

from pldf.kernel.arrays import Floats
from pldf.kernel.interpolation import value_at
from pldf.kernel.substeps import substep_count

from .vehicle_state import FINITE_MAX, VehicleState

GRAVITY_MPS2 = 9.81
# The drive fades out over this last part of the speed range instead of being switched.
CUT_OFF_GAIN_PER_S = 1.0
# Recuperation fades out below this speed, so that coasting ends without a jerk.
COAST_FADE_MPS = 3.0


def vehicle_start(st: VehicleState, grade: Floats) -> None:
    """Put the car at its start, driving steadily: the drive force balances the road load."""
    st.inertia_kg = st.body_mass_kg * st.body_rotating_factor
    st.mps2_per_n = 1.0 / st.inertia_kg
    st.drive_rate_per_s = 1.0 / st.body_drive_lag_s
    st.brake_rate_per_s = 1.0 / st.body_brake_lag_s
    st.s_m = st.start_s_m
    st.speed_mps = st.start_speed_mps
    st.drive_force_n = 0.0
    st.brake_force_n = 0.0
    _feel_road(st, grade)
    if st.speed_mps > 0.0 and st.load_n > 0.0:
        st.drive_force_n = min(st.load_n, st.drive_limit_n)
    elif st.speed_mps > 0.0:
        st.brake_force_n = -st.load_n
    _accelerate(st, st.speed_mps > 0.0)
    vehicle_refresh(st, grade)


def vehicle_step(st: VehicleState, grade: Floats, step_s: float) -> None:
    """Advance by ``step_s`` seconds in equal internal steps of at most 10 ms."""
    read_inputs(st)
    count = substep_count(step_s)
    inner_s = step_s
    if count > 1:  # spares the usual step a division
        inner_s = step_s / count
    for _ in range(count):
        _advance(st, inner_s)
        _feel_road(st, grade)
    moves = st.speed_mps > 0.0 or _leaves_standstill(st)
    _accelerate(st, moves)
    _update_jerk(st, moves)


def vehicle_refresh(st: VehicleState, grade: Floats) -> None:
    """Recompute the jerk from state and inputs; for the acceleration the actuators need a step."""
    read_inputs(st)
    _feel_road(st, grade)
    _update_jerk(st, st.speed_mps > 0.0 or _leaves_standstill(st))


def read_inputs(st: VehicleState) -> None:
    """Take the inputs over: what is not a number counts as no request and released pedals."""
    request = st.acceleration_request_mps2
    st.invalid_input = int(
        not is_finite(request)
        or not is_finite(st.driver_gas_pedal)
        or not is_finite(st.driver_brake_pedal)
    )
    st.request_mps2 = request if is_finite(request) else 0.0
    st.gas = pedal_travel(st.driver_gas_pedal)
    st.brake = pedal_travel(st.driver_brake_pedal)


def _feel_road(st: VehicleState, grade: Floats) -> None:
    """Keep what depends on position and speed alone."""
    st.load_n = road_load_n(st, grade)
    st.drive_limit_n = drive_force_max_n(st)


def _accelerate(st: VehicleState, moves: bool) -> None:
    force_n = st.drive_force_n - st.brake_force_n - st.load_n
    st.acceleration_mps2 = force_n * st.mps2_per_n if moves else 0.0


def _update_jerk(st: VehicleState, moves: bool) -> None:
    if not moves:
        st.jerk_mps3 = 0.0
        return
    drive_rate = (drive_demand_n(st) - st.drive_force_n) * st.drive_rate_per_s
    brake_rate = (brake_demand_n(st) - st.brake_force_n) * st.brake_rate_per_s
    drag_rate = 2.0 * drag_n_per_v2(st) * st.speed_mps * st.acceleration_mps2
    st.jerk_mps3 = (drive_rate - brake_rate - drag_rate) * st.mps2_per_n


def _advance(st: VehicleState, step_s: float) -> None:
    """One internal step: lags exactly, road load by the midpoint rule."""
    drive_demand = drive_demand_n(st)
    brake_demand = brake_demand_n(st)
    drive_x = step_s * st.drive_rate_per_s
    brake_x = step_s * st.brake_rate_per_s
    drive_share = lag_share(drive_x)
    brake_share = lag_share(brake_x)
    drive = drive_demand + (st.drive_force_n - drive_demand) * drive_share
    brake = brake_demand + (st.brake_force_n - brake_demand) * brake_share
    st.drive_force_n += (drive_demand - st.drive_force_n) * drive_x * drive_share
    st.brake_force_n += (brake_demand - st.brake_force_n) * brake_x * brake_share
    acceleration = 0.0
    if st.speed_mps > 0.0 or _leaves_standstill(st):
        first = (drive - brake - st.load_n) * st.mps2_per_n
        # The load's change over half a step is that of the drag alone; grade changes are slower.
        drag_rate = 2.0 * drag_n_per_v2(st) * st.speed_mps * first
        acceleration = first - 0.5 * step_s * drag_rate * st.mps2_per_n
    _move(st, acceleration, step_s)


def _move(st: VehicleState, acceleration_mps2: float, step_s: float) -> None:
    """Integrate speed and position; within a step that ends the motion, only up to the stop."""
    before = st.speed_mps
    after = before + step_s * acceleration_mps2
    s_m = st.s_m
    speed = before
    if after > 0.0:
        s_m += 0.5 * (before + after) * step_s
        speed = after
    elif before > 0.0:
        s_m += 0.5 * before * step_s * before / (before - after)  # this share of the step
        speed = 0.0
    # Stored on one path: compiled, what follows need not wait for the memory.
    st.s_m = s_m
    st.speed_mps = speed


def _leaves_standstill(st: VehicleState) -> bool:
    """Tell whether a standing car starts to move; until somebody wants that, it is held."""
    wanted = st.gas > 0.0 or (st.function_active != 0 and st.request_mps2 > 0.0)
    held = st.brake > 0.0 or not wanted
    return not held and st.drive_force_n - st.brake_force_n - st.load_n > 0.0


def drive_demand_n(st: VehicleState) -> float:
    """Drive force asked for by request and gas pedal (N), within what the drive can give."""
    if st.brake > 0.0:
        return 0.0
    demand = st.gas * st.drive_limit_n
    if st.function_active != 0:
        demand += _request_force_n(st)
    return max(0.0, min(demand, st.drive_limit_n))


def brake_demand_n(st: VehicleState) -> float:
    """Brake force (N): the pedal's, else what the request lacks, else recuperation."""
    pedal = st.brake
    strongest = st.inertia_kg * st.body_brake_max_mps2
    if pedal > 0.0:
        return pedal * strongest
    gas = st.gas
    if st.function_active != 0:
        lacking = -_request_force_n(st) - gas * st.drive_limit_n
        return max(0.0, min(lacking, strongest))
    if gas > 0.0:
        return 0.0
    fade = min(1.0, st.speed_mps / COAST_FADE_MPS)
    return st.inertia_kg * st.body_coast_decel_mps2 * fade


def _request_force_n(st: VehicleState) -> float:
    """Force that gives the requested acceleration on this grade at this speed (signed)."""
    return st.inertia_kg * st.request_mps2 + st.load_n


def drive_force_max_n(st: VehicleState) -> float:
    """Drive force available: force limit, power limit, cut-off at the highest speed."""
    available = st.body_force_max_n
    if available * st.speed_mps > st.body_power_max_w:
        available = st.body_power_max_w / st.speed_mps
    rest = CUT_OFF_GAIN_PER_S * (st.body_speed_max_mps - st.speed_mps)
    return max(0.0, min(available, st.inertia_kg * rest + st.load_n))


def road_load_n(st: VehicleState, grade: Floats) -> float:
    """Rolling, grade and air resistance at the present position and speed."""
    slope = st.grade_constant if st.grade_from_route == 0 else value_at(grade, st.s_m)
    weight = st.body_mass_kg * GRAVITY_MPS2 / sqrt(1.0 + slope * slope)
    drag = drag_n_per_v2(st) * st.speed_mps * st.speed_mps
    return weight * (st.body_rolling_coefficient + slope) + drag


def drag_n_per_v2(st: VehicleState) -> float:
    """Air resistance over squared speed."""
    return 0.5 * st.body_air_density_kgpm3 * st.body_drag_coefficient * st.body_frontal_area_m2


def lag_share(x: float) -> float:
    """Mean distance of a first-order lag from its demand over ``x`` time constants, over the first.

    Of the first distance ``x`` times this share is gone at the end. From the (2, 2) Padé
    approximant of exp(-x), which is off by less than x**5/720: 2e-9 at 10 ms and 150 ms, 6e-4 at
    x = 1.
    """
    return 1.0 / (1.0 + 0.5 * x + x * x * (1.0 / 12.0))


def pedal_travel(value: float) -> float:
    """Pedal travel within 0 and 1; released when the value is not a number."""
    if not is_finite(value):
        return 0.0
    return max(0.0, min(1.0, value))


def is_finite(value: float) -> bool:
    """Tell whether a value is a usable number (comparisons with NaN are false)."""
    return -FINITE_MAX < value < FINITE_MAX
