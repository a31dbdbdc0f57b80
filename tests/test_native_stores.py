"""The profile store of the native driving function, without Python and on every platform."""

from __future__ import annotations

from pathlib import Path

import pytest
from native_drives import CASES, by_source
from native_hosts import PLATFORMS, Hosts
from pldf.profile_file import decode

CASE = CASES["learn"]
SCRIPT = CASE.script()[:1500]


class Drives:
    """Drives on one platform with one store, which is not there yet."""

    def __init__(self, hosts: Hosts, platform: str, tmp_path: Path) -> None:
        self.hosts, self.platform, self.folder = hosts, platform, tmp_path
        self.store = tmp_path / "Fahrer Ж 車" / "neu"
        where = PLATFORMS[platform]
        settings = CASE.stored(where.path(self.store))
        fmu = hosts.fmu(platform, where.versions[-1], CASE.model)
        self.description = fmu.described(where, tmp_path / "fmu.txt", settings)
        self.script = tmp_path / "script"
        SCRIPT.tofile(self.script)

    def drive(self, processes: int = 1, instances: int = 1) -> list[bytes]:
        """Drive in several processes at once, with instances side by side; return all results."""
        each = [[self.folder / f"{p}-{i}" for i in range(instances)] for p in range(processes)]
        running = [
            self.hosts.start(
                self.platform, "replay", self.description, self.script, *found, cwd=self.folder
            )
            for found in each
        ]
        for process in running:
            self.hosts.end(process)
        return [path.read_bytes() for found in each for path in found]

    def profiles(self) -> dict[str, bytes]:
        """Return the files in the store by their name behind that of the driver's profile."""
        names = {path: path.name.removeprefix(NAME) for path in self.store.iterdir()}
        return {name: path.read_bytes() for path, name in names.items()}


NAME = "driver-000000_route-92a6126a3ee130f8"


@pytest.fixture(params=PLATFORMS)
def drives(request: pytest.FixtureRequest, hosts: Hosts, tmp_path: Path) -> Drives:
    return Drives(hosts, request.param, tmp_path)


@pytest.fixture(scope="module")
def learned(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    """Return what the source says in a first drive, and the profile that it leaves."""
    store = tmp_path_factory.mktemp("learned")
    results = by_source(CASE, SCRIPT, store)
    (path,) = store.iterdir()
    return results.tobytes(), path.read_bytes()


def test_what_was_learned_beside_another_drive_is_kept_beside_its_profile(
    drives: Drives, learned: tuple[bytes, bytes]
) -> None:
    results, profile = learned
    assert drives.drive(instances=3) == [results] * 3
    kept = {f".conflict-{n}.pldf": profile for n in (1, 2)}
    assert drives.profiles() == {".pldf": profile, **kept}


@pytest.mark.parametrize("damage", ["truncated", "flipped", "empty"])
def test_a_damaged_profile_is_kept_aside(
    drives: Drives, learned: tuple[bytes, bytes], damage: str
) -> None:
    results, profile = learned
    flipped = profile[:900] + bytes([profile[900] ^ 1]) + profile[901:]
    bad = {"truncated": profile[:-9], "flipped": flipped, "empty": b""}[damage]
    drives.store.mkdir(parents=True)
    (drives.store / f"{NAME}.pldf").write_bytes(bad)
    (found,) = drives.drive()
    assert len(found) == len(results)
    assert drives.profiles() == {".pldf": profile, ".pldf.refused-1": bad}


def test_processes_that_end_together_lose_nothing(drives: Drives) -> None:
    """Every drive continues the profile or is kept beside it; no half of a file, no lock stays."""
    drives.drive(processes=4)
    profiles = drives.profiles()
    saved = {name: len(decode(data, name).iterations) for name, data in profiles.items()}
    assert saved[".pldf"] + len(saved) - 1 == 4
