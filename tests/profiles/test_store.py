"""The profile store on a real disk, with real processes."""

from __future__ import annotations

import errno
import os
import random
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.files import disk
from pldf.files.disk import LOCK_NAME, folder_lock
from pldf.instance import ModelError
from pldf.profiles import store
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileRefused,
    ProfileStore,
    StoredProfile,
    read_profile,
    rollback_profile,
    write_profile,
)
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile

NAME = f"driver-000017_route-{ROUTE}.pldf"
WORKER = Path(__file__).parents[1] / "support" / "store_worker.py"
NOBODY_ELSE = 0.0  # lock timeout where nobody else can hold the lock
needs_sigkill = pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")


@contextmanager
def worker(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, str(WORKER), *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            yield process
        finally:
            process.kill()


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def saved_store(folder: Path, drives: int = 2) -> ProfileStore:
    profiles = ProfileStore(folder, NOBODY_ELSE)
    profile = new_profile()
    for seed in range(drives):
        profile = profiles.append(profile, drive_result(profile, f"drive {seed}", seed)).profile
    return profiles


def load(profiles: ProfileStore) -> StoredProfile:
    profile = profiles.load(DRIVER, ROUTE, 11)
    assert profile is not None
    return profile


def test_missing_folder_means_no_profile_and_is_made_with_its_parents(tmp_path: Path) -> None:
    profiles = ProfileStore(tmp_path / "a" / "b", NOBODY_ELSE)
    assert profiles.load(DRIVER, ROUTE, 11) is None
    assert profiles.files() == []
    assert not (tmp_path / "a").exists()
    saved = profiles.append(new_profile(), drive_result(new_profile()))
    assert saved.path == tmp_path / "a" / "b" / NAME
    assert saved.warning == ""
    assert list(content(tmp_path / "a" / "b")) == [NAME]


def test_every_iteration_is_kept_to_the_bit(tmp_path: Path) -> None:
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    expected = new_profile()
    for seed in range(5):
        profile = profiles.load(DRIVER, ROUTE, 11) or new_profile()
        result = drive_result(profile, f"drive {seed}", seed)
        profiles.append(profile, result)
        expected = expected.with_iteration(result)
    assert content(tmp_path) == {NAME: encode(expected)}
    assert encode(load(profiles)) == encode(expected)


def test_relative_folder_survives_a_change_of_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    profiles = ProfileStore("profiles", NOBODY_ELSE)
    monkeypatch.chdir("/")
    profiles.append(new_profile(), drive_result(new_profile()))
    assert list(content(tmp_path / "profiles")) == [NAME]


def test_files_of_drivers_and_routes(tmp_path: Path) -> None:
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    for driver_id, route in ((2, "a" * 16), (1, "b" * 16), (1, "a" * 16), (1234567, "c" * 16)):
        new = new_profile(driver_id=driver_id, route=route)
        profiles.append(new, drive_result(new))
    late = new_profile(driver_id=1, route="a" * 16)
    with pytest.raises(ProfileConflict):
        profiles.append(late, drive_result(late))
    assert [path.name for path in profiles.files()] == [
        f"driver-000001_route-{'a' * 16}.conflict-1.pldf",
        f"driver-000001_route-{'a' * 16}.pldf",
        f"driver-000001_route-{'b' * 16}.pldf",
        f"driver-000002_route-{'a' * 16}.pldf",
        f"driver-1234567_route-{'c' * 16}.pldf",
    ]
    assert profiles.files_of(1) == [profiles.path(1, "a" * 16), profiles.path(1, "b" * 16)]
    assert profiles.files_of(3) == []


def test_base_may_be_planned_anew(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    profile = load(profiles)
    faster = replace(profile, base_mps=profile.base_mps + 0.5)
    profiles.append(faster, drive_result(faster))
    again = load(profiles)
    assert len(again.iterations) == 3
    assert np.array_equal(again.base_mps, faster.base_mps)


# Files that cannot be used


def bad_files() -> dict[str, tuple[bytes, str]]:
    good = encode(learned_profile())
    return {
        "empty": (b"", "line 1: truncated"),
        "foreign": (b"<OpenDRIVE/>\n", "line 1: not a profile file"),
        "newer": (good.replace(b"FILE 1", b"FILE 2", 1), "line 1: format 2 of a newer version"),
        "truncated": (good[:-1], r"byte \d+: truncated"),
        "corrupt": (good[:200] + b"\xff" + good[201:], r"byte \d+: damaged: checksum"),
        "other route": (encode(new_profile(route="f" * 16)), "line 3: learned on another route"),
        "other driver": (encode(new_profile(driver_id=3)), "line 2: profile of driver 3, not"),
        "other length": (encode(new_profile(nodes=12)), "line 4: 12 nodes, but the route has 11"),
    }


@pytest.mark.parametrize("kind", bad_files())
def test_bad_file_is_kept_aside_and_survives_the_next_saves(tmp_path: Path, kind: str) -> None:
    data, reason = bad_files()[kind]
    (tmp_path / NAME).write_bytes(data)
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    with pytest.raises(ProfileRefused) as caught:
        profiles.load(DRIVER, ROUTE, 11)
    text = str(caught.value)
    assert re.match(re.escape(str(tmp_path / NAME)) + ", " + reason, text)
    assert text.endswith(f"; kept as {NAME}.refused-1; the drive goes on with the base profile")
    assert content(tmp_path) == {f"{NAME}.refused-1": data}
    assert profiles.refused() == [tmp_path / f"{NAME}.refused-1"]

    assert profiles.load(DRIVER, ROUTE, 11) is None
    saved = profiles.append(new_profile(), drive_result(new_profile()))
    assert saved.warning == ""
    assert content(tmp_path)[f"{NAME}.refused-1"] == data
    assert len(load(profiles).iterations) == 1


def test_bad_files_do_not_overwrite_each_other(tmp_path: Path) -> None:
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    for number in range(1, 4):
        (tmp_path / NAME).write_bytes(b"bad %d" % number)
        with pytest.raises(ProfileRefused, match=f"kept as {NAME}.refused-{number};"):
            profiles.load(DRIVER, ROUTE, 11)
    assert content(tmp_path) == {f"{NAME}.refused-{n}": b"bad %d" % n for n in (1, 2, 3)}


def test_file_that_went_bad_during_the_drive_is_kept_aside_too(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    profile = load(profiles)
    (tmp_path / NAME).write_bytes(b"bad")
    saved = profiles.append(profile, drive_result(profile))
    assert "not a profile file" in saved.warning
    assert f"kept as {NAME}.refused-1, a new profile took its place" in saved.warning
    assert content(tmp_path)[f"{NAME}.refused-1"] == b"bad"
    assert len(load(profiles).iterations) == 3


@pytest.mark.parametrize("make", [os.mkdir, pytest.param(getattr(os, "mkfifo", None))])
def test_what_is_no_regular_file_is_refused_without_waiting_for_it(
    tmp_path: Path, make: Callable[[Path], None] | None
) -> None:
    if make is None:
        pytest.skip("this system has no named pipes")
    make(tmp_path / NAME)
    with pytest.raises(ProfileRefused, match=r"cannot be read \(not a regular file\); kept as"):
        ProfileStore(tmp_path, NOBODY_ELSE).load(DRIVER, ROUTE, 11)


def test_huge_file_is_refused_without_reading_it(tmp_path: Path) -> None:
    with open(tmp_path / NAME, "wb") as file:
        file.truncate((1 << 32) + 1)  # takes no space where files may have holes
    with pytest.raises(ProfileRefused, match="longer than 4294967296 bytes"):
        read_profile(tmp_path / NAME)


def test_bad_file_stays_in_place_when_it_cannot_be_renamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / NAME).write_bytes(b"bad")
    profiles = ProfileStore(tmp_path, NOBODY_ELSE)
    with folder_lock(tmp_path, NOBODY_ELSE), pytest.raises(ProfileRefused) as caught:
        profiles.load(DRIVER, ROUTE, 11)
    assert "left in its place" in str(caught.value)
    assert LOCK_NAME in str(caught.value)
    monkeypatch.setattr(os, "replace", failing(errno.EROFS))
    with pytest.raises(ProfileRefused, match=r"left in its place \(Read-only file system\)"):
        profiles.load(DRIVER, ROUTE, 11)
    with pytest.raises(ModelError, match="cannot be saved"):
        profiles.append(new_profile(), drive_result(new_profile()))
    assert content(tmp_path) == {NAME: b"bad"}


def test_bad_file_that_another_process_replaced_meanwhile_is_not_put_aside(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / NAME).write_bytes(b"bad")

    @contextmanager
    def lock_after_the_other(folder: Path, timeout_s: float) -> Iterator[None]:
        with folder_lock(folder, timeout_s):
            (tmp_path / NAME).write_bytes(encode(learned_profile()))
            yield

    monkeypatch.setattr(store, "folder_lock", lock_after_the_other)
    assert len(load(ProfileStore(tmp_path)).iterations) == 2
    assert list(content(tmp_path)) == [NAME]


def test_read_profile_leaves_everything_as_it_is(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no such profile file"):
        read_profile(tmp_path / "missing" / NAME)
    (tmp_path / NAME).write_bytes(b"bad")
    with pytest.raises(ProfileRefused, match="not a profile file"):
        read_profile(tmp_path / NAME)
    assert content(tmp_path) == {NAME: b"bad"}


# Conflicts and locks


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


@pytest.mark.parametrize("array", ["learned_mps", "offset_mps", "drive", "intervention"])
def test_a_history_that_differs_in_one_number_is_a_conflict(tmp_path: Path, array: str) -> None:
    profiles = saved_store(tmp_path, 2)
    loaded = load(profiles)
    first = loaded.iterations[0]
    values = getattr(first, array).copy()
    values[-1] += 1.0
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


# Saving that fails or is killed


def failing(number: int) -> Callable[..., None]:
    def fail(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    return fail


@pytest.mark.parametrize("call", ["fsync", "replace"])
@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EACCES], ids=os.strerror)
def test_failed_save_changes_nothing_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, number: int
) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    monkeypatch.setattr(os, call, failing(number))
    for action in (
        lambda: profiles.append(profile, drive_result(profile)),
        lambda: profiles.rollback(DRIVER, ROUTE, 0),
        lambda: write_profile(tmp_path / NAME, new_profile()),
    ):
        with pytest.raises(ModelError) as caught:
            action()
        assert str(tmp_path / NAME) in str(caught.value)
        assert f"cannot be saved ({os.strerror(number)})" in str(caught.value)
        assert "choose another folder" in str(caught.value)
        assert content(tmp_path) == before


def test_write_that_breaks_off_in_the_middle(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource", reason="no limits of file sizes on this system")
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with pytest.raises(ModelError, match=r"cannot be saved \(File too large\)"):
            profiles.append(profile, drive_result(profile))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert content(tmp_path) == before


def test_folder_that_cannot_be_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    monkeypatch.setattr(os, "open", failing(errno.EROFS))  # the lock file cannot be made
    assert len(load(profiles).iterations) == 2
    with pytest.raises(ModelError, match=r"cannot be saved \(Read-only file system\)"):
        profiles.append(profile, drive_result(profile))
    assert content(tmp_path) == before


def test_file_where_the_folder_should_be(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("something else")
    for folder in (tmp_path / "file", tmp_path / "file" / "deeper"):
        profiles = ProfileStore(folder, NOBODY_ELSE)
        with pytest.raises(ModelError, match="file: not a folder; choose another profile store"):
            profiles.load(DRIVER, ROUTE, 11)
        with pytest.raises(ModelError, match=r"cannot be saved.*choose another folder"):
            profiles.append(new_profile(), drive_result(new_profile()))
    assert (tmp_path / "file").read_text() == "something else"


def test_unsound_result_is_not_saved(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    profile = load(profiles)
    result = drive_result(profile)
    result.learned_mps[4] = np.nan
    with pytest.raises(ModelError, match="learned_mps of iteration 3 is nan at 4 m"):
        profiles.append(profile, result)
    assert content(tmp_path) == before


def test_short_sharing_violations_are_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really_replace = os.replace
    refusals = iter([PermissionError(errno.EACCES, "in use")] * 2)

    def refuse_twice(source: Path, target: Path) -> None:
        for refusal in refusals:
            raise refusal
        really_replace(source, target)

    monkeypatch.setattr(disk, "_TRIES", 3)
    monkeypatch.setattr(disk, "_RETRY_S", 0.0)
    monkeypatch.setattr(os, "replace", refuse_twice)
    assert len(load(saved_store(tmp_path)).iterations) == 2


@needs_sigkill
def test_kill_before_any_step_of_saving_leaves_the_old_or_the_new_profile(tmp_path: Path) -> None:
    folder = tmp_path / "store"
    profiles = saved_store(folder, 1)
    known, step, saved = 1, 0, False
    while not saved:
        with worker("crash", folder, step) as process:
            saved = process.communicate()[0] == "saved\n"
        number = len(load(profiles).iterations)
        assert known <= number <= known + 1
        assert set(content(folder)) <= {NAME, NAME + ".tmp", LOCK_NAME}
        known, step = number, step + 1
    assert step > 6  # lock, look, write, flush, replace, flush the folder, unlock
    assert list(content(folder)) == [NAME]


@needs_sigkill
def test_kill_at_any_time_leaves_the_old_or_the_new_profile(tmp_path: Path) -> None:
    path = tmp_path / NAME
    possible = [encode(learned_profile(iterations, nodes=20_000)) for iterations in (1, 2)]
    delays = random.Random(7)
    for _ in range(40):
        with worker("overwrite", path) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            with pytest.raises(subprocess.TimeoutExpired):
                process.wait(delays.uniform(0.0, 0.02))
            process.kill()
        assert encode(read_profile(path)) in possible
        assert set(content(tmp_path)) <= {NAME, NAME + ".tmp", LOCK_NAME}
    write_profile(path, new_profile())
    assert content(tmp_path) == {NAME: encode(new_profile())}


# Single files and rollback


def test_write_profile_replaces_profiles_only(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "P2.pldf"
    for profile in (new_profile(), learned_profile(), new_profile(driver_id=3)):
        write_profile(path, profile)
        assert content(path.parent) == {"P2.pldf": encode(profile)}
    for other in (tmp_path / "road.csv", tmp_path / "deep"):
        if not other.exists():
            other.write_text("s_m\n")
        with pytest.raises(ProfileRefused, match="not overwritten, choose another file"):
            write_profile(other, new_profile())
    assert (tmp_path / "road.csv").read_text() == "s_m\n"
    assert (tmp_path / "deep").is_dir()


def test_link_to_a_profile_stays_a_link(tmp_path: Path) -> None:
    write_profile(tmp_path / "real.pldf", new_profile())
    link = tmp_path / "link.pldf"
    try:
        link.symlink_to("real.pldf")
    except OSError:
        pytest.skip("links need a privilege on this system")
    write_profile(link, learned_profile())
    assert link.is_symlink()
    assert (tmp_path / "real.pldf").read_bytes() == encode(learned_profile())


@pytest.mark.parametrize("to", [0, 1, 3])
def test_rollback_adds_a_copy_and_keeps_the_history(tmp_path: Path, to: int) -> None:
    profiles = saved_store(tmp_path, 3)
    before = load(profiles)
    profile = profiles.rollback(DRIVER, ROUTE, to)
    assert encode(load(profiles)) == encode(profile)
    assert encode(replace(profile, iterations=profile.iterations[:3])) == encode(before)
    newest, old = profile.iterations[3], before.iteration(to)
    assert (newest.number, newest.note, newest.interventions) == (4, f"rollback of {to}", 0)
    for name in ("learned_mps", "offset_mps", "drive", "intervention"):
        assert np.array_equal(getattr(newest, name), getattr(old, name))


def test_rollback_that_is_not_possible_changes_nothing(tmp_path: Path) -> None:
    profiles = saved_store(tmp_path)
    before = content(tmp_path)
    with pytest.raises(ModelError, match="no iteration 9; this profile has 0"):
        profiles.rollback(DRIVER, ROUTE, 9)
    with pytest.raises(ModelError, match="no such profile file"):
        rollback_profile(tmp_path / "nowhere" / "x.pldf", 1)
    assert content(tmp_path) == before
    assert not (tmp_path / "nowhere").exists()
    (tmp_path / NAME).write_bytes(b"bad")
    with pytest.raises(ProfileRefused):
        profiles.rollback(DRIVER, ROUTE, 1)
    assert content(tmp_path) == {NAME: b"bad"}
