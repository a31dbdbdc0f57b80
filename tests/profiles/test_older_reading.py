"""A profile of an older reading of the road is told: by the function, and nothing is touched."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from laboratory import files, function
from pldf.function import DrivingFunction
from pldf.kernel.codes import PROFILE_BASE
from pldf.profiles.older_reading import find_older_reading, pairs_of_one_road
from pldf.profiles.profile_file import encode
from pldf.profiles.store import ProfileStore
from pldf.profiles.stored_profile import StoredProfile
from pldf.roads import Route, fingerprint, write_route_csv
from two_readings import lesson, newer_reading, older_reading, other_road


@pytest.fixture(scope="module")
def learned() -> StoredProfile:
    return lesson(older_reading())[1]


def keep(store: Path, profile: StoredProfile) -> Path:
    path = ProfileStore(store).path(profile.driver_id, profile.route)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(encode(profile))
    return path


def told(store: Path, route: Route, tmp_path: Path, **settings: int) -> list[str]:
    """Start a drive; return its warnings."""
    road_file = tmp_path / "road.csv"
    write_route_csv(route, road_file)
    made = DrivingFunction()
    for name, value in {"learn": 1, **settings}.items():
        setattr(made.record, name, value)
    made.texts.route_file, made.texts.profile_store = str(road_file), str(store)
    made.initialize()
    assert made.record.profile_status == PROFILE_BASE
    assert np.array_equal(np.array(made.profile.learned_mps), np.array(made.profile.base_mps))
    return [message.text for message in made.messages if message.level == "warning"]


def test_the_function_says_so_with_file_and_way_out_and_touches_nothing(
    learned: StoredProfile, tmp_path: Path
) -> None:
    store = tmp_path / "store"
    path = keep(store, learned)
    before = files(store)
    (text,) = told(store, newer_reading(), tmp_path)
    assert text.startswith(
        f"{path} was probably learned on an older reading of this road (81 of 100"
    )
    assert "goes on with the base profile, and that file is left as it is" in text
    assert f"pldf profiles move {path} --route ROAD" in text
    assert files(store) == before


@pytest.mark.parametrize(
    ("route", "settings"),
    [
        (other_road(), {}),
        (newer_reading(), {"driver_id": 3}),  # another driver's
        (newer_reading(), {"learn": 0, "apply_learned": 0}),  # who would not have followed it
    ],
)
def test_else_nothing_is_said(
    learned: StoredProfile, tmp_path: Path, route: Route, settings: dict[str, int]
) -> None:
    keep(tmp_path / "store", learned)
    assert told(tmp_path / "store", route, tmp_path, **settings) == []


def test_nothing_is_said_once_there_is_a_profile_of_this_reading(
    learned: StoredProfile, tmp_path: Path
) -> None:
    store, route = ProfileStore(tmp_path), newer_reading()
    keep(tmp_path, learned)
    profile = lesson(route)[1]
    keep(tmp_path, profile)
    base = profile.base_mps
    assert store.older_reading(0, profile.route, base) is not None
    made = function(route)
    made.texts.profile_store = str(tmp_path)
    assert made._load(fingerprint(route)).iterations
    assert not made.messages
    assert store.readings_of_one_road() == [
        tuple(sorted(store.path(0, one.route) for one in (learned, profile)))
    ]


def test_the_likeliest_is_named_whatever_else_lies_there(
    learned: StoredProfile, tmp_path: Path
) -> None:
    base = np.array(function(newer_reading()).profile.base_mps)
    near = lesson(newer_reading(3001.0))[1]
    expected = keep(tmp_path, near)
    keep(tmp_path, learned)
    (tmp_path / "driver-000000_route-0000000000000000.pldf").write_bytes(b"PLDF-PROFILE 2\nbad")
    (tmp_path / "driver-000000_route-0000000000000001.pldf").mkdir()
    keep(tmp_path, replace(near, route="f" * 16, iterations=()))
    conflict = expected.with_name(expected.name.replace(".pldf", ".conflict-1.pldf"))
    conflict.write_bytes(expected.read_bytes())
    found = ProfileStore(tmp_path).older_reading(0, "0" * 16, base)
    assert found is not None and found.path == expected
    assert found.alike == np.count_nonzero(
        np.abs(near.iteration().base_mps[: len(base)] - base) <= 0.1
    )
    assert found.percent == 100  # one more metre at the end
    assert find_older_reading([], 0, "0" * 16, base) is None
    assert pairs_of_one_road([expected]) == []
