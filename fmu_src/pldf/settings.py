"""Parameters as people set them: by FMI name, as a number or as text."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

from .errors import ModelError
from .kernel.signals import Signal, signals_of

Given = float | int | str


def set_parameters(record: Any, given: Mapping[str, Given]) -> None:
    """Set parameters of ``record`` by FMI name.

    Raises:
        ModelError: there is no such parameter, or it cannot have this value; names the nearest.
    """
    parameters = {s.name: s for s in signals_of(record) if s.causality == "parameter"}
    for name, value in given.items():
        if name not in parameters:
            near = ", ".join(get_close_matches(name, parameters, cutoff=0.3)) or "see docs"
            raise ModelError(f"{name}: no such parameter; there are e.g. {near}")
        setattr(record, parameters[name].field, parameter_value(parameters[name], value))


def parameter_value(signal: Signal, given: Given) -> float | int:
    """Return a value of ``signal``; enumerations also by item, Booleans as true or false.

    Raises:
        ModelError: it is no such value; its range is checked where it is used.
    """
    text = str(given)
    words = {"true": 1, "false": 0} if signal.kind == "Boolean" else {}
    if signal.enumeration is not None:
        words = {item.lower(): code for code, item in enumerate(signal.enumeration.items)}
    try:
        if text.lower() in words:
            return words[text.lower()]
        return float(text) if signal.kind == "Real" else int(text)
    except ValueError:
        allowed = ", ".join(words) or ("a number" if signal.kind == "Real" else "a whole number")
        raise ModelError(f"{signal.name} = {text}: it must be {allowed}") from None
