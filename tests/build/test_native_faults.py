"""The native driving function when the disk fails: nothing is touched, nothing learned is lost."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import pytest
from fmi_host import Host, Slave
from native_saves import LOST, NAME, SHORT, Fault, NativeSaves
from pldf.kernel.codes import PROFILE_STATUS
from pldf.profiles.profile_file import decode

if sys.platform != "linux":
    pytest.skip("the C host is tested on Linux", allow_module_level=True)

READ_ERRORS = [errno.EMFILE, errno.EIO, errno.ENOMEM, errno.EACCES]
CONFLICT = NAME.replace(".pldf", ".conflict-1.pldf")
AT_START, AT_END = 1, 2  # of the two times at which the profile is opened


@pytest.fixture(scope="module")
def saves(native_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> NativeSaves:
    return NativeSaves(native_folder, 2, tmp_path_factory.mktemp("saves") / "two")


def content(store: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in store.iterdir()}


def iterations(data: bytes) -> int:
    return len(decode(data, NAME).iterations)


@pytest.mark.parametrize("number", READ_ERRORS, ids=os.strerror)
def test_what_cannot_be_read_at_the_end_is_not_touched_and_the_lesson_kept(
    saves: NativeSaves, tmp_path: Path, number: int
) -> None:
    assert LOST not in saves.drive(tmp_path)
    before = content(tmp_path)
    assert LOST not in saves.drive(tmp_path, Fault("open", AT_END, number))
    after = content(tmp_path)
    assert iterations(after.pop(CONFLICT)) == 2
    assert after == before


@pytest.mark.parametrize("number", READ_ERRORS, ids=os.strerror)
def test_what_cannot_be_read_at_the_start_is_compared_at_the_end(
    saves: NativeSaves, tmp_path: Path, number: int
) -> None:
    """So a lesson upon the base profile stands beside the history."""
    assert LOST not in saves.drive(tmp_path)
    before = content(tmp_path)
    assert LOST not in saves.drive(tmp_path, Fault("open", AT_START, number))
    after = content(tmp_path)
    assert after.pop(CONFLICT) == before[NAME]  # the first drive once more
    assert after == before


def test_a_read_that_fails_in_the_middle_is_no_damage_and_a_short_one_goes_on(
    saves: NativeSaves, tmp_path: Path
) -> None:
    assert LOST not in saves.drive(tmp_path)
    assert LOST not in saves.drive(tmp_path, Fault("read", 1, SHORT))
    before = content(tmp_path)
    assert iterations(before[NAME]) == 2
    assert LOST not in saves.drive(tmp_path, Fault("read", 4, errno.EIO))
    after = content(tmp_path)
    assert iterations(after.pop(CONFLICT)) == 3
    assert after == before


def test_a_bad_file_gets_its_name_back_if_the_write_fails(
    saves: NativeSaves, tmp_path: Path
) -> None:
    """At the start nobody could read it, so it is still there at the end."""
    bad = {NAME: b"bad"}
    (tmp_path / NAME).write_bytes(b"bad")
    unread, full = Fault("open", AT_START, errno.EIO), Fault("rename", 2, errno.ENOSPC)
    assert LOST in (told := saves.drive(tmp_path, unread, full))
    assert "unchanged" in told
    assert content(tmp_path) == bad
    still = Fault("rename", 3, errno.EIO)
    told = saves.drive(tmp_path, unread, full, still)
    assert LOST in told and f"what was there is now {tmp_path}/{NAME}.refused-1" in told
    assert content(tmp_path) == {f"{NAME}.refused-1": b"bad"}


def started(native_folder: Path, store: Path, learn: bool = True) -> tuple[str, list[str], Slave]:
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate()
    slave.start(profile_store=str(store), learn=learn)
    status = PROFILE_STATUS.items[slave.get("profile.status")]
    return status, slave.texts("logStatusWarning"), slave


def test_an_unwritable_store_is_told_before_the_drive(native_folder: Path, tmp_path: Path) -> None:
    status, told, slave = started(native_folder, tmp_path / "new" / "store")
    assert (status, told) == ("BASE", [])
    slave.free()
    assert not list(tmp_path.iterdir())
    store = Path("/proc/self/attr")  # where nobody can make a file, not even root
    status, (text,), slave = started(native_folder, store)
    assert status == "NOT_WRITABLE"
    assert text.startswith(
        f"what this drive teaches cannot be saved: {store}: cannot be written to"
    )
    slave.free()
    status, told, slave = started(native_folder, store, learn=False)
    assert (status, told) == ("BASE", [])
    slave.free()


def test_a_link_is_followed_and_a_late_lesson_kept_beside_its_file(
    saves: NativeSaves, tmp_path: Path
) -> None:
    store, real = tmp_path / "store", tmp_path / "real"
    for folder in (store, real):
        folder.mkdir()
    (store / NAME).symlink_to(os.path.join("..", "real", "of_anna"))
    for number in (1, 2):
        assert LOST not in saves.drive(store)
        assert [path.name for path in real.iterdir()] == ["of_anna"]
        assert iterations((real / "of_anna").read_bytes()) == number
    assert LOST not in saves.drive(store, Fault("open", AT_END, errno.EIO, "of_anna"))
    assert sorted(content(real)) == ["of_anna", "of_anna.conflict-1.pldf"]
    (real / "of_anna").write_bytes(b"bad")
    assert LOST not in saves.drive(store)
    assert content(real)["of_anna.refused-1"] == b"bad"
    assert iterations((real / "of_anna").read_bytes()) == 1
    assert [path.name for path in store.iterdir()] == [NAME]
    assert (store / NAME).is_symlink()


@pytest.mark.skipif(os.geteuid() != 0, reason="needs to become another user")
@pytest.mark.parametrize(("mode", "files"), [(0o644, 1), (0o600, 0)], ids=["readable", "closed"])
def test_a_left_over_lock_of_another_user(
    native_folder: Path, tmp_path_factory: pytest.TempPathFactory, mode: int, files: int
) -> None:
    """It blocks nobody who can open it; else it is named with the way out."""
    import tempfile  # noqa: PLC0415 - pytest's folders are closed to others

    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        store = Path(folder)
        lock = store / "pldf-store.lock"
        _, _, slave = started(native_folder, store)
        slave.set(vehicle__s_m=20.0, vehicle__speed_mps=20.0)
        slave.fmu.doStep(0.0, 1.0)
        slave.set(vehicle__s_m=40.0)
        slave.fmu.doStep(1.0, 1.0)
        lock.touch()
        lock.chmod(mode)
        os.seteuid(12345)
        try:
            slave.status("terminate")
        finally:
            os.seteuid(0)
        assert len(list(store.glob("*.pldf"))) == files
        if not files:
            (text,) = slave.texts()
            assert str(store) in text and "another user left pldf-store.lock" in text
            assert "delete it when" in text
        slave.free()
