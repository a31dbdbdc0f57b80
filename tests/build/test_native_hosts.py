"""Native FMUs in a host without Python, on every platform that can be run or emulated here."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import pytest
from native_drives import CASES
from native_hosts import MODELS, ON, PLATFORMS, Hosts, compiled_host, missing

STEPS = "20000"


def described(hosts: Hosts, platform: str, version: int, model: str, folder: Path) -> Path:
    fmu = hosts.fmu(platform, version, model)
    return fmu.described(PLATFORMS[platform], folder / f"{model}.txt")


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(("platform", "version"), ON)
def test_life_cycle_order_of_calls_instances_and_states(
    hosts: Hosts, platform: str, version: int, model: str, tmp_path: Path
) -> None:
    """Beside another FMU in one process, both unloaded in between (``native_host/check.c``)."""
    other = "ScriptedDriver" if model == "AdaptivePLDF" else "AdaptivePLDF"
    files = [described(hosts, platform, version, m, tmp_path) for m in (model, other)]
    before = sorted(tmp_path.iterdir())
    hosts.run(platform, "check", *files, cwd=tmp_path)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(("platform", "version"), ON)
def test_inputs_and_parameters_that_make_no_sense(
    hosts: Hosts, platform: str, version: int, model: str, tmp_path: Path
) -> None:
    file = described(hosts, platform, version, model, tmp_path)
    hosts.run(platform, "hostile", file, STEPS, cwd=tmp_path)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(("platform", "version"), ON)
def test_reading_and_setting_again_change_nothing(
    hosts: Hosts, platform: str, version: int, case: str, tmp_path: Path
) -> None:
    """Of two drives one is disturbed between the steps (``native_host/reads.c``)."""
    fmu = hosts.fmu(platform, version, CASES[case].model)
    settings = CASES[case].settings
    file = fmu.described(PLATFORMS[platform], tmp_path / "fmu.txt", settings)
    CASES[case].script().tofile(tmp_path / "script")
    hosts.run(platform, "reads", file, tmp_path / "script", cwd=tmp_path)


@pytest.mark.parametrize(("platform", "version"), ON)
def test_resources_are_found_from_the_library_where_the_named_folder_is_empty(
    hosts: Hosts, platform: str, version: int, tmp_path: Path
) -> None:
    case = next(case for case in CASES.values() if case.model == "AdaptivePLDF")
    empty = tmp_path / "empty"
    empty.mkdir()
    fmu = hosts.fmu(platform, version, case.model)
    file = fmu.described(PLATFORMS[platform], tmp_path / "fmu.txt", case.settings, resources=empty)
    case.script()[:2000].tofile(tmp_path / "script")
    hosts.run(platform, "reads", file, tmp_path / "script", cwd=tmp_path)


def test_fmi_2_and_fmi_3_in_one_process(hosts: Hosts, tmp_path: Path) -> None:
    here = PLATFORMS["linux64"]
    files = [
        hosts.fmu("linux64", version, "AdaptivePLDF").described(here, tmp_path / f"{version}.txt")
        for version in (2, 3)
    ]
    hosts.run("linux64", "versions", *files, cwd=tmp_path)


# Steps


@pytest.fixture(scope="module")
def quiet_host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a host that counts allocations and is killed at system calls."""
    program = tmp_path_factory.mktemp("quiet") / "host"
    compiled_host(PLATFORMS["linux64"], program, "quiet", "-rdynamic")
    return program


def quiet(program: Path, *arguments: str | Path) -> int:
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    if done.returncode == 77:
        missing("this system has no strict seccomp")
    assert not done.stderr
    return done.returncode


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", [2, 3])
def test_a_step_allocates_nothing_and_calls_no_system(
    hosts: Hosts, quiet_host: Path, version: int, model: str, tmp_path: Path
) -> None:
    file = described(hosts, "linux64", version, model, tmp_path)
    assert quiet(quiet_host, file, STEPS) == 0


def test_the_end_of_a_drive_calls_the_system(
    hosts: Hosts, quiet_host: Path, tmp_path: Path
) -> None:
    """What the test above sees if there is something to see."""
    fmu = hosts.fmu("linux64", 2, "AdaptivePLDF")
    settings = {"learn": 1, "profile_store": str(tmp_path)}
    file = fmu.described(PLATFORMS["linux64"], tmp_path / "fmu.txt", settings)
    assert quiet(quiet_host, file, STEPS, "end") == -signal.SIGKILL
