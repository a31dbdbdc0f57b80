"""What a person may set in the three FMUs, by names that are as short as they are clear."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Final

from ..errors import ModelError
from ..settings import Given, parameter_value
from .fmu import Fmu
from .master import connections
from .values import Value

_INTEGER_MAX: Final = 2**31 - 1  # of an FMI Integer
_NEAR_MAX: Final = 3

# part -> variable -> value
Chosen = dict[str, dict[str, Value]]


def chosen_values(fmus: Mapping[str, Fmu], given: Mapping[str, Given]) -> Chosen:
    """Return values by part and variable.

    Args:
        fmus: from ``unpacked``.
        given: by variable, or by ``PART.VARIABLE`` where more than one FMU has the variable.

    Raises:
        ModelError: one cannot be set; names what can.
    """
    settable = _settable(fmus)
    chosen: Chosen = {}
    for name, value in given.items():
        places = settable.get(name, [])
        if not places:
            raise ModelError(f"{name}: {_way_out(name, settable)}")
        if len(places) > 1:
            choices = ", ".join(f"{part}.{variable}" for part, variable in places)
            raise ModelError(f"{name}: more than one FMU has it, write one of {choices}")
        part, variable = places[0]
        chosen.setdefault(part, {})[variable] = _value(fmus[part], variable, value)
    return chosen


def _settable(fmus: Mapping[str, Fmu]) -> dict[str, list[tuple[str, str]]]:
    """Return (part, variable) by every name that a person may use; more than one: ambiguous."""
    fed = {connection.target for connection in connections(fmus)}
    names: dict[str, list[tuple[str, str]]] = {}
    for part, fmu in fmus.items():
        for signal in (*fmu.named("parameter"), *fmu.named("input")):
            place = (part, signal.name)
            if place not in fed:
                names.setdefault(signal.name, []).append(place)
                names[f"{part}.{signal.name}"] = [place]
    return names


def _way_out(name: str, settable: Mapping[str, object]) -> str:
    near = get_close_matches(name, settable, n=_NEAR_MAX, cutoff=0.5)
    hint = f"did you mean {', '.join(near)}?" if near else "write e.g. pldf.learning.weight=0.4"
    return f"no such parameter; {hint}"


def _value(fmu: Fmu, variable: str, given: Given) -> Value:
    signal = fmu.signals[variable]
    if signal.kind == "String":
        return str(given)
    value = parameter_value(signal, given)
    if signal.kind != "Real" and abs(value) > _INTEGER_MAX:
        raise ModelError(f"{variable} = {given}: it must lie within {_INTEGER_MAX} of 0")
    return value
