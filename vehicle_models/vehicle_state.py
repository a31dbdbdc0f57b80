"""Signals and state of the longitudinal vehicle.

The defaults are a Volkswagen ID.3 Pro Performance (58 kWh, 2020) with its driver alone on board.
``docs/vehicle.md`` gives the source of every number and says which are assumptions.
"""

from __future__ import annotations

from dataclasses import dataclass

from pldf.kernel.ranges import flag, number
from pldf.kernel.signals import (
    count_parameter,
    flag_input,
    flag_parameter,
    real_input,
    real_output,
    real_parameter,
    text_parameter,
)
from pldf.kernel.units import KMH_PER_MPS

FINITE_MAX = 1e300  # larger numbers count as infinite


@dataclass(slots=True)
class VehicleTexts:
    """String parameters."""

    route_file: str = text_parameter("Route for the grade, instead of the packed one of route_id")


@dataclass
class VehicleParameters:
    """One car, its low-level control and where it starts."""

    route_id: int = count_parameter(
        "Index of the packed route, 0 = the shipped study road", start=0, low=0, high=999
    )
    grade_from_route: int = flag_parameter("Grade from the route (else grade_constant)", start=True)
    grade_constant: float = real_parameter(
        "Grade everywhere, rise over run", "", start=0.0, low=-0.4, high=0.4
    )
    start_s_m: float = real_parameter(
        "Position at the start", "m", start=0.0, low=-1e7, high=1e7, name="start_s_m"
    )
    start_speed_mps: float = real_parameter(
        "Speed at the start", "m/s", start=80.0 / KMH_PER_MPS, low=0.0, high=80.0
    )
    body_mass_kg: float = real_parameter(
        "Mass with its load", "kg", start=1812.0, low=100.0, high=60_000.0
    )
    body_rotating_factor: float = real_parameter(
        "Mass with the rotating parts over mass", "", start=1.04, low=1.0, high=2.0
    )
    body_drag_coefficient: float = real_parameter(
        "Drag coefficient", "", start=0.267, low=0.0, high=2.0
    )
    body_frontal_area_m2: float = real_parameter(
        "Frontal area", "m2", start=2.27, low=0.0, high=20.0
    )
    body_air_density_kgpm3: float = real_parameter(
        "Density of the air", "kg/m3", start=1.2, low=0.0, high=2.0
    )
    body_rolling_coefficient: float = real_parameter(
        "Rolling resistance over weight", "", start=0.009, low=0.0, high=0.2
    )
    body_force_max_n: float = real_parameter(
        "Largest drive force at the wheels", "N", start=9696.0, low=1.0, high=1e6
    )
    body_power_max_w: float = real_parameter(
        "Largest drive power at the wheels", "W", start=141_100.0, low=1.0, high=1e7
    )
    body_speed_max_mps: float = real_parameter(
        "Speed at which the drive is cut off", "m/s", start=160.0 / KMH_PER_MPS, low=1.0, high=150.0
    )
    body_brake_max_mps2: float = real_parameter(
        "Deceleration by the brakes at full pedal", "m/s2", start=9.81, low=0.5, high=20.0
    )
    body_coast_decel_mps2: float = real_parameter(
        "Recuperation with all pedals released (0 = D, 1.3 = B)",
        "m/s2", start=0.0, low=0.0, high=5.0,
    )  # fmt: skip
    body_drive_lag_s: float = real_parameter(
        "Time constant of the drive force", "s", start=0.15, low=0.01, high=2.0
    )
    body_brake_lag_s: float = real_parameter(
        "Time constant of the brake force", "s", start=0.2, low=0.01, high=2.0
    )


@dataclass
class VehicleInputs:
    """What driving function and driver ask for."""

    acceleration_request_mps2: float = real_input(
        "Acceleration requested by the driving function", "m/s2", start=0.0, low=-10.0, high=5.0
    )
    driver_gas_pedal: float = real_input("Gas pedal travel", "", start=0.0, low=0.0, high=1.0)
    driver_brake_pedal: float = real_input("Brake pedal travel", "", start=0.0, low=0.0, high=1.0)
    function_active: int = flag_input("The request shall be followed", start=False)


# An actuator answers them with a lag: force and acceleration follow the steps alone.
DEMANDS = (
    "acceleration_request_mps2", "driver_gas_pedal", "driver_brake_pedal", "function_active",
)  # fmt: skip


@dataclass
class VehicleOutputs:
    """How the car moves."""

    s_m: float = real_output("Position along the route", "m")
    speed_mps: float = real_output("Ego speed", "m/s", low=0.0)
    acceleration_mps2: float = real_output("Ego acceleration", "m/s2")
    jerk_mps3: float = real_output("Change of the acceleration per second", "m/s3", follows=DEMANDS)


@dataclass
class VehicleMemory:
    """What the vehicle keeps from step to step."""

    inertia_kg: float = number(0.0, 1e6)  # these four follow from the parameters
    mps2_per_n: float = number(0.0, 1.0)
    drive_rate_per_s: float = number(0.0, 1e3)
    brake_rate_per_s: float = number(0.0, 1e3)
    drive_force_n: float = 0.0
    brake_force_n: float = 0.0
    load_n: float = 0.0  # road load at the present position and speed
    drive_limit_n: float = 0.0  # largest drive force there
    # the inputs as used: finite, pedals within 0 and 1
    request_mps2: float = number(-FINITE_MAX, FINITE_MAX)
    gas: float = number(0.0, 1.0)
    brake: float = number(0.0, 1.0)
    invalid_input: int = flag()
    warned: int = flag()


# A dataclass takes the fields of its LAST base first; value references follow from their order
# within a release (``signals.by_reference``).
@dataclass(slots=True)
class VehicleState(VehicleMemory, VehicleOutputs, VehicleInputs, VehicleParameters):
    """Everything of one vehicle but the grade per metre, in one flat record."""
