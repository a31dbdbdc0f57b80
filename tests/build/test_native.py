"""Native FMUs in Python masters: beside the Python FMUs, and what they read."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from shutil import rmtree
from typing import Any

import pytest
from fmi3_host import Host3, Slave3
from fmi_host import Host, Slave
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import drive
from pldf.recordings.recording import write_recording
from pldf.roads import packed_route
from pldf.study.phases import PHASES, DriveSetting, values_of

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
if sys.platform != "linux":
    pytest.skip("builds and loads the linux64 FMUs", allow_module_level=True)

from pldf.cosim.prepared import write_prepared_route


def driven(fmus: dict[str, Fmu], phase: str, store: Path, number: int) -> tuple[bytes, bytes]:
    """Return recording and profile file after one drive of 1 km with this store."""
    more = {"vehicle": {"start_s_m": 3400.0}}
    setting = DriveSetting(packed_route(0), {"route_id": 0}, store=store, more=more)
    result = drive(fmus, values_of(PHASES[phase], setting), setting.length_m)
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


def test_refuses_parameters_and_routes_with_a_reason(native_folder: Path, tmp_path: Path) -> None:
    host = Host(native_folder / "AdaptivePLDF.fmu")
    for values, text in (
        ({"planner__accel_max_mps2": math.nan}, "planner.accel_max_mps2"),
        ({"route_id": 7}, "7.prepared"),
        ({"route_file": str(tmp_path / "none.xodr")}, "no such file"),
        ({"route_file": __file__}, "pldf route"),
    ):
        assert text in reason(host, **values)


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


def reason(host: Host, location: str | None = None, **values: Any) -> str:
    """Return why an instance with these resources and parameters cannot be initialized."""
    slave = host.instantiate(location=location)
    slave.set(**values)
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    assert slave.status("exitInitializationMode") == 3
    text = slave.texts()[-1]
    slave.free()
    return text


@pytest.mark.parametrize(
    ("location", "path"),
    [
        ("file:///no%20where/", "/no where/"),
        ("FILE:/nowhere", "/nowhere/"),
        ("File://LocalHost/nowhere", "/nowhere/"),
        ("file://localhost/nowhere", "/nowhere/"),
        ("file://localhost/C:/nowhere", "C:/nowhere/"),
        ("file://localhosts/nowhere", "//localhosts/nowhere/"),
        ("file:///q%3a/nowhere", "q:/nowhere/"),
        ("file:///Q%3A/nowhere", "Q:/nowhere/"),
        ("file://Q:/nowhere", "Q:/nowhere/"),
        ("file://q%3A/nowhere", "q:/nowhere/"),
        ("file://server/nowhere", "//server/nowhere/"),
        ("/nowhere%20", "/nowhere%%20/"),  # FMI 2.0 doubles it in messages
    ],
)
def test_finds_the_resources_by_address(native_folder: Path, location: str, path: str) -> None:
    text = reason(Host(native_folder / "AdaptivePLDF.fmu"), location, route_id=999)
    assert text.startswith(f"{path}route/999.prepared: ")


def test_tells_that_there_are_no_resources(native_folder: Path, tmp_path: Path) -> None:
    host = Host(native_folder / "AdaptivePLDF.fmu", tmp_path)
    rmtree(tmp_path / "resources")
    for location in ("file:", "file:///" + "x" * 4096):
        assert "named no folder of resources" in reason(host, location)
        assert "none beside this library" in reason(host, location)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("model", ["AdaptivePLDF", "ScriptedDriver"])
def test_finds_its_own_resources_where_the_importer_names_none(
    model: str, version: int, native_folder: Path, tmp_path: Path
) -> None:
    """NULL, an empty text, an empty folder, a wrong one, and a path that is too long."""
    host: Host = (Host, Host3)[version - 2](
        native_folder / ("fmi3" if version == 3 else "") / f"{model}.fmu", tmp_path / "ä 100 %"
    )
    empty = tmp_path / "empty"
    empty.mkdir()
    outputs = []
    address = "file://" if version == 2 else ""
    wrong = (f"{address}{empty}", f"{address}{tmp_path}/nowhere", f"{address}/{'x' * 4096}")
    for location in (f"{address}{host.folder}/resources", None, "", *wrong):
        slave = (Slave, Slave3)[version - 2](host, "one", location)
        slave.start(**({"kind": 1} if model == "ScriptedDriver" else {}))
        outputs.append(slave.outputs())
        told = [
            text for text in slave.texts("logEvents") if "0.prepared: not in the folder" in text
        ]
        assert len(told) == (len(outputs) > 1)
        assert all(f"{host.folder}/resources".replace("%", "%" * (4 - version)) in t for t in told)
        slave.free()
    assert all(found == outputs[0] for found in outputs)


def test_tells_how_a_script_is_prepared(native_folder: Path) -> None:
    host = Host(native_folder / "ScriptedDriver.fmu")
    assert "'pldf script --help'" in reason(host, script_file=__file__, kind=1)


def test_tells_that_a_damaged_profile_is_kept_aside(
    native_folder: Path, native_fmus: dict[str, Fmu], tmp_path: Path
) -> None:
    driven(native_fmus, "A2", tmp_path, 0)
    (path,) = tmp_path.glob("*.pldf")
    bad = path.read_bytes()[:-9]
    path.write_bytes(bad)
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate()
    slave.start(profile_store=str(tmp_path), driver_id=1)
    assert slave.get("profile.status") == 2
    assert "refused-1" in slave.texts("logStatusWarning")[0]
    assert (tmp_path / (path.name + ".refused-1")).read_bytes() == bad
    slave.free()
