"""What a simulated study wrote of itself, for the report to print: texts and parameters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec

from ..errors import ModelError
from ..findings import Finding
from ..study.own_files import VERSIONS

Parameters = Mapping[str, Mapping[str, float]]


class _Versions(msgspec.Struct):
    """The part of the file that the report needs; all else in it is printed as it is."""

    parameters: dict[str, dict[str, float]] = msgspec.field(default_factory=dict)
    source: str = ""  # a digest of what drove


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


def driven_otherwise(folder: Path, within: Path) -> tuple[Finding, ...]:
    """Return what is to be said if the variants ``within`` were driven by another release.

    Args:
        folder: of the study that the report is about.
        within: folder of a study with variants, each in a folder of its own.
    """
    source = _source(folder / VERSIONS)
    others = [path for path in sorted(within.glob(f"*/{VERSIONS}")) if _source(path) != source]
    if not source or not others:
        return ()
    return (
        Finding(
            "warning", str(within), 0, others[0].parent.name,
            f"not driven by the release that drove {folder}",
            "its table and figure do not belong to the drives beside them",
            "drive it anew with --restart, or take the folder away",
        ),
    )  # fmt: skip


def _source(path: Path) -> str:
    """Return the digest of what drove; empty if the file does not say."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=_Versions).source
    except (OSError, msgspec.DecodeError):
        return ""
