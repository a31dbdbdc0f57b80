"""Roads and scripts for native FMUs, which parse neither OpenDRIVE nor CSV: prepared on the way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Final

from vehicle_models.driver_script import read_script, script_arrays
from vehicle_models.lead_script import read_traffic, traffic_arrays

from ..roads import read_route
from .fmu import Fmu
from .kinds import PARTS_IN_TRAFFIC
from .prepared import SUFFIX, prepared_route, prepared_script
from .values import Value


def _route(path: Path) -> bytes:
    return prepared_route(read_route(path))


def _script(path: Path) -> bytes:
    return prepared_script(script_arrays(read_script(path)))


def _traffic(path: Path) -> bytes:
    return prepared_script(traffic_arrays(read_traffic(path)))


# part and parameter -> how the file is prepared
_PREPARE: Final[dict[tuple[str, str], Callable[[Path], bytes]]] = {
    **{(part, "route_file"): _route for part in PARTS_IN_TRAFFIC},
    ("driver", "script_file"): _script,
    ("lead", "script_file"): _traffic,
}


def readable_values(
    fmus: Mapping[str, Fmu], values: Mapping[str, Mapping[str, Value]]
) -> dict[str, dict[str, Value]]:
    """Return ``values`` with every file that a native FMU is to read in the form it can read.

    What is prepared lies beside the unpacked FMUs and goes with them.

    Raises:
        ModelError: a route or a script cannot be read; names file and line.
    """
    return {
        part: {name: _readable(fmus[part], (part, name), value) for name, value in chosen.items()}
        for part, chosen in values.items()
    }


def _readable(fmu: Fmu, name: tuple[str, str], value: Value) -> Value:
    if not (fmu.native and name in _PREPARE and value):
        return value
    path = Path(str(value))
    return value if path.suffix == SUFFIX else str(_prepared(fmu.folder.parent, name, path))


@cache
def _prepared(folder: Path, name: tuple[str, str], path: Path) -> Path:
    data = _PREPARE[name](path)
    # A name of its own: other processes of a study prepare the same file.
    with NamedTemporaryFile(dir=folder, suffix=SUFFIX, delete=False) as file:
        file.write(data)
    return Path(file.name)
