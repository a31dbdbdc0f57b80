"""What a file is, by its content."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Final, Literal

from vehicle_models.driver_script import SCRIPT
from vehicle_models.lead_script import TRAFFIC_SCRIPT

from ...errors import ModelError
from ...files.tables import Column, Format, read_header
from ...profiles.file_parts import MAGIC
from ...recordings.columns import RECORDING
from ...recordings.inputs import SUFFIXES
from ...recordings.mapping import PARTS
from ...roads.csv_file import ROUTE
from ...study.drive_row import DRIVES
from ...study.participants_file import PARTICIPANTS
from ..long_run import LONG_RUN
from ..questionnaires.scales import asked_by

Kind = Literal[
    "road", "recording", "questionnaire", "drives", "long run", "participants", "people",
    "exclusions", "driver script", "traffic script", "profile",
    "study file", "mapping file", "",
]  # fmt: skip

# What a laboratory knows about its participants: any columns beside their names.
PEOPLE: Final = Format(
    "list of participants",
    "participant",
    (Column("participant", "text", wanted="the name of a participant"),),
)
_FORMATS: Final[dict[Kind, Format]] = {
    "recording": RECORDING,
    "road": ROUTE,
    "drives": DRIVES,
    "long run": LONG_RUN,
    "participants": PARTICIPANTS,
    "driver script": SCRIPT,
    "traffic script": TRAFFIC_SCRIPT,
}
_FITS: Final = 0.5  # share of the needed columns that tells what a table is
_TABLE_SUFFIXES: Final = (".csv", ".tsv", ".txt", "")
# Files with another ending are checked when they are named, not when a folder is.
KNOWN_SUFFIXES: Final = tuple(
    dict.fromkeys((".csv", ".tsv", ".xodr", ".xml", ".toml", ".pldf", *SUFFIXES))
)


def kind_of(path: Path) -> Kind:
    """Return what ``path`` is by its content; empty if that is nothing known.

    A table is what most of its needed columns say; one of other names is taken for a questionnaire
    if it is called so, else for a recording, which a mapping file can make one of.

    Raises:
        ModelError: the file cannot be read.
    """
    start = _start_of(path)
    suffix = path.suffix.lower()
    if start.startswith(MAGIC) or suffix == ".pldf":
        return "profile"
    if _is_opendrive(start, suffix):
        return "road"
    if suffix == ".toml":
        return _kind_of_toml(path)
    if suffix in _TABLE_SUFFIXES:
        return _kind_of_table(path)
    return "recording" if suffix in SUFFIXES else ""


def is_opendrive(path: Path) -> bool:
    """Return whether ``path`` is, or should be, a road in OpenDRIVE; errors as ``kind_of``."""
    return _is_opendrive(_start_of(path), path.suffix.lower())


def _is_opendrive(start: bytes, suffix: str) -> bool:
    return b"<OpenDRIVE" in start or suffix in (".xodr", ".xml")


def _start_of(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(1 << 16)
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({error.strerror}); check the path") from None


def _kind_of_toml(path: Path) -> Kind:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError):
        return "study file"  # its reader says what is wrong
    return "mapping file" if content.keys() <= set(PARTS) else "study file"


def _kind_of_table(path: Path) -> Kind:
    try:
        names = read_header(path)
    except ModelError:
        return "questionnaire" if _called_questionnaire(path) else "recording"
    if any(map(asked_by, names)) and "s_m" not in names:
        return "questionnaire"
    shares = {kind: _share_of(form, names) for kind, form in _FORMATS.items()}
    best = max(shares, key=lambda kind: shares[kind])
    if shares[best] >= _FITS:
        return best
    if "participant" in names:
        return "exclusions" if "reason" in names else "people"
    return "questionnaire" if _called_questionnaire(path) else "recording"


def _share_of(form: Format, names: tuple[str, ...]) -> float:
    needed = [column.name for column in form.columns if column.needed]
    return sum(name in names for name in needed) / len(needed)


def _called_questionnaire(path: Path) -> bool:
    return any(word in path.stem.lower() for word in ("questionnaire", "survey", "fragebogen"))
