"""Files that last: what the disk is asked for, and when."""

from __future__ import annotations

import os
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
