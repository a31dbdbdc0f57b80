"""Recordings: one row per communication point, in a CSV that people and programs read.

Columns absent from a laboratory's recording are derived where that is possible; otherwise the error
names them. Needed in any case are ``time_s``, ``s_m``, ``speed_mps`` and ``mode``.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..files.tables import Cell, Column, Fault, Format, Table, read_table, table_csv, write_table
from ..kernel.arrays import FloatArray
from ..kernel.codes import MODE

RECORDING: Final = Format(
    "recording",
    "sample",
    (
        Column("time_s", unit="s"),
        Column("s_m", unit="m"),
        Column("speed_mps", unit="m/s"),
        Column("acceleration_mps2", unit="m/s2", needed=False),
        Column("mode", "word", words=MODE.items),
        Column("gas_pedal", unit="1", needed=False),
        Column("brake_pedal", unit="1", needed=False),
        Column("set_speed_mps", unit="m/s", needed=False),
        Column("set_speed_offset_mps", unit="m/s", needed=False),
        Column("profile_mps", unit="m/s", needed=False),
        Column("base_mps", unit="m/s", needed=False),
        Column("limit_mps", unit="m/s", needed=False),
        Column("eligible", "flag", needed=False),
    ),
    rows_min=2,
)
COLUMNS: Final = RECORDING.names


@dataclass(frozen=True, eq=False)
class Recording:
    """Named columns of equal length, float64; ``mode`` holds the codes of ``codes.MODE``."""

    columns: dict[str, FloatArray]
    comments: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.columns["time_s"])

    def __getitem__(self, name: str) -> FloatArray:
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        return name in self.columns


def write_recording(path: str | os.PathLike[str], recording: Recording) -> None:
    """Write ``recording`` as CSV, atomically; every number reads back to the same bits."""
    write_table(path, _cells(recording), recording.comments)


def recording_csv(recording: Recording) -> bytes:
    """Return the content of a recording's file."""
    return table_csv(_cells(recording), recording.comments)


def _cells(recording: Recording) -> dict[str, list[Cell] | FloatArray]:
    cells: dict[str, list[Cell] | FloatArray] = {
        name: recording[name] for name in COLUMNS if name in recording
    }
    cells["mode"] = [MODE.items[int(code)] for code in recording["mode"]]
    if "eligible" in cells:
        cells["eligible"] = [bool(flag) for flag in recording["eligible"]]
    return cells


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Return the columns that the file ``path`` has; unknown columns are passed over.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    table = read_table(path, RECORDING)
    table.refuse(_back_in_time(table))
    return Recording(table.numbers, table.comments)


def _back_in_time(table: Table) -> Iterator[Fault]:
    for row in np.flatnonzero(np.diff(table.numbers["time_s"]) <= 0.0).tolist():
        text = "not after the line before; sort the recording by time and drop repeated rows"
        yield table.fault(row + 1, "time_s", text)
