"""Profiles as single files: writing and rolling back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pldf.errors import ModelError
from pldf.profiles.profile_file import encode
from pldf.profiles.store import (
    ProfileRefused,
    rollback_profile,
    write_profile,
)
from pldf.profiles.stored_profile import COLUMN_NAMES
from profile_examples import DRIVER, ROUTE, learned_profile, new_profile
from stored import NAME, content, load, saved_store


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
