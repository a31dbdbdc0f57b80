"""Recordings: one row per communication point, in a CSV that people and programs read.

Columns absent from a laboratory's recording are derived where that is possible; otherwise the error
names them. Needed in any case are ``time_s``, ``s_m``, ``speed_mps`` and ``mode``.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from ..files.tables import Cell, table_csv, write_table
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .columns import COLUMNS, KINDS
from .mapping import RecordingMap, read_map
from .reading import read_columns

PathLike = str | os.PathLike[str]


@dataclass(frozen=True, eq=False)
class Recording:
    """A recording that was read or made.

    Attributes:
        columns: by name, of equal length, float64; ``mode`` holds the codes of ``codes.MODE``.
        comments: of the file.
        notes: how it was read and what was repaired.
    """

    columns: dict[str, FloatArray]
    comments: tuple[str, ...] = ()
    notes: tuple[Finding, ...] = ()

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
    for name in cells:
        kind = KINDS[name]
        if kind.kind == "word":
            cells[name] = [kind.words[int(code)] for code in recording[name]]
        elif kind.kind in ("flag", "whole"):
            cells[name] = [int(value) for value in recording[name]]
    return cells


def read_recording(path: PathLike, mapping: RecordingMap | PathLike | None = None) -> Recording:
    """Return the columns that the file ``path`` has; unknown columns are passed over.

    Args:
        path: CSV, or with the optional packages Parquet (``.parquet``) or ASAM MDF4 (``.mf4``); or
            a structured NumPy array (``.npy``, ``.npz``).
        mapping: what the columns are called there and which units they have: a mapping file, the
            name of a ready map, or either as read; default: ``map.toml`` beside the file or in the
            folder of its study, else a ready map that fits, else our names.

    Raises:
        ModelError: naming file, line, column and value of all that cannot be used.
    """
    if mapping is not None and not isinstance(mapping, RecordingMap):
        mapping = read_map(os.fspath(mapping))
    return Recording(*read_columns(Path(path), mapping))
