"""Profiles as single files: writing and rolling back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileRefused,
    ProfileStore,
    continue_profile,
    present_profile,
    read_profile,
    require_continued,
    rollback_profile,
    write_profile,
)
from pldf.profiles.stored_profile import COLUMN_NAMES
from profile_examples import DRIVER, ROUTE, drive_result, learned_profile, new_profile
from stored import NAME, content, load, saved_store


def test_write_profile_replaces_what_the_profile_continues_only(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "P2.pldf"
    for profile in (new_profile(), learned_profile(1), learned_profile(2)):
        write_profile(path, profile)
        assert content(path.parent) == {"P2.pldf": encode(profile)}
    for other in (new_profile(driver_id=3), learned_profile(1), new_profile(route="f" * 16)):
        with pytest.raises(ModelError, match=r"holds driver 17 .* 2 iterations.*--force"):
            write_profile(path, other)
    for foreign in (tmp_path / "road.csv", tmp_path / "deep"):
        if not foreign.exists():
            foreign.write_text("s_m\n")
        with pytest.raises(ModelError, match="not overwritten; choose another file"):
            write_profile(foreign, new_profile())
    assert (tmp_path / "road.csv").read_text() == "s_m\n"
    assert content(path.parent) == {"P2.pldf": encode(learned_profile(2))}


@pytest.mark.parametrize("before", [encode(learned_profile()), b"s_m\n"], ids=["sound", "other"])
def test_by_force_what_was_there_is_kept_aside(tmp_path: Path, before: bytes) -> None:
    path = tmp_path / "P2.pldf"
    path.write_bytes(before)
    kept = write_profile(path, new_profile(driver_id=3), force=True)
    assert content(tmp_path) == {
        "P2.pldf": encode(new_profile(driver_id=3)),
        "P2.pldf.replaced-1": before,
    }
    assert kept == tmp_path / "P2.pldf.replaced-1"
    assert ProfileStore(tmp_path).replaced() == [kept]
    assert write_profile(path, new_profile(driver_id=3), force=True) is None  # nothing to keep


def test_what_was_changed_meanwhile_stays_and_the_result_is_kept_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "P2.pldf"
    write_profile(path, learned_profile(1))
    mine = learned_profile(2)
    require_continued(path, mine, present_profile(path))
    theirs = learned_profile(1).rolled_back(0)
    write_profile(path, theirs)
    with pytest.raises(ProfileConflict, match="changed by another process meanwhile and left"):
        continue_profile(path, mine)
    assert content(tmp_path) == {"P2.pldf": encode(theirs), "P2.conflict-1.pldf": encode(mine)}


@pytest.fixture
def link(tmp_path: Path) -> Path:
    """A link in a store's place, to a profile with two iterations in another folder."""
    (tmp_path / "store").mkdir()
    write_profile(tmp_path / "elsewhere" / "real.pldf", learned_profile(2))
    path = tmp_path / "store" / NAME
    try:
        path.symlink_to("../elsewhere/real.pldf")
    except OSError:
        pytest.skip("links need a privilege on this system")
    return path


def test_every_writer_follows_a_link(link: Path) -> None:
    real, profiles = link.parents[1] / "elsewhere" / "real.pldf", ProfileStore(link.parent)
    profiles.append(load(profiles), drive_result(load(profiles)))
    assert len(read_profile(real).iterations) == 3
    write_profile(link, load(profiles).rolled_back(0))
    rollback_profile(link, 1)
    assert len(read_profile(real).iterations) == 5
    late = learned_profile(1)
    with pytest.raises(ProfileConflict):
        profiles.append(late, drive_result(late))
    assert link.is_symlink()
    assert set(content(real.parent)) == {"real.pldf", "real.conflict-1.pldf"}
    assert set(content(link.parent)) == {NAME}


def test_a_bad_file_behind_a_link_is_kept_beside_that_file(link: Path) -> None:
    real, profiles = link.parents[1] / "elsewhere" / "real.pldf", ProfileStore(link.parent)
    real.write_bytes(b"bad")
    with pytest.raises(ProfileRefused, match=r"kept as real\.pldf\.refused-1"):
        profiles.load(DRIVER, ROUTE, 11)
    profiles.append(new_profile(), drive_result(new_profile()))
    assert link.is_symlink()
    assert len(read_profile(real).iterations) == 1


@pytest.mark.parametrize("to", [0, 1, 3])
def test_rollback_adds_a_copy_and_keeps_the_history(tmp_path: Path, to: int) -> None:
    profiles = saved_store(tmp_path, 3)
    before = load(profiles)
    profile = profiles.rollback(DRIVER, ROUTE, to)
    assert encode(load(profiles)) == encode(profile)
    assert encode(replace(profile, iterations=profile.iterations[:3])) == encode(before)
    newest, old = profile.iterations[3], before.iteration(to)
    assert (newest.number, newest.note, newest.interventions) == (4, f"rollback of {to}", 0)
    assert newest.kind == "rollback"
    for name in COLUMN_NAMES:
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
