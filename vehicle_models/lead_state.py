"""Signals and state of the car ahead. ``docs/traffic.md`` explains the numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from pldf.kernel.ranges import code, flag, holds, nanoseconds, number, whole
from pldf.kernel.signals import (
    Enumeration,
    count_output,
    count_parameter,
    flag_output,
    real_input,
    real_output,
    real_parameter,
    text_parameter,
)

# Where the scene comes from (``kind``).
ONE_CAR: Final = 0
BY_SCRIPT: Final = 1
TRAFFIC: Final = 2

# What a car that drives by itself is doing (``phase``).
NOBODY: Final = 0
DRIVING: Final = 1
STOPPING: Final = 2
STANDING: Final = 3

# What the user is told of (``trouble``).
TROUBLE: Final = Enumeration("Trouble", ("NONE", "INVALID_INPUT", "CONTACT"))
NO_TROUBLE: Final = 0
INVALID_INPUT: Final = 1
CONTACT: Final = 2

CARS_MAX: Final = 999_999_999


@dataclass(slots=True)
class LeadTexts:
    """String parameters."""

    script_file: str = text_parameter(
        "Traffic script to follow, instead of the packed one of script_id", name="script_file"
    )
    route_file: str = text_parameter("Route, instead of the packed one of route_id")


@dataclass
class SceneParameters:
    """Where the scene comes from, and the one car of kind 0."""

    kind: int = count_parameter(
        "0 = one car, by scene.*; 1 = script; 2 = traffic that drives the road by itself",
        start=TRAFFIC, low=0, high=2,
    )  # fmt: skip
    script_id: int = count_parameter(
        "Index of the packed traffic script (kind 1)", start=0, low=0, high=999, name="script_id"
    )
    route_id: int = count_parameter(
        "Index of the packed route, 0 = the shipped study road", start=0, low=0, high=999
    )
    seed: int = count_parameter("Seed of the traffic (kind 2)", start=1, low=0, high=999_999_999)
    scene_appear_s: float = real_parameter(
        "Time at which the car appears", "s", start=0.0, low=0.0, high=1e6
    )
    scene_gap_m: float = real_parameter(
        "Gap at which it appears", "m", start=60.0, low=0.0, high=1e4
    )
    scene_speed_mps: float = real_parameter(
        "Speed at which it appears", "m/s", start=15.0, low=0.0, high=80.0
    )
    scene_change_s: float = real_parameter(
        "Time at which it begins to change its speed, 0 = never", "s", start=0.0, low=0.0, high=1e6
    )
    scene_next_speed_mps: float = real_parameter(
        "Speed to which it changes", "m/s", start=0.0, low=0.0, high=80.0
    )
    scene_change_mps2: float = real_parameter(
        "How hard it brakes or accelerates for that", "m/s2", start=2.0, low=0.1, high=12.0
    )
    scene_leave_s: float = real_parameter(
        "Time at which it leaves the lane, 0 = never", "s", start=0.0, low=0.0, high=1e6
    )


@dataclass
class TrafficParameters:
    """How the cars of kind 2 drive; the last two hold for all kinds."""

    traffic_free_s: float = real_parameter(
        "Time without a car ahead, on average", "s", start=20.0, low=0.0, high=1e5
    )
    traffic_stay_s: float = real_parameter(
        "Time for which a car stays ahead, on average", "s", start=30.0, low=1.0, high=1e5
    )
    traffic_cut_in_share: float = real_parameter(
        "Share of the cars that cut in; one catches up with the others",
        "", start=0.5, low=0.0, high=1.0,
    )  # fmt: skip
    traffic_stop_share: float = real_parameter(
        "Share of the cars that stop once", "", start=0.3, low=0.0, high=1.0
    )
    traffic_pace_low: float = real_parameter(
        "Slowest car's speed over that which limits and curves allow",
        "", start=0.7, low=0.1, high=1.5,
    )  # fmt: skip
    traffic_pace_high: float = real_parameter(
        "Fastest car's speed over that which limits and curves allow",
        "", start=1.0, low=0.1, high=1.5,
    )  # fmt: skip
    traffic_lateral_accel_max_mps2: float = real_parameter(
        "Lateral acceleration at which the cars take curves",
        "m/s2", start=2.5, low=0.1, high=10.0,
    )  # fmt: skip
    traffic_reach_m: float = real_parameter(
        "Gap up to which the sensor sees a car", "m", start=200.0, low=1.0, high=1e4
    )
    traffic_jerk_max_mps3: float = real_parameter(
        "How quickly a car changes its acceleration", "m/s3", start=10.0, low=0.5, high=100.0
    )


@dataclass
class LeadInputs:
    """The car behind: ours."""

    vehicle_s_m: float = real_input(
        "Arc length along the route", "m", start=0.0, low=-1e7, high=1e7
    )
    vehicle_speed_mps: float = real_input("Ego speed", "m/s", start=0.0, low=-10.0, high=150.0)


@dataclass
class LeadOutputs:
    """What a sensor of our car tells of the car ahead; all 0 where it sees none."""

    lead_present: int = flag_output("The sensor sees a car ahead")
    lead_gap_m: float = real_output("Gap to it, bumper to bumper; negative after a contact", "m")
    lead_speed_mps: float = real_output("Its speed", "m/s", low=0.0)
    lead_acceleration_mps2: float = real_output("Its acceleration", "m/s2")
    lead_cars: int = holds(whole(0, CARS_MAX), count_output("How many cars have been ahead so far"))


@dataclass
class LeadMemory:
    """What is kept from step to step. Times are whole nanoseconds."""

    planner_accel_max_mps2: float = 0.0
    planner_accel_min_mps2: float = 0.0
    planner_jerk_max_mps3: float = 0.0
    time_ns: int = nanoseconds()
    scene_done: int = whole(0, 3)  # how many of appear, change and leave have happened
    there: int = flag()  # a car is ahead, seen or not
    unseen: int = flag()  # the sensor has lost it
    rear_m: float = 0.0  # position of its rear bumper along the route
    speed_mps: float = 0.0
    acceleration_mps2: float = 0.0
    wanted_mps: float = 0.0  # the speed that it goes for
    strength_mps2: float = 0.0  # how hard
    phase: int = whole(NOBODY, STANDING)
    until_ns: int = nanoseconds()  # when the next car comes, or this one leaves
    stop_ns: int = nanoseconds()  # when this one stops, or drives on; 0 = never
    pace: float = 0.0  # its speed over that which the road allows
    random: float = number(1.0, 2147483646.0, start=1.0)  # MINSTD, a whole number
    ego_m: float = 0.0  # our car in this internal step
    ego_mps: float = 0.0
    trouble: int = code(TROUBLE)


# A dataclass takes the fields of its LAST base first; value references follow from their order
# within a release (``signals.by_reference``).
@dataclass(slots=True)
class LeadState(LeadMemory, LeadOutputs, LeadInputs, TrafficParameters, SceneParameters):
    """Everything of the traffic ahead but its road and script, in one flat record."""
