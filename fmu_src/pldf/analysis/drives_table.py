"""``drives.csv``: one row per drive of a study, simulated or real."""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Iterator, Sequence
from math import isfinite, nan
from pathlib import Path
from typing import Final

from ..instance import ModelError
from ..recordings.interventions import pedal_interventions, rates_of
from ..recordings.recording import Recording
from ..study.drive_row import COLUMNS, DriveRow

NEEDED: Final = ("participant", "phase", "pedal_rate", "set_speed_rate", "combined_rate")


def row_of(participant: str, phase: str, recording: Recording, where: str) -> DriveRow:
    """Return what a recording with pedals and set-speed offset says about the drive."""
    rates = rates_of(recording)
    return DriveRow(
        participant=participant,
        phase=phase,
        pedal_rate=rates.pedal,
        set_speed_rate=rates.set_speed,
        combined_rate=rates.combined,
        duration_s=float(recording["time_s"][-1] - recording["time_s"][0]),
        interventions=len(pedal_interventions(recording)),
        where=where,
    )


def read_drives(path: Path, without: Collection[str] = ()) -> list[DriveRow]:
    """Read the drives in the CSV file ``path``, in order, but those of some participants.

    Raises:
        ModelError: naming file, line and column of the first thing that cannot be used.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return list(_read(path, file, without))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ModelError(f"{path}: cannot be read as a CSV text file ({error})") from error


def _read(path: Path, lines: Iterator[str], without: Collection[str]) -> Iterator[DriveRow]:
    numbered = ((number, line) for number, line in enumerate(lines, start=1))
    told = [(n, next(csv.reader([line]))) for n, line in numbered if _counts(line)]
    if not told:
        raise ModelError(f"{path}: empty; the first line is {','.join(COLUMNS)}")
    first, header = told[0]
    missing = [name for name in NEEDED if name not in header]
    if missing:
        raise ModelError(f"{path}, line {first}: missing column {', '.join(missing)}")
    for number, cells in told[1:]:
        where = f"{path}, line {number}"
        if len(cells) != len(header):
            raise ModelError(f"{where}: {len(cells)} values for {len(header)} columns")
        row = dict(zip(header, (cell.strip() for cell in cells), strict=True))
        if row["participant"] not in without:
            yield _drive(where, row)


def _counts(line: str) -> bool:
    return bool(line.strip()) and not line.startswith("#")


def _drive(where: str, row: dict[str, str]) -> DriveRow:
    participant, phase = row["participant"], row["phase"]
    if not participant:
        raise ModelError(f"{where}: no participant")
    check_phase(f"{where}, participant {participant}", phase)
    where_drive = f"{where}, participant {participant}, phase {phase}"
    if row.get("system", phase[0]) != phase[0]:
        raise ModelError(f"{where_drive}: the system is {row['system']}, not {phase[0]}")
    shares = [_number(where_drive, row, name) for name in NEEDED[2:]]
    for name, share in zip(NEEDED[2:], shares, strict=True):
        if not 0.0 <= share <= 1.0:
            raise ModelError(f"{where_drive}, {name}: {share:g} is no share of time, 0 to 1")
    return DriveRow(
        participant=participant,
        phase=phase,
        pedal_rate=shares[0],
        set_speed_rate=shares[1],
        combined_rate=shares[2],
        position=int(_optional(where_drive, row, "position", 0.0)),
        duration_s=_optional(where_drive, row, "duration_s"),
        interventions=_optional(where_drive, row, "interventions"),
        wish_error_mps=_optional(where_drive, row, "wish_error_mps"),
        where=where,
    )


def check_phase(where: str, phase: str) -> None:
    """Raise ModelError unless ``phase`` is A or B and the number of the drive."""
    if not re.fullmatch(r"[AB][1-9]\d*", phase):
        raise ModelError(
            f"{where}: phase {phase!r} is not A or B and the number of the drive, such as A1"
        )


def _optional(where: str, row: dict[str, str], name: str, absent: float = nan) -> float:
    return _number(where, row, name) if row.get(name) else absent


def _number(where: str, row: dict[str, str], name: str) -> float:
    try:
        value = float(row[name])
    except ValueError:
        value = nan
    if not isfinite(value):
        raise ModelError(f"{where}, {name}: {row[name]!r} is not a number")
    return value


def check_complete(drives: Sequence[DriveRow], needed: Collection[str], source: str) -> None:
    """Raise ModelError if a participant lacks a drive or has one twice.

    A phase may have been driven several times: then the positions tell the drives apart.

    Args:
        drives: all drives.
        needed: phases that every participant must have driven.
        source: file or folder that they come from.
    """
    seen: dict[tuple[str, str, int], DriveRow] = {}
    for drive in drives:
        before = seen.setdefault((drive.participant, drive.phase, drive.position), drive)
        if before is not drive:
            raise ModelError(
                f"{drive.where}: participant {drive.participant} has phase {drive.phase} already "
                f"({before.where}); a phase driven twice needs positions that differ"
            )
    driven = {(participant, phase) for participant, phase, _ in seen}
    for participant in dict.fromkeys(drive.participant for drive in drives):
        missing = [phase for phase in needed if (participant, phase) not in driven]
        if missing:
            raise ModelError(
                f"{source}: participant {participant} has no drive {', '.join(missing)}; add it "
                f"or leave the participant out with --without {participant}"
            )
