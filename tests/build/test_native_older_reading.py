"""A native FMU says of a profile of an older reading what the Python FMU says, to the letter."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmi_host import Host
from laboratory import files
from pldf.function import DrivingFunction
from pldf.kernel.codes import PROFILE_STATUS
from pldf.profiles.profile_file import encode
from pldf.profiles.store import ProfileStore
from pldf.roads import Route, write_route_csv
from two_readings import lesson, newer_reading, older_reading, other_road

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

from pldf.cosim.prepared import write_prepared_route


def by_python(road: Path, store: Path) -> list[str]:
    made = DrivingFunction()
    made.texts.route_file, made.texts.profile_store = str(road), str(store)
    made.record.learn = 1
    made.initialize()
    return [message.text for message in made.messages if message.level == "warning"]


def by_native(host: Host, road: Path, store: Path) -> list[str]:
    slave = host.instantiate()
    slave.start(route_file=str(road), profile_store=str(store), learn=True)
    assert PROFILE_STATUS.items[slave.get("profile.status")] == "BASE"
    told = slave.texts("logStatusWarning")
    slave.free()
    return told


def keep(
    store: Path, route: Route, gas: tuple[tuple[float, float], ...] = ((500.0, 600.0),)
) -> None:
    profile = lesson(route, gas=gas)[1]
    path = ProfileStore(store).path(profile.driver_id, profile.route)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(encode(profile))


def test_both_say_the_same(native_folder: Path, tmp_path: Path) -> None:
    """With none, one, and several candidates beside what is no profile at all."""
    host = Host(native_folder / "AdaptivePLDF.fmu")
    road, prepared, store = tmp_path / "road.csv", tmp_path / "road.prepared", tmp_path / "store"
    write_route_csv(newer_reading(), road)
    write_prepared_route(newer_reading(), prepared)
    counts = []
    for step in (
        store.mkdir,
        lambda: keep(store, other_road()),
        lambda: keep(store, older_reading()),
        lambda: (store / "driver-000000_route-0000000000000000.pldf").write_bytes(b"PLDF-PRO"),
        (store / "driver-000000_route-0000000000000001.pldf").mkdir,
        lambda: keep(store, newer_reading(3001.0)),
    ):
        step()
        before = files(store)
        expected = by_python(road, store)
        assert by_native(host, prepared, store) == expected
        assert files(store) == before
        counts.append([f"{text.split('(')[1][:4]}" for text in expected])
    assert [len(one) for one in counts] == [0, 0, 1, 1, 1, 1]
    assert counts[-1] != counts[-2]  # the nearer one is named
