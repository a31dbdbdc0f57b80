"""The profile store: a folder with one file per driver and route.

Profiles get to the disk and from it only here.

What is promised, whatever happens (two processes, kill -9, a full disk):

- A profile file is complete at any time: it is written beside its place, flushed to the disk and
  then put there in one go (``os.replace``). Readers need no lock.
- Who writes holds the lock of the folder, from reading to writing. So a file that is being written
  has a fixed name (``.tmp`` behind the name of the profile): one left behind by a killed process is
  replaced by the next save, and they cannot pile up.
- Nothing is lost. A file that was read and cannot be used is renamed to ``NAME.refused-N`` before
  its place is taken. One that cannot be read now is left alone. A result that comes late, because
  somebody else saved since its profile was loaded, or that meets such a file, goes into a profile
  file of its own, ``NAME.conflict-N.pldf``. A rollback adds an iteration.
- Whoever writes does it the same way (``saving``). A link is followed: the file that it leads to is
  replaced, and everything else happens beside that file.
"""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import (
    folder_lock,
    free_name,
    real_path,
    reason,
    rename_file,
)
from ..files.folders import nearest_entry, require_writable
from ..kernel.arrays import FloatArray
from .older_reading import OlderReading, find_older_reading, pairs_of_one_road
from .profile_file import same_history
from .saving import (
    LOCK_TIMEOUT_S,
    REFUSED,
    SUFFIX,
    ProfileConflict,
    ProfileUnreadable,
    Saved,
    read,
    save,
)
from .single_file import (
    change_profile,
    continue_profile,
    export_format_1,
    present_profile,
    read_profile,
    require_continued,
    rollback_profile,
    write_profile,
)
from .stored_profile import Iteration, ProfileRefused, StoredProfile

__all__ = [
    "STORE_VARIABLE",
    "Iteration",
    "OlderReading",
    "ProfileConflict",
    "ProfileRefused",
    "ProfileStore",
    "ProfileUnreadable",
    "Saved",
    "StoredProfile",
    "change_profile",
    "continue_profile",
    "export_format_1",
    "present_profile",
    "read_profile",
    "require_continued",
    "rollback_profile",
    "write_profile",
]

STORE_VARIABLE: Final = "PLDF_PROFILE_STORE"

_GOES_ON: Final = "the drive goes on with the base profile"


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
        return self.folder / f"driver-{driver_id:06d}_route-{route}{SUFFIX}"

    def files(self) -> list[Path]:
        """Return all profile files by name, those of conflicts included; none of them is read."""
        return sorted(self.folder.glob(f"*{SUFFIX}"))

    def files_of(self, driver_id: int) -> list[Path]:
        """Return the profile files of one driver, one per route, without those of conflicts."""
        files = self.folder.glob(f"driver-{driver_id:06d}_route-*{SUFFIX}")
        return sorted(file for file in files if ".conflict-" not in file.name)

    def refused(self) -> list[Path]:
        """Return the files that were put aside because they could not be used."""
        return sorted(self.folder.glob(f"*{SUFFIX}.refused-*"))

    def replaced(self) -> list[Path]:
        """Return the files that were put aside when others took their place by force."""
        return sorted(self.folder.glob(f"*{SUFFIX}.replaced-*"))

    def load(self, driver_id: int, route: str, nodes: int) -> StoredProfile | None:
        """Return the profile of a driver on the route with this fingerprint and number of nodes.

        None: there is none yet.

        Raises:
            ProfileRefused: the file cannot be used; it was renamed if that is possible.
            ProfileUnreadable: it cannot be read now; nothing was touched.
            ModelError: the store is not a folder.
        """
        self._require_folder()
        wanted = (driver_id, route, nodes)
        path = real_path(self.path(driver_id, route))
        try:
            return read(path, wanted)
        except ProfileRefused as refusal:
            profile, outcome = self._put_aside(path, wanted)
            if profile is None:
                raise refusal.followed_by(f"{outcome}; {_GOES_ON}") from None
            return profile

    def older_reading(
        self, driver_id: int, route: str, base_mps: FloatArray
    ) -> OlderReading | None:
        """Return what this driver probably learned on an older reading of a road; None: nothing.

        Args:
            driver_id: whose profile.
            route: fingerprint of the road as it is read now.
            base_mps: its base profile, m/s per node.
        """
        return find_older_reading(self.files_of(driver_id), driver_id, route, base_mps)

    def readings_of_one_road(self) -> list[tuple[Path, Path]]:
        """Return pairs of profiles of one driver that were probably learned on one road."""
        return pairs_of_one_road(path for path in self.files() if ".conflict-" not in path.name)

    def append(self, profile: StoredProfile, *iterations: Iteration) -> Saved:
        """Save ``profile``, as it was loaded for this drive (or new), with ``iterations`` added.

        The base profile may have been planned anew; the history must still be the one in the file.

        Raises:
            ProfileConflict: it is not, or cannot be read now; the result is kept in a file of its
                own.
            ModelError: the result is not sound, the folder cannot be written to or is locked.
        """
        extended = replace(profile, iterations=(*profile.iterations, *iterations))
        return save(
            self.path(profile.driver_id, profile.route),
            extended,
            lambda present: same_history(present, profile),
            self.lock_timeout_s,
        )

    def require_writable(self) -> None:
        """Try to write in the folder, or where it would be made, without leaving anything.

        Raises:
            ModelError: a profile could not be saved here.
        """
        self._require_folder()
        try:
            require_writable(self.folder)
        except OSError as error:
            raise ModelError(
                f"{nearest_entry(self.folder)}: cannot be written to ({reason(error)}); make it "
                "writable, or choose another profile store"
            ) from error

    def delete(self, driver_id: int) -> list[Path]:
        """Delete every file in which something of this driver is kept; return what they were.

        Those are the driver's profiles under any name, what was kept beside them (conflicts,
        refused and replaced files) and what a killed process left of a save.

        Raises:
            ModelError: a file cannot be deleted; the text says which were.
        """
        self._require_folder()
        return self._delete(self._all_of(driver_id), f"driver {driver_id}")

    def delete_file(self, path: Path) -> list[Path]:
        """Delete one profile file of this folder and what was kept beside it; return what.

        Raises:
            ModelError: it is not there, or a file cannot be deleted.
        """
        if not path.is_file():
            raise ModelError(f"{path}: no such profile file")
        return self._delete(self._beside(path), path.name)

    def _delete(self, paths: Iterable[Path], whose: str) -> list[Path]:
        gone: list[Path] = []
        try:
            with folder_lock(self.folder, self.lock_timeout_s):
                for path in sorted(paths):
                    path.unlink()
                    gone.append(path)
        except OSError as error:
            names = ", ".join(path.name for path in gone) or "nothing"
            raise ModelError(
                f"{self.folder}: not all of {whose} could be deleted ({reason(error)}); deleted: "
                f"{names}. Mend that and delete again"
            ) from error
        return gone

    def _beside(self, path: Path) -> set[Path]:
        """Return ``path`` with the files that saves put beside it."""
        stem = glob.escape(path.name.removesuffix(SUFFIX))
        patterns = (f"{glob.escape(path.name)}.*", f"{stem}.conflict-*")
        return {path, *(other for p in patterns for other in self.folder.glob(p))}

    def _all_of(self, driver_id: int) -> set[Path]:
        named = set(self.folder.glob(f"driver-{driver_id:06d}_route-*"))
        for path in self.files():
            with suppress(ModelError):  # what cannot be read is known by its name alone
                profile = read(path)
                if profile is not None and profile.driver_id == driver_id:
                    named |= self._beside(path)
        return named

    def rollback(self, driver_id: int, route: str, to: int) -> StoredProfile:
        """As ``rollback_profile``, for the file of this driver on this route."""
        return rollback_profile(self.path(driver_id, route), to, self.lock_timeout_s)

    def _require_folder(self) -> None:
        """Refuse early a store that can never be made, because a file is in its way."""
        nearest = nearest_entry(self.folder)
        if not nearest.is_dir():
            raise ModelError(f"{nearest}: not a folder; choose another profile store")

    def _put_aside(
        self, path: Path, wanted: tuple[int, str, int]
    ) -> tuple[StoredProfile | None, str]:
        """Judge a refused file again under the lock: somebody may have dealt with it meanwhile."""
        try:
            with folder_lock(path.parent, self.lock_timeout_s):
                try:
                    return read(path, wanted), "put aside by another process"
                except ProfileRefused:
                    kept = free_name(path.with_name(path.name + REFUSED))
                    rename_file(path, kept)
                    return None, f"kept as {kept.name}"
        except (OSError, ModelError) as error:
            return None, f"left in its place ({reason(error)})"
