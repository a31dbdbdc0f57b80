"""What the driver makes of a car ahead: no gas behind it, brakes for it, waves the function on."""

from __future__ import annotations

import pytest
from pldf.kernel.codes import ACTIVE, STANDBY

from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_state import HANDS_OFF, PREFERENCE

CLEARLY_TOO_SLOW_MPS = 12.0


def driver(kind: int = PREFERENCE, **inputs: float) -> ScriptedDriver:
    """Return a driver on the study's first straight whose function is active since 2 s."""
    model = ScriptedDriver()
    model.record.kind = kind
    model.record.driver_uses_lever = 0
    model.initialize()
    seen = {
        "vehicle_s_m": 100.0, "vehicle_speed_mps": 20.0, "target_speed_mps": 20.0,
        "set_speed_mps": 22.0, "limit_mps": 22.0, "mode": ACTIVE,
    }  # fmt: skip
    for name, value in {**seen, **inputs}.items():
        setattr(model.record, name, value)
    for _ in range(200):
        model.step(0.01)
    return model


def presses(model: ScriptedDriver, seconds: float) -> tuple[float, float, int]:
    """Return the strongest gas and brake and how often RESUME is pressed."""
    gas = brake = 0.0
    resumes, before = 0, 0
    for _ in range(round(seconds / 0.01)):
        model.step(0.01)
        record = model.record
        gas = max(gas, record.driver_gas_pedal)
        brake = max(brake, record.driver_brake_pedal)
        resumes += record.lever_resume > before
        before = record.lever_resume
    return gas, brake, resumes


@pytest.mark.parametrize(("gap_m", "lead_mps", "helps"), [(20.0, 12.0, False), (150.0, 25.0, True)])
def test_nobody_presses_the_gas_right_behind_a_car(
    gap_m: float, lead_mps: float, helps: bool
) -> None:
    slow = {"vehicle_speed_mps": CLEARLY_TOO_SLOW_MPS, "target_speed_mps": CLEARLY_TOO_SLOW_MPS}
    model = driver(**slow, lead_present=1, lead_gap_m=gap_m, lead_speed_mps=lead_mps)
    gas, brake, _ = presses(model, 4.0)
    assert (gas > 0.1) == helps
    assert brake == 0.0


def test_the_foot_leaves_the_gas_when_a_car_cuts_in() -> None:
    slow = {"vehicle_speed_mps": CLEARLY_TOO_SLOW_MPS, "target_speed_mps": CLEARLY_TOO_SLOW_MPS}
    model = driver(**slow)
    assert presses(model, 3.0)[0] > 0.1
    model.record.lead_present, model.record.lead_gap_m = 1, 10.0
    model.record.lead_speed_mps = CLEARLY_TOO_SLOW_MPS
    for _ in range(50):
        model.step(0.01)
    assert model.record.driver_gas_pedal == 0.0


def test_the_driver_brakes_where_the_function_could_not_brake_enough() -> None:
    """20 m/s towards a standing car: 200 / (gap - 2 m) is the deceleration that it takes."""
    for gap_m, brakes in ((70.0, False), (40.0, True)):
        model = driver(lead_present=1, lead_gap_m=gap_m, lead_speed_mps=0.0)
        assert (presses(model, 2.0)[1] > 0.2) == brakes, gap_m


def test_without_the_function_the_driver_brakes_for_a_car_much_earlier() -> None:
    model = driver(lead_present=1, lead_gap_m=70.0, lead_speed_mps=0.0)
    model.record.mode = STANDBY
    assert presses(model, 3.0)[1] > 0.1


@pytest.mark.parametrize("kind", [HANDS_OFF, PREFERENCE])
def test_after_a_stop_behind_a_car_the_function_is_told_to_go_on(kind: int) -> None:
    standing = {"vehicle_speed_mps": 0.0, "target_speed_mps": 0.0, "lead_present": 1}
    model = driver(kind, **standing, lead_gap_m=3.0, lead_speed_mps=0.0)
    assert presses(model, 5.0) == (0.0, 0.0, 0)
    model.record.lead_speed_mps = 1.0
    gas, brake, resumes = presses(model, 2.5)
    assert (gas, brake) == (0.0, 0.0)
    assert resumes in (2, 3)


@pytest.mark.parametrize("nonsense", [float("nan"), float("inf"), -float("inf")])
def test_a_car_ahead_of_which_nothing_is_known_changes_nothing(nonsense: float) -> None:
    slow = {"vehicle_speed_mps": CLEARLY_TOO_SLOW_MPS, "target_speed_mps": CLEARLY_TOO_SLOW_MPS}
    alone = driver(**slow)
    odd = driver(**slow, lead_present=1, lead_gap_m=nonsense, lead_speed_mps=nonsense)
    for _ in range(400):
        alone.step(0.01)
        odd.step(0.01)
        assert odd.record.driver_gas_pedal == alone.record.driver_gas_pedal
