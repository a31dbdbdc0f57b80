"""The native session: its checks of parameters, FMU states, and what it tells at the end."""

from __future__ import annotations

import ctypes
import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest
from fmi3_host import Host3, Slave3
from fmi_host import Host, Slave
from pldf.errors import ModelError
from pldf.function import DrivingFunction
from pldf.kernel.state import PldfState
from pldf.profiles.profile_file import decode, encode
from pldf.roads import packed_route

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

from pldf.build.native.driving_function import MODEL
from pldf.cosim.prepared import write_prepared_route

OK, WARNING, ERROR = 0, 1, 3


@pytest.fixture(scope="module")
def host(native_folder: Path) -> Host:
    return Host(native_folder / "AdaptivePLDF.fmu")


@pytest.fixture
def slave(host: Host) -> Iterator[Slave]:
    one = host.instantiate()
    yield one
    one.free()


def drive(slave: Slave, first: int, steps: int) -> list[Any]:
    """Drive with 20 m/s from step ``first`` on and return the outputs after each step."""
    found = []
    for k in range(first, first + steps):
        values = {"vehicle__s_m": 100.0 + k, "vehicle__speed_mps": 20.0}
        found += slave.run(0.05 * k, 1, 0.05, **values)
    return found


def terminated(slave: Slave) -> int:
    return int(slave.fmu.dll.fmi2Terminate(ctypes.c_void_p(slave.fmu.component)))


# Parameters


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"learning.accel_max_mps2": 1.0},
        {"planner.accel_max_mps2": 2.0, "learning.accel_max_mps2": 2.0},
        {"planner.accel_max_mps2": 2.0, "learning.accel_max_mps2": 1.75},
        {"planner.accel_min_mps2": -1.5, "learning.accel_min_mps2": -1.25},
        {"planner.accel_min_mps2": -1.5, "learning.accel_min_mps2": -1.5},
        {"planner.lateral_accel_max_mps2": 4.0, "learning.lateral_accel_max_mps2": 3.0},
        {"learning.lateral_accel_max_mps2": 1e9},
        {"learning.lateral_accel_max_mps2": math.nan},
        {"learning.accel_min_mps2": 0.5},
    ],
)
def test_parameters_are_refused_as_by_the_python_model(
    slave: Slave, values: dict[str, float]
) -> None:
    model = DrivingFunction()
    for name, value in values.items():
        setattr(model.record, name.replace(".", "_"), value)
    try:
        model.initialize()
        refusal = ""
    except ModelError as error:
        refusal = str(error)
    slave.set(**{name.replace(".", "__"): value for name, value in values.items()})
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    assert slave.status("exitInitializationMode") == (ERROR if refusal else OK)
    said, told = refusal.split(": ", 1), "".join(slave.texts()).split(": ", 1)
    assert said[1:] == told[1:]  # before it stands the value, in other digits
    assert said[0].split(" = ")[0] == told[0].split(" = ")[0]


# Restoring


def test_a_refused_state_changes_nothing(host: Host, slave: Slave, tmp_path: Path) -> None:
    """Its route became shorter meanwhile; once it is as before, the state is restored."""
    path = tmp_path / "road.prepared"
    route = packed_route(0)
    write_prepared_route(route, path)
    other, twin = host.instantiate().start(route_file=str(path)), host.instantiate().start()
    drive(other, 0, 30)
    state, following = other.state(), drive(other, 30, 30)
    drive(slave.start(), 0, 50)
    drive(twin, 0, 50)
    half: dict[str, Any] = {name: knots[: len(knots) // 2] for name, knots in route.knots.items()}
    write_prepared_route(replace(route, **half), path)
    assert slave.restore(state) == ERROR
    assert "route of this state has changed" in slave.texts()[-1]
    assert slave.state() == twin.state()
    assert drive(slave, 50, 50) == drive(twin, 50, 50)
    path.unlink()
    assert slave.restore(state) == ERROR
    assert slave.state() == twin.state()
    write_prepared_route(route, path)
    assert slave.restore(state) == OK
    assert drive(slave, 30, 30) == following
    other.free()
    twin.free()


def test_a_restored_drive_learns_in_its_own_store(host: Host, slave: Slave, tmp_path: Path) -> None:
    """Not in the one for which outputs were computed before."""
    first, second = tmp_path / "first", tmp_path / "second"
    other = host.instantiate().start(learn=1, profile_store=str(second))
    drive(other, 0, 10)
    state = other.state()
    slave.set(learn=1, profile_store=str(first))
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    slave.get("target_speed_mps")
    slave.set(profile_store=str(second))
    assert slave.restore(state) == OK
    drive(slave, 10, 30)
    assert terminated(slave) == OK
    assert not first.exists()
    assert len(list(second.glob("*.pldf"))) == 1
    other.free()


def test_a_state_from_before_a_drive_brings_its_own_store(
    host: Host, slave: Slave, tmp_path: Path
) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    other = host.instantiate()
    other.set(learn=1, profile_store=str(second))
    before = other.state()
    other.start()
    drive(other, 0, 10)
    driving = other.state()
    drive(slave.start(learn=1, profile_store=str(first)), 0, 5)
    assert slave.restore(before) == OK
    assert slave.restore(driving) == OK
    drive(slave, 10, 30)
    assert terminated(slave) == OK
    assert not first.exists()
    assert len(list(second.glob("*.pldf"))) == 1
    other.free()


# Serialized states

HEAD = {"size": 40, "nodes": 48, "rows": 56, "phase": 64, "ready": 72, "stale": 80, "told": 88}
TIME = HEAD["told"] + 8 * len(MODEL.watches)
TEXTS = TIME + 8
CELLS = [field.name for field in fields(PldfState)]


def changed(state: bytes, empty: bytes, place: str | int, value: int | float | bytes) -> bytes:
    """Return a state with another value and a checksum that fits.

    Args:
        state: to be changed.
        empty: one from before initialization, it ends with the record.
        place: in the header or the record by name, or an offset.
        value: int64, float64 or bytes.
    """
    record = len(empty) - 4 - 8 * len(CELLS)
    if isinstance(place, str):
        place = HEAD[place] if place in HEAD else record + 8 * CELLS.index(place)
    if not isinstance(value, bytes):
        value = struct.pack("<q" if isinstance(value, int) else "<d", value)
    body = state[:place] + value + state[place + len(value) : -4]
    return body + struct.pack("<I", zlib.crc32(body))


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("phase", 4), ("phase", -1), ("phase", 10**12), ("phase", 0), ("ready", 2), ("stale", -1),
        ("told", 4), ("told", -1), ("nodes", -1), ("nodes", 2**60), ("rows", 2**62), ("rows", -1),
        ("size", 0), (TIME, math.nan), (TEXTS, b"a" * 4096), (TEXTS + 4096, b"a" * 4096),
        ("input_state", 4), ("input_state", 10**15), ("lever_resume", 2), ("function_active", -1),
        ("profile_status", 99), ("hmi_reason", -1), ("first_node", -1), ("first_node", 10**9),
        ("nodes_", 10**9), ("nodes_", -1), ("drive_interventions", 10**9),
        ("drive_interventions", -1), ("intervening", 1),
    ],
)  # fmt: skip
def test_a_hostile_state_is_refused(slave: Slave, place: str | int, value: Any) -> None:
    """Its checksum is right, so its values are checked."""
    empty = slave.state()
    drive(slave.start(), 0, 30)
    good = slave.state()
    where = len(empty) - 4 - 8 * (len(CELLS) - CELLS.index("nodes"))
    bad = changed(good, empty, where if place == "nodes_" else place, value)
    assert slave.status("deSerializeFMUstate", bad) == ERROR
    assert "not a state of this FMU" in slave.texts()[-1]
    assert slave.state() == good
    assert changed(good, empty, "phase", 2) == good
    assert slave.restore(good) == OK


def test_states_with_inputs_that_make_no_sense_are_restored(native_folder: Path) -> None:
    slave = Host(native_folder / "ScriptedDriver.fmu").instantiate()
    slave.start(mode=2**31 - 1)
    slave.run(0.0, 3, vehicle__speed_mps=math.nan)
    state = slave.state()
    following = slave.run(0.03, 3)
    assert slave.restore(state) == OK
    assert slave.run(0.03, 3) == following
    slave.free()


# The end of a drive


def test_terminate_warns_that_the_profile_was_not_saved(slave: Slave, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    drive(slave.start(learn=1, profile_store=str(tmp_path / "file")), 0, 30)
    assert terminated(slave) == WARNING
    assert "profile not saved" in slave.texts()[-1]
    assert terminated(slave) == ERROR


def test_terminate_of_fmi3_warns_as_well(native_folder: Path, tmp_path: Path) -> None:
    slave = Host3(native_folder / "fmi3" / "AdaptivePLDF.fmu").instantiate()
    (tmp_path / "file").write_text("")
    drive(slave.start(learn=1, profile_store=str(tmp_path / "file")), 0, 30)
    terminate = slave.fmu.dll.fmi3Terminate
    assert terminate(ctypes.c_void_p(slave.fmu.component)) == WARNING
    slave.free()


def test_a_drive_is_learned_once_and_says_so(slave: Slave, tmp_path: Path) -> None:
    drive(slave.start(learn=1, profile_store=str(tmp_path)), 0, 30)
    state = slave.state()
    assert terminated(slave) == OK
    assert slave.restore(state) == OK
    drive(slave, 30, 30)
    assert terminated(slave) == WARNING
    assert [text for text in slave.texts("logStatusWarning") if "a second time" in text]
    (path,) = tmp_path.glob("*.pldf")
    assert len(decode(path.read_bytes(), path.name).iterations) == 1


@pytest.mark.parametrize("end", ["reset", "freeInstance"])
def test_a_drive_that_is_not_terminated_is_learned_too(
    host: Host, tmp_path: Path, end: str
) -> None:
    slave = host.instantiate()
    drive(slave.start(learn=1, profile_store=str(tmp_path)), 0, 30)
    assert not list(tmp_path.iterdir())
    getattr(slave.fmu, end)()
    (path,) = tmp_path.glob("*.pldf")
    assert len(decode(path.read_bytes(), path.name).iterations) == 1


def test_a_history_of_equal_length_but_other_values_is_a_conflict(
    host: Host, slave: Slave, tmp_path: Path
) -> None:
    drive(slave.start(learn=1, profile_store=str(tmp_path)), 0, 30)
    assert terminated(slave) == OK
    (path,) = tmp_path.iterdir()
    profile = decode(path.read_bytes(), path.name)
    (first,) = profile.iterations
    other = encode(replace(profile, iterations=(replace(first, learned_mps=profile.base_mps / 2),)))
    second = host.instantiate()
    drive(second.start(learn=1, profile_store=str(tmp_path)), 0, 30)
    path.write_bytes(other)
    assert terminated(second) == WARNING
    assert "changed by another process" in second.texts("logStatusWarning")[-1]
    assert path.read_bytes() == other
    (kept,) = tmp_path.glob("*.conflict-1.pldf")
    assert len(decode(kept.read_bytes(), kept.name).iterations) == 2
    second.free()


# Time


def test_the_time_is_a_number_before_it_is_known(slave: Slave, native_folder: Path) -> None:
    last = ctypes.c_double(-1.0)
    get = slave.fmu.dll.fmi2GetRealStatus
    assert get(ctypes.c_void_p(slave.fmu.component), 2, ctypes.byref(last)) == OK
    assert last.value == 0.0
    new = Slave3(Host3(native_folder / "fmi3" / "AdaptivePLDF.fmu"), "one", None)
    last.value = -1.0
    step, c = new.fmu.dll.fmi3DoStep, ctypes.c_void_p(new.fmu.component)
    times = ctypes.c_double(0.0), ctypes.c_double(0.1)
    assert step(c, *times, True, None, None, None, ctypes.byref(last)) == ERROR
    assert last.value == 0.0
    new.free()
