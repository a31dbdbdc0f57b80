"""The version with a digest of the sources that decide results.

Two FMUs, or an FMU and a study, with the same version give the same results to the bit.
"""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from . import __version__

_DIGITS: Final = 12
# Kernels, roads, and what starts the kernels with parameters and stored profiles. FMI, files and
# study only carry values to and fro; what compiles the kernels must not change a bit.
_DECIDING: Final = {
    "pldf": (
        "kernel/*.py",
        "roads/*.py",
        "roads/data/*",
        "function.py",
        "instance.py",
        "stored_profile.py",
    ),
    "vehicle_models": ("*.py", "scripts/*"),
}
_CARRYING: Final = frozenset({"native.py", "longitudinal_vehicle.py", "scripted_driver.py"})


@cache
def build_version() -> str:
    """Return the package's version, ``+`` and twelve hexadecimal digits."""
    return f"{__version__}+{_digest(_sources())}"


def _sources() -> dict[str, Path]:
    """Return the deciding files by package and relative path."""
    found = {}
    for package, patterns in _DECIDING.items():
        spec = find_spec(package)
        if spec is None or not spec.submodule_search_locations:
            raise ImportError(f"package {package} is not installed")
        folder = Path(spec.submodule_search_locations[0])
        paths = {path for pattern in patterns for path in folder.glob(pattern)}
        for path in paths:
            if path.is_file() and path.name not in _CARRYING:
                found[f"{package}/{path.relative_to(folder).as_posix()}"] = path
    return found


def _digest(sources: dict[str, Path]) -> str:
    total = hashlib.sha256()
    for name in sorted(sources):
        text = sources[name].read_text(encoding="utf-8")  # the same whatever ends its lines
        total.update(f"{len(name)} {name} {len(text)}\n{text}".encode())
    return total.hexdigest()[:_DIGITS]
