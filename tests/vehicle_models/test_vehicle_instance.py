"""The vehicle as an instance: its route, its state, its compiled twin."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from car import car, run
from pldf.compiled import compile_modules, pack, unpack
from pldf.errors import ModelError
from pldf.kernel import interpolation, substeps
from pldf.kernel.interpolation import value_at

from vehicle_models import vehicle_kernel
from vehicle_models.vehicle import LongitudinalVehicle
from vehicle_models.vehicle_kernel import vehicle_step


def route_file(folder: Path) -> Path:
    path = folder / "hill.csv"
    path.write_text(
        "s_m,curvature_per_m,speed_limit_mps,grade\n0,0,25,0\n100,0,25,0\n200,0,25,0.1\n900,0,25,0.1\n"
    )
    return path


def test_grade_comes_from_the_route(tmp_path: Path) -> None:
    vehicle = LongitudinalVehicle()
    vehicle.texts.route_file = str(route_file(tmp_path))
    vehicle.record.start_s_m = 150.0
    vehicle.initialize()
    assert value_at(vehicle.arrays[0], 150.0) == pytest.approx(0.05)
    run(vehicle, 10.0)
    uphill = vehicle.record.speed_mps
    flat = car()
    run(flat, 10.0)
    assert uphill < flat.record.speed_mps - 5.0


def test_a_missing_route_is_an_error() -> None:
    vehicle = LongitudinalVehicle()
    vehicle.texts.route_file = "no_such_route.csv"
    with pytest.raises(ModelError, match=r"no_such_route\.csv"):
        vehicle.initialize()


def test_state_is_saved_and_restored_to_the_bit() -> None:
    vehicle = car(driver_gas_pedal=0.3)
    run(vehicle, 2.0)
    state = vehicle.snapshot()
    run(vehicle, 2.0)
    once = vehicle.snapshot()
    vehicle.restore(state)
    run(vehicle, 2.0)
    assert vehicle.snapshot() == once


def test_compiled_kernel_equals_cpython_to_the_bit() -> None:
    compiled = compile_modules([interpolation, substeps, vehicle_kernel])
    grade = np.linspace(-0.05, 0.05, 400)
    vehicle = car(body_coast_decel_mps2=0.8)
    vehicle.record.grade_from_route = 1
    packed = pack(vehicle.record)
    reference = replace(vehicle.record)
    views = memoryview(grade)
    rng = np.random.default_rng(1)
    for k in range(600):
        if k % 20 == 0:
            values = (*rng.uniform(-3.0, 2.0, 1), *np.maximum(rng.uniform(-1.0, 0.8, 2), 0.0))
            active = int(rng.integers(2))
        for target in (reference, packed[0]):
            for name, value in zip(
                ("acceleration_request_mps2", "driver_gas_pedal", "driver_brake_pedal"),
                map(float, values),
                strict=True,
            ):
                _put(target, name, value)
            _put(target, "function_active", active)
        vehicle_step(reference, views, 0.02)
        compiled["vehicle_step"](packed[0], grade, 0.02)
        unpack(packed, vehicle.record)
        assert vehicle.record == reference


def _put(target: object, name: str, value: float) -> None:
    if isinstance(target, np.void):
        target[name] = value
    else:
        setattr(target, name, value)
