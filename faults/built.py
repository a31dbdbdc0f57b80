"""Where the FMUs are that experiments drive; whoever runs experiments says so first."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Literal

Kind = Literal["python", "native"]

_FOLDERS: Final[dict[Kind, Path]] = {}


def use(python: Path, native: Path) -> None:
    """Let all experiments of this process drive these; FMI 3.0 archives lie in ``native/fmi3``."""
    _FOLDERS.update(python=python, native=native)


def folder(kind: Kind) -> Path:
    """Return the folder with ``AdaptivePLDF.fmu``, ``LongitudinalVehicle.fmu`` and so on."""
    return _FOLDERS[kind]
