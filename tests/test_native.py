"""Native FMUs: the same bits as the Python source they were compiled from, in hosts without it."""

from __future__ import annotations

import ctypes
import math
import re
import sys
from pathlib import Path

import pytest
from fmi_host import Host
from pldf.roads import packed_route
from pldf.study.fmu import Fmu
from pldf.study.master import drive
from pldf.study.phases import PHASES, Setting, values_of
from pldf.study.recording import write_recording

import build_fmu

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
if sys.platform != "linux":
    pytest.skip("builds and loads the linux64 FMUs", allow_module_level=True)

from pldf.native.build import HEADERS
from pldf.native.prepared import write_prepared_route

# The coupled loop


def driven(fmus: dict[str, Fmu], phase: str, store: Path, number: int) -> tuple[bytes, bytes]:
    """Return recording and profile file after one drive of 1 km with this store."""
    more = {"vehicle": {"start_s_m": 3400.0}}
    setting = Setting(packed_route(0), {"route_id": 0}, store=store, more=more)
    values = values_of(PHASES[phase], setting, number)
    result = drive(fmus, values, setting.course(lambda _: None))
    recording = store / f"{number}.csv"
    write_recording(recording, result.recording)
    (profile,) = store.glob("*.pldf")
    return recording.read_bytes(), profile.read_bytes()


def test_a_loop_of_native_fmus_equals_that_of_python_fmus(
    fmus: dict[str, Fmu], native_fmus: dict[str, Fmu], tmp_path: Path
) -> None:
    """Each continues what the other has learned, and both are the same to the byte."""
    kinds = [(fmus, native_fmus), (native_fmus, fmus)]
    results = []
    for number, (first, second) in enumerate(kinds):
        store = tmp_path / str(number)
        store.mkdir()
        results.append([driven(first, "A2", store, 0), driven(second, "B2", store, 1)])
        assert sorted(path.suffix for path in store.iterdir()) == [".csv", ".csv", ".pldf"]
    assert results[0] == results[1]
    assert b"iteration 2 " in results[0][1][1]


# What is read


def test_refuses_parameters_and_routes_with_a_reason(native_folder: Path, tmp_path: Path) -> None:
    host = Host(native_folder / "AdaptivePLDF.fmu")
    for values, text in (
        ({"planner__accel_max_mps2": math.nan}, "planner.accel_max_mps2"),
        ({"route_id": 7}, "7.prepared"),
        ({"route_file": str(tmp_path / "none.xodr")}, "no such file"),
        ({"route_file": __file__}, "pldf route"),
    ):
        slave = host.instantiate()
        slave.set(**values)
        slave.fmu.setupExperiment(startTime=0.0)
        slave.fmu.enterInitializationMode()
        assert slave.status("exitInitializationMode") == 3
        assert text in slave.texts()[-1]
        slave.free()


def test_drives_an_exported_route(native_folder: Path, tmp_path: Path) -> None:
    exported = tmp_path / "road 1 %.prepared"
    write_prepared_route(packed_route(0), exported)
    host = Host(native_folder / "AdaptivePLDF.fmu")
    seen = []
    for values in ({}, {"route_file": str(exported)}):
        slave = host.instantiate(location=f"file:////{host.folder}/resources/").start(**values)
        seen.append(slave.outputs())
        slave.free()
    assert seen[0] == seen[1]


@pytest.mark.parametrize("damage", ["truncated", "flipped", "empty"])
def test_a_damaged_profile_is_kept_aside(
    native_folder: Path, native_fmus: dict[str, Fmu], tmp_path: Path, damage: str
) -> None:
    driven(native_fmus, "A2", tmp_path, 0)
    (path,) = tmp_path.glob("*.pldf")
    good = path.read_bytes()
    flipped = bytes([good[900] ^ 1])
    bad = {"truncated": good[:-9], "flipped": good[:900] + flipped + good[901:], "empty": b""}[
        damage
    ]
    path.write_bytes(bad)
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate()
    slave.start(profile_store=str(tmp_path), driver_id=1)
    assert slave.get("profile.status") == 2
    assert "refused-1" in slave.texts("logStatusWarning")[0]
    assert (tmp_path / (path.name + ".refused-1")).read_bytes() == bad
    slave.free()


# The library


def test_exports_the_functions_of_fmi_and_nothing_else(native_folder: Path) -> None:
    host = Host(native_folder / "AdaptivePLDF.fmu")
    path = host.folder / "binaries" / "linux64" / "AdaptivePLDF.so"
    library = ctypes.CDLL(str(path))
    declared = re.findall(
        r"FMI2_Export \w+\s+(fmi2\w+);", (HEADERS / "fmi2Functions.h").read_text()
    )
    model_exchange = set(declared[declared.index("fmi2EnterEventMode") : -9])
    for name in set(declared) - model_exchange:
        assert hasattr(library, name), name
    assert len(set(declared) - model_exchange) == 34
    for name in ("model", "model_step", "session_step", "disk_read"):
        assert not hasattr(library, name)


def test_the_same_sources_give_the_same_bytes(native_folder: Path, tmp_path: Path) -> None:
    arguments = ["--native", "--target", "linux64", "--only", "LongitudinalVehicle"]
    assert build_fmu.main([*arguments, "--out", str(tmp_path)]) == 0
    path = Path("native", "LongitudinalVehicle.fmu")
    assert (tmp_path / path).read_bytes() == (native_folder / path.name).read_bytes()
