"""The profile store on a real disk: what is kept, and files that cannot be used."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.files.disk import LOCK_NAME, folder_lock
from pldf.profiles import store
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileRefused,
    ProfileStore,
    read_profile,
)
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile
from stored import NAME, NOBODY_ELSE, content, failing, load, saved_store


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
    faster = profile.base_mps + 0.5
    profiles.append(profile, replace(drive_result(profile), base_mps=faster))
    again = load(profiles)
    assert len(again.iterations) == 3
    assert np.array_equal(again.iteration().base_mps, faster)
    assert np.array_equal(again.iteration(2).base_mps, profile.base_mps)
    # Going back to it is going back to what is planned now.
    back = profiles.rollback(DRIVER, ROUTE, 0).iteration()
    assert np.array_equal(back.learned_mps, faster)


# Files that cannot be used


def bad_files() -> dict[str, tuple[bytes, str]]:
    good = encode(learned_profile())
    return {
        "empty": (b"", "line 1: truncated"),
        "foreign": (b"<OpenDRIVE/>\n", "line 1: not a profile file"),
        "newer": (good.replace(b"FILE 2", b"FILE 3", 1), "line 1: format 3 of a newer version"),
        "truncated": (good[:-1], r"byte \d+: truncated"),
        "corrupt": (good[:-200] + b"\xff" + good[-199:], r"byte \d+: damaged: checksum"),
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
