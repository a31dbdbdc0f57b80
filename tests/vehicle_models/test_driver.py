"""The driver: scripts, the hidden wish and what is done about it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import inf, nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pldf.compiled import compile_modules, pack, unpack
from pldf.function import DrivingFunction
from pldf.instance import ModelError, zeros
from pldf.kernel import interpolation, planner, substeps
from pldf.kernel.arrays import RouteArrays, Work
from pldf.kernel.codes import ACTIVE, FAULT, GAS_OVERRIDE, LEARN_FAITHFUL, OFF, STANDBY

from vehicle_models import driver_kernel, pedal_kernel, script_kernel, wish_kernel
from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_script import CONTROLS, PACKED, packed_script, read_script
from vehicle_models.driver_state import ON_GAS, DriverState
from vehicle_models.vehicle import LongitudinalVehicle
from vehicle_models.wish_kernel import WishArrays, prepare_wish

STEP_S = 0.01
MODULES = (
    interpolation, substeps, planner, wish_kernel, script_kernel, pedal_kernel, driver_kernel,
)  # fmt: skip
KMH = 1.0 / 3.6
LEVER = (
    "lever_resume",
    "lever_cancel",
    "lever_up",
    "lever_down",
    "lever_up_long",
    "lever_down_long",
)
PEDALS = ("driver_gas_pedal", "driver_brake_pedal")
SEEN = ("mode", "target_speed_mps", "set_speed_mps", "limit_mps")
# The wish of a driver who wants exactly what the driving function does by default.
LIKE_THE_FUNCTION: dict[str, float] = {
    "wish_offset_mps": 0.0,
    "wish_lateral_accel_max_mps2": 2.5,
    "wish_accel_max_mps2": 1.2,
    "wish_accel_min_mps2": -1.0,
    "wish_anticipation_s": 0.0,
}


def straight(folder: Path, *limits_kmh: float) -> str:
    """A straight road with a new limit each 1000 m; returns its file name."""
    path = folder / "straight.csv"
    lines = ["s_m,curvature_per_m,speed_limit_mps"]
    lines += [f"{1000 * i},0,{limit / 3.6!r}" for i, limit in enumerate(limits_kmh)]
    lines.append(f"{1000 * len(limits_kmh)},0,{limits_kmh[-1] / 3.6!r}")
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def driver(route_file: str = "", script_file: str = "", **values: float) -> ScriptedDriver:
    """An initialized driver."""
    someone = ScriptedDriver()
    someone.texts.route_file = route_file
    someone.texts.script_file = script_file
    for name, value in values.items():
        assert hasattr(someone.record, name)
        setattr(someone.record, name, value)
    someone.initialize()
    return someone


def watch(someone: ScriptedDriver, seconds: float, **inputs: float) -> list[dict[str, float]]:
    """Hold the inputs and return all outputs after each step."""
    for name, value in inputs.items():
        assert hasattr(someone.record, name)
        setattr(someone.record, name, value)
    seen = []
    for _ in range(round(seconds / STEP_S)):
        someone.step(STEP_S)
        seen.append({name: getattr(someone.record, name) for name in (*PEDALS, *LEVER)})
    return seen


def first(seen: list[dict[str, float]], name: str) -> float:
    """Time of the first step in which an output is not 0."""
    return next(STEP_S * (k + 1) for k, row in enumerate(seen) if row[name] != 0)


def presses(seen: list[dict[str, float]], name: str) -> int:
    values = [0.0, *(row[name] for row in seen)]
    return sum(a == 0 and b != 0 for a, b in pairwise(values))


# --- scripts ---------------------------------------------------------------------------------


def script(folder: Path, *lines: str) -> str:
    path = folder / "script.csv"
    path.write_text("# a comment\nat,unit,control,value,duration_s\n" + "\n".join(lines) + "\n")
    return str(path)


@pytest.mark.parametrize("control", CONTROLS)
def test_every_control_is_operated_for_its_time(tmp_path: Path, control: str) -> None:
    value = "0.4" if control in ("gas", "brake") else ""
    someone = driver(script_file=script(tmp_path, f"0.5,s,{control},{value},0.3"), kind=1)
    seen = watch(someone, 2.0)
    name = f"driver_{control}_pedal" if control in ("gas", "brake") else f"lever_{control}"
    assert first(seen, name) == pytest.approx(0.5)
    assert [row[name] for row in seen].count(0.4 if value else 1) == 30
    assert not any(row[other] for row in seen for other in (*PEDALS, *LEVER) if other != name)


def test_events_by_position_happen_once(tmp_path: Path) -> None:
    someone = driver(script_file=script(tmp_path, "100,m,gas,0.2,1"), kind=1)
    assert presses(watch(someone, 1.0, vehicle_s_m=99.9), PEDALS[0]) == 0
    seen = watch(someone, 3.0, vehicle_s_m=100.0)
    assert presses(seen, PEDALS[0]) == 1
    assert first(seen, PEDALS[0]) == STEP_S
    assert presses(watch(someone, 3.0, vehicle_s_m=150.0), PEDALS[0]) == 0


def test_order_does_not_matter_and_the_stronger_pedal_wins(tmp_path: Path) -> None:
    lines = ("2,s,gas,0.1,2", "1,s,gas,0.6,2")
    one = watch(driver(script_file=script(tmp_path, *lines), kind=1), 5.0)
    two = watch(driver(script_file=script(tmp_path, *lines[::-1]), kind=1), 5.0)
    assert one == two
    assert one[250][PEDALS[0]] == 0.6
    assert one[350][PEDALS[0]] == 0.1


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("x,s,gas,0.2,1", r"line 3, at: 'x' is not a number from 0 to 1e\+09"),
        ("-1,s,gas,0.2,1", "line 3, at: '-1'"),
        ("1,km,gas,0.2,1", "line 3, unit: 'km' is not one of s, m"),
        ("1,s,clutch,0.2,1", "line 3, control: 'clutch' is not one of gas, brake, resume"),
        ("1,s,gas,1.2,1", "line 3, value: '1.2' is not a number from 0 to 1"),
        ("1,s,gas,,1", "line 3, value: '' is not a number"),
        ("1,s,gas,nan,1", "line 3, value: 'nan' is not a number"),
        ("1,s,up,0.5,1", "line 3, value: '0.5' for the lever; leave it empty"),
        ("1,s,gas,0.2,0", "line 3, duration_s: '0' is not a number from 0.001"),
        ("1,s,gas", "line 3: 3 values for 5 columns"),
    ],
)
def test_script_errors_name_file_and_line(tmp_path: Path, line: str, complaint: str) -> None:
    with pytest.raises(ModelError, match=complaint) as error:
        driver(script_file=script(tmp_path, line), kind=1)
    assert "script.csv" in str(error.value)


def test_unusable_script_files(tmp_path: Path) -> None:
    path = tmp_path / "bad.csv"
    with pytest.raises(ModelError, match=r"bad\.csv: cannot be read"):
        read_script(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ModelError, match="line 1: not UTF-8 text; save the file as UTF-8"):
        read_script(path)
    path.write_text("at,unit,control,value\n1,s,up,\n")
    with pytest.raises(ModelError, match=r"line 1: missing column duration_s"):
        read_script(path)
    path.write_text("")
    with pytest.raises(ModelError, match=r"no header; a driver script has the columns at,unit"):
        read_script(path)
    path.write_text("at,unit,control,value,duration_s\n")
    with pytest.raises(ModelError, match="no events"):
        read_script(path)


def test_packed_scripts() -> None:
    for script_id in range(len(PACKED)):
        assert len(read_script(packed_script(script_id))) > 3
    with pytest.raises(ModelError, match="script_id 9 is unknown; packed scripts are 0"):
        driver(kind=1, script_id=9)


# --- hands off and activation ----------------------------------------------------------------


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


# --- the wish --------------------------------------------------------------------------------


def route_arrays_of(limit: NDArray[np.float64], curvature: NDArray[np.float64]) -> RouteArrays:
    return RouteArrays(limit, curvature, np.zeros(0), np.zeros(0), np.zeros(0))


def wish_of(
    limit: NDArray[np.float64], curvature: NDArray[np.float64], **values: float
) -> WishArrays:
    wish, work = zeros(WishArrays, len(limit)), zeros(Work, len(limit))
    record = replace(DriverState(), **values)  # type: ignore[arg-type]
    prepare_wish(record, route_arrays_of(limit, curvature), wish, work)
    return wish


def test_wish_has_offset_anticipation_and_curve_speed() -> None:
    limit = np.where(np.arange(2000) < 1000, 20.0, 30.0)
    curvature = np.where(abs(np.arange(2000) - 1700) < 50, 0.01, 0.0)
    early = wish_of(limit, curvature, wish_offset_mps=2.0, wish_anticipation_s=3.0).wish_mps
    late = wish_of(limit, curvature, wish_offset_mps=2.0, wish_anticipation_s=0.0).wish_mps
    assert early[500] == late[500] == 22.0
    assert late[1000] == pytest.approx(22.0, abs=1e-9)
    assert early[936] > 22.0 + 0.001  # 3 s at 22 m/s are 66 m
    assert early[933] == pytest.approx(22.0, abs=1e-9)
    assert early[1700] == pytest.approx(np.sqrt(2.9 / 0.01), abs=1e-6)
    assert np.all(np.diff(np.square(early)) <= 2 * 1.5 + 1e-9)
    assert np.all(np.diff(np.square(early)) >= -2 * 1.3 - 1e-9)


def test_anticipation_does_not_skip_a_short_lower_limit() -> None:
    limit = np.full(1000, 30.0)
    limit[500:520] = 15.0
    wish = wish_of(limit, np.zeros(1000), wish_offset_mps=0.0, wish_anticipation_s=10.0).wish_mps
    assert wish[500] == pytest.approx(30.0, abs=1e-6)  # the whole of the short limit is ignored
    limit[400:500] = 20.0
    wish = wish_of(limit, np.zeros(1000), wish_offset_mps=0.0, wish_anticipation_s=10.0).wish_mps
    assert wish[499] <= 20.0


# --- reactions on a straight road ------------------------------------------------------------


def cruising(route_file: str, speed_kmh: float, **values: float) -> ScriptedDriver:
    """A driver who watches an active function that keeps a speed."""
    someone = driver(route_file, driver_spread=0.0, driver_uses_lever=0, **values)
    keep = {"vehicle_speed_mps": speed_kmh * KMH, "target_speed_mps": speed_kmh * KMH}
    watch(someone, 1.1, mode=STANDBY, vehicle_s_m=200.0, **keep)
    watch(someone, 0.3, mode=ACTIVE)
    return someone


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


# --- the closed loop with the driving function -----------------------------------------------


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


def test_compiled_kernel_equals_cpython_to_the_bit() -> None:
    compiled = compile_modules(MODULES)
    plain = default_drive().driver
    fresh = driver(driver_spread=0.3)
    wish = WishArrays(*(np.zeros_like(a) for a in fresh.arrays[:3]))
    function = default_drive().function
    work = zeros(Work, len(wish.wish_mps))
    routes = RouteArrays(*(np.array(a) for a in function.route))
    packed = pack(fresh.record)
    compiled["prepare_wish"](packed[0], routes, wish, work)
    for ours, theirs in zip(fresh.arrays[:3], wish, strict=True):
        assert np.array_equal(ours, np.asarray(theirs))
    packed = pack(fresh.record)
    blank = script_kernel.ScriptArrays(*(np.array(a) for a in plain.arrays[3:]))
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
    wish = WishArrays(*(np.array(a) for a in someone.arrays[:3]))
    events = script_kernel.ScriptArrays(*(np.array(a) for a in someone.arrays[3:]))
    for k in range(4000):
        someone.record.vehicle_s_m = packed[0]["vehicle_s_m"] = float(k)
        someone.step(0.03)
        compiled["driver_step"](packed[0], wish, events, 0.03)
        unpack(packed, twin)
        assert twin == someone.record
