"""Vehicle, driver and driving function coupled in one process, in the numba subset.

The order of events is that of ``master`` with the FMUs, which the results equal to the bit: all
three step with the outputs of the last communication point (Jacobi).
"""

from __future__ import annotations

from typing import NamedTuple

from vehicle_models.driver_kernel import driver_start, driver_step
from vehicle_models.driver_state import DriverState
from vehicle_models.script_kernel import ScriptArrays
from vehicle_models.vehicle_kernel import vehicle_start, vehicle_step
from vehicle_models.vehicle_state import VehicleState
from vehicle_models.wish_kernel import WishArrays

from ..kernel.arrays import Floats, ProfileArrays, RouteArrays, TraceArrays
from ..kernel.drive import drive_step, refresh
from ..kernel.state import PldfState

ARRIVED = 0
STOOD_STILL = 1
TOO_SLOW = 2


class Models(NamedTuple):
    """The three records."""

    vehicle: VehicleState
    driver: DriverState
    pldf: PldfState


class ModelArrays(NamedTuple):
    """What the three models know and remember beside their records."""

    wish: WishArrays
    script: ScriptArrays
    route: RouteArrays
    profile: ProfileArrays
    trace: TraceArrays


class Ends(NamedTuple):
    """When a drive is over."""

    length_m: float
    step_s: float
    steps: int  # at most
    standstill_mps: float
    standstill_s: float


class Rows(NamedTuple):
    """What is seen before each step; columns of the recording. Empty: nothing is kept."""

    s_m: Floats
    speed_mps: Floats
    acceleration_mps2: Floats
    mode: Floats
    gas_pedal: Floats
    brake_pedal: Floats
    set_speed_mps: Floats
    set_speed_offset_mps: Floats
    base_mps: Floats
    learned_delta_mps: Floats
    limit_mps: Floats
    eligible: Floats
    vehicle_x_m: Floats
    vehicle_y_m: Floats
    lever_resume: Floats
    lever_cancel: Floats
    lever_up: Floats
    lever_down: Floats
    lever_up_long: Floats
    lever_down_long: Floats
    teach_pause: Floats
    teach_forget_here: Floats
    teach_undo: Floats
    lead_present: Floats
    lead_gap_m: Floats
    lead_speed_mps: Floats
    limit_override_mps: Floats
    acceleration_request_mps2: Floats
    hmi_reason: Floats
    hmi_event: Floats
    hmi_learned_in_drives: Floats
    hmi_confidence: Floats
    hmi_take_over: Floats
    following_limits: Floats
    following_time_gap_s: Floats
    hmi_sentence: Floats
    hmi_sentence_speed: Floats
    hmi_sentence_base: Floats
    hmi_sentence_limit: Floats
    hmi_sentence_drive: Floats


def run_drive(models: Models, arrays: ModelArrays, ends: Ends, rows: Rows) -> tuple[int, int]:
    """Drive until the end; return how it ended (code) and the number of steps made.

    Inputs start at 0 where no output is known yet: the vehicle is first, the function last.
    """
    vehicle, driver, pldf = models
    vehicle_start(vehicle, arrays.route.grade)
    _show_vehicle_to_driver(vehicle, driver)
    driver_start(driver)
    _show_to_function(vehicle, driver, pldf)
    refresh(pldf, arrays.route, arrays.profile)
    moved = 0  # last step at which the vehicle moved
    for k in range(ends.steps):
        if vehicle.s_m >= ends.length_m:
            return ARRIVED, k
        if vehicle.speed_mps > ends.standstill_mps:
            moved = k
        if (k - moved) * ends.step_s > ends.standstill_s:
            return STOOD_STILL, k
        if k < len(rows.s_m):
            _write_row(models, rows, k)
        _exchange(vehicle, driver, pldf)
        vehicle_step(vehicle, arrays.route.grade, ends.step_s)
        driver_step(driver, arrays.wish, arrays.script, ends.step_s)
        drive_step(pldf, arrays.route, arrays.profile, arrays.trace, ends.step_s)
    return TOO_SLOW, ends.steps


def _exchange(vehicle: VehicleState, driver: DriverState, pldf: PldfState) -> None:
    """Feed every input from the output of the last communication point."""
    _show_to_function(vehicle, driver, pldf)
    _show_vehicle_to_driver(vehicle, driver)
    driver.mode = pldf.mode
    driver.target_speed_mps = pldf.target_speed_mps
    driver.set_speed_mps = pldf.set_speed_mps
    driver.limit_mps = pldf.limit_mps
    vehicle.acceleration_request_mps2 = pldf.acceleration_request_mps2
    vehicle.function_active = pldf.function_active
    vehicle.driver_gas_pedal = driver.driver_gas_pedal
    vehicle.driver_brake_pedal = driver.driver_brake_pedal


def _show_vehicle_to_driver(vehicle: VehicleState, driver: DriverState) -> None:
    driver.vehicle_s_m = vehicle.s_m
    driver.vehicle_speed_mps = vehicle.speed_mps
    driver.vehicle_acceleration_mps2 = vehicle.acceleration_mps2


def _show_to_function(vehicle: VehicleState, driver: DriverState, pldf: PldfState) -> None:
    pldf.vehicle_s_m = vehicle.s_m
    pldf.vehicle_speed_mps = vehicle.speed_mps
    pldf.vehicle_acceleration_mps2 = vehicle.acceleration_mps2
    pldf.driver_gas_pedal = driver.driver_gas_pedal
    pldf.driver_brake_pedal = driver.driver_brake_pedal
    pldf.lever_resume = driver.lever_resume
    pldf.lever_cancel = driver.lever_cancel
    pldf.lever_up = driver.lever_up
    pldf.lever_down = driver.lever_down
    pldf.lever_up_long = driver.lever_up_long
    pldf.lever_down_long = driver.lever_down_long


def _write_row(models: Models, rows: Rows, k: int) -> None:
    rows.s_m[k] = models.vehicle.s_m
    rows.speed_mps[k] = models.vehicle.speed_mps
    rows.acceleration_mps2[k] = models.vehicle.acceleration_mps2
    rows.mode[k] = models.pldf.mode
    rows.gas_pedal[k] = models.driver.driver_gas_pedal
    rows.brake_pedal[k] = models.driver.driver_brake_pedal
    rows.set_speed_mps[k] = models.pldf.set_speed_mps
    rows.set_speed_offset_mps[k] = models.pldf.set_speed_offset_mps
    rows.base_mps[k] = models.pldf.base_speed_mps
    rows.learned_delta_mps[k] = models.pldf.hmi_learned_delta_mps
    rows.limit_mps[k] = models.pldf.limit_mps
    rows.eligible[k] = models.pldf.eligible
    rows.vehicle_x_m[k] = models.pldf.vehicle_x_m
    rows.vehicle_y_m[k] = models.pldf.vehicle_y_m
    rows.lever_resume[k] = models.driver.lever_resume
    rows.lever_cancel[k] = models.driver.lever_cancel
    rows.lever_up[k] = models.driver.lever_up
    rows.lever_down[k] = models.driver.lever_down
    rows.lever_up_long[k] = models.driver.lever_up_long
    rows.lever_down_long[k] = models.driver.lever_down_long
    rows.teach_pause[k] = models.pldf.teach_pause
    rows.teach_forget_here[k] = models.pldf.teach_forget_here
    rows.teach_undo[k] = models.pldf.teach_undo
    rows.lead_present[k] = models.pldf.lead_present
    rows.lead_gap_m[k] = models.pldf.lead_gap_m
    rows.lead_speed_mps[k] = models.pldf.lead_speed_mps
    rows.limit_override_mps[k] = models.pldf.limit_override_mps
    rows.acceleration_request_mps2[k] = models.pldf.acceleration_request_mps2
    rows.hmi_reason[k] = models.pldf.hmi_reason
    rows.hmi_event[k] = models.pldf.hmi_event
    rows.hmi_learned_in_drives[k] = models.pldf.hmi_learned_in_drives
    rows.hmi_confidence[k] = models.pldf.hmi_confidence
    rows.hmi_take_over[k] = models.pldf.hmi_take_over
    rows.following_limits[k] = models.pldf.following_limits
    rows.following_time_gap_s[k] = models.pldf.following_time_gap_s
    rows.hmi_sentence[k] = models.pldf.hmi_sentence
    rows.hmi_sentence_speed[k] = models.pldf.hmi_sentence_speed
    rows.hmi_sentence_base[k] = models.pldf.hmi_sentence_base
    rows.hmi_sentence_limit[k] = models.pldf.hmi_sentence_limit
    rows.hmi_sentence_drive[k] = models.pldf.hmi_sentence_drive
