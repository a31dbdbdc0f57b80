"""Reading, replacing and locking files so that nobody ever sees or leaves half of one.

The lock is one per folder, between processes and between instances in one process. It is the
operating system's (``flock``, on Windows ``msvcrt.locking``): it vanishes with the
process that holds it, so a killed process never blocks anybody. The file it sits on is removed at
release; what is left of a killed process is reused.
"""

from __future__ import annotations

import errno
import os
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Final, TypeVar

from ..errors import ModelError

LOCK_NAME: Final = "pldf-store.lock"
_POLL_S: Final = 0.01
_TAKEN: Final = (errno.EAGAIN, errno.EACCES, errno.EDEADLK)
# Windows refuses to rename or open a file for the moment that somebody else has it open.
_TRIES: Final = 100 if os.name == "nt" else 1
_RETRY_S: Final = 0.02

T = TypeVar("T")


class Unusable(OSError):  # noqa: N818 - it says what the file is
    """What is there can never be read as a file: it is no regular one, or too long."""


class LockHeld(ModelError):  # noqa: N818 - it says what happened, to a person
    """Somebody else has the lock of a folder."""


@contextmanager
def folder_lock(folder: Path, timeout_s: float) -> Iterator[None]:
    """Hold the lock of ``folder``, which must exist; wait for it up to ``timeout_s`` seconds.

    Raises:
        LockHeld: somebody else held it all the time.
        ModelError: somebody else left one that this user cannot open.
        OSError: the lock file cannot be created, or the file system knows no locks.
    """
    path = folder / LOCK_NAME
    deadline_s = time.monotonic() + timeout_s
    while (descriptor := _acquire(path)) is None:
        if time.monotonic() >= deadline_s:
            raise LockHeld(
                f"{path}: held by another process for {timeout_s:g} s, nothing was changed; "
                "try again when it has finished"
            )
        time.sleep(_POLL_S)
    try:
        yield
    finally:
        _release(path, descriptor)


if sys.platform == "win32":
    import msvcrt

    def _lock(descriptor: int) -> None:
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)

    def _acquire(path: Path) -> int | None:
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT)
        except PermissionError:  # being removed by its last holder
            return None
        return descriptor if _locked(descriptor) else None

    def _release(path: Path, descriptor: int) -> None:
        os.close(descriptor)
        with suppress(OSError):  # refused while others have it open: they reuse it
            path.unlink()

else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def _acquire(path: Path) -> int | None:
        try:
            descriptor = _open_lock(path)
        except PermissionError:
            if os.path.lexists(path):  # somebody else's is there since we looked
                return None
            raise
        if not _locked(descriptor):
            return None
        if not _is_at(path, descriptor):  # its last holder has removed it meanwhile
            os.close(descriptor)
            return None
        return descriptor

    def _open_lock(path: Path) -> int:
        """Open the lock for whoever may write in its folder, whoever made it."""
        # To read is enough for a lock on most file systems, and what a strange umask leaves. And
        # no O_CREAT on what is there: a shared folder with a sticky bit forbids it.
        for flags in (os.O_RDWR, os.O_RDONLY):
            try:
                return os.open(path, flags)
            except FileNotFoundError:
                return _new_lock(path)
            except PermissionError as error:
                problem = error
        raise ModelError(
            f"{path}: a lock that another user left cannot be opened ({reason(problem)}), nothing "
            "was changed; delete it when no simulation uses this folder, or ask for write access"
        )

    def _new_lock(path: Path) -> int:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        # It holds nothing that could be read; its group need not be that of the folder.
        with suppress(OSError):  # somebody else was faster: it is theirs, and they have done it
            os.fchmod(descriptor, 0o644 | os.stat(path.parent).st_mode & 0o022)
        return descriptor

    def _release(path: Path, descriptor: int) -> None:
        with suppress(OSError):
            path.unlink()  # while it is locked: who waits for it sees that it is gone
        os.close(descriptor)

    def _is_at(path: Path, descriptor: int) -> bool:
        try:
            return os.path.samestat(os.stat(path), os.fstat(descriptor))
        except FileNotFoundError:
            return False


def _locked(descriptor: int) -> bool:
    try:
        _lock(descriptor)
    except OSError as error:
        os.close(descriptor)
        if error.errno in _TAKEN:
            return False
        raise
    return True


def read_file(path: Path, size_max: int, begin: bytes = b"") -> bytes:
    """Return the content of the regular file ``path`` of at most ``size_max`` bytes.

    Of a file that does not begin with ``begin`` no more than that many bytes.

    Raises:
        Unusable: it is no regular file, or longer.
        OSError: there is no such file, or it cannot be read now.
    """
    return _patiently(lambda: _read_file(path, size_max, begin))


def _read_file(path: Path, size_max: int, begin: bytes) -> bytes:
    if not stat.S_ISREG(os.stat(path).st_mode):  # a folder; or a pipe, which would never end
        raise Unusable(errno.EINVAL, "not a regular file")
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size  # another file may have taken the place
        if size > size_max:
            raise Unusable(errno.EFBIG, f"longer than {size_max} bytes")
        data = file.read(len(begin))
        if data != begin[:size]:
            return data
        data += file.read()
    if len(data) < size:
        raise OSError(errno.EIO, "it ends while it is read")
    return data


def rename_file(path: Path, to: Path) -> None:
    """Rename ``path`` for good; needs the lock, under which ``to`` was found free."""
    _patiently(lambda: os.replace(path, to))
    _sync_folder(path.parent)


def real_path(path: Path) -> Path:
    """Return the file that ``path`` leads to through links: what a writer replaces."""
    return Path(os.path.realpath(path))


def free_name(stem: Path, end: str = "") -> Path:
    """Return ``stem-N`` and ``end`` with the first N that is not taken; needs the lock."""
    names = (stem.with_name(f"{stem.name}-{number}{end}") for number in count(1))
    return next(name for name in names if not os.path.lexists(name))


def replace_file(path: Path, data: bytes, aside: Path | None = None) -> None:
    """Write ``data`` to the disk, then put it in the place of ``path``; needs the lock.

    With ``aside`` what was in that place gets this name, once the rest can hardly fail.

    Raises:
        OSError: it failed; ``path`` is as it was, and nothing half-written is left.
        ModelError: as OSError, but what was there has the name ``aside`` now.
    """
    temporary = path.with_name(path.name + ".tmp")
    with suppress(FileNotFoundError):
        temporary.unlink()  # of a killed process; opening it instead would follow a link
    try:
        with open(temporary, "xb") as file:
            file.write(data)
            file.flush()
            _sync(file.fileno())
        _swap(temporary, path, aside)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise
    _sync_folder(path.parent)


def _swap(temporary: Path, path: Path, aside: Path | None) -> None:
    """Put ``temporary`` in the place of ``path``, which gets its name back if that fails."""
    if aside is not None:
        _patiently(lambda: os.replace(path, aside))
    try:
        _patiently(lambda: os.replace(temporary, path))
    except OSError as error:
        if aside is None:
            raise
        try:
            _patiently(lambda: os.replace(aside, path))
        except OSError:
            raise ModelError(
                f"{path}: cannot be saved ({reason(error)}); what was there is now {aside}"
            ) from error
        raise


def make_folder(folder: Path) -> None:
    """Make ``folder`` and those above it, for good; one that is there stays as it is.

    Raises:
        OSError: that is not possible.
    """
    if folder.is_dir():
        return
    make_folder(folder.parent)
    folder.mkdir(exist_ok=True)  # another process may have made it meanwhile
    _sync_folder(folder.parent)


def _sync_folder(folder: Path) -> None:
    """Make a new name last through a power cut, where the system can do that for folders."""
    if os.name == "nt":
        return
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            _sync(descriptor)
        finally:
            os.close(descriptor)


def _sync(descriptor: int) -> None:
    if sys.platform == "darwin":  # there fsync leaves it in the drive's cache
        with suppress(OSError):  # some file systems know no more than that
            fcntl.fcntl(descriptor, fcntl.F_FULLFSYNC)
            return
    os.fsync(descriptor)


def _patiently(action: Callable[[], T]) -> T:
    for _ in range(_TRIES - 1):
        try:
            return action()
        except PermissionError:
            time.sleep(_RETRY_S)
    return action()


def reason(error: Exception) -> str:
    """Return what the system says about ``error``, without the file name."""
    if isinstance(error, MemoryError):
        return "it does not fit into memory"
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
