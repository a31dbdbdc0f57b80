"""The longitudinal vehicle with some parameters, driven for a while."""

from __future__ import annotations

from vehicle_models.vehicle import LongitudinalVehicle

STEP_S = 0.01


def car(**values: float) -> LongitudinalVehicle:
    """An initialized vehicle on a constant grade (level unless stated)."""
    vehicle = LongitudinalVehicle()
    for name, value in {"grade_from_route": 0, **values}.items():
        assert hasattr(vehicle.record, name)
        setattr(vehicle.record, name, value)
    vehicle.initialize()
    return vehicle


def run(vehicle: LongitudinalVehicle, seconds: float, step_s: float = STEP_S) -> None:
    for _ in range(round(seconds / step_s)):
        vehicle.step(step_s)


def inertia_kg(vehicle: LongitudinalVehicle) -> float:
    return vehicle.record.body_mass_kg * vehicle.record.body_rotating_factor
