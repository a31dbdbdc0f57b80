"""Our FMUs, through fmpy."""

from __future__ import annotations

import math
import subprocess
import sys

import pytest
from fmi_host import Host
from pldf.build import fmus as fmu_build
from pushed_cart import EXAMPLE, FATAL, OK


def numbers(outputs):
    return [value for value in outputs.values() if not isinstance(value, str)]


@pytest.mark.parametrize("name", fmu_build.FMUS)
def test_our_fmus_run_and_start_anew(fmu_folder, name, monkeypatch, tmp_path):
    monkeypatch.setenv("PLDF_PROFILE_STORE", str(tmp_path))
    host = Host(fmu_folder / f"{name}.fmu")
    slave = host.instantiate().start()
    first = slave.outputs()
    run = slave.run(0.0, 50)
    slave.fmu.terminate()
    state = slave.state()
    slave.fmu.reset()
    assert slave.start().outputs() == first
    assert slave.run(0.0, 50) == run
    assert slave.restore(state) == OK
    slave.free()
    assert all(math.isfinite(v) for o in (first, *run) for v in numbers(o))


def drive_on(slave, first: int, steps: int) -> list:
    """Drive at a constant 20 m/s from step ``first`` on and return the outputs."""
    found = []
    for step in range(first, first + steps):
        slave.set(vehicle__s_m=0.2 * step, vehicle__speed_mps=20.0, lever__resume=True)
        found += slave.run(0.01 * step, 1)
    return found


def test_drive_restored_in_another_instance_is_learned_for_its_own_driver(fmu_folder, tmp_path):
    host = Host(fmu_folder / "AdaptivePLDF.fmu")
    files = {"profile_store": str(tmp_path), "learn": 1}
    first = host.instantiate("first").start(**files, driver_id=1)
    other = host.instantiate("other").start(**files, driver_id=2)
    fresh = host.instantiate("fresh")
    drive_on(first, 0, 100)
    state = first.state()
    expected = drive_on(first, 100, 50)
    first.fmu.terminate()
    for slave in (other, fresh):
        assert slave.restore(state) == OK
        assert drive_on(slave, 100, 50) == expected
        slave.fmu.terminate()
    for number, slave in enumerate((first, other, fresh), start=1):
        assert f"drive {number} learned" in slave.texts("logEvents")[-1]
        slave.free()
    assert [p.name[:14] for p in tmp_path.glob("*.pldf")] == ["driver-000001_"]


def test_next_drive_follows_what_the_last_one_learned(fmu_folder, tmp_path):
    host = Host(fmu_folder / "AdaptivePLDF.fmu")
    found = []
    for ending in ("terminate", "reset", "freeInstance"):
        slave = host.instantiate().start(profile_store=str(tmp_path), learn=1)
        found.append((slave.get("profile.iteration"), slave.get("profile.status")))
        drive_on(slave, 0, 100)
        getattr(slave.fmu, ending)()
        if ending != "freeInstance":
            slave.free()
    last = host.instantiate().start(profile_store=str(tmp_path))
    assert [*found, (last.get("profile.iteration"), last.get("profile.status"))] == [
        (0, 0), (1, 1), (2, 1), (3, 1)
    ]  # fmt: skip
    last.free()


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("name", fmu_build.FMUS)
def test_inputs_that_are_no_numbers_never_come_out(fmu_folder, name, value):
    slave = Host(fmu_folder / f"{name}.fmu").instantiate().start()
    inputs = [n for n, v in slave.variables.items() if (v.causality, v.type) == ("input", "Real")]
    time = 0.0
    for bad in inputs:
        slave.set(**{bad: value})
        between = slave.outputs()
        after = slave.run(time, 2)
        assert all(math.isfinite(v) for o in (between, *after) for v in numbers(o)), bad
        slave.set(**{bad: 0.0})
        slave.run(time + 0.02, 2)
        time += 0.04
    assert len(slave.log) < 4 * len(inputs)
    slave.free()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"route_id": 999}, "999"),
        ({"route_file": "/no/such/road.xodr"}, "/no/such/road.xodr"),
        ({"planner__accel_max_mps2": math.nan}, "planner.accel_max_mps2"),
        ({"learn": 7}, "learn"),
        ({"localization": -1}, "localization"),
    ],
)
def test_unusable_parameters_of_the_driving_function(fmu_folder, values, message):
    slave = Host(fmu_folder / "AdaptivePLDF.fmu").instantiate()
    slave.set(**values)
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    assert slave.status("exitInitializationMode") == FATAL
    (text,) = slave.texts()
    assert message in text
    assert "Traceback" not in text
    slave.free()


def test_all_three_in_one_process(fmu_folder, monkeypatch, tmp_path):
    monkeypatch.setenv("PLDF_PROFILE_STORE", str(tmp_path))
    hosts = [Host(fmu_folder / f"{name}.fmu") for name in fmu_build.FMUS]
    slaves = [host.instantiate().start() for host in hosts]
    for slave in slaves:
        assert len(slave.run(0.0, 20)) == 20
    for slave in slaves:
        slave.free()


ONE_AFTER_THE_OTHER = """
import shutil, sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from fmi_host import Host
for number, name in enumerate({names!r}):
    host = Host(Path({fmu_folder!r}, name + ".fmu"), Path(str(number)))
    slave = host.instantiate().start()
    slave.run(0.0, 5)
    slave.free()
    shutil.rmtree(host.folder)
"""


def test_one_after_the_other_from_folders_that_vanish(fmu_folder, tmp_path):
    names = list(fmu_build.FMUS)
    script = ONE_AFTER_THE_OTHER.format(
        tests=str(EXAMPLE.parent), fmu_folder=str(fmu_folder), names=[*reversed(names), *names]
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
