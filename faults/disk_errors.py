"""A disk that fails, at any call and with any error, while profiles are read and saved."""

from __future__ import annotations

import builtins
import errno
import os
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from native_saves import CALLS, LOST, NAME, SHORT, Fault
from pldf.errors import ModelError
from pldf.profiles.profile_file import encode
from pldf.profiles.store import Iteration, ProfileConflict, ProfileStore, StoredProfile
from profile_examples import drive_result, learned_profile

from .binary_files import temporary_folder
from .experiment import Counts, Experiment, Progress
from .saving import first_drive, lessons, native_saves

DAMAGED: Final = b"damaged"
ERRORS: Final = (errno.ENOSPC, errno.EIO, errno.EMFILE, errno.ENOMEM, errno.EACCES, SHORT)
CALL_MAX: Final = 20  # more than one save needs


def errors_in_python(count: int, seed: int, progress: Progress) -> Counts:
    """Let a random call of loading and appending fail, with and without a damaged file."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    old = learned_profile(2)
    for number in range(count):
        with temporary_folder() as folder:
            store = ProfileStore(folder, 0.0)
            path = store.path(old.driver_id, old.route)
            present = encode(old) if rng.random() < 0.8 else DAMAGED
            path.write_bytes(present)
            before = old if rng.random() < 0.5 else _loaded(store, old)
            path.write_bytes(present)
            _remove_others(path)
            lesson = drive_result(before, "lesson")
            error = int(rng.choice(ERRORS[:-1]))
            with failing_call(int(rng.integers(1, CALL_MAX)), error) as failed:
                told = _told(store, before, lesson)
            found.update(_judged(path, present, encode(before.with_iteration(lesson)), told))
            found["errors"] += bool(failed)
        progress(number + 1)
    return dict(found)


def _loaded(store: ProfileStore, like: StoredProfile) -> StoredProfile:
    try:
        return store.load(like.driver_id, like.route, like.nodes) or like
    except ModelError:
        return like


def _remove_others(path: Path) -> None:
    for other in path.parent.iterdir():
        if other != path:
            other.unlink()


def _told(store: ProfileStore, before: StoredProfile, lesson: Iteration) -> ModelError | None:
    try:
        store.append(before, lesson)
    except ModelError as error:
        return error
    return None


def _judged(path: Path, present: bytes, result: bytes, told: ModelError | None) -> Counts:
    """Whoever is told that nothing was lost finds the lesson, and what was there is never lost."""
    files = {other.name: other.read_bytes() for other in path.parent.iterdir()}
    there = files.get(path.name)
    kept = any(data == result for name, data in files.items() if name.endswith(".pldf"))
    beside = isinstance(told, ProfileConflict)
    wrong = (
        (present == DAMAGED and present not in files.values())
        or ((told is None or beside) and not kept)
        or ("is unchanged" in str(told) and there != present)
        or (present != DAMAGED and there not in (present, result))
    )
    return {
        "saved": told is None,
        "kept_beside": beside,
        "refused": told is not None and not beside,
        "violations": bool(wrong),
    }


@contextmanager
def failing_call(at: int, error: int) -> Iterator[list[str]]:
    """Let the ``at``-th call to the disk fail with ``error``; give a list that then names it."""
    failed: list[str] = []
    calls = 0
    where: Any
    places = [(os, name) for name in ("open", "stat", "fstat", "replace", "unlink", "fsync")]
    real = [(where, name, getattr(where, name)) for where, name in [*places, (builtins, "open")]]

    def watched(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
        def watching(*given: Any, **more: Any) -> Any:
            nonlocal calls
            calls += 1
            if calls == at:
                failed.append(name)
                raise OSError(error, os.strerror(error))
            made = call(*given, **more)
            return _WatchedFile(made, watched) if call is real[-1][2] else made

        return watching

    for where, name, call in real:
        setattr(where, name, watched(name, call))
    try:
        yield failed
    finally:
        for where, name, call in real:
            setattr(where, name, call)


class _WatchedFile:
    """An open file whose reading and writing are calls to the disk, too."""

    def __init__(self, file: Any, watched: Callable[[str, Any], Any]) -> None:
        self._file = file
        self.read, self.write = watched("read", file.read), watched("write", file.write)
        self.flush, self.fileno = watched("flush", file.flush), file.fileno

    def __enter__(self) -> _WatchedFile:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def errors_in_native_fmus(count: int, seed: int, progress: Progress) -> Counts:
    """Let a random call of a native FMU fail, with and without a damaged file."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as folder:
        for version in (2, 3):
            saves, store = native_saves(folder, version)
            first = first_drive(saves, store)
            for number in range((count + version % 2) // 2):
                present = first if rng.random() < 0.8 else DAMAGED
                (store / NAME).write_bytes(present)
                _remove_others(store / NAME)
                lost = LOST in saves.drive(store, _fault(rng, store.name))
                found.update(_judged_native(store, present, lost))
                progress((version - 2) * count // 2 + number + 1)
    return dict(found)


def _fault(rng: np.random.Generator, path: str) -> Fault:
    call, error = str(rng.choice(CALLS)), int(rng.choice(ERRORS))
    if call not in ("read", "write") and error == SHORT:
        error = errno.EIO
    most = 12 if call == "any" else 4
    return Fault(call, int(rng.integers(1, most + 1)), error, path)


def _judged_native(store: Path, present: bytes, lost: bool) -> Counts:
    """As ``_judged``: all sound, and a lesson more unless the FMU said that it is lost."""
    files = {path.name: path.read_bytes() for path in store.iterdir()}
    profiles = {name: data for name, data in files.items() if name.endswith(".pldf")}
    damaged = present == DAMAGED
    learned = sum(lessons(data) for data in profiles.values() if data != present or not damaged)
    wrong = (
        (damaged and present not in files.values())
        or (not damaged and NAME not in files)
        or (not lost and learned < 1 + (not damaged))
        or (not damaged and lost and files.get(NAME) != present)
    )
    return {
        "rounds": 1,
        "saved": not lost and len(profiles) == 1,
        "kept_beside": not lost and len(profiles) > 1,
        "refused": lost,
        "violations": bool(wrong),
    }


EXPERIMENTS: Final = (
    Experiment(
        "disk_errors_in_python",
        "Whatever call to the disk fails, what was there stays, and no lesson is lost silently.",
        errors_in_python,
        count=10_000,
        short=200,
    ),
    Experiment(
        "disk_errors_in_native_fmus",
        "The same holds for native FMUs, of FMI 2.0 and 3.0.",
        errors_in_native_fmus,
        count=8000,
        short=40,
    ),
)
