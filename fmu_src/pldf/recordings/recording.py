"""Recordings: one row per communication point, in a CSV that people and programs read.

Columns absent from a laboratory's recording are derived where that is possible; otherwise the error
names them. Needed in any case are ``time_s``, ``s_m``, ``speed_mps`` and ``mode``.
"""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Final

import numpy as np

from ..files.disk import replace_file
from ..instance import ModelError
from ..kernel.arrays import FloatArray, ProfileArrays, RouteArrays
from ..kernel.codes import GAS_OVERRIDE, MODE, STANDBY

COLUMNS: Final = (
    "time_s",
    "s_m",
    "speed_mps",
    "acceleration_mps2",
    "mode",
    "gas_pedal",
    "brake_pedal",
    "set_speed_mps",
    "set_speed_offset_mps",
    "profile_mps",
    "base_mps",
    "limit_mps",
    "eligible",
)
NEEDED: Final = ("time_s", "s_m", "speed_mps", "mode")


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
    replace_file(Path(path), recording_csv(recording))


def recording_csv(recording: Recording) -> bytes:
    """Return the content of a recording's file."""
    names = [name for name in COLUMNS if name in recording]
    texts = [_texts(name, recording[name]) for name in names]
    lines = chain(
        (f"# {comment}" for comment in recording.comments),
        (",".join(names),),
        (",".join(row) for row in zip(*texts, strict=True)),
    )
    return ("\n".join(lines) + "\n").encode()


def _texts(name: str, values: FloatArray) -> list[str]:
    if name == "mode":
        return [MODE.items[int(value)] for value in values]
    if name == "eligible":
        return ["1" if value else "0" for value in values]
    return [repr(value) for value in values.tolist()]


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Return the columns that the file ``path`` has; unknown columns are passed over.

    Raises:
        ModelError: naming file, line and column of the first thing that cannot be used.
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ModelError(f"{path}: cannot be read as a CSV text file ({error})") from error
    lines = text.rstrip().splitlines()
    first = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    comments = tuple(line[1:].strip() for line in lines[:first])
    rows = list(csv.reader(io.StringIO("\n".join(lines[first:]))))
    if not rows or not rows[0]:
        raise ModelError(f"{path}: no header line; a recording starts with {','.join(NEEDED)},...")
    header = [name.strip() for name in rows[0]]
    missing = [name for name in NEEDED if name not in header]
    if missing:
        raise ModelError(
            f"{path}, line {first + 1}: missing column {', '.join(missing)} "
            f"(needed are {', '.join(NEEDED)})"
        )
    _check_widths(path, rows, first)
    columns: dict[str, FloatArray] = {
        name: _column(path, name, [row[header.index(name)] for row in rows[1:]], first + 2)
        for name in COLUMNS
        if name in header
    }
    recording = Recording(columns, comments)
    _check(path, recording, first + 2)
    return recording


def _check_widths(path: str | os.PathLike[str], rows: list[list[str]], first: int) -> None:
    for number, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise ModelError(
                f"{path}, line {first + number + 1}: {len(row)} values for {len(rows[0])} columns"
            )


def _column(
    path: str | os.PathLike[str], name: str, texts: list[str], first_line: int
) -> FloatArray:
    """Convert one column; the slow search for the line happens only when that fails."""
    try:
        if name == "mode":
            return np.array([MODE.code(text.strip()) for text in texts], dtype=np.float64)
        return np.array(texts, dtype=np.float64) if texts else np.zeros(0)
    except ValueError:
        pass
    for number, text in enumerate(texts):
        try:
            MODE.code(text.strip()) if name == "mode" else float(text)
        except ValueError:
            wanted = f"one of {', '.join(MODE.items)}" if name == "mode" else "a number"
            raise ModelError(
                f"{path}, line {first_line + number}, {name}: {text!r} is not {wanted}"
            ) from None
    raise AssertionError("a column that cannot be converted has a cell that cannot")


def _check(path: str | os.PathLike[str], recording: Recording, first_line: int) -> None:
    if len(recording) < 2:
        raise ModelError(f"{path}: {len(recording)} samples; a drive needs at least two")
    for name, values in recording.columns.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise ModelError(f"{path}, line {first_line + bad[0]}, {name}: not a finite number")
    back = np.flatnonzero(np.diff(recording["time_s"]) <= 0.0)
    if len(back):
        raise ModelError(
            f"{path}, line {first_line + back[0] + 1}, time_s: not after the line before; "
            "sort the recording by time and drop repeated rows"
        )


def completed(recording: Recording, route: RouteArrays, profile: ProfileArrays) -> Recording:
    """Return ``recording`` with every column, absent ones derived from route and profile driven.

    Pedals come from the mode (standby after driving counts as braked), acceleration from the
    speed, set speed and offset from each other and the limit.
    """
    columns = dict(recording.columns)
    cell = np.clip(np.floor(columns["s_m"]), 0, len(route.limit_mps) - 1).astype(np.intp)
    node = np.arange(float(len(route.limit_mps)))
    automatic = (np.asarray(route.limit_mps) + np.asarray(profile.offset_mps))[cell]
    columns.setdefault("limit_mps", np.asarray(route.limit_mps)[cell])
    columns.setdefault("base_mps", np.interp(columns["s_m"], node, np.asarray(profile.base_mps)))
    columns.setdefault(
        "profile_mps", np.interp(columns["s_m"], node, np.asarray(profile.learned_mps))
    )
    columns.setdefault("gas_pedal", (columns["mode"] == GAS_OVERRIDE).astype(np.float64))
    columns.setdefault("brake_pedal", (columns["mode"] == STANDBY).astype(np.float64))
    columns.setdefault("eligible", np.ones(len(recording)))
    columns.setdefault("acceleration_mps2", np.gradient(columns["speed_mps"], columns["time_s"]))
    if "set_speed_mps" not in columns:
        columns["set_speed_mps"] = automatic + columns.get("set_speed_offset_mps", 0.0)
    columns.setdefault("set_speed_offset_mps", columns["set_speed_mps"] - automatic)
    return replace(recording, columns={name: columns[name] for name in COLUMNS})
