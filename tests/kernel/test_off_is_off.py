"""What is not wired changes no bit: no car ahead, no temporary limit, no button."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from laboratory import KMH, PointMass, function, road
from pldf.function import DrivingFunction
from pldf.kernel.signals import signals_of

STEP_S = 0.05
ROAD = road(
    1500.0,
    [(0.0, 80.0 * KMH), (700.0, 50.0 * KMH)],
    [(300.0, 380.0, 0.01), (1000.0, 1060.0, 0.008)],
)
NOBODY = {"lead_present": 0, "lead_gap_m": float("nan"), "lead_speed_mps": float("nan")}


def outputs(made: DrivingFunction) -> list[float]:
    signals = [s for s in signals_of(made.record) if s.causality == "output"]
    return [float(getattr(made.record, s.field)) for s in signals]


def driven(seed: int, **settings: Any) -> tuple[list[list[float]], DrivingFunction]:
    """Drive with pedals and lever of chance; return all outputs of all steps."""
    rng = np.random.default_rng(seed)
    inputs = {k: v for k, v in settings.items() if k in NOBODY}
    settings = {k: v for k, v in settings.items() if k not in NOBODY}
    car = PointMass(function(ROAD, **settings), 12.0, 0.2)
    rows: list[list[float]] = []
    gas = brake = 0.0
    while car.s_m < 1490.0 and len(rows) < 3000:
        chance = rng.random(4)
        gas = 0.3 if chance[0] < 0.01 else gas * (chance[1] > 0.03)
        brake = 0.2 if chance[2] < 0.003 else brake * (chance[1] > 0.1)
        car.step(
            STEP_S,
            driver_gas_pedal=gas,
            driver_brake_pedal=brake,
            lever_resume=int(len(rows) % 40 < 3),
            lever_up_long=int(chance[3] < 0.005),
            **inputs,
        )
        rows.append(outputs(car.made))
    return rows, car.made


@pytest.mark.parametrize("seed", range(2))
def test_without_a_car_ahead_its_numbers_mean_nothing(seed: int) -> None:
    alone, made = driven(seed, learn=1)
    nobody, other = driven(seed, learn=1, **NOBODY)
    assert alone == nobody
    np.testing.assert_array_equal(made.learn().learned_mps, other.learn().learned_mps)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("settings", [{"following_desired_time_gap_s": 3.0}, {"hmi_language": 1}])
def test_settings_of_what_is_off_mean_nothing(seed: int, settings: dict[str, Any]) -> None:
    alone, _ = driven(seed)
    other, _ = driven(seed, **settings)
    assert alone == other


@pytest.mark.parametrize("seed", range(3))
def test_a_car_ahead_only_ever_lowers_the_request(seed: int) -> None:
    """Beside it drives a twin that sees no car ahead; each step both begin with one request."""
    rng = np.random.default_rng(seed)
    made, twin = function(ROAD), function(ROAD)
    car = PointMass(made, 15.0, 0.2)
    gap, lead, lower = 40.0, 15.0, 0
    for k in range(3000):
        seen = {
            "vehicle_s_m": car.s_m,
            "vehicle_speed_mps": car.speed_mps,
            "vehicle_acceleration_mps2": car.acceleration_mps2,
            "lever_resume": int(k % 40 < 3),
        }
        for name, value in seen.items():
            setattr(twin.record, name, value)
        twin.record.acceleration_request_mps2 = made.record.acceleration_request_mps2
        twin.step(STEP_S)
        lead = max(lead + STEP_S * rng.choice([-3.5, -1.0, 0.0, 1.5, 2.0]), 0.0)
        if rng.random() < 0.005:
            gap, lead = rng.uniform(5.0, 60.0), rng.uniform(0.0, 20.0)
        ahead = {"lead_present": 1, "lead_gap_m": gap, "lead_speed_mps": lead}
        if rng.random() < 0.1:
            ahead = NOBODY
        car.step(STEP_S, lever_resume=seen["lever_resume"], **ahead)
        gap = max(gap + STEP_S * (lead - car.speed_mps), 0.5)
        request, alone = (
            made.record.acceleration_request_mps2,
            twin.record.acceleration_request_mps2,
        )
        assert request <= alone + 1e-12
        lower += request < alone
    assert lower > 100
