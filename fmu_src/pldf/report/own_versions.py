"""What a simulated study wrote of itself, for the report to print: texts and parameters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from ..errors import ModelError

Parameters = Mapping[str, Mapping[str, float]]


class _Versions(msgspec.Struct):
    """The part of the file that the report needs; all else in it is printed as it is."""

    parameters: dict[str, dict[str, float]] = msgspec.field(default_factory=dict)


def read_text(path: Path) -> str:
    """Return the text in the file ``path``; ModelError if it cannot be read or is none."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ModelError(f"{path}: cannot be read ({error}); restore it or take it away") from error


def read_parameters(path: Path, text: str) -> Parameters:
    """Return part (pldf, vehicle) -> FMI name -> value from ``text``, the content of ``path``.

    Raises:
        ModelError: it is not what a study writes.
    """
    try:
        return msgspec.json.decode(text, type=_Versions).parameters
    except msgspec.DecodeError as error:
        raise ModelError(
            f"{path}: not what 'pldf study' wrote ({error}), so the parameters of the run are not "
            "known; restore the file, or take it away to have the figures drawn with the defaults"
        ) from error
