"""Folders that something is to be written into later."""

from __future__ import annotations

import errno
import os
from contextlib import suppress
from pathlib import Path

from .disk import LockHeld, folder_lock


def nearest_entry(folder: Path) -> Path:
    """Return ``folder``, or the first above it that is there."""
    return next(p for p in (folder, *folder.parents) if os.path.exists(p))


def require_writable(folder: Path) -> None:
    """Try to write in ``folder``, or where it would be made, without leaving anything.

    Raises:
        OSError: nothing can be written there, or a file is in the folder's place.
        ModelError: somebody else left a lock that this user cannot open.
    """
    nearest = nearest_entry(folder)
    if not nearest.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "not a folder")
    # The lock is made as any file is; and a lock that somebody left would be in the way.
    with suppress(LockHeld), folder_lock(nearest, 0.0):
        pass
