"""Native FMUs: the same bits as the Python source they were compiled from, in hosts without it."""

from __future__ import annotations

import ctypes
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fmi_host import Host
from pldf.function import DrivingFunction
from pldf.kernel.signals import signals_of
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


# Everything the function says, step by step


def hostile_inputs(k: int) -> dict[str, float]:
    """Return a drive with pedals, lever, jumps and nonsense."""
    speed = 22.0 + 3.0 * math.sin(0.001 * k)
    return {
        "vehicle_s_m": 0.22 * k + (500.0 if 2000 < k < 2010 else 0.0),
        "vehicle_speed_mps": math.nan if 3000 < k < 3020 else speed,
        "vehicle_acceleration_mps2": 0.4 * math.cos(0.01 * k),
        "driver_gas_pedal": 0.4 if k % 900 > 700 else 0.0,
        "driver_brake_pedal": 0.3 if k % 1700 > 1600 else 0.0,
        "lever_resume": int(k % 400 > 390),
        "lever_up_long": int(k % 650 > 640),
        "lever_down": int(k % 1050 > 1040),
        "eligible": int(k % 800 > 40),
    }


def test_every_output_of_every_step_equals_the_source(native_folder: Path) -> None:
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate().start(learn=1)
    model = DrivingFunction()
    model.record.learn = 1
    model.initialize()
    signals = signals_of(model.record)
    outputs = {s.name: s.field for s in signals if s.causality == "output"}
    names = {s.field: s.name.replace(".", "__") for s in signals}
    codes = set()
    for k in range(4000):
        step_s = 0.01 if k % 7 else 0.037
        inputs = hostile_inputs(k)
        for field, value in inputs.items():
            setattr(model.record, field, value)
        slave.set(**{names[field]: value for field, value in inputs.items()})
        model.step(step_s)
        slave.fmu.doStep(0.037 * k, step_s)
        found = slave.outputs()
        assert found == {name: getattr(model.record, f) for name, f in outputs.items()}
        codes.add(found["mode"])
    assert codes == {1, 2, 3, 4}
    slave.free()


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


# A host without Python


@pytest.mark.parametrize("name", ["AdaptivePLDF", "LongitudinalVehicle", "ScriptedDriver"])
def test_c_host(native_folder: Path, c_host: Path, tmp_path: Path, name: str) -> None:
    """Life cycle, wrong order, instances, states, hostile inputs; and the same bits as in fmpy."""
    others = [n for n in ("AdaptivePLDF", "LongitudinalVehicle") if n != name][:1]
    hosts = [Host(native_folder / f"{n}.fmu") for n in (name, *others)]
    arguments = []
    for host in hosts:
        model = host.description.coSimulation.modelIdentifier
        library = host.folder / "binaries" / "linux64" / f"{model}.so"
        arguments += [str(library), host.description.guid, f"file://{host.folder}/resources"]
    inputs, outputs = (reals(hosts[0], causality) for causality in ("input", "output"))
    environment = {"REALS_IN": listed(inputs), "REALS_OUT": listed(outputs)}
    done = subprocess.run(
        [c_host, *arguments],
        env={"PATH": os.environ["PATH"], **environment},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    lines = done.stdout.splitlines()
    assert done.returncode == 0, [*lines[-1:], done.stderr]
    assert len(lines) == 2000
    slave = hosts[0].instantiate().start()
    for k, line in enumerate(lines):
        values = [float((7 * k + 13 * i) % 97) / 97.0 for i in range(len(inputs))]
        slave.fmu.setReal(inputs, [0.2 * k, *values[1:]])
        slave.fmu.doStep(0.01 * k, 0.01)
        found = np.array(slave.fmu.getReal(outputs))
        assert found.tobytes() == np.array([float.fromhex(x) for x in line.split()]).tobytes()
    slave.free()
    assert list(tmp_path.iterdir()) == []


def reals(host: Host, causality: str) -> list[int]:
    """Return the value references of the Real variables with this causality."""
    variables = host.description.modelVariables
    return [v.valueReference for v in variables if (v.type, v.causality) == ("Real", causality)]


def listed(references: list[int]) -> str:
    return ",".join(map(str, references))


def test_c_host_learns_what_fmpy_learns(native_folder: Path, c_host: Path, tmp_path: Path) -> None:
    """With the store from the environment; the second instance saved late and lost nothing."""
    host = Host(native_folder / "AdaptivePLDF.fmu")
    inputs, outputs = reals(host, "input"), reals(host, "output")
    (learn,) = [
        v.valueReference for v in host.description.modelVariables if v.name == "learn_faithful"
    ]
    library = host.folder / "binaries" / "linux64" / "AdaptivePLDF.so"
    environment = {
        "REALS_IN": listed(inputs),
        "REALS_OUT": listed(outputs),
        "LEARN": str(learn),
        "PLDF_PROFILE_STORE": "relative/store",
    }
    arguments = [c_host, library, host.description.guid, f"file://{host.folder}/resources"]
    subprocess.run(arguments, env=environment, cwd=tmp_path, capture_output=True, check=True)
    store = tmp_path / "relative" / "store"
    slave = host.instantiate().start(learn_faithful=True, profile_store=str(tmp_path / "fmpy"))
    for k in range(2000):
        values = [float((7 * k + 13 * i) % 97) / 97.0 for i in range(len(inputs))]
        slave.fmu.setReal(inputs, [0.2 * k, *values[1:]])
        slave.fmu.doStep(0.01 * k, 0.01)
    slave.fmu.terminate()
    slave.free()
    (expected,) = (tmp_path / "fmpy").iterdir()
    late = expected.with_suffix(".conflict-1.pldf").name
    assert sorted(path.name for path in store.iterdir()) == [late, expected.name]
    assert (store / expected.name).read_bytes() == expected.read_bytes()


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
