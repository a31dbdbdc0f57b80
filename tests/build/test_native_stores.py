"""The profile store of the native driving function, without Python and on every platform."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmi_host import Host, Slave
from native_drives import CASES, by_source
from native_hosts import PLATFORMS, Hosts
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.stored_profile import COLUMN_NAMES

CASE = CASES["learn"]
SCRIPT = CASE.script()[:1500]
FOLDER_MAX = 3999  # bytes: names in a store, and what is added to them, must fit into 4095
KEPT_MAX = 9999
REFUSED = 2  # profile status


class Drives:
    """Drives on one platform with one store, which is not there yet."""

    def __init__(self, hosts: Hosts, platform: str, tmp_path: Path) -> None:
        self.hosts, self.platform, self.folder = hosts, platform, tmp_path
        self.script = tmp_path / "script"
        SCRIPT.tofile(self.script)
        self.describe(tmp_path / "Fahrer Ж 車" / "neu")

    def describe(self, store: Path) -> None:
        """Say that this is the store."""
        where = PLATFORMS[self.platform]
        fmu = self.hosts.fmu(self.platform, where.versions[-1], CASE.model)
        settings = CASE.stored(where.path(store))
        self.store = store
        self.description = fmu.described(where, self.folder / "fmu.txt", settings)

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
OLDER = f"driver-000000_route-{'f' * 16}.pldf"


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


def test_a_profile_of_an_older_reading_is_told_and_left_alone(
    drives: Drives, learned: tuple[bytes, bytes]
) -> None:
    """In a folder with letters beyond ASCII; what is learned now gets a file of its own."""
    _, profile = learned
    older = encode(replace(decode(profile, NAME), route="f" * 16))
    drives.store.mkdir(parents=True)
    (drives.store / OLDER).write_bytes(older)
    results = drives.folder / "results"
    process = drives.hosts.start(
        drives.platform, "replay", drives.description, drives.script, results, cwd=drives.folder
    )
    told = process.communicate()[1].decode(errors="replace")
    assert process.returncode == 0
    assert "was probably learned on an older reading of this road (100 of 100 m" in told
    assert f"/{OLDER} --route ROAD" in told.replace("\\", "/")
    assert drives.profiles() == {".pldf": profile, OLDER: older}


def test_a_profile_of_release_0_2_0_is_upgraded(
    drives: Drives, learned: tuple[bytes, bytes], tmp_path: Path
) -> None:
    """By the next write, as Python does it; a rollback is known by its note."""
    old = encode_1(decode(learned[1], NAME).rolled_back(0))
    expected = continued(tmp_path / "python", old)
    assert expected.startswith(b"PLDF-PROFILE 2\n")
    kinds = [iteration.kind for iteration in decode(expected, NAME).iterations]
    assert kinds == ["drive", "rollback", "drive"]
    drives.store.mkdir(parents=True)
    (drives.store / f"{NAME}.pldf").write_bytes(old)
    drives.drive()
    assert drives.profiles() == {".pldf": expected}


def test_evidence_survives_a_drive(
    drives: Drives, learned: tuple[bytes, bytes], tmp_path: Path
) -> None:
    """Evidence and pending demonstrations, to the bit, where the drive taught nothing."""
    profile = decode(learned[1], NAME)
    random = np.random.default_rng(7)
    columns = {
        name: random.integers(0, 3, profile.nodes).astype(float)
        for name in COLUMN_NAMES
        if "evidence" in name or "pending" in name
    }
    assert len(columns) == 12
    filled = profile.with_iteration(profile.next_iteration("learn", "filled", 0, columns))
    expected = continued(tmp_path / "python", encode(filled))
    newest = decode(expected, NAME).iteration()
    assert newest.number == 3
    untaught = newest.drive < 3
    assert 100 < np.sum(untaught) < profile.nodes
    for name, values in columns.items():
        if not name.startswith("offset"):
            np.testing.assert_array_equal(getattr(newest, name)[untaught], values[untaught])
    drives.store.mkdir(parents=True)
    (drives.store / f"{NAME}.pldf").write_bytes(encode(filled))
    drives.drive()
    assert drives.profiles() == {".pldf": expected}


def continued(store: Path, profile: bytes) -> bytes:
    """Return what the source makes of a profile in one more drive."""
    store.mkdir()
    (store / f"{NAME}.pldf").write_bytes(profile)
    by_source(CASE, SCRIPT, store)
    (path,) = store.iterdir()
    return path.read_bytes()


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


def test_a_store_below_a_long_path(drives: Drives, learned: tuple[bytes, bytes]) -> None:
    """Longer than the 260 characters that Windows takes without ado."""
    drives.describe(drives.folder / ("Ж" * 120) / ("n" * 200))
    assert drives.drive() == [learned[0]]
    assert drives.profiles() == {".pldf": learned[1]}


def test_a_store_whose_path_is_no_text(hosts: Hosts, tmp_path: Path) -> None:
    """On Windows, whose paths are text; the drive goes on."""
    drives = Drives(hosts, "win64", tmp_path)
    drives.describe(Path("STORE"))
    described = drives.description.read_bytes()
    drives.description.write_bytes(described.replace(b"Z:STORE", b"Z:\\\xff"))
    (found,) = drives.drive()
    names = [v.name for v in hosts.fmu("win64", 3, CASE.model).variables("output")]
    assert np.frombuffer(found)[names.index("profile.status")] == REFUSED


# Here only


@pytest.fixture
def damaged(tmp_path: Path) -> Path:
    """Return a store with a profile that is not sound."""
    (tmp_path / f"{NAME}.pldf").write_bytes(b"damaged")
    return tmp_path


def started(native_folder: Path, store: Path | str) -> Slave:
    host = Host(native_folder / "AdaptivePLDF.fmu")
    return host.instantiate().start(profile_store=str(store), learn=True)


def ended(slave: Slave) -> None:
    for second in range(3):
        slave.set(vehicle__s_m=20.0 * second, vehicle__speed_mps=20.0)
        slave.fmu.doStep(float(second), 1.0)
    slave.fmu.terminate()


def folder_of_length(top: Path, length: int) -> Path:
    """Return a folder whose path has this many bytes."""
    name = "n" * 99
    count, rest = divmod(length - len(str(top)), len(name) + 1)
    return Path(str(top) + f"/{name}" * (count - 1), "n" * (len(name) + rest))


def test_a_store_with_the_longest_path(native_folder: Path, tmp_path: Path) -> None:
    store = folder_of_length(tmp_path, FOLDER_MAX)
    store.mkdir(parents=True)
    for number in (1, 2):
        (store / f"{NAME}.pldf").write_bytes(b"damaged")
        slave = started(native_folder, store)
        assert f".refused-{number}" in slave.texts("logStatusWarning")[0]
        ended(slave)
        assert not slave.texts()
        slave.free()


def test_a_store_with_a_path_that_is_too_long(native_folder: Path, tmp_path: Path) -> None:
    store = folder_of_length(tmp_path, FOLDER_MAX + 1)
    slave = started(native_folder, store)
    assert slave.get("profile.status") == REFUSED
    (text,) = slave.texts("logStatusWarning")
    assert f"{FOLDER_MAX + 1} bytes" in text
    ended(slave)
    assert not list(tmp_path.iterdir())
    slave.free()


def test_a_damaged_profile_that_cannot_be_renamed_stays(native_folder: Path, damaged: Path) -> None:
    """Here since there is no name left for it."""
    for number in range(1, KEPT_MAX + 1):
        (damaged / f"{NAME}.pldf.refused-{number}").symlink_to("nothing")
    before = sorted(damaged.iterdir())
    slave = started(native_folder, damaged)
    assert slave.get("profile.status") == REFUSED
    reason = f"{KEPT_MAX} files"
    assert "left in its place" in (text := slave.texts("logStatusWarning")[0]) and reason in text
    ended(slave)
    (text,) = slave.texts()
    assert (
        text.startswith("profile not saved: ")
        and "what was there is unchanged" in text
        and reason in text
    )
    assert sorted(damaged.iterdir()) == before
    assert (damaged / f"{NAME}.pldf").read_bytes() == b"damaged"
    slave.free()


def test_a_backslash_separates_nothing_on_posix(native_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "C:").touch()
    store = tmp_path / "C:\\users\\profiles"
    slave = started(native_folder, store)
    assert not slave.texts("logStatusWarning")
    ended(slave)
    assert sorted(tmp_path.iterdir()) == [tmp_path / "C:", store]
    assert [path.name for path in store.iterdir()] == [f"{NAME}.pldf"]
    slave.free()
