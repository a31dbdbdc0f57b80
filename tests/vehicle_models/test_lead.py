"""The car ahead: by parameters, by a script and from a seed, against plain formulas."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from pldf.errors import ModelError
from pldf.roads import packed_route, route_arrays

from vehicle_models.lead import LeadVehicle
from vehicle_models.lead_script import PACKED_TRAFFIC, packed_traffic, read_traffic
from vehicle_models.lead_state import BY_SCRIPT, ONE_CAR, TRAFFIC

HEADER = "at,unit,action,gap_m,speed_mps,acceleration_mps2\n"


class Seen(NamedTuple):
    """What the sensor of a car at constant speed saw, a value per step."""

    time_s: NDArray[np.float64]
    ego_m: NDArray[np.float64]
    present: NDArray[np.float64]
    gap_m: NDArray[np.float64]
    speed_mps: NDArray[np.float64]
    acceleration_mps2: NDArray[np.float64]
    cars: NDArray[np.float64]


def lead(kind: int, **values: float) -> LeadVehicle:
    model = LeadVehicle()
    for name, value in {"kind": kind, **values}.items():
        setattr(model.record, name, value)
    return model


def watched(
    model: LeadVehicle, seconds: float, ego_mps: float, step_s: float = 0.01, from_m: float = 0.0
) -> Seen:
    """Drive behind it at constant speed."""
    model.initialize()
    record = model.record
    rows = []
    for k in range(round(seconds / step_s)):
        record.vehicle_s_m = from_m + k * step_s * ego_mps
        record.vehicle_speed_mps = ego_mps
        model.step(step_s)
        end_s = (k + 1) * step_s
        rows.append(
            (end_s, from_m + end_s * ego_mps, record.lead_present, record.lead_gap_m,
             record.lead_speed_mps, record.lead_acceleration_mps2, record.lead_cars)
        )  # fmt: skip
    return Seen(*np.array(rows).T)


def by_script(folder: Path, lines: str) -> LeadVehicle:
    path = folder / "traffic.csv"
    path.write_text(HEADER + lines)
    model = lead(BY_SCRIPT)
    model.texts.script_file = str(path)
    return model


def test_nobody_is_ahead_before_the_first_step() -> None:
    model = lead(ONE_CAR)
    model.record.vehicle_s_m = 500.0
    model.initialize()
    record = model.record
    assert (record.lead_present, record.lead_gap_m, record.lead_speed_mps) == (0, 0.0, 0.0)


@pytest.mark.parametrize("step_s", [0.001, 0.01, 0.1])
def test_a_steady_car_is_where_its_speed_brings_it(step_s: float) -> None:
    model = lead(ONE_CAR, scene_appear_s=2.0, scene_gap_m=40.0, scene_speed_mps=18.0)
    seen = watched(model, 10.0, ego_mps=20.0, step_s=step_s)
    there = seen.present == 1
    assert seen.time_s[there][0] == pytest.approx(2.0, abs=1.5 * step_s)
    expected = 40.0 - 2.0 * (seen.time_s[there] - 2.0)
    np.testing.assert_allclose(seen.gap_m[there], expected, atol=1e-6)
    assert np.all(seen.speed_mps[there] == 18.0)
    assert np.all(seen.gap_m[~there] == 0.0)


@pytest.mark.parametrize("strength", [2.0, 3.5, 6.0])
def test_braking_to_a_stop_takes_the_way_of_its_deceleration(strength: float) -> None:
    start = 20.0
    model = lead(
        ONE_CAR, scene_gap_m=50.0, scene_speed_mps=start, scene_change_s=1.0,
        scene_next_speed_mps=0.0, scene_change_mps2=strength,
    )  # fmt: skip
    seen = watched(model, 30.0, ego_mps=0.0, from_m=100.0)
    rear_m = seen.ego_m + seen.gap_m
    way = rear_m[-1] - np.interp(1.0, seen.time_s, rear_m)
    # v**2 / 2a, later by half the time in which the deceleration builds up at 10 m/s3, and by the
    # soft end: the last strength * 0.4 s of speed decays with 0.4 s.
    build_up = start * strength / 10.0 / 2.0
    soft_end = (strength * 0.4) ** 2 / (2.0 * strength)
    assert way == pytest.approx(start**2 / (2.0 * strength) + build_up + soft_end, rel=0.02)
    assert seen.speed_mps[-1] == 0.0
    assert seen.acceleration_mps2.min() == pytest.approx(-strength)
    jerk = np.diff(seen.acceleration_mps2) / 0.01
    moving = seen.speed_mps[1:] > 0.0  # standing, the acceleration ends at once
    assert np.abs(jerk[moving]).max() <= 10.0 + 1e-6


def test_speed_is_the_integral_of_acceleration_and_position_that_of_speed() -> None:
    model = lead(TRAFFIC, traffic_free_s=1.0, traffic_stay_s=60.0, traffic_stop_share=1.0, seed=5)
    seen = watched(model, 30.0, ego_mps=15.0)
    one = (seen.present == 1) & (seen.cars == 1)
    speed, rear_m = seen.speed_mps[one], (seen.ego_m + seen.gap_m)[one]
    grown = np.cumsum(seen.acceleration_mps2[one][1:]) * 0.01
    moving = slice(0, int(np.argmax(speed <= 0.0)) if (speed <= 0.0).any() else len(speed))
    np.testing.assert_allclose(speed[1:][moving] - speed[0], grown[moving][: len(speed) - 1],
                               atol=0.05)  # fmt: skip
    np.testing.assert_allclose(np.diff(rear_m), 0.5 * (speed[1:] + speed[:-1]) * 0.01, atol=1e-3)


def test_a_car_that_leaves_is_gone() -> None:
    model = lead(ONE_CAR, scene_speed_mps=20.0, scene_leave_s=3.0)
    seen = watched(model, 5.0, ego_mps=20.0)
    assert not seen.present[seen.time_s > 3.005].any()
    assert seen.present[(seen.time_s > 0.02) & (seen.time_s < 2.995)].all()


def test_a_script_does_each_of_its_events(tmp_path: Path) -> None:
    model = by_script(
        tmp_path,
        "1,s,appear,90,20,\n2,s,speed,,10,2.5\n8,s,lost,,,\n8.5,s,seen,,,\n300,m,leave,,,\n",
    )
    seen = watched(model, 20.0, ego_mps=20.0)
    time_s, there = seen.time_s, seen.present == 1
    assert not there[time_s < 0.995].any()
    assert there[(time_s > 1.005) & (time_s < 7.995)].all()
    assert not there[(time_s > 8.005) & (time_s < 8.495)].any()
    assert seen.speed_mps[np.searchsorted(time_s, 7.5)] == pytest.approx(10.0, abs=0.1)
    assert seen.acceleration_mps2.min() == pytest.approx(-2.5)
    assert not there[seen.ego_m > 300.5].any()


def test_a_car_that_was_lost_has_driven_on(tmp_path: Path) -> None:
    model = by_script(tmp_path, "1,s,appear,30,18,\n2,s,lost,,,\n2.5,s,seen,,,\n")
    seen = watched(model, 3.0, ego_mps=20.0)
    before, after = (np.searchsorted(seen.time_s, t) for t in (1.99, 2.52))
    passed_s = seen.time_s[after] - seen.time_s[before]
    assert seen.gap_m[before] - seen.gap_m[after] == pytest.approx(2.0 * passed_s)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("1,s,appear,,20,\n", "gap_m: missing; appear needs it"),
        ("1,s,speed,,,\n", "speed_mps: missing; speed needs it"),
        ("1,s,leave,,3,\n", "speed_mps: '3' for leave; leave it empty"),
        ("1,s,overtake,,,\n", "overtake"),
        ("1,s,appear,-3,20,\n", "gap_m"),
        ("1,km,leave,,,\n", "km"),
    ],
)
def test_a_line_that_cannot_be_meant_is_refused_with_its_place(
    tmp_path: Path, line: str, told: str
) -> None:
    model = by_script(tmp_path, "0,s,appear,50,20,\n" + line)
    with pytest.raises(ModelError, match=r"traffic\.csv, line 3") as refusal:
        model.initialize()
    assert told.partition(":")[2].strip() in str(refusal.value)


def test_shipped_scripts_are_readable_and_an_unknown_one_names_them() -> None:
    for number in range(len(PACKED_TRAFFIC)):
        assert len(read_traffic(packed_traffic(number))) > 3
    with pytest.raises(ModelError, match="cut_in_and_stop"):
        packed_traffic(len(PACKED_TRAFFIC))


def test_the_same_seed_gives_the_same_traffic_and_another_one_another() -> None:
    first, again, other = (
        watched(lead(TRAFFIC, seed=seed, traffic_free_s=5.0), 60.0, ego_mps=15.0)
        for seed in (4, 4, 9)
    )
    np.testing.assert_array_equal(first.gap_m, again.gap_m)
    assert first.cars[-1] >= 1
    assert not np.array_equal(first.gap_m, other.gap_m)


@pytest.mark.parametrize("seed", range(12))
def test_traffic_obeys_the_road_appears_at_safe_gaps_and_stops(seed: int) -> None:
    """Against the route's own numbers: no car is faster than limit and lateral acceleration allow.

    A car that cuts in comes at the speed of ours, which may be above both, and slows down.
    """
    model = lead(
        TRAFFIC, seed=seed, traffic_free_s=3.0, traffic_stay_s=40.0, traffic_cut_in_share=0.0
    )
    seen = watched(model, 200.0, ego_mps=12.0)
    route = route_arrays(packed_route(0))
    curvature = np.abs(np.asarray(route.curvature_per_m))
    with np.errstate(divide="ignore"):
        allowed = np.minimum(np.asarray(route.limit_mps), np.sqrt(2.5 / curvature))
    there = seen.present == 1
    cell = np.minimum((seen.ego_m + seen.gap_m)[there].astype(int), len(allowed) - 1)
    assert np.all(seen.speed_mps[there] <= allowed[cell] + 1.0)
    first_seen = np.flatnonzero(np.diff(seen.cars, prepend=0.0))
    assert len(first_seen) >= 2
    assert np.all(seen.gap_m[first_seen] >= 100.0 - 1.0)


def test_who_cuts_in_keeps_a_time_gap_and_is_hardly_slower() -> None:
    model = lead(
        TRAFFIC, traffic_free_s=4.0, traffic_stay_s=4.0, traffic_cut_in_share=1.0,
        traffic_stop_share=0.0, traffic_pace_low=1.0,
    )  # fmt: skip
    seen = watched(model, 200.0, ego_mps=15.0)
    first_seen = np.flatnonzero(np.diff(seen.cars, prepend=0.0))
    assert len(first_seen) >= 10
    assert np.all(seen.gap_m[first_seen] >= 0.9 * 15.0)
    assert np.all(seen.gap_m[first_seen] <= 3.0 + 1.6 * 15.0 + 0.1)
    assert np.all(seen.speed_mps[first_seen] >= 12.0 - 0.1)


def test_stops_end() -> None:
    model = lead(
        TRAFFIC, traffic_free_s=1.0, traffic_stay_s=15.0, traffic_stop_share=1.0,
        traffic_cut_in_share=0.0, traffic_reach_m=1000.0,
    )  # fmt: skip
    seen = watched(model, 250.0, ego_mps=1.0)
    cars = seen.cars[(seen.present == 1) & (seen.speed_mps == 0.0)].astype(int)
    stood_s = 0.01 * np.bincount(cars)[1 : int(seen.cars[-1])]  # the last one may stand still
    in_sight = stood_s[stood_s > 0.0]
    assert len(in_sight) >= 4
    assert np.all((in_sight >= 2.0) & (in_sight <= 8.05))


def test_a_contact_is_told_once_and_a_car_driven_through_is_gone() -> None:
    model = lead(ONE_CAR, scene_gap_m=10.0, scene_speed_mps=0.0)
    seen = watched(model, 3.0, ego_mps=10.0)
    assert seen.gap_m[(seen.present == 1)].min() < 0.0
    assert not seen.present[seen.time_s > 1.52].any()
    told = [message.text for message in model.messages if message.level == "warning"]
    assert len(told) == 1
    assert "run into the car ahead" in told[0]


@pytest.mark.parametrize("nonsense", [float("nan"), float("inf"), -1e9, 1e9])
def test_a_position_that_is_no_place_is_bridged_and_told(nonsense: float) -> None:
    model = lead(ONE_CAR, scene_gap_m=50.0, scene_speed_mps=10.0)
    watched(model, 1.0, ego_mps=10.0)
    model.record.vehicle_s_m = nonsense
    for _ in range(100):
        model.step(0.01)
    assert model.record.lead_gap_m == pytest.approx(50.0, abs=0.15)
    assert [message.level for message in model.messages] == ["warning"]
    lead(ONE_CAR).restore(model.snapshot())  # within the ranges of a state


def test_a_saved_state_goes_on_to_the_bit() -> None:
    first, second = lead(TRAFFIC, seed=2, traffic_free_s=2.0), lead(TRAFFIC, seed=2)
    watched(first, 20.0, ego_mps=15.0)
    second.initialize()
    second.restore(first.snapshot())
    for k in range(3000):
        for model in (first, second):
            model.record.vehicle_s_m = 300.0 + 0.15 * k
            model.record.vehicle_speed_mps = 15.0
            model.step(0.01)
        assert first.record == second.record
