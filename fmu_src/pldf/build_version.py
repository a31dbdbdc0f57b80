"""What FMUs are made from: the version, and a digest of what makes native ones.

Two FMUs, or an FMU and a study, with the same version give the same results to the bit.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from . import __version__

_DIGITS: Final = 12
# Kernels, roads, the tables that roads and scripts are read from, and what starts the kernels with
# parameters and stored profiles. FMI, other files and study only carry values to and fro; what
# compiles the kernels must not change a bit.
_DECIDING: Final = {
    "pldf": (
        "kernel/*.py",
        "roads/*.py",
        "roads/data/*",
        "files/encodings.py",
        "files/tables/*.py",
        "function.py",
        "instance.py",
        "profiles/stored_profile.py",
    ),
    "vehicle_models": ("*.py", "scripts/*", "traffic_scripts/*"),
}
_CARRYING: Final = frozenset(
    {"native.py", "lead_vehicle.py", "longitudinal_vehicle.py", "scripted_driver.py"}
)
# What makes native FMUs of the kernels.
_MAKING: Final = {
    "pldf": (
        "build/native/*.py",
        "build/runtime/*.[ch]",
        "cosim/platforms.py",
        "cosim/prepared.py",
    ),
    "vehicle_models": ("native.py",),
}


@cache
def build_version() -> str:
    """Return the package's version, ``+`` and twelve hexadecimal digits."""
    sources = _sources(_DECIDING)
    deciding = {name: path for name, path in sources.items() if path.name not in _CARRYING}
    return f"{__version__}+{_digest(deciding)}"


@cache
def native_making() -> str:
    """Return twelve hexadecimal digits of what makes native FMUs of the kernels.

    That decides no results, so it is no part of the version; but who changed it expects to drive
    with FMUs that were made anew.
    """
    return _digest(_sources(_MAKING))


def _sources(patterns_of: Mapping[str, Sequence[str]]) -> dict[str, Path]:
    """Return files by package and relative path."""
    path_of = {}
    for package, patterns in patterns_of.items():
        spec = find_spec(package)
        if spec is None or not spec.submodule_search_locations:
            raise ImportError(f"package {package} is not installed")
        folder = Path(spec.submodule_search_locations[0])
        paths = {path for pattern in patterns for path in folder.glob(pattern)}
        for path in paths:
            if path.is_file():
                path_of[f"{package}/{path.relative_to(folder).as_posix()}"] = path
    return path_of


def _digest(sources: dict[str, Path]) -> str:
    total = hashlib.sha256()
    for name in sorted(sources):
        text = sources[name].read_text(encoding="utf-8")  # the same whatever ends its lines
        total.update(f"{len(name)} {name} {len(text)}\n{text}".encode())
    return total.hexdigest()[:_DIGITS]
