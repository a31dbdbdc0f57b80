"""``--set NAME=VALUE``."""

from __future__ import annotations

import argparse
from typing import Any

from ...errors import ModelError
from ...settings import set_parameters


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Add ``--set NAME=VALUE``."""
    parser.add_argument(
        "--set",
        dest="settings",
        type=setting,
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="set a parameter by its FMI name, e.g. learning.weight=0.4 (repeatable)",
    )


def setting(text: str) -> str:
    """Return a ``NAME=VALUE`` as it is; anything else is wrong usage."""
    if "=" not in text:
        raise argparse.ArgumentTypeError(f"{text}: write {text}=VALUE")
    return text


def split_settings(settings: list[str]) -> dict[str, str]:
    """Return values by name from ``NAME=VALUE`` texts."""
    return dict(text.split("=", 1) for text in settings)


def apply_settings(record: Any, settings: list[str]) -> None:
    """Set parameters of ``record`` from ``NAME=VALUE`` texts; ModelError if one cannot be."""
    given = split_settings(settings)
    try:
        set_parameters(record, given)
    except ModelError as problem:
        raise ModelError(f"--set {problem}") from None
