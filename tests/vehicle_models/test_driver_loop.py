"""Driver, function and vehicle in a closed loop; the compiled driver."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from driver_watch import KMH, LEVER, PEDALS, STEP_S, cruising, driver, straight, watch
from numpy.typing import NDArray
from pldf.compiled import compile_modules, pack, unpack
from pldf.function import DrivingFunction
from pldf.instance import zeros
from pldf.kernel import interpolation, planner, substeps
from pldf.kernel.arrays import RouteArrays, Work
from pldf.kernel.codes import ACTIVE, FAULT, GAS_OVERRIDE, LEARN_FAITHFUL, STANDBY

from vehicle_models.driver import KERNELS, ScriptedDriver
from vehicle_models.script_kernel import ScriptArrays
from vehicle_models.vehicle import LongitudinalVehicle
from vehicle_models.wish_kernel import WishArrays

MODULES = (*KERNELS, interpolation, substeps, planner)
# How many of the driver's arrays are the wish; the script is behind it.
WISH = len(WishArrays._fields)
SEEN = ("mode", "target_speed_mps", "set_speed_mps", "limit_mps")
# The wish of a driver who wants exactly what the driving function does by default.
LIKE_THE_FUNCTION: dict[str, float] = {
    "wish_offset_mps": 0.0,
    "wish_lateral_accel_max_mps2": 2.5,
    "wish_accel_max_mps2": 1.2,
    "wish_accel_min_mps2": -1.0,
    "wish_anticipation_s": 0.0,
}


class Drive(NamedTuple):
    """What is left of one drive over the study road."""

    function: DrivingFunction
    driver: ScriptedDriver
    vehicle: LongitudinalVehicle
    speed_mps: NDArray[np.float64]
    outputs: NDArray[np.float64]

    @property
    def interventions(self) -> int:
        """Number of pedal interventions."""
        return self.function.record.drive_interventions


def exchange(function: Any, vehicle: Any, someone: Any) -> None:
    vehicle.acceleration_request_mps2 = function.acceleration_request_mps2
    vehicle.function_active = function.function_active
    for name in SEEN:
        setattr(someone, name, getattr(function, name))
    for name in (*PEDALS, *LEVER):
        setattr(function, name, getattr(someone, name))
    for name in PEDALS:
        setattr(vehicle, name, getattr(someone, name))
    for name in ("s_m", "speed_mps", "acceleration_mps2"):
        setattr(function, f"vehicle_{name}", getattr(vehicle, name))
        setattr(someone, f"vehicle_{name}", getattr(vehicle, name))


def drive(store: Path | None = None, step_s: float = STEP_S, **values: float) -> Drive:
    """Drive the study road; with a store, follow what is learned and learn."""
    function, vehicle = DrivingFunction(), LongitudinalVehicle()
    if store is not None:
        function.texts.profile_store = str(store)
        function.record.learn = LEARN_FAITHFUL
    function.initialize()
    vehicle.initialize()
    someone = driver(**values)
    end_m = len(function.profile.base_mps) - 2.0
    rows: list[tuple[float, ...]] = []
    while vehicle.record.s_m < end_m:
        exchange(function.record, vehicle.record, someone.record)
        for model in (vehicle, function, someone):
            model.step(step_s)
        pedals = (someone.record.driver_gas_pedal, someone.record.driver_brake_pedal)
        rows.append((vehicle.record.speed_mps, *pedals))
        assert len(rows) * step_s < 600.0
    function.finish()
    table = np.array(rows)
    return Drive(function, someone, vehicle, table[:, 0], table[:, 1:])


@cache
def default_drive() -> Drive:
    return drive()


@pytest.mark.parametrize("threshold_kmh", [3.0, 5.0])
def test_a_content_driver_does_nothing(threshold_kmh: float) -> None:
    content = drive(driver_threshold_mps=threshold_kmh * KMH, **LIKE_THE_FUNCTION)
    assert content.interventions == 0
    assert content.function.record.rate_combined == 0.0
    assert np.all(content.outputs == 0.0)


def test_the_default_driver_intervenes_like_a_person() -> None:
    record = default_drive().function.record
    assert 0.15 < record.rate_pedal < 0.35
    assert 0.3 < record.rate_set_speed < 0.7
    gas = np.concatenate(([0], default_drive().outputs[:, 0] > 0.0, [0])).astype(int)
    lengths_s = STEP_S * (np.flatnonzero(np.diff(gas) < 0) - np.flatnonzero(np.diff(gas) > 0))
    assert len(lengths_s) >= 5
    assert 1.0 <= np.median(lengths_s) <= 10.0
    assert lengths_s.max() < 20.0
    pauses_s = STEP_S * (
        np.flatnonzero(np.diff(gas) > 0)[1:] - np.flatnonzero(np.diff(gas) < 0)[:-1]
    )
    assert pauses_s.min() > 0.5  # no pedal bounce


def test_a_slower_driver_brakes_and_reactivates() -> None:
    slow = drive(wish_offset_mps=-8.0 * KMH, wish_lateral_accel_max_mps2=1.7)
    assert slow.outputs[:, 1].max() > 0.05
    assert slow.interventions >= 5
    assert slow.function.record.mode in (ACTIVE, STANDBY, GAS_OVERRIDE)
    assert slow.speed_mps.min() > 5.0


def test_learning_leaves_less_to_do(tmp_path: Path) -> None:
    rates = [drive(tmp_path, seed=k).function.record.rate_combined for k in range(3)]
    assert rates[0] > 0.4
    assert rates[1] < 0.5 * rates[0]
    assert rates[2] < 0.4 * rates[0]


def test_same_seed_same_drive_to_the_bit() -> None:
    again = drive()
    assert again.driver.snapshot() == default_drive().driver.snapshot()
    assert again.vehicle.snapshot() == default_drive().vehicle.snapshot()
    other = drive(seed=2)
    assert other.vehicle.snapshot() != again.vehicle.snapshot()


def test_the_step_hardly_matters() -> None:
    reference = default_drive()
    for step_s in (0.001, 0.02, 0.1):
        other = drive(step_s=step_s)
        assert other.interventions == pytest.approx(reference.interventions, abs=1)
        for rate in ("rate_pedal", "rate_set_speed"):
            expected = getattr(reference.function.record, rate)
            assert getattr(other.function.record, rate) == pytest.approx(expected, abs=0.02)


def test_state_is_saved_and_restored_to_the_bit(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 90.0)
    watch(someone, 1.5)
    state = someone.snapshot()
    once = watch(someone, 3.0)
    twin = ScriptedDriver()
    twin.restore(state)
    assert watch(twin, 3.0) == once
    assert twin.snapshot() == someone.snapshot()


VARIED = {
    "wish_offset_person_sd_mps": 1.0,
    "wish_offset_place_sd_mps": 0.8,
    "wish_offset_occasion_sd_mps": 0.6,
    "wish_lateral_person_sigma": 0.2,
    "wish_lateral_place_sigma": 0.1,
    "wish_lateral_occasion_sigma": 0.1,
}


@pytest.mark.parametrize("variation", [{}, VARIED], ids=["constant", "varied"])
def test_compiled_kernel_equals_cpython_to_the_bit(variation: dict[str, float]) -> None:
    compiled = compile_modules(MODULES)
    plain = default_drive().driver
    fresh = driver(driver_spread=0.3, person_seed=7, **variation)
    wish = WishArrays(*(np.zeros_like(a) for a in fresh.arrays[:WISH]))
    function = default_drive().function
    work = zeros(Work, len(wish.wish_mps))
    routes = RouteArrays(*(np.array(a) for a in function.route))
    packed = pack(fresh.record)
    compiled["prepare_wish"](packed[0], routes, wish, work)
    for ours, theirs in zip(fresh.arrays[:WISH], wish, strict=True):
        assert np.array_equal(ours, np.asarray(theirs))
    packed = pack(fresh.record)
    blank = ScriptArrays(*(np.array(a) for a in plain.arrays[WISH:]))
    rng, twin = np.random.default_rng(3), replace(fresh.record)
    for k in range(2000):
        if k % 40 == 0:
            inputs = {
                "vehicle_s_m": float(k * 2.2),
                "vehicle_speed_mps": float(rng.uniform(10.0, 32.0)),
                "vehicle_acceleration_mps2": float(rng.uniform(-0.5, 0.5)),
                "mode": int(rng.choice([STANDBY, ACTIVE, ACTIVE, ACTIVE, GAS_OVERRIDE, FAULT])),
                "target_speed_mps": float(rng.uniform(10.0, 32.0)),
            }
        for name, value in inputs.items():
            setattr(fresh.record, name, value)
            packed[0][name] = value
        fresh.step(0.02)
        compiled["driver_step"](packed[0], wish, blank, 0.02)
        unpack(packed, twin)
        assert twin == fresh.record


def test_compiled_script_equals_cpython_to_the_bit() -> None:
    compiled = compile_modules(MODULES)
    someone = driver(kind=1)
    packed, twin = pack(someone.record), replace(someone.record)
    wish = WishArrays(*(np.array(a) for a in someone.arrays[:WISH]))
    events = ScriptArrays(*(np.array(a) for a in someone.arrays[WISH:]))
    for k in range(4000):
        someone.record.vehicle_s_m = packed[0]["vehicle_s_m"] = float(k)
        someone.step(0.03)
        compiled["driver_step"](packed[0], wish, events, 0.03)
        unpack(packed, twin)
        assert twin == someone.record
