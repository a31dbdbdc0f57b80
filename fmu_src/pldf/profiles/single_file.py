"""Profiles as single files, named by whoever uses them: read, write, roll back, export."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import free_name, real_path, replace_file
from .profile_file import encode
from .profile_format_1 import encode_1
from .saving import (
    LOCK_TIMEOUT_S,
    ProfileUnreadable,
    Saved,
    continues,
    described,
    put,
    read,
    save,
    writing,
)
from .stored_profile import ProfileRefused, StoredProfile

_ADVICE: Final = (
    "not overwritten; choose another file, or replace it by force (it is kept aside then): "
    "--force, in Python force=True"
)


def read_profile(path: str | os.PathLike[str]) -> StoredProfile:
    """Return the profile in the file ``path``; nothing on the disk is changed.

    Raises:
        ProfileRefused: the file cannot be read or is not a sound profile.
        ModelError: there is no such file.
    """
    profile = read(Path(path))
    if profile is None:
        raise ModelError(f"{path}: no such profile file")
    return profile


def write_profile(
    path: str | os.PathLike[str],
    profile: StoredProfile,
    lock_timeout_s: float = LOCK_TIMEOUT_S,
    *,
    force: bool = False,
) -> Path | None:
    """Put ``profile`` into the file ``path``, atomically; missing folders are made.

    What is there is replaced if ``profile`` continues it: all its iterations are in ``profile``.
    Anything else is replaced by ``force`` only, and kept aside; returned is where.

    Raises:
        ModelError: the profile is not sound, it does not continue what is there, the folder cannot
            be written to or is locked.
    """
    target, data = real_path(Path(path)), encode(profile)
    with writing(target, lock_timeout_s):
        try:
            require_continued(path, profile, present_profile(target))
        except ModelError:
            if not force:
                raise
            kept = free_name(target.with_name(target.name + ".replaced"))
            replace_file(target, data, aside=kept)
            return kept
        put(target, profile, data, lambda _: True)
    return None


def continue_profile(
    path: str | os.PathLike[str], profile: StoredProfile, lock_timeout_s: float = LOCK_TIMEOUT_S
) -> Saved:
    """Put ``profile`` into the file ``path`` that it continues, or beside what it does not.

    For what must not be lost; ``require_continued`` tells first whether it belongs there.

    Raises:
        ProfileConflict: the file was changed since, or cannot be read now; the result is kept in a
            file of its own.
        ModelError: the profile is not sound, the folder cannot be written to or is locked.
    """
    return save(Path(path), profile, lambda there: continues(profile, there), lock_timeout_s)


def present_profile(path: str | os.PathLike[str]) -> StoredProfile | None:
    """Return what a profile that is written to ``path`` has to continue; None: nothing is there.

    Raises:
        ModelError: it cannot be read, or is no sound profile.
    """
    try:
        return read(Path(path))
    except (ProfileRefused, ProfileUnreadable) as problem:
        raise ModelError(f"{problem}; {_ADVICE}") from None


def require_continued(
    path: str | os.PathLike[str], profile: StoredProfile, present: StoredProfile | None
) -> None:
    """Refuse to let ``profile`` take the place of ``present`` in ``path`` and lose some of it.

    Raises:
        ModelError: ``present`` has iterations that ``profile`` has not, or is somebody else's.
    """
    if present is not None and not continues(profile, present):
        raise ModelError(
            f"{path}: holds {described(present)}, which {described(profile)} does not "
            f"continue; {_ADVICE}"
        )


def rollback_profile(
    path: str | os.PathLike[str], to: int, lock_timeout_s: float = LOCK_TIMEOUT_S
) -> StoredProfile:
    """Add a copy of iteration ``to`` (0: the base profile) as the newest one; all others stay.

    Raises:
        ProfileRefused: the file is not a sound profile; it is left as it is.
        ModelError: there is no such file or iteration, it cannot be read now, or saving fails.
    """
    return change_profile(path, lambda profile: profile.rolled_back(to), lock_timeout_s)


def change_profile(
    path: str | os.PathLike[str],
    change: Callable[[StoredProfile], StoredProfile],
    lock_timeout_s: float = LOCK_TIMEOUT_S,
) -> StoredProfile:
    """Put what ``change`` makes of the profile in the file ``path`` in its place; return it.

    ``change`` only adds iterations; if it returns what it was given, nothing is written.

    Raises:
        ProfileRefused: the file is not a sound profile; it is left as it is.
        ModelError: there is no such file, it cannot be read or changed, or saving fails.
    """
    read_profile(path)  # before a folder or a lock file is made for nothing
    target = real_path(Path(path))
    with writing(target, lock_timeout_s):
        present = read_profile(target)
        profile = change(present)
        if profile is not present:
            put(target, profile, encode(profile), lambda there: continues(profile, there))
    return profile


def export_format_1(
    path: str | os.PathLike[str], profile: StoredProfile, lock_timeout_s: float = LOCK_TIMEOUT_S
) -> None:
    """Put ``profile`` into the new file ``path``, as release 0.2.0 reads it.

    Raises:
        ModelError: there is something already, or the folder cannot be written to or is locked.
    """
    target = Path(os.path.abspath(path))
    data = encode_1(profile)
    with writing(target, lock_timeout_s):
        if os.path.lexists(target):
            raise ModelError(f"{path}: it is there already; choose another file")
        replace_file(target, data)
