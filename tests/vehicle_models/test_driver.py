"""The driver who watches: activation, pedals and lever on a straight road."""

from __future__ import annotations

from functools import cache
from math import inf, nan
from pathlib import Path

import pytest
from driver_watch import (
    KMH,
    LEVER,
    PEDALS,
    STEP_S,
    cruising,
    driver,
    first,
    presses,
    straight,
    watch,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from pldf.kernel.codes import ACTIVE, OFF, STANDBY

from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_state import ON_GAS


@pytest.mark.parametrize("kind", [0, 2])
def test_activates_after_one_second_and_again_until_active(tmp_path: Path, kind: int) -> None:
    someone = driver(straight(tmp_path, 100), kind=kind, wish_offset_mps=0.0)
    standing = {"vehicle_speed_mps": 100 * KMH, "target_speed_mps": 100 * KMH}
    seen = watch(someone, 3.5, mode=STANDBY, **standing)
    assert first(seen, "lever_resume") == pytest.approx(1.0)
    assert presses(seen, "lever_resume") == 3
    assert presses(watch(someone, 10.0, mode=ACTIVE), "lever_resume") == 0


def test_hands_off_stays_hands_off() -> None:
    someone = driver(kind=0)
    watch(someone, 2.0, mode=STANDBY)
    watch(someone, 1.0, mode=ACTIVE)
    seen = watch(someone, 20.0, mode=STANDBY, vehicle_speed_mps=1.0)
    assert not any(row[name] for row in seen for name in (*PEDALS, *LEVER))


def test_small_deviations_are_accepted(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 102.5)  # wish 107, threshold 5
    assert not any(row[name] for row in watch(someone, 20.0) for name in (*PEDALS, *LEVER))


def test_too_slow_is_answered_by_gas_after_the_reaction_time(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 102.5, driver_reaction_s=1.5)
    seen = watch(someone, 4.0, vehicle_speed_mps=101.5 * KMH)
    assert first(seen, "driver_gas_pedal") == pytest.approx(1.5, abs=0.03)
    assert not any(row["driver_brake_pedal"] for row in seen)


def test_gas_is_released_beyond_the_wish(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 95.0)
    watch(someone, 3.0)
    assert someone.record.phase == ON_GAS
    assert watch(someone, 1.0, vehicle_speed_mps=109.9 * KMH)[-1]["driver_gas_pedal"] > 0.0
    assert watch(someone, 1.0, vehicle_speed_mps=110.1 * KMH)[-1]["driver_gas_pedal"] == 0.0


def test_too_fast_is_answered_by_brake_and_reactivation(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 102.5, driver_reactivation_s=3.0)
    seen = watch(someone, 2.0, vehicle_speed_mps=113.0 * KMH)
    assert first(seen, "driver_brake_pedal") == pytest.approx(1.0, abs=0.03)
    seen = watch(someone, 1.0, mode=STANDBY, vehicle_speed_mps=103.0 * KMH)
    released = next(k for k, row in enumerate(seen) if row["driver_brake_pedal"] == 0.0) * STEP_S
    seen += watch(someone, 3.5)
    assert first(seen, "lever_resume") == pytest.approx(released + 3.0, abs=0.05)


def test_no_gas_while_the_function_is_under_way_to_the_wish(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 102.5)
    under_way = {"vehicle_acceleration_mps2": 0.5, "target_speed_mps": 105.0 * KMH}
    seen = watch(someone, 5.0, vehicle_speed_mps=90.0 * KMH, **under_way)
    assert presses(seen, "driver_gas_pedal") == 0
    assert presses(watch(someone, 3.0, target_speed_mps=90.0 * KMH), "driver_gas_pedal") == 1


def test_no_pedal_for_a_deviation_that_is_about_to_end(tmp_path: Path) -> None:
    someone = cruising(straight(tmp_path, 100), 102.5)
    seen = watch(someone, 5.0, vehicle_speed_mps=100.0 * KMH, vehicle_acceleration_mps2=1.0)
    assert presses(seen, "driver_gas_pedal") == 0


def test_lever_in_steady_cruise(tmp_path: Path) -> None:
    road = straight(tmp_path, 100, 80)
    someone = driver(road, driver_spread=0.0, wish_offset_mps=11.0 * KMH)
    speed = {"vehicle_speed_mps": 100 * KMH, "target_speed_mps": 100 * KMH}
    watch(someone, 1.1, mode=STANDBY, limit_mps=100 * KMH, set_speed_mps=100 * KMH, **speed)
    seen = watch(someone, 3.5, mode=ACTIVE, vehicle_s_m=300.0)
    assert presses(seen, "lever_up_long") == 1
    # The function takes the tip over; 6 km/h are still missing: one more tip, then 1 is left.
    seen = watch(someone, 0.8, set_speed_mps=105 * KMH)
    assert presses(seen, "lever_up_long") == 1
    seen = watch(someone, 2.0, set_speed_mps=110 * KMH)
    assert presses(seen, "lever_up_long") == 0


def test_no_lever_before_a_new_limit(tmp_path: Path) -> None:
    road = straight(tmp_path, 100, 80)
    someone = driver(road, driver_spread=0.0)
    cruise = {"vehicle_speed_mps": 100 * KMH, "target_speed_mps": 100 * KMH}
    cruise |= {"set_speed_mps": 100 * KMH, "limit_mps": 100 * KMH}
    watch(someone, 1.1, mode=STANDBY, **cruise)
    seen = watch(someone, 6.0, mode=ACTIVE, vehicle_s_m=1000.0 - 7.5 * 100 * KMH)
    assert presses(seen, "lever_up_long") == 0


def test_keeps_going_when_the_function_stays_away(tmp_path: Path) -> None:
    someone = driver(straight(tmp_path, 100))
    seen = watch(someone, 8.0, mode=OFF, vehicle_speed_mps=50 * KMH)
    assert first(seen, "driver_gas_pedal") > 3.0
    assert presses(seen, "driver_brake_pedal") == 0


@pytest.mark.parametrize("bad", [nan, inf])
@pytest.mark.parametrize("name", ["vehicle_s_m", "vehicle_speed_mps", "set_speed_mps"])
def test_unusable_inputs_release_everything(tmp_path: Path, name: str, bad: float) -> None:
    someone = cruising(straight(tmp_path, 100), 90.0)
    watch(someone, 3.0)
    assert someone.record.driver_gas_pedal > 0.0
    good = getattr(someone.record, name)
    seen = watch(someone, 1.0, **{name: bad})
    assert not any(row[output] for row in seen for output in (*PEDALS, *LEVER))
    assert [m.level for m in someone.messages] == ["warning"]
    assert presses(watch(someone, 2.0, **{name: good}), "driver_gas_pedal") == 1


@cache
def initial_state(kind: int) -> bytes:
    return driver(kind=kind).snapshot()


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(), st.floats(-10.0, 150.0), st.floats(-50.0, 50.0), st.integers(0, 4),
            st.floats(0.0, 60.0), st.sampled_from([0.0001, 0.01, 0.1]),
        ),
        max_size=20,
    ),
    st.integers(0, 2),
)  # fmt: skip
def test_outputs_stay_in_range_whatever_happens(
    inputs: list[tuple[float, float, float, int, float, float]], kind: int
) -> None:
    someone = ScriptedDriver()
    someone.restore(initial_state(kind))
    record = someone.record
    for s_m, speed, acceleration, mode, known, step_s in inputs:
        record.vehicle_s_m, record.vehicle_speed_mps = s_m, speed
        record.vehicle_acceleration_mps2, record.mode = acceleration, mode
        record.target_speed_mps = record.set_speed_mps = record.limit_mps = known
        for _ in range(30):
            someone.step(step_s)
            assert all(0.0 <= getattr(record, name) <= 1.0 for name in PEDALS)
            assert all(getattr(record, name) in (0, 1) for name in LEVER)
            both = record.driver_gas_pedal > 0.0 and record.driver_brake_pedal > 0.0
            assert not both or kind == 1  # a script may press both
