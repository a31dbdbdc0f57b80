"""The tables of parameters in a study file: [function], [vehicle] and [driver], by FMI name."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any, Final

from vehicle_models.vehicle_state import VehicleState

from ..errors import ModelError
from ..kernel.codes import LEARN_FAITHFUL, LEARN_OFF
from ..kernel.signals import Signal, signals_of
from ..kernel.state import PldfState
from ..settings import parameter_value
from ..toml_file import Key, TomlFile
from .participants import DRIVER_SIGNALS
from .study_tables import parameter_table

# Parameters that follow from the study file's other keys.
_NOT_TO_SET: Final = (
    "apply_learned", "driver_id", "learn_consistent", "learn_faithful", "localization",
    "main_switch", "route_id", "start_s_m",
)  # fmt: skip


def _settable(record: type[PldfState] | type[VehicleState]) -> dict[str, Signal]:
    return {
        signal.name: signal
        for signal in signals_of(record)
        if signal.causality == "parameter" and signal.name not in _NOT_TO_SET
    }


# The tables of parameters, and what the coupled models are called.
_PARTS: Final = {"function": "pldf", "vehicle": "vehicle", "driver": "driver"}
# The tables of parameters: what may be set there, by FMI name.
SETTABLE: Final[Mapping[str, Mapping[str, Signal]]] = {
    "function": _settable(PldfState),
    "vehicle": _settable(VehicleState),
    "driver": {signal.name: signal for signal in DRIVER_SIGNALS.values()},
}


def changes_of(settings: Mapping[str, str]) -> dict[Key, Any]:
    """Return parameters that a person named, as changes of a study file.

    Args:
        settings: text by FMI name, with ``pldf.``, ``vehicle.`` or ``driver.`` before it where
            more than one of the three has it.

    Raises:
        ModelError: there is no such parameter in a study file, or it cannot have this value.
    """
    places: dict[str, list[Key]] = {}
    for table, part in _PARTS.items():
        for name in SETTABLE[table]:
            places.setdefault(name, []).append((table, name))
            places.setdefault(f"{part}.{name}", []).append((table, name))
    changes = {}
    for given, text in settings.items():
        if given not in places:
            near = ", ".join(get_close_matches(given, places, n=3, cutoff=0.5)) or "learning.weight"
            raise ModelError(f"--set {given}: not in a study file; did you mean {near}?")
        if len(places[given]) > 1:
            both = " or ".join(f"{_PARTS[table]}.{name}" for table, name in places[given])
            raise ModelError(f"--set {given}: more than one FMU has it, write {both}")
        (key,) = places[given]
        changes[key] = _uncoded(SETTABLE[key[0]][key[1]], text)
    return changes


def parameters_of(file: TomlFile, part: str, *table: str) -> dict[str, float | int]:
    """Return what a table of ``part`` sets, by FMI name; enumerations and Booleans as numbers.

    Args:
        file: the study file.
        part: whose parameters these are, a key of ``SETTABLE``.
        table: where they stand; left out: in the table of this name.

    Raises:
        ModelError: naming file, line, key and the allowed values.
    """
    known = SETTABLE[part]
    place = table or (part,)
    read = file.read(parameter_table(known.values()), *place)
    return {
        name: _coded(known[name], getattr(read, known[name].field)) for name in file.within(*place)
    }


def function_of(file: TomlFile, *table: str) -> dict[str, float | int]:
    """Return the parameters of the driving function; ``learn`` is how drives learn that do."""
    values = parameters_of(file, "function", *table)
    if values.get("learn", LEARN_FAITHFUL) == LEARN_OFF:
        file.fail(
            (*(table or ("function",)), "learn"),
            '"OFF": the drives say whether they learn, this says how: write "FAITHFUL" or '
            '"CONSISTENT", or choose drives that do not learn in [drives], such as A1',
        )
    return values


def _uncoded(signal: Signal, text: str) -> Any:
    """Return what a study file says for a value that was given as text."""
    value = parameter_value(signal, text)
    if signal.enumeration is not None and 0 <= value < len(signal.enumeration.items):
        return signal.enumeration.items[int(value)]
    return bool(value) if signal.kind == "Boolean" else value


def _coded(signal: Signal, value: Any) -> float | int:
    if signal.enumeration is not None:
        return signal.enumeration.items.index(value)
    return float(value) if signal.kind == "Real" else int(value)
