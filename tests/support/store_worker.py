"""A second process for the tests of the store: ``store_worker.py ACTION FOLDER [ARGUMENTS]``."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path

from pldf.files.disk import folder_lock
from pldf.profiles.store import ProfileConflict, ProfileStore, rollback_profile, write_profile
from profile_examples import DRIVER, ROUTE, drive_result, new_profile, two_bases


def tell(text: str) -> None:
    print(text, flush=True)


def hold(folder: str) -> None:
    """Hold the lock until killed."""
    with folder_lock(Path(folder), 60.0):
        tell("locked")
        sys.stdin.read()


def append(folder: str, name: str, drives: str) -> None:
    """Load and append many times."""
    store = ProfileStore(folder, lock_timeout_s=60.0)
    tell("ready")
    sys.stdin.readline()
    for number in range(int(drives)):
        profile = store.load(DRIVER, ROUTE, 11) or new_profile()
        try:
            store.append(profile, drive_result(profile, f"{name}{number}"))
        except ProfileConflict as conflict:
            tell(conflict.kept.name)


def rollback(path: str, times: str) -> None:
    """Roll back many times."""
    tell("ready")
    sys.stdin.readline()
    for _ in range(int(times)):
        rollback_profile(path, 1, lock_timeout_s=60.0)


def overwrite(path: str) -> None:
    """Write two profiles in turn until killed."""
    profiles = two_bases()
    for number in count():
        write_profile(path, profiles[number % 2])
        if number == 1:
            tell("ready")


def crash(folder: str, step: str) -> None:
    """Append one drive, killed before the given step that changes the disk."""
    store = ProfileStore(folder)
    profile = store.load(DRIVER, ROUTE, 11) or new_profile()
    steps = count()

    def die_here() -> None:
        if next(steps) == int(step):
            os.kill(os.getpid(), signal.SIGKILL)

    def watch(event: str, arguments: tuple[object, ...]) -> None:
        if event in ("open", "os.rename", "os.remove") and folder in str(arguments[0]):
            die_here()

    def watched(fsync: Callable[[int], None]) -> Callable[[int], None]:
        def replacement(descriptor: int) -> None:
            die_here()
            fsync(descriptor)

        return replacement

    sys.addaudithook(watch)
    os.fsync = watched(os.fsync)  # type: ignore[assignment]
    store.append(profile, drive_result(profile))
    tell("saved")


if __name__ == "__main__":
    actions = {"append": append, "crash": crash, "hold": hold, "overwrite": overwrite}
    actions["rollback"] = rollback
    actions[sys.argv[1]](*sys.argv[2:])
