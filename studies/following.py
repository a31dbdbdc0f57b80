"""How the shipped car follows: tests after ISO 15622, and a wave in a string of cars.

    python studies/following.py

Prints the tables of docs/algorithm.md, section 8. The cars are the driving function with the
shipped vehicle, on a straight level road; the lead does what its acceleration says.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from pldf.function import DrivingFunction
from pldf.kernel.arrays import FloatArray
from pldf.kernel.units import KMH_PER_MPS
from pldf.profiles.store import StoredProfile
from pldf.roads import Route, fingerprint

from vehicle_models.vehicle import LongitudinalVehicle

STEP_S: Final = 0.02
LENGTH_M: Final = 6000.0
LIMIT_MPS: Final = 130.0 / KMH_PER_MPS
Acceleration = Callable[[float], float]


class Lead:
    """A car that does what it is told, never backwards."""

    def __init__(self, s_m: float, speed_mps: float) -> None:
        self.s_m, self.speed_mps = s_m, speed_mps

    def step(self, acceleration_mps2: float) -> None:
        """Move on by one step."""
        before = self.speed_mps
        self.speed_mps = max(before + acceleration_mps2 * STEP_S, 0.0)
        self.s_m += 0.5 * (before + self.speed_mps) * STEP_S


class Car:
    """The driving function in its vehicle, active from the start."""

    def __init__(self, s_m: float, speed_mps: float) -> None:
        self._function, self._vehicle = DrivingFunction(), LongitudinalVehicle()
        places = np.array([0.0, LENGTH_M])
        none = np.zeros(2)
        route = Route("straight", places, none, none + LIMIT_MPS, none, places, none)
        self._function.prepare(route)
        base = np.array(self._function.profile.base_mps)
        self._function.follow(StoredProfile(0, fingerprint(route), base))
        start = self._vehicle.record
        start.grade_from_route, start.start_s_m, start.start_speed_mps = 0, s_m, speed_mps
        self._vehicle.initialize()
        self.outputs = self._function.record
        self.outputs.lever_resume = 1

    @property
    def s_m(self) -> float:
        """Position in m."""
        return self._vehicle.record.s_m

    @property
    def speed_mps(self) -> float:
        """Speed in m/s."""
        return self._vehicle.record.speed_mps

    def step(self, gap_m: float, lead_mps: float) -> None:
        """Move on by one step, as both FMUs do in a master that lets them step at once."""
        st, vehicle = self.outputs, self._vehicle.record
        st.vehicle_s_m, st.vehicle_speed_mps = vehicle.s_m, vehicle.speed_mps
        st.vehicle_acceleration_mps2 = vehicle.acceleration_mps2
        st.lead_present, st.lead_gap_m, st.lead_speed_mps = 1, gap_m, lead_mps
        vehicle.acceleration_request_mps2 = st.acceleration_request_mps2
        vehicle.function_active = st.function_active
        self._function.step(STEP_S)
        self._vehicle.step(STEP_S)


class Seen(NamedTuple):
    """Of one encounter: gaps, strongest request, when the driver was called and when it hit."""

    nearest_m: float
    request_mps2: float
    final_m: float
    called_s: float
    contact_s: float


def encounter(
    speed_mps: float, gap_m: float, lead_mps: float, acceleration: Acceleration, seconds: float
) -> Seen:
    """Let the car meet a lead; times in s are -1 where nothing of the kind happened."""
    car, lead = Car(0.0, speed_mps), Lead(gap_m, lead_mps)
    nearest, request, called_s, contact_s = gap_m, 0.0, -1.0, -1.0
    for k in range(round(seconds / STEP_S)):
        gap = lead.s_m - car.s_m
        nearest = min(nearest, gap)
        if gap < 0.0 and contact_s < 0.0:
            contact_s = k * STEP_S
        car.step(gap, lead.speed_mps)
        lead.step(acceleration(k * STEP_S))
        request = min(request, car.outputs.acceleration_request_mps2)
        if car.outputs.hmi_take_over and called_s < 0.0:
            called_s = k * STEP_S
    return Seen(nearest, request, lead.s_m - car.s_m, called_s, contact_s)


def desired_gap_m(speed_mps: float) -> float:
    """Gap that the car is to keep."""
    return 3.0 + 1.8 * speed_mps


def braking(decel_mps2: float) -> Acceleration:
    """A lead that brakes from the second second on."""
    return lambda t: -decel_mps2 if t >= 1.0 else 0.0


def steady(_: float) -> float:
    """A lead that keeps its speed."""
    return 0.0


def print_encounters() -> None:
    """Print one row per encounter."""
    v = 100.0 / KMH_PER_MPS
    cases: dict[str, tuple[float, float, float, Acceleration]] = {
        "lead at 60 km/h, 250 m ahead": (v, 250.0, 60.0 / KMH_PER_MPS, steady),
        "standing lead, 150 m ahead": (v, 150.0, 0.0, steady),
        "standing lead, 250 m ahead": (v, 250.0, 0.0, steady),
        "cut-in at our speed, 1.0 s ahead": (v, v, v, steady),
        "cut-in 10 km/h slower, 1.0 s ahead": (v, v, v - 10.0 / KMH_PER_MPS, steady),
        "cut-in 40 km/h slower, 0.7 s ahead": (v, 0.7 * v, v - 40.0 / KMH_PER_MPS, steady),
    }
    for decel in (2.0, 3.5, 6.0):
        for kmh in (50.0, 100.0):
            start = kmh / KMH_PER_MPS
            name = f"lead brakes with {decel:g} m/s² from {kmh:g} km/h"
            cases[name] = (start, desired_gap_m(start), start, braking(decel))
    print("| encounter | strongest request, m/s² | smallest gap, m | last gap, m | take over |")
    print("|---|---|---|---|---|")
    for name, (speed, gap, lead, acceleration) in cases.items():
        seen = encounter(speed, gap, lead, acceleration, 60.0)
        called = "never" if seen.called_s < 0.0 else f"at {seen.called_s:.1f} s"
        if seen.contact_s >= 0.0:
            called += f", contact at {seen.contact_s:.1f} s"
        print(
            f"| {name} | {seen.request_mps2:.2f} | {seen.nearest_m:.1f} | {seen.final_m:.1f} "
            f"| {called} |"
        )


def string_of_cars(frequency_hz: float, swing_mps: float, cars: int = 10) -> FloatArray:
    """Return the largest deviation from 80 km/h of a lead that swings and the cars behind it."""
    mean = 80.0 / KMH_PER_MPS
    gap = desired_gap_m(mean)
    lead, tail = Lead(1000.0, mean), [Car(1000.0 - (k + 1) * gap, mean) for k in range(cars)]
    peaks = np.zeros(cars + 1)
    for k in range(round((3.0 / frequency_hz + 30.0) / STEP_S)):
        ahead: list[Lead | Car] = [lead, *tail[:-1]]
        speeds = np.array([lead.speed_mps, *(car.speed_mps for car in tail)])
        peaks = np.maximum(peaks, np.abs(speeds - mean))
        seen = [(a.s_m - car.s_m, a.speed_mps) for a, car in zip(ahead, tail, strict=True)]
        for car, (gap_m, lead_mps) in zip(tail, seen, strict=True):
            car.step(gap_m, lead_mps)
        after = mean + swing_mps * np.sin(2.0 * np.pi * frequency_hz * (k + 1) * STEP_S)
        lead.step((after - lead.speed_mps) / STEP_S)
    return peaks


def print_strings() -> None:
    """Print one row per wave: the peaks of some of the cars, and the largest growth of all."""
    print("| wave | lead | car 1 | car 2 | car 5 | car 10 | largest from car to car |")
    print("|---|---|---|---|---|---|---|")
    for frequency in (0.02, 0.05, 0.1, 0.2, 0.5):
        for swing in (1.0, min(5.0, 2.5 / (2.0 * np.pi * frequency))):
            peaks = string_of_cars(frequency, swing)
            growth = max(behind / ahead for ahead, behind in pairwise(peaks) if ahead > 0.05)
            told = " | ".join(f"{peaks[k]:.2f}" for k in (0, 1, 2, 5, 10))
            print(f"| {frequency:g} Hz | {told} | {growth:.3f} |")


if __name__ == "__main__":
    print_encounters()
    print()
    print_strings()
