"""What the native driving function does to the disk, call by call, and the stack that it needs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from native_drives import CASES
from native_hosts import PLATFORMS, Hosts, compiled_host

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
if sys.platform != "linux":
    pytest.skip("the C host is tested on Linux", allow_module_level=True)

HERE = PLATFORMS["linux64"]
CASE = CASES["learn"]
NAME = "driver-000000_route-92a6126a3ee130f8.pldf"
LOCK = "pldf-store.lock"
# As docs/native.md promises; threads of Linux on ARM have no less than 128.
STACK_KB = {"linux64": 64, "win64": 64, "aarch64-linux": 128}
GUARD_S = 120.0  # ends a process that would wait for ever


@pytest.fixture(scope="module")
def recorded_host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a host that writes down what its FMU does to the disk."""
    program = tmp_path_factory.mktemp("recorded") / "host"
    compiled_host(HERE, program, "recorded", "-rdynamic")
    return program


def described(hosts: Hosts, store: Path, folder: Path) -> Path:
    fmu = hosts.fmu("linux64", 2, CASE.model)
    return fmu.described(HERE, folder / "fmu.txt", CASE.stored(str(store)))


def calls(host: Path, hosts: Hosts, store: Path, folder: Path, *more: str) -> list[str]:
    """Return what the FMU does in a first drive with this store, paths from ``folder`` on."""
    file = described(hosts, store, folder)
    done = subprocess.run(
        [host, file, folder / "calls", *more], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    text = (folder / "calls").read_text()
    return text.replace(f" {folder}/", " ").replace(f" {folder}\n", " .\n").splitlines()


def test_what_was_saved_lasts_through_a_power_cut(
    recorded_host: Path, hosts: Hosts, tmp_path: Path
) -> None:
    """Data before the name, names of new folders and files through their folder."""
    assert calls(recorded_host, hosts, tmp_path / "a" / "b", tmp_path) == [
        f"flock {LOCK}",  # before the drive: could it be saved?
        f"unlink {LOCK}",
        "mkdir a",
        "fsync .",
        "mkdir a/b",
        "fsync a",
        f"flock a/b/{LOCK}",
        f"fsync a/b/{NAME}.tmp",
        f"rename a/b/{NAME}",
        "fsync a/b",
        f"unlink a/b/{LOCK}",
    ]


@pytest.mark.parametrize("how", ["steal", "replace"])
def test_a_lock_on_a_file_that_its_last_holder_removed_does_not_count(
    recorded_host: Path, hosts: Hosts, tmp_path: Path, how: str
) -> None:
    """Whether or not there is another file in its place."""
    found = calls(recorded_host, hosts, tmp_path, tmp_path, how)
    locking = [call for call in found if LOCK in call]
    assert locking == [
        f"unlink {LOCK}",
        f"flock {LOCK} (deleted)",
        f"flock {LOCK}",
        f"unlink {LOCK}",
    ]
    assert found.index(f"rename {NAME}") > found.index(f"flock {LOCK}")


def test_a_pipe_in_the_place_of_the_profile_does_not_hang(hosts: Hosts, tmp_path: Path) -> None:
    """It is refused like any other file that is no profile, and kept aside."""
    store = tmp_path / "store"
    store.mkdir()
    os.mkfifo(store / NAME)
    CASE.script()[:100].tofile(tmp_path / "script")
    file = described(hosts, store, tmp_path)
    process = hosts.start("linux64", "replay", file, tmp_path / "script", "out", cwd=tmp_path)
    try:
        process.wait(GUARD_S)
    finally:
        process.kill()
    hosts.end(process)
    assert sorted(path.name for path in store.iterdir()) == [NAME, f"{NAME}.refused-1"]
    assert (store / f"{NAME}.refused-1").is_fifo()


# Stack


def with_stack(
    hosts: Hosts, platform: str, folder: Path, kilobytes: int
) -> subprocess.Popen[bytes]:
    """Start a drive that learns, in a thread with this stack."""
    where = PLATFORMS[platform]
    fmu = hosts.fmu(platform, where.versions[-1], CASE.model)
    settings = CASE.stored(where.path(folder / ("store" * 20)))
    file = fmu.described(where, folder / "fmu.txt", settings)
    CASE.script()[:500].tofile(folder / "script")
    return hosts.start(platform, "stack", file, folder / "script", str(kilobytes), cwd=folder)


@pytest.mark.parametrize("platform", PLATFORMS)
def test_a_whole_drive_fits_into_a_little_stack(
    hosts: Hosts, platform: str, tmp_path: Path
) -> None:
    """From instantiation to Terminate with learning, saving and a long warning."""
    for _ in range(2):
        hosts.end(with_stack(hosts, platform, tmp_path, STACK_KB[platform]))
    *beside, profile = sorted((tmp_path / ("store" * 20)).iterdir())
    assert [b"iteration 2 " in path.read_bytes() for path in beside] == [False, True]
    assert b"iteration 2 " in profile.read_bytes()


def test_a_drive_does_not_fit_into_less(hosts: Hosts, tmp_path: Path) -> None:
    """What the test above sees if there is something to see."""
    process = with_stack(hosts, "linux64", tmp_path, 20)
    process.communicate()
    assert process.returncode == -signal.SIGSEGV
