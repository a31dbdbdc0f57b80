"""In which order an importer may call (FMI 2.0.4, section 4.2.4), as a table."""

from __future__ import annotations

from enum import IntEnum
from typing import Final

from ..errors import ModelError


class Phase(IntEnum):
    """Where an FMU instance stands between instantiation and termination."""

    INSTANTIATED = 0
    INITIALIZING = 1
    STEPPING = 2
    TERMINATED = 3


_BEFORE_STEPPING: Final = {
    Phase.INSTANTIATED: Phase.INSTANTIATED,
    Phase.INITIALIZING: Phase.INITIALIZING,
}

# call -> phase in which it is allowed -> phase afterwards. Reading values is always allowed.
CALLS: Final[dict[str, dict[Phase, Phase]]] = {
    "fmi2SetupExperiment": {Phase.INSTANTIATED: Phase.INSTANTIATED},
    "fmi2EnterInitializationMode": {Phase.INSTANTIATED: Phase.INITIALIZING},
    "fmi2ExitInitializationMode": {Phase.INITIALIZING: Phase.STEPPING},
    "fmi2DoStep": {Phase.STEPPING: Phase.STEPPING},
    "fmi2Terminate": {Phase.STEPPING: Phase.TERMINATED},
    "setting a fixed parameter": _BEFORE_STEPPING,
    "setting a variable": {**_BEFORE_STEPPING, Phase.STEPPING: Phase.STEPPING},
}


def next_phase(phase: Phase, call: str) -> Phase:
    """Return the phase after ``call``; ModelError, and nothing changed, when it is out of order."""
    allowed = CALLS[call]
    if phase not in allowed:
        wanted = " or ".join(p.name for p in allowed)
        raise ModelError(f"{call} is not allowed in phase {phase.name}, only in {wanted}")
    return allowed[phase]
