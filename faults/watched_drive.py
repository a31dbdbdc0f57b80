"""One drive of vehicle and driving function with a driver who wants harm, in the numba subset.

The driver's wish is a speed per metre: 0 = hands off, else gas below it and brake above it. The
order of events is that of ``pldf.study.loop``.
"""

from __future__ import annotations

from typing import NamedTuple

from pldf.kernel.arrays import Floats, ProfileArrays, RouteArrays, TraceArrays
from pldf.kernel.codes import ACTIVE, STANDBY
from pldf.kernel.drive import drive_step, refresh
from pldf.kernel.interpolation import cell_at
from pldf.kernel.state import PldfState

from vehicle_models.vehicle_kernel import vehicle_start, vehicle_step
from vehicle_models.vehicle_state import VehicleState

# Above its wish by more than this the driver brakes, unless the car is about to stand.
BRAKE_FROM_MPS = 1.0
SLOWEST_MPS = 3.0


class Lesson(NamedTuple):
    """What the driver does, per cell."""

    wish_mps: Floats  # 0 = hands off
    tips: Floats  # contact of the lever: 1 up, -1 down (long tips), 0 none


class Seen(NamedTuple):
    """What is seen before each step."""

    s_m: Floats
    speed_mps: Floats
    acceleration_mps2: Floats
    request_mps2: Floats
    mode: Floats
    driver: Floats  # 1 = a pedal or a contact is operated
    manual: Floats  # 1 = a set speed set by hand is in force


def watch_drive(
    models: tuple[VehicleState, PldfState],
    route: RouteArrays,
    arrays: tuple[ProfileArrays, TraceArrays],
    lesson: Lesson,
    seen: Seen,
    step_s: float,
) -> int:
    """Drive to the end of the route; fill ``seen`` and return the number of steps made."""
    vehicle, pldf = models
    profile, trace = arrays
    end_m = len(route.limit_mps) - 2.0
    vehicle_start(vehicle, route.grade)
    show_car(vehicle, pldf)
    refresh(pldf, route, profile)
    for k in range(len(seen.s_m)):
        if vehicle.s_m >= end_m:
            return k
        _act(pldf, lesson, vehicle.s_m, vehicle.speed_mps, k)
        _write(vehicle, pldf, seen, k)
        show_car(vehicle, pldf)
        move_car(vehicle, pldf)
        vehicle_step(vehicle, route.grade, step_s)
        drive_step(pldf, route, profile, trace, step_s)
    return len(seen.s_m)


def show_car(vehicle: VehicleState, pldf: PldfState) -> None:
    """Give the function what the vehicle tells."""
    pldf.vehicle_s_m = vehicle.s_m
    pldf.vehicle_speed_mps = vehicle.speed_mps
    pldf.vehicle_acceleration_mps2 = vehicle.acceleration_mps2


def move_car(vehicle: VehicleState, pldf: PldfState) -> None:
    """Give the vehicle what the function requests and the driver presses."""
    vehicle.acceleration_request_mps2 = pldf.acceleration_request_mps2
    vehicle.function_active = pldf.function_active
    vehicle.driver_gas_pedal = pldf.driver_gas_pedal
    vehicle.driver_brake_pedal = pldf.driver_brake_pedal


def _act(pldf: PldfState, lesson: Lesson, s_m: float, speed_mps: float, k: int) -> None:
    """Operate pedals and lever for this place; RESUME again and again while hands are off."""
    cell = cell_at(len(lesson.tips), s_m)
    wish = lesson.wish_mps[cell]
    brakes = wish > 0.0 and speed_mps > max(wish + BRAKE_FROM_MPS, SLOWEST_MPS)
    pldf.driver_brake_pedal = 0.4 if brakes else 0.0
    pldf.driver_gas_pedal = 1.0 if speed_mps < wish else 0.0
    away = pldf.mode == STANDBY and wish == 0.0
    pldf.lever_resume = 1 if away and k - 20 * int(k / 20.0) < 10 else 0
    pldf.lever_up_long = 1 if lesson.tips[cell] > 0.0 else 0
    pldf.lever_down_long = 1 if lesson.tips[cell] < 0.0 else 0


def _write(vehicle: VehicleState, pldf: PldfState, seen: Seen, k: int) -> None:
    seen.s_m[k] = vehicle.s_m
    seen.speed_mps[k] = vehicle.speed_mps
    seen.acceleration_mps2[k] = vehicle.acceleration_mps2
    seen.request_mps2[k] = pldf.acceleration_request_mps2
    seen.mode[k] = pldf.mode
    pedals = pldf.driver_gas_pedal + pldf.driver_brake_pedal
    lever = pldf.lever_resume + pldf.lever_up_long + pldf.lever_down_long
    seen.driver[k] = 1.0 if pedals + lever > 0.0 or pldf.mode != ACTIVE else 0.0
    seen.manual[k] = 1.0 if pldf.manual_set_mps > 0.0 and vehicle.s_m < pldf.manual_end_m else 0.0
