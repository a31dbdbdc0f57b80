"""What a recording says against itself is told; what honest recordings look like is not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from laboratory import KMH, road
from numpy.typing import NDArray
from pldf.findings import Finding
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.recordings.contradictions import contradictions
from pldf.recordings.quality import quality_of
from pldf.recordings.recording import Recording
from pldf.roads import route_arrays

Columns = dict[str, NDArray[np.float64]]
Change = Callable[[Columns], Columns]

LENGTH_M = 3000.0
ROUTE = route_arrays(road(LENGTH_M, [(0.0, 100 * KMH), (1500.0, 80 * KMH)]))


def driven(step_s: float = 0.05) -> Columns:
    """A drive over the whole road: gas, brake, an offset; position is the integral of the speed."""
    time = np.arange(0.0, 120.0, step_s)
    speed = 26.0 + 1.5 * np.sin(time / 9.0) - 4.0 / (1.0 + np.exp(60.0 - time))
    position = 1.0 + np.concatenate(
        ([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time)))
    )
    time, speed, position = (x[position < LENGTH_M] for x in (time, speed, position))
    limit = np.where(position < 1500.0, 100 * KMH, 80 * KMH)
    gas = (time > 20.0) & (time < 30.0)
    brake = (time > 60.0) & (time < 65.0)
    offset = np.where((time > 80.0) & (time < 100.0), 10 * KMH, 0.0)
    return {
        "time_s": time,
        "s_m": position,
        "speed_mps": speed,
        "acceleration_mps2": np.gradient(speed, time),
        "mode": np.where(gas, float(GAS_OVERRIDE), np.where(brake, float(STANDBY), float(ACTIVE))),
        "gas_pedal": np.where(gas, 0.4, 0.0),
        "brake_pedal": np.where(brake, 0.3, 0.0),
        "set_speed_mps": limit + offset,
        "set_speed_offset_mps": offset,
        "profile_mps": np.minimum(limit, 26.0),
        "base_mps": np.minimum(limit, 26.0),
        "limit_mps": limit,
    }


def found(columns: Columns, with_road: bool = True) -> list[Finding]:
    return contradictions(Recording(columns), "drive.csv", ROUTE if with_road else None)


def only(columns: Columns, with_road: bool = True) -> Finding:
    (finding,) = found(columns, with_road)
    assert finding.file == "drive.csv" and finding.consequence and finding.way_out
    return finding


def scaled(*names: str, by: float) -> Change:
    return lambda c: {**c, **{name: by * c[name] for name in names}}


def with_column(name: str, change: Callable[[Columns], NDArray[np.float64]]) -> Change:
    return lambda c: {**c, name: change(c)}


def kept(rows: Callable[[Columns], NDArray[np.bool_]]) -> Change:
    return lambda c: {name: values[rows(c)] for name, values in c.items()}


def rounded(decimals: int) -> Change:
    exact = ("time_s", "mode")
    return lambda c: {n: v if n in exact else np.round(v, decimals) for n, v in c.items()}


def noisy(columns: Columns) -> Columns:
    chance = np.random.default_rng(7)
    sigma = {"speed_mps": 0.1, "s_m": 0.3, "acceleration_mps2": 0.3}
    return {n: v + chance.normal(0.0, sigma.get(n, 0.0), len(v)) for n, v in columns.items()}


def halting(columns: Columns) -> Columns:
    """The same drive with a standstill of 20 s in its middle."""
    time = columns["time_s"]
    row = len(time) // 2
    braking = np.arange(0.0, 6.0, 0.05)
    speeds = columns["speed_mps"][row] * np.concatenate(
        (1.0 - braking / 6.0, np.zeros(400), braking / 6.0)
    )
    way = columns["s_m"][row] + np.concatenate(([0.0], np.cumsum(speeds[1:] * 0.05)))
    out = {n: np.insert(v, row, np.full(len(speeds), v[row])) for n, v in columns.items()}
    out["speed_mps"] = np.insert(columns["speed_mps"], row, speeds)
    behind = np.where(np.arange(len(time)) < row, 0.0, way[-1] - way[0] + 0.5)
    out["s_m"] = np.insert(columns["s_m"] + behind, row, way)
    out["time_s"] = np.arange(len(out["s_m"])) * 0.05
    out["acceleration_mps2"] = np.gradient(out["speed_mps"], out["time_s"])
    inside = out["s_m"] < LENGTH_M
    out["limit_mps"] = np.where(out["s_m"] < 1500.0, 100 * KMH, 80 * KMH)
    return {n: v[inside] for n, v in out.items()}


HONEST: dict[str, Change] = {
    "as it is": lambda c: c,
    "4 decimals": rounded(4),
    "1 decimal": rounded(1),
    "whole metres": with_column("s_m", lambda c: np.round(c["s_m"])),
    "float32": lambda c: {n: v.astype(np.float32).astype(np.float64) for n, v in c.items()},
    "1 Hz": lambda c: {n: v[::20] for n, v in c.items()},
    "1 Hz, 1 decimal": lambda c: {n: np.round(v[::20], 1) for n, v in c.items()},
    "1 Hz with jitter": lambda c: {
        n: v[::20] + (1e-3 * np.arange(len(v[::20])) if n == "time_s" else 0.0)
        for n, v in c.items()
    },
    "noise": noisy,
    "a stop": halting,
    "needed columns": lambda c: {n: c[n] for n in ("time_s", "s_m", "speed_mps", "mode")},
    "epoch": with_column("time_s", lambda c: c["time_s"] + 1_700_000_000.0),
    "speed of a tachometer": scaled("speed_mps", by=1.03),
    "a gap of 1.4 s": kept(lambda c: (c["time_s"] < 40.0) | (c["time_s"] > 41.35)),
}


@pytest.mark.parametrize("with_road", (True, False))
@pytest.mark.parametrize("kind", HONEST)
def test_nothing_is_said_about_an_honest_recording(kind: str, with_road: bool) -> None:
    assert found(HONEST[kind](driven()), with_road) == []


UNITS: dict[str, tuple[Change, str, str]] = {
    "km/h": (scaled("speed_mps", by=3.6), "speed_mps", "3.6 times"),
    "mph": (scaled("speed_mps", by=2.23694), "speed_mps", "2.237 times"),
    "ms": (scaled("time_s", by=1e3), "time_s", "1000 times"),
    "us": (scaled("time_s", by=1e6), "time_s", "1e+06 times"),
    "km": (scaled("s_m", by=1e-3), "s_m", "1000 times"),
    "ft": (scaled("s_m", by=3.2808), "s_m", "0.3048 times"),
    "h": (scaled("time_s", by=1 / 3600), "time_s", "0.0002778 times"),
}


@pytest.mark.parametrize("unit", UNITS)
def test_a_unit_that_the_other_columns_contradict_is_named_with_its_factor(unit: str) -> None:
    change, column, factor = UNITS[unit]
    needed = {n: v for n, v in driven().items() if n in ("time_s", "s_m", "speed_mps", "mode")}
    finding = only(change(needed), with_road=False)
    assert finding.severity == "error"
    assert finding.place == column
    assert factor in finding.text and f"{column} in {unit}?" in finding.text
    assert f'{column} = {{ column = "{column}", unit = "{unit}" }}' in finding.way_out


def test_two_units_at_once_are_named_both() -> None:
    both = scaled("time_s", by=1e3)(scaled("speed_mps", by=3.6)(driven()))
    needed = {n: both[n] for n in ("time_s", "s_m", "speed_mps", "mode")}
    assert "speed_mps in km/h and time_s in ms?" in only(needed, with_road=False).text


def test_the_case_of_a_speed_in_kmh_survives_holes_and_noise() -> None:
    columns = noisy(scaled("speed_mps", by=3.6)(driven()))
    holed = kept(lambda c: np.abs(c["time_s"] % 30.0 - 5.0) > 3.0)(columns)
    first = found(holed, with_road=False)[0]
    assert (first.severity, first.place) == ("error", "speed_mps")
    assert "speed_mps in km/h?" in first.text


def test_speed_and_position_that_differ_by_no_unit_are_a_warning() -> None:
    finding = only(scaled("speed_mps", by=1.1)(driven()))
    assert finding.severity == "warning"
    assert "1.1 times what s_m and time_s say" in finding.text


def test_a_position_that_falls_is_no_drive_of_this_road() -> None:
    columns = with_column("s_m", lambda c: LENGTH_M - c["s_m"])(driven())
    needed = {n: columns[n] for n in ("time_s", "s_m", "speed_mps", "mode")}
    assert "s_m falls" in only(needed).text


def test_a_speed_with_the_other_sign() -> None:
    needed = {n: v for n, v in driven().items() if n in ("time_s", "s_m", "speed_mps", "mode")}
    assert "speed_mps is negative" in only(scaled("speed_mps", by=-1.0)(needed)).text


def test_limits_of_a_town_in_kmh_are_told_by_the_speed_alone() -> None:
    columns = driven()
    slow = scaled("time_s", by=2.0)(scaled("speed_mps", by=0.5)(columns))
    names = ("time_s", "s_m", "speed_mps", "mode", "limit_mps")
    town = {n: slow[n] for n in names} | {"limit_mps": np.full(len(slow["time_s"]), 50.0)}
    finding = only(town, with_road=False)
    assert (finding.severity, finding.place) == ("error", "limit_mps")
    assert found({**town, "limit_mps": town["limit_mps"] / 3.6}, with_road=False) == []


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("seed", range(40))
def test_whatever_the_numbers_are_there_is_an_answer(seed: int) -> None:
    chance = np.random.default_rng(seed)
    rows = int(chance.integers(2, 40))
    scale = 10.0 ** chance.uniform(-3.0, 6.0)
    columns = {n: scale * chance.normal(0.0, 1.0, rows) for n in driven()}
    columns["time_s"] = np.cumsum(chance.exponential(scale, rows) + 1e-6)
    columns["mode"] = chance.integers(0, 5, rows).astype(np.float64)
    if seed % 4 == 0:
        columns["limit_mps"][:] = 0.0
    if seed % 5 == 0:
        columns["s_m"][:], columns["speed_mps"][:] = 10.0, 0.0
    for with_road in (True, False):
        assert all(one.text and one.file == "drive.csv" for one in found(columns, with_road))


def test_way_and_speed_in_one_wrong_unit_are_too_fast_for_a_car() -> None:
    columns = scaled("s_m", "speed_mps", by=5.0)(driven())
    needed = {n: columns[n] for n in ("time_s", "s_m", "speed_mps", "mode")}
    assert "no car drives so" in only(needed, with_road=False).consequence


@pytest.mark.parametrize("unit, factor", (("km/h", 3.6), ("mph", 2.23694)))
@pytest.mark.parametrize("name", ("set_speed_mps", "limit_mps", "profile_mps", "base_mps"))
def test_speeds_are_held_against_the_roads_limit(name: str, unit: str, factor: float) -> None:
    columns = scaled(name, by=factor)(driven())
    columns.pop("set_speed_offset_mps")
    first = found(columns)[0]
    assert (first.severity, first.place) == ("error", name)
    assert f"{name} in {unit}?" in first.text


@pytest.mark.parametrize("name", ("set_speed_mps", "limit_mps"))
def test_limit_and_set_speed_contradict_each_other_without_a_road(name: str) -> None:
    columns = scaled(name, by=3.6)(driven())
    columns.pop("set_speed_offset_mps")
    first = found(columns, with_road=False)[0]
    assert (first.severity, first.place) == ("error", name)


def test_a_set_speed_that_never_fits_is_told() -> None:
    finding = only(with_column("set_speed_mps", lambda c: 0.0 * c["time_s"] + 1.0)(driven()))
    assert (finding.severity, finding.place) == ("warning", "set_speed_mps")


def test_an_offset_in_kmh_is_an_error() -> None:
    finding = only(scaled("set_speed_offset_mps", by=3.6)(driven()))
    assert (finding.severity, finding.place) == ("error", "set_speed_offset_mps")


@pytest.mark.parametrize("factor, text", ((1 / 9.81, "in g?"), (-1.0, "other sign")))
def test_an_acceleration_that_the_speed_contradicts(factor: float, text: str) -> None:
    columns = driven()
    time = columns["time_s"]
    columns["speed_mps"] = 20.0 + 8.0 * np.sin(time / 6.0)
    columns["s_m"] = 1.0 + 20.0 * time - 48.0 * (np.cos(time / 6.0) - 1.0)
    columns["acceleration_mps2"] = factor * 8.0 / 6.0 * np.cos(time / 6.0)
    columns = {n: v for n, v in columns.items() if "limit" not in n}
    finding = only(columns, with_road=False)
    assert (finding.severity, finding.place) == ("warning", "acceleration_mps2")
    assert text in finding.text


def test_a_recording_longer_than_the_road() -> None:
    columns = driven()
    short = route_arrays(road(2000.0, [(0.0, 100 * KMH), (1500.0, 80 * KMH)]))
    (finding,) = contradictions(Recording(columns), "drive.csv", short)
    assert finding.severity == "warning"
    assert f"{columns['s_m'][-1] - 2000.0:.0f} m past the road's end (2000 m)" in finding.text


def test_a_recording_that_begins_before_the_road_and_one_beside_it() -> None:
    needed = {n: v for n, v in driven().items() if "limit" not in n}
    before = with_column("s_m", lambda c: c["s_m"] - 200.0)(needed)
    assert "begins at -199 m, before the road" in found(before)[0].text
    beside = with_column("s_m", lambda c: c["s_m"] + 5000.0)(needed)
    finding = only(beside)
    assert (finding.severity, finding.consequence) == ("error", "no sample lies on the road")


def test_half_a_drive_says_how_much() -> None:
    finding = only(kept(lambda c: c["s_m"] < 1560.0)(driven()))
    assert finding.severity == "note"
    assert "covers 52 % of the road: 1 to 1559 m of 3000 m" in finding.text


def test_limits_of_another_place_of_the_road_say_how_far_off() -> None:
    shifted = with_column("limit_mps", lambda c: np.where(c["s_m"] < 1400.0, 100, 80) * KMH)
    columns = shifted(driven())
    columns["set_speed_mps"] = columns["limit_mps"] + columns["set_speed_offset_mps"]
    finding = only(columns)
    assert finding.place == "limit_mps"
    assert "100 m further on" in finding.text and "add 100 m" in finding.way_out


def test_drop_outs_say_how_many_metres_they_cost() -> None:
    columns = kept(lambda c: np.abs(c["time_s"] - 40.0) > 0.81)(driven())
    finding = only(columns)
    row = int(np.argmax(np.diff(columns["time_s"])))
    lost = columns["s_m"][row + 1] - columns["s_m"][row]
    assert finding.severity == "warning"
    assert "a drop-out of more than 1.5 s: 1.7 s at 39.2 s" in finding.text
    assert finding.consequence.startswith(f"{lost:.0f} m are not learned")
    assert quality_of(Recording(columns), None).lost_m == pytest.approx(lost)


def test_a_logger_slower_than_a_hole_is_an_error() -> None:
    finding = only({n: v[::40] for n, v in driven().items()})
    assert finding.severity == "error"
    assert "a sample every 2 s" in finding.text


def test_time_running_backwards_and_standing() -> None:
    columns = driven()
    columns["time_s"][500:] -= 10.0
    assert "time runs backwards from 24.95 s to 15 s" in only(columns).text
    columns = driven()
    columns["time_s"][500] = columns["time_s"][499]
    assert "time stands still at 24.95 s" in only(columns).text


@pytest.mark.parametrize("wrong", (np.nan, np.inf))
def test_no_number_is_an_error(wrong: float) -> None:
    columns = driven()
    columns["speed_mps"][99:102] = wrong
    finding = only(columns)
    assert (finding.severity, finding.place) == ("error", "speed_mps")
    assert f"3 of {len(columns['time_s'])} samples are no number, first in sample 100" in (
        finding.text
    )


def test_a_position_that_stands_while_the_car_drives() -> None:
    columns = driven()
    columns["s_m"][800:860] = columns["s_m"][800]
    finding = only(columns)
    assert (finding.severity, finding.place) == ("warning", "s_m")
    assert f"stands still at {columns['s_m'][800]:.0f} m for 3.0 s" in finding.text


def test_a_speed_that_stands_while_the_position_says_otherwise() -> None:
    columns = driven()
    columns["speed_mps"][1150:1300] = columns["speed_mps"][1150]
    columns.pop("acceleration_mps2")
    finding = only(columns)
    assert (finding.severity, finding.place) == ("warning", "speed_mps")
    assert "stands still at" in finding.text and "for 7.5 s" in finding.text


def test_a_position_that_jumps_and_laps() -> None:
    columns = driven()
    columns["s_m"][800:] -= 40.0
    columns = {n: v for n, v in columns.items() if n != "limit_mps"}
    assert "jumps from" in only(columns).text
    columns = {n: np.concatenate((v[:800], v[: len(v) - 800])) for n, v in driven().items()}
    columns["time_s"] = driven()["time_s"]
    assert "each lap is a recording of its own" in found(columns, False)[0].way_out


def test_accelerations_that_no_car_reaches() -> None:
    columns = driven()
    columns["speed_mps"][700] = 0.0
    finding = only(columns)
    assert finding.place == "speed_mps" and "to 0.0 m/s within 0.05 s" in finding.text


def test_a_mode_that_is_never_active() -> None:
    finding = only(with_column("mode", lambda c: 0.0 * c["mode"] + STANDBY)(driven()))
    assert (finding.place, finding.text) == ("mode", "never ACTIVE, only STANDBY")


def test_a_car_that_does_not_move() -> None:
    columns = driven()
    columns["s_m"][:] = 700.0
    assert found(columns, with_road=False)[0].severity == "error"
    columns["speed_mps"][:] = 0.0
    columns["acceleration_mps2"][:] = 0.0
    assert only(columns, with_road=False).severity == "warning"


PEDALS: dict[str, tuple[Change, str]] = {
    "percent": (scaled("gas_pedal", by=100.0), "percent?"),
    "uncalibrated": (with_column("brake_pedal", lambda c: c["brake_pedal"] - 0.3), "from -0.3"),
    "the car's throttle": (
        with_column("gas_pedal", lambda c: 0.3 + 0.0 * c["time_s"]),
        "in which mode is ACTIVE",
    ),
    "another drive's": (
        with_column("gas_pedal", lambda c: 0.0 * c["time_s"]),
        "mode is GAS_OVERRIDE for 9.9",
    ),
}


@pytest.mark.parametrize("kind", PEDALS)
def test_pedals_that_contradict_the_mode_or_their_range(kind: str) -> None:
    change, text = PEDALS[kind]
    finding = only(change(driven()))
    assert finding.severity == "warning"
    assert text in finding.text


def test_a_recording_made_in_python_may_lack_what_no_file_does() -> None:
    columns = driven()
    del columns["mode"]
    assert found(columns)[0].text == "missing column mode"
    assert found({name: values[:1] for name, values in driven().items()})[0].text == "1 samples"


def late(name: str, rows: int) -> Change:
    return with_column(name, lambda c: np.concatenate((np.full(rows, c[name][0]), c[name][:-rows])))


def test_a_speed_that_is_late_for_the_position_is_told() -> None:
    finding = only(
        with_column("speed_mps", lambda c: c["speed_mps"] + 3.0 * (c["time_s"] < 9))(driven())
    )
    assert finding.place == "speed_mps, s_m"
    assert "for 7.1 s, first at 0.0 s (1 m), they differ by up to 10.8 km/h" in finding.text


def test_an_offset_that_changes_without_the_set_speed_is_told() -> None:
    columns = late("set_speed_offset_mps", 100)(driven())
    finding = only({n: v for n, v in columns.items() if n != "limit_mps"}, with_road=False)
    assert finding.place == "set_speed_mps, set_speed_offset_mps"
    assert "2 of 2 changes of the offset are none of the set speed" in finding.text
    assert "the first by +10.0 km/h at 85.1 s" in finding.text


def test_a_drive_without_leave_to_learn_is_told() -> None:
    columns = driven()
    finding = only({**columns, "eligible": np.zeros(len(columns["time_s"]))})
    assert finding.text == "0 in every row: learning was allowed nowhere"
