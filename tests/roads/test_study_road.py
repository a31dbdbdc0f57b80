"""The shipped study road."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.roads import (
    fingerprint,
    open_road,
    open_route,
    packed_route,
    read_route,
    route_arrays,
)
from pldf.roads.load import DATA
from pldf.roads.make_study_road import write_study_road
from pldf.route_facts import route_facts

KMH = 1.0 / 3.6


def test_the_study_road_is_what_its_script_writes(tmp_path: Path) -> None:
    write_study_road(tmp_path)
    for name in ("study_road.xodr", "study_road.csv"):
        assert (tmp_path / name).read_bytes() == (DATA / name).read_bytes()


def test_both_files_of_the_study_road_are_the_same_road() -> None:
    xodr, csv = packed_route(0), read_route(DATA / "study_road.csv")
    assert fingerprint(xodr) == fingerprint(csv)
    for name in ("s_m", "curvature_per_m", "speed_limit_mps", "grade"):
        np.testing.assert_array_equal(xodr.knots[name], csv.knots[name])
    np.testing.assert_allclose(xodr.x_m, csv.x_m, atol=6e-5)
    np.testing.assert_allclose(xodr.y_m, csv.y_m, atol=6e-5)


def test_the_study_road_is_the_papers() -> None:
    facts = route_facts(packed_route(0))
    assert facts.route.length_m == 4500.0
    assert facts.route.has_line
    assert 200.0 <= facts.driving_time_s <= 220.0
    assert len(facts.curves) >= 6
    assert {round(limit / KMH) for _, limit in facts.limits} == {50, 60, 80, 100}
    long_limits = np.diff([s for s, _ in facts.limits] + [4500.0])
    assert np.sum(long_limits >= 600.0) >= 3
    limit = np.asarray(facts.arrays.limit_mps) / KMH
    assert np.mean(limit > 79.0) > 0.8
    assert np.max(np.abs(facts.arrays.grade)) < 0.04
    assert np.all(facts.base_mps <= facts.arrays.limit_mps)


def test_the_study_roads_line_turns_as_its_curvature_says() -> None:
    arrays = route_arrays(packed_route(0))
    heading = np.unwrap(np.angle(np.diff(np.asarray(arrays.x_m) + 1j * np.asarray(arrays.y_m))))
    route = packed_route(0)
    turn = np.interp(np.arange(1.0, 4500.0), route.s_m, route.curvature_per_m)
    np.testing.assert_allclose(np.diff(heading), turn, atol=4e-5)
    steps = np.hypot(np.diff(arrays.x_m), np.diff(arrays.y_m))
    np.testing.assert_allclose(steps, 1.0, atol=1e-5)


def test_unknown_packed_routes_are_named() -> None:
    with pytest.raises(ModelError, match=r"route_id 7 is unknown.*0 = study_road"):
        packed_route(7)
    with pytest.raises(ModelError, match="route_id -1 is unknown"):
        packed_route(-1)


def test_study_names_the_shipped_road(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert fingerprint(open_route("study")) == fingerprint(packed_route(0))


def test_a_folder_of_its_name_does_not_hide_the_study_road(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study").mkdir()
    assert open_road("study").route_id == 0
    Path("0").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n50,0,20\n")
    assert open_road("0").route_id is None  # but a file does
