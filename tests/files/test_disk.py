"""Files that last: what the disk is asked for, and when."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from pldf.files import disk

no_folders = pytest.mark.skipif(os.name == "nt", reason="Windows syncs no folders")


@no_folders
@pytest.mark.parametrize("action", ["rename", "replace"])
def test_a_new_name_is_on_the_disk_before_it_is_told(
    action: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    old.write_bytes(b"content")
    synced: list[tuple[bool, bool]] = []  # is it the folder, was the new name there

    def fsync(descriptor: int) -> None:
        same = os.path.samestat(os.fstat(descriptor), os.stat(tmp_path))
        synced.append((same, new.exists()))

    monkeypatch.setattr(os, "fsync", fsync)
    if action == "rename":
        disk.rename_file(old, new)
    else:
        disk.replace_file(new, b"content")
    assert new.read_bytes() == b"content"
    assert synced[-1] == (True, True)


@pytest.mark.skipif(sys.platform != "linux", reason="tells what is synchronized by /proc")
def test_a_new_folder_lasts_through_a_power_cut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder that holds the new name is synchronized, once the name is in it."""
    done = []
    sync, make = os.fsync, os.mkdir

    def note_sync(descriptor: int) -> None:
        done.append(f"fsync {os.readlink(f'/proc/self/fd/{descriptor}')}")
        sync(descriptor)

    def note_make(path: Path, mode: int = 0o777) -> None:
        make(path, mode)
        done.append(f"mkdir {path}")

    monkeypatch.setattr(os, "fsync", note_sync)
    monkeypatch.setattr(os, "mkdir", note_make)
    folder = tmp_path / "a" / "b"
    disk.make_folder(folder)
    disk.make_folder(folder)
    assert folder.is_dir()
    assert done == [
        f"mkdir {tmp_path}/a",
        f"fsync {tmp_path}",
        f"mkdir {tmp_path}/a/b",
        f"fsync {tmp_path}/a",
    ]


def test_a_file_in_the_place_of_a_folder_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    for folder in (tmp_path / "a", tmp_path / "a" / "b"):
        with pytest.raises(OSError, match="exists"):
            disk.make_folder(folder)


def test_a_relative_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    disk.make_folder(Path("a/b"))
    assert (tmp_path / "a" / "b").is_dir()
