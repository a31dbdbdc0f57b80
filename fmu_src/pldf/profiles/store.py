"""The profile store: a folder with one file per driver and route.

Profiles get to the disk and from it only here.

What is promised, whatever happens (two processes, kill -9, a full disk):

- A profile file is complete at any time: it is written beside its place, flushed to the disk and
  then put there in one go (``os.replace``). Readers need no lock.
- Who writes holds the lock of the folder, from reading to writing. So a file that is being written
  has a fixed name (``.tmp`` behind the name of the profile): one left behind by a killed process is
  replaced by the next save, and they cannot pile up.
- Nothing is lost. A file that cannot be used is renamed to ``NAME.refused-N`` before its place is
  taken. A result that comes late, because somebody else saved since its profile was loaded, goes
  into a profile file of its own, ``NAME.conflict-N.pldf``. A rollback adds an iteration.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import (
    folder_lock,
    free_name,
    make_folder,
    read_file,
    reason,
    rename_file,
    replace_file,
)
from .file_parts import FILE_MAX
from .profile_file import decode, encode, require_match, same_history
from .profile_format_1 import encode_1
from .stored_profile import Iteration, ProfileRefused, StoredProfile

__all__ = [
    "STORE_VARIABLE",
    "Iteration",
    "ProfileConflict",
    "ProfileRefused",
    "ProfileStore",
    "Saved",
    "StoredProfile",
    "export_format_1",
    "read_profile",
    "rollback_profile",
    "write_profile",
]

STORE_VARIABLE: Final = "PLDF_PROFILE_STORE"
LOCK_TIMEOUT_S: Final = 10.0

_SUFFIX: Final = ".pldf"
_GOES_ON: Final = "the drive goes on with the base profile"


class ProfileConflict(ModelError):  # noqa: N818 - it says what happened, to a person
    """Somebody else saved since the profile was loaded; ``kept`` holds the late result."""

    def __init__(self, path: Path, kept: Path) -> None:
        super().__init__(
            f"{path}: changed by another process during this drive and left as it is; "
            f"what this drive learned is kept in {kept}"
        )
        self.kept = kept


@dataclass(frozen=True)
class Saved:
    """What is now in the file ``path``; ``warning``: what had to be put aside for it, or empty."""

    path: Path
    profile: StoredProfile
    warning: str = ""


def read_profile(path: str | os.PathLike[str]) -> StoredProfile:
    """Return the profile in the file ``path``; nothing on the disk is changed.

    Raises:
        ProfileRefused: the file cannot be read or is not a sound profile.
        ModelError: there is no such file.
    """
    profile = _read(Path(path))
    if profile is None:
        raise ModelError(f"{path}: no such profile file")
    return profile


def write_profile(
    path: str | os.PathLike[str], profile: StoredProfile, lock_timeout_s: float = LOCK_TIMEOUT_S
) -> None:
    """Put ``profile`` into the file ``path``, atomically; missing folders are made.

    A sound profile that is there is replaced; anything else is left alone.

    Raises:
        ModelError: the profile is not sound, something else is in its place, the folder cannot be
            written to or is locked.
    """
    target = Path(os.path.realpath(path))
    data = encode(profile)
    with _writing(target, lock_timeout_s):
        try:
            _read(target)
        except ProfileRefused as refusal:
            raise refusal.followed_by("not overwritten, choose another file") from None
        replace_file(target, data)


def rollback_profile(
    path: str | os.PathLike[str], to: int, lock_timeout_s: float = LOCK_TIMEOUT_S
) -> StoredProfile:
    """Add a copy of iteration ``to`` (0: the base profile) as the newest one; all others stay.

    Raises:
        ProfileRefused: the file is not a sound profile; it is left as it is.
        ModelError: there is no such file or iteration, or saving fails.
    """
    read_profile(path)  # before a folder or a lock file is made for nothing
    target = Path(os.path.realpath(path))
    with _writing(target, lock_timeout_s):
        profile = read_profile(target).rolled_back(to)
        replace_file(target, encode(profile))
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
    with _writing(target, lock_timeout_s):
        if os.path.lexists(target):
            raise ModelError(f"{path}: it is there already; choose another file")
        replace_file(target, data)


class ProfileStore:
    """The profiles in one folder, which need not exist before the first save.

    Args:
        folder: where the files are; made absolute, since a simulator may change its folder.
        lock_timeout_s: how long to wait for another process that is saving.
    """

    def __init__(
        self, folder: str | os.PathLike[str], lock_timeout_s: float = LOCK_TIMEOUT_S
    ) -> None:
        self.folder = Path(os.path.abspath(folder))
        self.lock_timeout_s = lock_timeout_s

    def path(self, driver_id: int, route: str) -> Path:
        """Return where the profile of this driver on this route is or would be."""
        return self.folder / f"driver-{driver_id:06d}_route-{route}{_SUFFIX}"

    def files(self) -> list[Path]:
        """Return all profile files by name, those of conflicts included; none of them is read."""
        return sorted(self.folder.glob(f"*{_SUFFIX}"))

    def files_of(self, driver_id: int) -> list[Path]:
        """Return the profile files of one driver, one per route, without those of conflicts."""
        files = self.folder.glob(f"driver-{driver_id:06d}_route-*{_SUFFIX}")
        return sorted(file for file in files if ".conflict-" not in file.name)

    def refused(self) -> list[Path]:
        """Return the files that were put aside because they could not be used."""
        return sorted(self.folder.glob(f"*{_SUFFIX}.refused-*"))

    def load(self, driver_id: int, route: str, nodes: int) -> StoredProfile | None:
        """Return the profile of a driver on the route with this fingerprint and number of nodes.

        None: there is none yet.

        Raises:
            ProfileRefused: the file cannot be used; it was renamed if that is possible.
            ModelError: the store is not a folder.
        """
        self._require_folder()
        wanted = (driver_id, route, nodes)
        path = self.path(driver_id, route)
        try:
            return _read(path, wanted)
        except ProfileRefused as refusal:
            profile, outcome = self._put_aside(path, wanted)
            if profile is None:
                raise refusal.followed_by(f"{outcome}; {_GOES_ON}") from None
            return profile

    def append(self, profile: StoredProfile, iteration: Iteration) -> Saved:
        """Save ``profile``, as it was loaded for this drive (or new), with ``iteration`` added.

        The base profile may have been planned anew; the history must still be the one in the file.

        Raises:
            ProfileConflict: it is not; the result is kept in a file of its own.
            ModelError: the result is not sound, the folder cannot be written to or is locked.
        """
        extended = profile.with_iteration(iteration)
        data = encode(extended)
        path = self.path(profile.driver_id, profile.route)
        with _writing(path, self.lock_timeout_s):
            present, warning = _make_room(path, (profile.driver_id, profile.route, profile.nodes))
            if present is not None and not same_history(present, profile):
                kept = free_name(path.with_suffix(".conflict-{}" + _SUFFIX))
                replace_file(kept, data)
                raise ProfileConflict(path, kept)
            replace_file(path, data)
        return Saved(path, extended, warning)

    def rollback(self, driver_id: int, route: str, to: int) -> StoredProfile:
        """As ``rollback_profile``, for the file of this driver on this route."""
        return rollback_profile(self.path(driver_id, route), to, self.lock_timeout_s)

    def _require_folder(self) -> None:
        """Refuse early a store that can never be made, because a file is in its way."""
        nearest = next(p for p in (self.folder, *self.folder.parents) if os.path.exists(p))
        if not nearest.is_dir():
            raise ModelError(f"{nearest}: not a folder; choose another profile store")

    def _put_aside(
        self, path: Path, wanted: tuple[int, str, int]
    ) -> tuple[StoredProfile | None, str]:
        """Judge a refused file again under the lock: somebody may have dealt with it meanwhile."""
        try:
            with folder_lock(self.folder, self.lock_timeout_s):
                try:
                    return _read(path, wanted), "put aside by another process"
                except ProfileRefused:
                    return None, f"kept as {_keep_aside(path).name}"
        except (OSError, ModelError) as error:
            return None, f"left in its place ({reason(error)})"


def _read(path: Path, wanted: tuple[int, str, int] | None = None) -> StoredProfile | None:
    """Return the profile in ``path``, None if there is no such file."""
    try:
        data = read_file(path, FILE_MAX)
    except FileNotFoundError:
        return None
    except (OSError, MemoryError) as error:
        raise ProfileRefused(str(path), "", f"cannot be read ({reason(error)})") from error
    profile = decode(data, str(path))
    if wanted is not None:
        require_match(profile, wanted, str(path))
    return profile


@contextmanager
def _writing(path: Path, lock_timeout_s: float) -> Iterator[None]:
    """Make the folder of ``path`` and hold its lock; turn OSErrors into one line for the user."""
    try:
        make_folder(path.parent)
        with folder_lock(path.parent, lock_timeout_s):
            yield
    except OSError as error:
        raise ModelError(
            f"{path}: cannot be saved ({reason(error)}), what was there is unchanged; "
            "make room there, or choose another folder"
        ) from error


def _make_room(path: Path, wanted: tuple[int, str, int]) -> tuple[StoredProfile | None, str]:
    """Return the sound profile in ``path``, or None and what was put aside; needs the lock."""
    try:
        return _read(path, wanted), ""
    except ProfileRefused as refusal:
        kept = _keep_aside(path)
        return None, str(refusal.followed_by(f"kept as {kept.name}, a new profile took its place"))


def _keep_aside(path: Path) -> Path:
    kept = free_name(path.with_name(path.name + ".refused-{}"))
    rename_file(path, kept)
    return kept
