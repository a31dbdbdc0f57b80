"""How a profile gets into its file: the one way of everybody who writes one.

Lock, read what is there, compare it with what the new profile was made from; then write, or keep
the new one beside it. Only what was read and found bad loses its place, and is kept aside.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import (
    Unusable,
    folder_lock,
    free_name,
    make_folder,
    read_file,
    real_path,
    reason,
    replace_file,
)
from .file_parts import FILE_MAX, MAGIC
from .profile_file import decode, encode, require_match, same_history
from .stored_profile import ProfileRefused, StoredProfile

LOCK_TIMEOUT_S: Final = 10.0
SUFFIX: Final = ".pldf"
REFUSED: Final = ".refused"


class ProfileConflict(ModelError):  # noqa: N818 - it says what happened, to a person
    """What was learned did not get into its file, which is as it was; ``kept`` holds the result."""

    def __init__(self, path: Path, kept: Path, why: str) -> None:
        super().__init__(f"{path}: {why} and left as it is; what was learned is kept in {kept}")
        self.kept = kept


class ProfileUnreadable(ModelError):  # noqa: N818 - it says what happened, to a person
    """A profile file that may be sound and cannot be read now; nobody touches it."""

    def __init__(self, path: Path, error: Exception) -> None:
        super().__init__(f"{path}: cannot be read now ({reason(error)})")
        self.why = f"cannot be read now ({reason(error)})"


@dataclass(frozen=True)
class Saved:
    """What is now in the file ``path``; ``warning``: what had to be put aside for it, or empty."""

    path: Path
    profile: StoredProfile
    warning: str = ""


def read(path: Path, wanted: tuple[int, str, int] | None = None) -> StoredProfile | None:
    """Return the profile in ``path``, None if there is no such file."""
    try:
        profile = decode(read_file(path, FILE_MAX, MAGIC), str(path))
    except FileNotFoundError:
        return None
    except Unusable as error:
        raise ProfileRefused(str(path), "", f"cannot be read ({reason(error)})") from error
    except (OSError, MemoryError) as error:
        raise ProfileUnreadable(path, error) from error
    if wanted is not None:
        require_match(profile, wanted, str(path))
    return profile


def save(
    path: Path, profile: StoredProfile, follows: Callable[[StoredProfile], bool], timeout_s: float
) -> Saved:
    """Put ``profile`` where it belongs: into ``path`` if it ``follows`` what is there.

    Raises:
        ProfileConflict: it does not, or that cannot be read now; it is kept in a file of its own.
        ModelError: it is not sound, the folder cannot be written to or is locked.
    """
    target = real_path(path)
    with writing(target, timeout_s):
        return put(target, profile, encode(profile), follows)


def put(
    path: Path, profile: StoredProfile, data: bytes, follows: Callable[[StoredProfile], bool]
) -> Saved:
    """Write ``profile``, whose bytes are ``data``, in the way of every writer; needs the lock.

    Into ``path`` if it ``follows`` what is there, or if what is there was read and found bad (which
    is put aside); else into a file of its own.
    """
    try:
        present = read(path, identity(profile))
    except ProfileUnreadable as problem:
        raise _kept_beside(path, data, problem.why) from None
    except ProfileRefused as refusal:
        kept = free_name(path.with_name(path.name + REFUSED))
        replace_file(path, data, aside=kept)
        outcome = f"kept as {kept.name}, a new profile took its place"
        return Saved(path, profile, str(refusal.followed_by(outcome)))
    if present is not None and not follows(present):
        raise _kept_beside(path, data, "changed by another process meanwhile")
    replace_file(path, data)
    return Saved(path, profile)


def _kept_beside(path: Path, data: bytes, why: str) -> ProfileConflict:
    kept = free_name(path.with_name(path.name.removesuffix(SUFFIX) + ".conflict"), SUFFIX)
    replace_file(kept, data)
    return ProfileConflict(path, kept, why)


def continues(profile: StoredProfile, older: StoredProfile) -> bool:
    """Tell whether all iterations of ``older`` are the first ones of ``profile``."""
    begun = replace(profile, iterations=profile.iterations[: len(older.iterations)])
    return identity(profile) == identity(older) and same_history(begun, older)


def identity(profile: StoredProfile) -> tuple[int, str, int]:
    """Return driver, route and number of nodes."""
    return profile.driver_id, profile.route, profile.nodes


def described(profile: StoredProfile) -> str:
    """Return whose profile it is, and how much is in it."""
    count = len(profile.iterations)
    return f"driver {profile.driver_id} on route {profile.route} with {count} iterations"


@contextmanager
def writing(path: Path, lock_timeout_s: float) -> Iterator[None]:
    """Make the folder of ``path`` and hold its lock; say what fails in one line for the user."""
    try:
        make_folder(path.parent)
        with folder_lock(path.parent, lock_timeout_s):
            yield
    except (OSError, MemoryError) as error:
        raise ModelError(
            f"{path}: cannot be saved ({reason(error)}), what was there is unchanged; "
            "make room there, or choose another folder"
        ) from error
