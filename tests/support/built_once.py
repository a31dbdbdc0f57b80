"""What takes long to build is built once per test run, however many workers there are."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from filelock import FileLock


def once(factory: pytest.TempPathFactory, name: str, build: Callable[[Path], None]) -> Path:
    """Return a folder that one of all xdist workers lets ``build`` fill; the others wait for it."""
    base = factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / name
    stamp = folder.with_suffix(".built")
    with FileLock(folder.with_suffix(".lock")):
        if not stamp.is_file():
            folder.mkdir(exist_ok=True)  # another worker may have failed here
            build(folder)
            stamp.touch()
    return folder
