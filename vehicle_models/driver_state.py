"""Signals and state of the driver model.

Defaults are the medians of the study's starting values where the study has one; the others are
decisions, explained in ``docs/vehicle.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from pldf.kernel.codes import MODE
from pldf.kernel.ranges import flag, nanoseconds, number, whole
from pldf.kernel.signals import (
    count_input,
    count_parameter,
    flag_input,
    flag_output,
    flag_parameter,
    real_input,
    real_output,
    real_parameter,
    since,
    text_parameter,
)
from pldf.kernel.units import MPS_PER_KMH

HANDS_OFF: Final = 0
SCRIPT: Final = 1
PREFERENCE: Final = 2

# What the driver is doing (``phase``).
AWAY: Final = 0  # the function is not active; waits, then presses RESUME
WATCHING: Final = 1
ON_GAS: Final = 2
ON_BRAKE: Final = 3


@dataclass(slots=True)
class DriverTexts:
    """String parameters."""

    script_file: str = text_parameter(
        "Script to follow, instead of the packed one of script_id", name="script_file"
    )
    route_file: str = text_parameter("Route, instead of the packed one of route_id")


def _offset_sd(how: str) -> Any:
    return real_parameter(
        f"Standard deviation of the wished offset {how}", "m/s", start=0.0, low=0.0, high=20.0
    )


def _lateral_sigma(how: str) -> Any:
    return real_parameter(
        f"Standard deviation of the logarithm of the accepted lateral acceleration {how}",
        "", start=0.0, low=0.0, high=1.0,
    )  # fmt: skip


@dataclass
class WishParameters:
    """Which driver, on which route, with which hidden wish."""

    kind: int = count_parameter(
        "0 = hands off, activates only; 1 = script; 2 = preference driver",
        start=PREFERENCE, low=0, high=2,
    )  # fmt: skip
    script_id: int = count_parameter(
        "Index of the packed script (kind 1)", start=0, low=0, high=999, name="script_id"
    )
    route_id: int = count_parameter(
        "Index of the packed route, 0 = the shipped study road", start=0, low=0, high=999
    )
    seed: int = count_parameter(
        "Seed of this drive: small irregularities, and the occasion's part of the wish",
        start=1,
        low=0,
        high=999_999_999,
    )
    wish_offset_mps: float = real_parameter(
        "Wished speed above the legal limit where nothing else binds",
        "m/s", start=7.0 * MPS_PER_KMH, low=-20.0, high=30.0,
    )  # fmt: skip
    wish_lateral_accel_max_mps2: float = real_parameter(
        "Lateral acceleration accepted in curves", "m/s2", start=2.9, low=0.1, high=10.0
    )
    wish_accel_max_mps2: float = real_parameter(
        "Strength of accelerating", "m/s2", start=1.5, low=0.1, high=5.0
    )
    wish_accel_min_mps2: float = real_parameter(
        "Strength of slowing down, negative", "m/s2", start=-1.3, low=-10.0, high=-0.1
    )
    wish_jerk_max_mps3: float = real_parameter(
        "Largest jerk of the wished speed; 0 = not limited", "m/s3", start=1.0, low=0.0, high=50.0
    )
    wish_anticipation_s: float = real_parameter(
        "Time before the sign at which a higher limit counts", "s", start=2.0, low=0.0, high=20.0
    )
    person_seed: int = since(
        "0.3",
        count_parameter(
            "Seed of what lasts: how this person's wish differs from the usual one, and from place "
            "to place",
            start=1, low=0, high=999_999_999, name="person_seed",
        ),
    )  # fmt: skip
    wish_offset_person_sd_mps: float = since(
        "0.3", _offset_sd("from person to person, for good (person_seed)")
    )
    wish_offset_place_sd_mps: float = since(
        "0.3", _offset_sd("of one person from limit to limit, for good (person_seed)")
    )
    wish_offset_occasion_sd_mps: float = since(
        "0.3", _offset_sd("from drive to drive (seed), half of the variance limit by limit")
    )
    wish_lateral_person_sigma: float = since(
        "0.3", _lateral_sigma("from person to person, for good (person_seed)")
    )
    wish_lateral_place_sigma: float = since(
        "0.3", _lateral_sigma("of one person from curve to curve, for good (person_seed)")
    )
    wish_lateral_occasion_sigma: float = since(
        "0.3", _lateral_sigma("from drive to drive (seed), half of the variance curve by curve")
    )


@dataclass
class DriverParameters:
    """How the driver acts on the wish."""

    driver_threshold_mps: float = real_parameter(
        "Deviation from the wish below which nothing is done",
        "m/s", start=5.0 * MPS_PER_KMH, low=0.0, high=30.0,
    )  # fmt: skip
    driver_reaction_s: float = real_parameter(
        "Time for which a deviation lasts before a pedal is pressed",
        "s", start=1.0, low=0.0, high=10.0,
    )  # fmt: skip
    driver_spread: float = real_parameter(
        "Spread of the driver's delays, share of each delay", "", start=0.2, low=0.0, high=1.0
    )
    driver_overshoot: float = real_parameter(
        "How far a pedal is held beyond the wish, in thresholds", "", start=0.6, low=0.0, high=5.0
    )
    driver_start_s: float = real_parameter(
        "Time of the first activation of the function", "s", start=1.0, low=0.0, high=3600.0
    )
    driver_reactivation_s: float = real_parameter(
        "Time from letting go of the brake to pressing RESUME", "s", start=2.0, low=0.0, high=60.0
    )
    driver_uses_lever: int = flag_parameter("Sets the speed by the lever in cruise", start=True)
    driver_lever_step_mps: float = real_parameter(
        "Set-speed change that one long tip is known to make",
        "m/s", start=5.0 * MPS_PER_KMH, low=0.1, high=20.0,
    )  # fmt: skip
    driver_lever_settled_s: float = real_parameter(
        "Time of steady cruise before the lever is used", "s", start=3.0, low=0.0, high=60.0
    )
    driver_lever_limit_s: float = real_parameter(
        "Time before the next limit within which the lever is left alone",
        "s", start=8.0, low=0.0, high=60.0,
    )  # fmt: skip
    driver_lever_straight_s: float = real_parameter(
        "Time of straight road ahead that the lever needs", "s", start=5.0, low=0.0, high=60.0
    )
    driver_lever_curvature_per_m: float = real_parameter(
        "Curvature up to which a road counts as straight", "1/m", start=0.002, low=0.0, high=1.0
    )
    driver_speed_gain_per_s: float = real_parameter(
        "Acceleration aimed at per speed deviation", "1/s", start=0.6, low=0.01, high=10.0
    )
    driver_gas_gain_mps2: float = real_parameter(
        "Acceleration that full gas is believed to give", "m/s2", start=4.0, low=0.1, high=20.0
    )
    driver_brake_gain_mps2: float = real_parameter(
        "Deceleration that full brake is believed to give", "m/s2", start=9.81, low=0.1, high=20.0
    )
    driver_pedal_time_s: float = real_parameter(
        "Time in which a pedal corrects the acceleration", "s", start=0.5, low=0.05, high=10.0
    )
    driver_pedal_rate_per_s: float = real_parameter(
        "Fastest pedal movement, travel per second", "1/s", start=1.0, low=0.01, high=20.0
    )


@dataclass
class DriverInputs:
    """What the driver perceives."""

    vehicle_s_m: float = real_input(
        "Arc length along the route", "m", start=0.0, low=-1e7, high=1e7
    )
    vehicle_speed_mps: float = real_input("Ego speed", "m/s", start=0.0, low=-10.0, high=150.0)
    vehicle_acceleration_mps2: float = real_input(
        "Ego acceleration", "m/s2", start=0.0, low=-50.0, high=50.0
    )
    mode: int = count_input(
        f"Mode of the driving function: {MODE.legend}", start=0, low=0, high=len(MODE.items) - 1
    )
    target_speed_mps: float = real_input(
        "Speed the function aims at here", "m/s", start=0.0, low=0.0, high=150.0
    )
    set_speed_mps: float = real_input(
        "Set speed of the function", "m/s", start=0.0, low=0.0, high=150.0
    )
    limit_mps: float = real_input(
        "Legal limit here, 0 = unknown (then the lever is not used)",
        "m/s", start=0.0, low=0.0, high=150.0,
    )  # fmt: skip
    lead_present: int = since("0.3", flag_input("There is a car ahead", start=False))
    lead_gap_m: float = since(
        "0.3",
        real_input("Gap to it, bumper to bumper", "m", start=0.0, low=-1e4, high=1e6),
    )
    lead_speed_mps: float = since(
        "0.3", real_input("Its speed", "m/s", start=0.0, low=-10.0, high=150.0)
    )


@dataclass
class DriverOutputs:
    """What the driver does."""

    driver_gas_pedal: float = real_output("Gas pedal travel", "", low=0.0, high=1.0)
    driver_brake_pedal: float = real_output("Brake pedal travel", "", low=0.0, high=1.0)
    lever_resume: int = flag_output("Lever: activate or resume")
    lever_cancel: int = flag_output("Lever: cancel")
    lever_up: int = flag_output("Lever: set speed up, short tip")
    lever_down: int = flag_output("Lever: set speed down, short tip")
    lever_up_long: int = flag_output("Lever: set speed up, long tip")
    lever_down_long: int = flag_output("Lever: set speed down, long tip")
    teach_pause: int = since("0.3", flag_output("Nothing is to be learned while true"))
    teach_forget_here: int = since("0.3", flag_output("Forget what was learned here (rising edge)"))
    teach_undo: int = since("0.3", flag_output("Take the newest lesson back (rising edge)"))


@dataclass
class DriverMemory:
    """What the driver remembers from step to step. Times are whole nanoseconds."""

    planner_accel_max_mps2: float = 0.0
    planner_accel_min_mps2: float = 0.0
    planner_jerk_max_mps3: float = 0.0
    time_ns: int = nanoseconds()
    phase: int = whole(AWAY, ON_BRAKE)
    phase_ns: int = nanoseconds()  # since the phase began
    delay_ns: int = nanoseconds()  # what this phase, or this urge, waits for
    urge: int = whole(-1, 1)  # 1 = gas, -1 = brake, 0 = content
    urge_ns: int = nanoseconds()
    attempts: int = whole(0, 999_999_999)  # RESUME presses since the function was last active
    was_active: int = flag()
    releasing: int = flag()
    button: int = whole(0, 8)  # control code of the lever contact held, 0 = none
    button_ns: int = nanoseconds()  # since it was pressed
    settled_ns: int = nanoseconds()  # since the car cruises at the set speed
    stood_behind: int = flag()  # the car stands behind one that stood
    tipping: int = flag()  # a series of tips has begun
    random: float = number(1.0, 2147483646.0, start=1.0)  # MINSTD, a whole number
    invalid_input: int = flag()
    warned: int = flag()


# A dataclass takes the fields of its LAST base first; value references follow from their order
# within a release (``signals.by_reference``).
@dataclass(slots=True)
class DriverState(DriverMemory, DriverOutputs, DriverInputs, DriverParameters, WishParameters):
    """Everything of one driver but wish and script, in one flat record."""
