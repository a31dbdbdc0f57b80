"""Arguments that several commands share."""

from __future__ import annotations

import argparse
from difflib import get_close_matches
from typing import Any

from ..instance import ModelError
from ..kernel.signals import Signal, signals_of


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Add ``--set NAME=VALUE``."""
    parser.add_argument(
        "--set",
        dest="settings",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="set a parameter by its FMI name, e.g. learning.weight=0.4 (repeatable)",
    )


def apply_settings(record: Any, settings: list[str]) -> None:
    """Set parameters of ``record`` from ``NAME=VALUE`` texts; ModelError if one cannot be."""
    parameters = {s.name: s for s in signals_of(record) if s.causality == "parameter"}
    for setting in settings:
        name, equals, text = setting.partition("=")
        if name not in parameters or not equals:
            near = ", ".join(get_close_matches(name, parameters, cutoff=0.3)) or "see docs"
            raise ModelError(f"--set {setting}: no such parameter; write NAME=VALUE, e.g. {near}")
        setattr(record, parameters[name].field, parse_value(parameters[name], text))


def parse_value(signal: Signal, text: str) -> float | int:
    """Return ``text`` as a value of ``signal``; enumerations by item, Booleans as true or false."""
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
