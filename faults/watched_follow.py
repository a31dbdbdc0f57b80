"""One drive of vehicle and driving function behind cars that come and go, in the numba subset.

What the cars ahead do is settled before the drive, per communication step; they do not look back.
The order of events is that of ``pldf.study.loop``.
"""

from __future__ import annotations

from typing import NamedTuple

from pldf.kernel.arrays import Floats, ProfileArrays, RouteArrays, TraceArrays
from pldf.kernel.codes import STANDBY
from pldf.kernel.drive import drive_step, refresh
from pldf.kernel.state import PldfState

from faults.watched_drive import move_car, show_car
from vehicle_models.vehicle_kernel import vehicle_start, vehicle_step
from vehicle_models.vehicle_state import VehicleState

PLENTY_M = 5.0


class Cars(NamedTuple):
    """The car ahead at each communication point, and what the driver does about it."""

    present: Floats  # 1 = there is one
    speed_mps: Floats
    new_gap_m: Floats  # another car takes this place: its distance; 0 = still the same car
    gas: Floats  # pedal travel
    tip: Floats  # lever: 1 = resume, 2 = up, 3 = down


class Watched(NamedTuple):
    """What is seen before each step, and what the function says after it."""

    s_m: Floats
    speed_mps: Floats
    acceleration_mps2: Floats
    request_mps2: Floats
    mode: Floats
    gap_m: Floats  # bumper to bumper; without a car: 0
    take_over: Floats  # after the step that was given this sample
    next_request_mps2: Floats  # the same
    next_mode: Floats  # the same


def watch_follow(
    models: tuple[VehicleState, PldfState],
    route: RouteArrays,
    arrays: tuple[ProfileArrays, TraceArrays],
    cars: Cars,
    watched: Watched,
    step_s: float,
) -> int:
    """Drive until the road, the cars or the gap end; return the number of steps made."""
    vehicle, pldf = models
    profile, trace = arrays
    end_m = len(route.limit_mps) - 2.0
    gap = 0.0
    not_a_number = 0.0 * 1e308 * 1e308 * 1e308
    vehicle_start(vehicle, route.grade)
    show_car(vehicle, pldf)
    refresh(pldf, route, profile)
    for k in range(len(watched.s_m)):
        if vehicle.s_m >= end_m:
            return k
        if cars.new_gap_m[k] > 0.0:
            gap = cars.new_gap_m[k]
        _note_before(vehicle, pldf, watched, k)
        watched.gap_m[k] = gap if cars.present[k] != 0.0 else 0.0
        show_car(vehicle, pldf)
        pldf.lead_present = 1 if cars.present[k] != 0.0 else 0
        pldf.lead_gap_m = gap if cars.present[k] != 0.0 else not_a_number
        pldf.lead_speed_mps = cars.speed_mps[k] if cars.present[k] != 0.0 else not_a_number
        _move_driver(pldf, cars, k)
        move_car(vehicle, pldf)
        before_m = vehicle.s_m
        vehicle_step(vehicle, route.grade, step_s)
        drive_step(pldf, route, profile, trace, step_s)
        watched.take_over[k] = pldf.hmi_take_over
        watched.next_request_mps2[k] = pldf.acceleration_request_mps2
        watched.next_mode[k] = pldf.mode
        if cars.present[k] != 0.0 and gap <= 0.0:
            return k + 1
        after = cars.speed_mps[min(k + 1, len(cars.speed_mps) - 1)]
        gap += 0.5 * (cars.speed_mps[k] + after) * step_s - (vehicle.s_m - before_m)
    return len(watched.s_m)


def _move_driver(pldf: PldfState, cars: Cars, k: int) -> None:
    """Press the gas, move the lever, and press RESUME again and again while nothing is active."""
    pldf.driver_gas_pedal = cars.gas[k]
    away = pldf.mode == STANDBY and k - 20 * int(k / 20.0) < 10
    pldf.lever_resume = 1 if away or cars.tip[k] == 1.0 else 0
    pldf.lever_up_long = 1 if cars.tip[k] == 2.0 else 0
    pldf.lever_down_long = 1 if cars.tip[k] == 3.0 else 0


def _note_before(vehicle: VehicleState, pldf: PldfState, watched: Watched, k: int) -> None:
    watched.s_m[k] = vehicle.s_m
    watched.speed_mps[k] = vehicle.speed_mps
    watched.acceleration_mps2[k] = vehicle.acceleration_mps2
    watched.request_mps2[k] = pldf.acceleration_request_mps2
    watched.mode[k] = pldf.mode


def least_gap(
    ego: tuple[float, float, float], lead_mps: float, gap_m: float, late_s: float, lag_s: float
) -> float:
    """Return the smallest gap (m) if the lead brakes with 3.5 m/s2 now and the ego as promised.

    ``ego`` is speed, acceleration and request; the request starts to fall after ``late_s`` and is
    followed with a first-order lag. Tried in steps of 20 ms, not derived.
    """
    speed, acceleration, request = ego
    step, t, gap, least = 0.02, 0.0, gap_m, gap_m
    share = step / (lag_s + 0.5 * step)
    while speed > 0.0 and least > -1.0:
        if t >= late_s:
            request = max(request - 2.5 * step, -3.5)
        acceleration += share * (request - acceleration)
        slower = max(speed + acceleration * step, 0.0)
        lead_slower = max(lead_mps - 3.5 * step, 0.0)
        gap += 0.5 * step * (lead_mps + lead_slower - speed - slower)
        least = min(least, gap)
        speed, lead_mps, t = slower, lead_slower, t + step
        if t > 60.0:
            return least
    return least


def judge_gaps(
    watched: Watched, lead_mps: Floats, spare_m: Floats, times: tuple[float, float]
) -> None:
    """Fill ``spare_m`` with the smallest gap that braking as promised would leave, per step."""
    late_s, lag_s = times
    for k in range(len(spare_m)):
        speed, acceleration = watched.speed_mps[k], watched.acceleration_mps2[k]
        request, gap = watched.request_mps2[k], watched.gap_m[k]
        strongest = max(request, acceleration, 0.0)
        ramp_s = late_s + lag_s + (strongest + 3.5) / 2.5
        fastest = speed + ramp_s * strongest
        # No way to a stop is longer. Where it leaves plenty, nothing has to be tried.
        way = fastest * ramp_s + fastest * fastest / 7.0
        left = min(gap, gap + lead_mps[k] * lead_mps[k] / 7.0 - way)
        if left > PLENTY_M:
            spare_m[k] = left
        else:
            ego = (speed, acceleration, request)
            spare_m[k] = least_gap(ego, lead_mps[k], gap, late_s, lag_s)
