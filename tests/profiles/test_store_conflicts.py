"""Profile stores that several processes use: conflicts and locks."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from pldf.errors import ModelError
from pldf.files import disk
from pldf.files.disk import LOCK_NAME, folder_lock
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileStore,
    read_profile,
    write_profile,
)
from pldf.profiles.stored_profile import COLUMN_NAMES
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile
from stored import NAME, NOBODY_ELSE, content, load, needs_sigkill, saved_store, worker


def test_late_result_is_kept_in_a_file_of_its_own(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    loaded = load(profiles)
    profiles.append(loaded, drive_result(loaded, "first", 7))
    before = content(tmp_path)[NAME]
    for number in (1, 2):
        late = drive_result(loaded, f"late {number}", 8)
        with pytest.raises(ProfileConflict, match="changed by another process") as caught:
            profiles.append(loaded, late)
        assert str(caught.value.kept) in str(caught.value)
        assert caught.value.kept.name == NAME.replace(".pldf", f".conflict-{number}.pldf")
        assert encode(read_profile(caught.value.kept)) == encode(loaded.with_iteration(late))
    assert content(tmp_path)[NAME] == before


def test_two_first_drives_are_a_conflict_too(tmp_path: Path) -> None:
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    new = new_profile()
    profiles.append(new, drive_result(new, "one", 1))
    with pytest.raises(ProfileConflict):
        profiles.append(new, drive_result(new, "two", 2))


def test_a_history_of_equal_length_but_other_content_is_a_conflict(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path, 2)
    other = learned_profile(2).with_iteration(drive_result(learned_profile(2)))
    loaded = replace(load(profiles), iterations=other.iterations[:2])
    with pytest.raises(ProfileConflict):
        profiles.append(loaded, drive_result(loaded))


@pytest.mark.parametrize("array", COLUMN_NAMES)
def test_a_history_that_differs_in_one_number_is_a_conflict(tmp_path: Path, array: str) -> None:
    profiles = saved_store(tmp_path, 2)
    loaded = load(profiles)
    first = loaded.iterations[0]
    values = getattr(first, array).copy()
    values[-1] += 1.0 if values[-1] < 1.0 else -1.0
    changed = replace(
        loaded, iterations=(replace(first, **{array: values}), *loaded.iterations[1:])
    )
    with pytest.raises(ProfileConflict):
        profiles.append(changed, drive_result(changed))
    profiles.append(loaded, drive_result(loaded))


def test_two_processes_lose_no_drive(tmp_path: Path) -> None:
    drives = 25
    with worker("append", tmp_path, "a", drives) as a, worker("append", tmp_path, "b", drives) as b:
        outputs = race(a, b)
    main = [iteration.note for iteration in read_profile(tmp_path / NAME).iterations]
    late = [read_profile(tmp_path / name).iterations[-1].note for out in outputs for name in out]
    assert sorted(main + late) == sorted(f"{x}{n}" for x in "ab" for n in range(drives))
    assert len(content(tmp_path)) == 1 + len(late)


def test_two_processes_lose_no_rollback(tmp_path: Path) -> None:
    saved_store(tmp_path, 1)
    path = tmp_path / NAME
    with worker("rollback", path, 25) as a, worker("rollback", path, 25) as b:
        race(a, b)
    assert len(read_profile(path).iterations) == 51
    assert list(content(tmp_path)) == [NAME]


def race(*processes: subprocess.Popen[str]) -> list[list[str]]:
    for process in processes:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    for process in processes:
        assert process.stdin is not None
        process.stdin.write("go\n")
        process.stdin.flush()
    outputs = [process.communicate()[0].split() for process in processes]
    assert [process.returncode for process in processes] == [0] * len(processes)
    return outputs


@needs_sigkill
def test_lock_of_another_process_is_named_and_vanishes_with_it(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    with worker("hold", tmp_path) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "locked\n"
        for action in (
            lambda: profiles.append(profile, drive_result(profile)),
            lambda: profiles.rollback(DRIVER, ROUTE, 1),
            lambda: write_profile(tmp_path / NAME, profile, NOBODY_ELSE),
        ):
            with pytest.raises(ModelError, match="held by another process") as caught:
                action()
            assert str(tmp_path / LOCK_NAME) in str(caught.value)
        assert load(profiles).iterations[-1].number == 2  # reading needs no lock
        holder.kill()
        holder.wait()
        assert content(tmp_path) == {**before, LOCK_NAME: b""}
    profiles.append(profile, drive_result(profile))
    assert list(content(tmp_path)) == [NAME]


def test_lock_excludes_other_instances_in_the_same_process(tmp_path: Path) -> None:
    with folder_lock(tmp_path, NOBODY_ELSE):
        with pytest.raises(ModelError, match="held"), folder_lock(tmp_path, NOBODY_ELSE):
            pass
        assert (tmp_path / LOCK_NAME).exists()
    with folder_lock(tmp_path, NOBODY_ELSE):
        pass
    assert content(tmp_path) == {}


@pytest.mark.skipif(os.name == "nt", reason="Windows does not remove a file that is open")
def test_lock_on_a_file_that_its_last_holder_removed_does_not_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really_lock = disk._lock
    removals = iter(["gone", "gone and made anew by the next holder"])

    def lock_too_late(descriptor: int) -> None:
        really_lock(descriptor)
        for removal in removals:
            (tmp_path / LOCK_NAME).unlink()
            if "anew" in removal:
                (tmp_path / LOCK_NAME).write_bytes(b"")
            return

    monkeypatch.setattr(disk, "_lock", lock_too_late)
    for _ in range(2):
        with pytest.raises(ModelError, match="held"), folder_lock(tmp_path, NOBODY_ELSE):
            pass
    with folder_lock(tmp_path, NOBODY_ELSE):
        pass


needs_users = pytest.mark.skipif(
    os.name == "nt" or os.geteuid() != 0, reason="only root can try it as other users"
)
SOMEBODY = 12345


def as_user(user: int, umask: int, action: Callable[[], object]) -> str:
    """Do ``action`` in a process of ``user``; return its error."""
    read, write = os.pipe()
    if (child := os.fork()) == 0:
        try:
            os.setgroups([])
            os.setresgid(500, 500, 500)
            os.setresuid(user, user, user)
            os.umask(umask)
            action()
        except BaseException as error:
            os.write(write, str(error).encode())
        finally:
            os._exit(0)
    os.close(write)
    os.waitpid(child, 0)
    with os.fdopen(read) as told:
        return told.read()


@needs_users
def test_a_lock_that_cannot_be_opened_is_named_with_the_way_out() -> None:
    shared = Path("/tmp", f"pldf-shared-{os.getpid()}")
    shared.mkdir()
    try:
        shared.chmod(0o777)
        (shared / LOCK_NAME).touch(0o600)  # as release 0.2.0 may have left it
        new = new_profile()
        told = as_user(
            SOMEBODY,
            0o022,
            lambda: ProfileStore(shared, NOBODY_ELSE).append(new, drive_result(new)),
        )
        assert told.startswith(f"{shared / LOCK_NAME}: a lock that another user left")
        assert "delete it when no simulation uses this folder" in told
    finally:
        shutil.rmtree(shared)
