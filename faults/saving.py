"""Saving that is killed at any moment, and writers of all kinds at once."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from native_saves import KILLED, LOST, NAME, Fault, NativeSaves
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.store import (
    ProfileConflict,
    ProfileStore,
    continue_profile,
    read_profile,
    rollback_profile,
)
from profile_examples import drive_result, learned_profile

from . import built
from .binary_files import temporary_folder
from .experiment import Counts, Experiment, Progress

LONG_NODES: Final = 20_000  # so that writing takes its time
CALL_MAX: Final = 16  # more than one drive needs
KILL_AFTER_MAX_S: Final = 0.03  # a save of that profile takes less


def kills_in_python(count: int, seed: int, progress: Progress) -> Counts:
    """Kill processes that append to a profile, each at a random moment."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as folder:
        store = ProfileStore(folder)
        old = learned_profile(1, nodes=LONG_NODES)
        new = old.with_iteration(drive_result(old, "next"))
        path = store.path(old.driver_id, old.route)
        possible = encode(old), encode(new)
        for number in range(count):
            path.write_bytes(possible[0])
            after_s = rng.uniform(0, KILL_AFTER_MAX_S)
            found["kills"] += _killed(lambda: store.append(old, new.iterations[-1]), after_s)
            found.update(_after_kill(path, possible))
            progress(number + 1)
        store.append(read_profile(path), drive_result(read_profile(path)))  # nothing is in its way
    return dict(found)


def _killed(action: Callable[[], object], after_s: float) -> bool:
    """Do ``action`` in a process of its own; return whether it was killed before its end."""
    child = os.fork()
    if child == 0:
        try:
            action()
        finally:
            os._exit(0)
    time.sleep(after_s)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


def _after_kill(path: Path, possible: tuple[bytes, bytes]) -> Counts:
    data = path.read_bytes()
    others = {other.name for other in path.parent.iterdir()} - {path.name}
    allowed = {f"{path.name}.tmp", "pldf-store.lock"}
    return {
        "rounds": 1,
        "saved": data == possible[1],
        "left_over_files": len(others),
        "violations": data not in possible or not others <= allowed,
    }


def kills_of_native_fmus(count: int, seed: int, progress: Progress) -> Counts:
    """Kill C hosts of native FMUs, before a random call to the disk or at a random moment."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as folder:
        for version in (2, 3):
            saves, store = native_saves(folder, version)
            old = first_drive(saves, store)
            lasted_s = min(_lasted_s(saves, store, old) for _ in range(5))
            possible = old, (store / NAME).read_bytes()
            for number in range((count + version % 2) // 2):
                (store / NAME).write_bytes(old)
                fault = Fault("any", int(rng.integers(1, CALL_MAX)), KILLED)
                process = saves.start(store, *([fault] if number % 2 else []))
                if not number % 2:
                    time.sleep(rng.uniform(0.0, lasted_s))
                    process.kill()
                process.communicate()
                found["kills"] += process.returncode == -signal.SIGKILL
                found.update(_after_kill(store / NAME, possible))
                progress((version - 2) * count // 2 + number + 1)
    return dict(found)


def _lasted_s(saves: NativeSaves, store: Path, old: bytes) -> float:
    (store / NAME).write_bytes(old)
    begin_s = time.monotonic()
    if LOST in saves.drive(store):
        raise RuntimeError("a drive without a fault does not save")
    return time.monotonic() - begin_s


def native_saves(folder: Path, version: int) -> tuple[NativeSaves, Path]:
    """Return drives of a native FMU for this version of FMI, and an empty store."""
    store = folder / f"store{version}"
    store.mkdir()
    return NativeSaves(built.folder("native"), version, folder / f"fmi{version}"), store


def first_drive(saves: NativeSaves, store: Path) -> bytes:
    """Return what a first drive leaves."""
    if LOST in saves.drive(store):
        raise RuntimeError("a drive without a fault does not save")
    return (store / NAME).read_bytes()


def lessons(data: bytes) -> int:
    """Return how many iterations a sound profile has."""
    return len(decode(data, NAME).iterations)


def concurrent_writers(count: int, seed: int, progress: Progress) -> Counts:
    """Let Python and native FMUs, ``pldf learn`` and rollbacks write into one profile at once."""
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as folder:
        hosts = [native_saves(folder, version)[0] for version in (2, 3)]
        for number in range(count):
            store = folder / f"shared{number}"
            store.mkdir()
            before = lessons(first_drive(hosts[0], store))
            writes = _written_at_once(store, hosts, seed + number)
            kept = [lessons(path.read_bytes()) for path in store.glob("*.conflict-*.pldf")]
            after = lessons((store / NAME).read_bytes()) + len(kept)
            found.update(writes=writes, kept_beside=len(kept))
            found["violations"] += abs(before + writes - after)
            progress(number + 1)
    return dict(found)


def _written_at_once(store: Path, hosts: list[NativeSaves], seed: int) -> int:
    """Return how many writes there were; all must succeed."""
    context = multiprocessing.get_context("fork")
    each, path = 6, store / NAME
    jobs = [
        context.Process(target=_many, args=(writer, path, each, seed + k))
        for k, writer in enumerate((_append, _append, _learn, _roll_back))
    ]
    driving = [host.start(store) for host in hosts]
    for job in jobs:
        job.start()
    for job in jobs:
        job.join()
    for process in driving:
        process.communicate()
    failed = [p for p in driving if p.returncode] + [job for job in jobs if job.exitcode]
    if failed:
        raise RuntimeError(f"{len(failed)} writers failed")
    return len(jobs) * each + len(driving)


def _many(write: Callable[[Path, int], None], path: Path, times: int, seed: int) -> None:
    for number in range(times):
        write(path, 1000 * seed + number)


def _append(path: Path, seed: int) -> None:
    """As an FMU does it: loaded at the start, appended at the end."""
    store = ProfileStore(path.parent, 60.0)
    known = read_profile(path)
    profile = store.load(known.driver_id, known.route, known.nodes)
    assert profile is not None
    time.sleep(0.002)  # the drive
    try:
        store.append(profile, drive_result(profile, f"drive {seed}", seed))
    except ProfileConflict:
        return


def _learn(path: Path, seed: int) -> None:
    """As ``pldf learn --profile-in X --out X`` does it."""
    profile = read_profile(path)
    try:
        continue_profile(
            path, profile.with_iteration(drive_result(profile, f"learn {seed}", seed)), 60.0
        )
    except ProfileConflict:
        return


def _roll_back(path: Path, seed: int) -> None:
    rollback_profile(path, seed % 2, 60.0)


EXPERIMENTS: Final = (
    Experiment(
        "kills_while_saving_in_python",
        "After a kill at any moment the profile is the old or the new one, whole.",
        kills_in_python,
        count=4000,
        short=60,
    ),
    Experiment(
        "kills_of_native_fmus",
        "After a kill of a native FMU, FMI 2.0 or 3.0, the profile is the old or the new one.",
        kills_of_native_fmus,
        count=10_000,
        short=40,
    ),
    Experiment(
        "concurrent_writers",
        "Python and native FMUs, pldf learn and rollbacks that write at once lose no lesson.",
        concurrent_writers,
        count=120,
        short=1,
    ),
)
