"""``drives.csv``: one row per drive of a study, simulated or real."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from math import isnan, nan
from pathlib import Path
from typing import Final

from ..files.tables import Fault, LeftOut, Table, read_table
from ..findings import Finding
from ..recordings.interventions import Rates, pedal_interventions, rates_of
from ..recordings.recording import Recording
from ..study.drive_row import DRIVES, DriveRow
from .exclusions import EXCLUSIONS, Exclusions

_ROUNDED: Final = 0.015  # what three shares written with two decimals can be off


def row_of_recording(participant: str, phase: str, recording: Recording, where: str) -> DriveRow:
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


def read_drives(
    path: Path, left_out: LeftOut | None = None, notes: list[Finding] | None = None
) -> list[DriveRow]:
    """Read the drives in the CSV file ``path``, in order.

    Args:
        path: the file.
        left_out: says of the cells of a row, by column, whether it is passed over.
        notes: how the file was read is added to them.

    Raises:
        ModelError: naming file, line, participant, phase, column and value of what is wrong.
    """
    table = read_table(path, DRIVES, left_out)
    table.refuse((*_other_systems(table), *_impossible_shares(table)))
    if notes is not None:
        notes += table.notes
    return [_drive(table, row) for row in range(len(table))]


def _drive(table: Table, row: int) -> DriveRow:
    numbers = {name: float(values[row]) for name, values in table.numbers.items()}
    numbers.pop("system", None)
    position = numbers.pop("position", nan)
    return DriveRow(
        participant=table.texts["participant"][row],
        phase=table.texts["phase"][row],
        position=0 if isnan(position) else int(position),
        where=f"{table.path}, line {table.lines[row]}",
        **numbers,
    )


def _other_systems(table: Table) -> Iterator[Fault]:
    for row, place in enumerate(table.numbers.get("system", ())):
        system, phase = "AB"[int(place)], table.texts["phase"][row]
        if system != phase[0]:
            yield table.fault(row, "system", f"{system!r} is not that of the phase, {phase[0]}")


def _impossible_shares(table: Table) -> Iterator[Fault]:
    """The time with either covers that with each, and is at most that with one plus the other."""
    shares = [table.numbers[f"{name}_rate"] for name in Rates._fields]
    for row, (pedal, set_speed, combined) in enumerate(zip(*shares, strict=True)):
        low, high = max(pedal, set_speed), min(pedal + set_speed, 1.0)
        if not low - _ROUNDED <= combined <= high + _ROUNDED:
            yield table.fault(
                row,
                "combined_rate",
                f"{combined:g} cannot be the share of the time with pedal ({pedal:g}), set speed "
                f"({set_speed:g}) or both, which is from {low:g} to {high:g}; correct the three",
            )


def repeated(drives: Sequence[DriveRow]) -> Iterator[Finding]:
    """Yield the drives that are there twice.

    A phase may have been driven several times: then the positions tell the drives apart.
    """
    seen: dict[tuple[str, str, int], DriveRow] = {}
    for drive in drives:
        before = seen.setdefault((drive.participant, drive.phase, drive.position), drive)
        if before is not drive:
            yield Finding(
                "error", drive.where, 0, "",
                f"participant {drive.participant} has phase {drive.phase} already "
                f"({before.where}); a phase driven twice needs positions that differ",
            )  # fmt: skip


def missing(
    driven: Sequence[tuple[str, str]], needed: Collection[str], source: str, exclusions: Exclusions
) -> Iterator[Finding]:
    """Yield the participants who lack a drive that is not left out.

    Args:
        driven: participant and phase of all drives.
        needed: phases that every participant must have driven.
        source: file or folder that they come from.
        exclusions: what is left out.
    """
    for who in dict.fromkeys(participant for participant, _ in driven):
        absent = [phase for phase in needed if (who, phase) not in driven]
        if lacking := [phase for phase in absent if not exclusions.has(who, phase)]:
            yield Finding(
                "error", source, 0, "", f"participant {who} has no drive {', '.join(lacking)}", "",
                f"add it, say in {EXCLUSIONS} why it is missing, or leave the participant out with "
                f"--without {who}",
            )  # fmt: skip
