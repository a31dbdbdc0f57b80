"""Profile stores with drives in them, and other processes that use them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from pldf.profiles.store import (
    ProfileStore,
    StoredProfile,
)
from profile_examples import DRIVER, ROUTE, drive_result, new_profile

NAME = f"driver-000017_route-{ROUTE}.pldf"
WORKER = Path(__file__).with_name("store_worker.py")
NOBODY_ELSE = 0.0  # lock timeout where nobody else can hold the lock
needs_sigkill = pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")


@contextmanager
def worker(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, str(WORKER), *map(str, arguments)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            yield process
        finally:
            process.kill()


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def saved_store(folder: Path, drives: int = 2) -> ProfileStore:
    profiles = ProfileStore(folder, NOBODY_ELSE)
    profile = new_profile()
    for seed in range(drives):
        profile = profiles.append(profile, drive_result(profile, f"drive {seed}", seed)).profile
    return profiles


def load(profiles: ProfileStore) -> StoredProfile:
    profile = profiles.load(DRIVER, ROUTE, 11)
    assert profile is not None
    return profile


def failing(number: int) -> Callable[..., None]:
    def fail(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    return fail
