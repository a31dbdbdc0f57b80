"""Adaptive predictive longitudinal driving function (PLDF) that learns from its driver.

The names of ``__all__`` are imported when they are first used, so that ``import pldf`` is free, and
who reads a route waits for no co-simulation. ``__init__.pyi`` tells type checkers the same.
"""

from importlib import import_module
from typing import Any

__version__ = "0.2.0"

# Where each name of the front door lives.
_PLACES = {
    "Analysis": "analysis.analysis",
    "Drive": "cosim.master",
    "Learned": "recordings.offline",
    "ModelError": "errors",
    "Recording": "recordings.recording",
    "Replay": "recordings.replayed",
    "Route": "roads",
    "StoredProfile": "profiles.store",
    "analyse": "api",
    "base_profile": "api",
    "drive": "api",
    "learn": "api",
    "open_route": "roads",
    "read_profile": "profiles.single_file",
    "read_recording": "recordings.recording",
    "replay": "api",
    "run_study": "api",
    "write_profile": "profiles.single_file",
}
__all__ = list(_PLACES)


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_PLACES[name]}", __name__), name)
    globals()[name] = value  # found without this function from now on
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
