"""What a simulator sends for a cluster, checked: a name that nobody shows must not go unnoticed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from http import HTTPStatus
from math import isfinite
from typing import Any, Final

from .storage import Refused

# A variable as the page knows it (``Variable`` in ``types.js``), by name.
Variables = Mapping[str, Mapping[str, Any]]

_LISTED_MAX: Final = 5
_WANTED: Final = {
    "String": "a text",
    "Boolean": "true or false",
    "Real": "a number",
    "Integer": "a whole number",
}


def shown_variables(bundle: Mapping[str, Any]) -> Variables:
    """Return what a drive tells: inputs and outputs of function and car; none without models."""
    models = bundle.get("models", {})
    return {
        variable["name"]: variable
        for part in ("vehicle", "pldf")
        if part in models
        for variable in models[part]["variables"]
        if variable["causality"] != "parameter"
    }


def require_frame(message: Mapping[str, Any], known: Variables) -> None:
    """Check the names and values of a frame; without ``known`` ones only that there are values.

    Raises:
        Refused: names what is not known, and values that are of another kind.
    """
    values = message.get("values")
    if not isinstance(values, dict):
        raise Refused(HTTPStatus.BAD_REQUEST, 'a frame has "values": {"vehicle.speed_mps": ...}')
    problems = list(_problems(values, known))[:_LISTED_MAX] if known else []
    if problems:
        raise Refused(HTTPStatus.BAD_REQUEST, "; ".join(problems))


def _problems(values: Mapping[str, Any], known: Variables) -> Iterator[str]:
    for name, value in values.items():
        if name not in known:
            near = get_close_matches(name, known, n=1)
            yield f"{name} is unknown{f'; did you mean {near[0]}?' if near else ''}"
        elif not _fits(known[name]["kind"], value):
            yield f"{name} = {value!r} must be {_WANTED[known[name]['kind']]}"


def _fits(kind: str, value: Any) -> bool:
    if kind == "String":
        return isinstance(value, str)
    if kind == "Boolean":
        return value in (False, True)
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and isfinite(value) and (kind == "Real" or value == int(value))
