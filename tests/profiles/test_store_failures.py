"""Saving that fails or is killed leaves the old or the new profile."""

from __future__ import annotations

import errno
import os
import random
import subprocess
from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.files import disk
from pldf.files.disk import LOCK_NAME
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileStore,
    read_profile,
    write_profile,
)
from profile_examples import DRIVER, ROUTE, drive_result, new_profile, two_bases
from stored import NAME, NOBODY_ELSE, content, failing, load, needs_sigkill, saved_store, worker


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
        lambda: write_profile(tmp_path / NAME, new_profile(), force=True),
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
    possible = [encode(profile) for profile in two_bases()]
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
    write_profile(path, two_bases()[0])
    assert content(tmp_path) == {NAME: possible[0]}
