"""Times of the rows of a recording: repeated rows, shared stamps, clocks that stand or go back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..files.tables import Fault, Table
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .columns import RECORDING
from .stamps import CoarseStamps

_BACKWARDS: Final = "sort the recording by time, or cut it where the logger began anew"


def with_growing_time(
    table: Table, numbers: dict[str, FloatArray], notes: list[Finding], clock: str
) -> dict[str, FloatArray]:
    """Return columns whose time grows: without repeated rows, with shared stamps spread out.

    Args:
        table: as it was read, for lines.
        numbers: its columns as ours.
        notes: take what was done.
        clock: name of the column of time in the file.

    Raises:
        TableError: time runs backwards or stands still.
    """
    table.refuse(_back_in_time(table, numbers["time_s"], clock))
    same = np.append(False, np.diff(numbers["time_s"]) == 0.0)
    lines = np.array(table.lines)
    repeated = same & _as_before(numbers)
    # Where most rows with the stamp before differ from it, stamps are coarse, and equal rows are
    # those of a car that stands.
    if 2 * np.count_nonzero(repeated) > np.count_nonzero(same):
        notes.append(_repeated(table, lines[repeated]))
        numbers = {name: values[~repeated] for name, values in numbers.items()}
        lines, same = lines[~repeated], same[~repeated]
    if not same.any():
        table.refuse(_one_row(table, numbers))
        return numbers
    coarse = CoarseStamps(numbers["time_s"])
    table.refuse(_standing(coarse, lines))
    times_s = coarse.times_s()
    notes.append(_shared_out(table, coarse, times_s, int(lines[same][0])))
    return {**numbers, "time_s": times_s}


def _one_row(table: Table, numbers: dict[str, FloatArray]) -> Iterator[Fault]:
    if len(numbers["time_s"]) < RECORDING.rows_min:
        yield Fault(table.lines[0], "", "all rows are the same; a recording needs two that differ")


def _as_before(numbers: dict[str, FloatArray]) -> NDArray[np.bool_]:
    """Tell which rows are like the one before in every column."""
    same = [np.append(False, v[1:] == v[:-1]) for v in numbers.values()]
    return np.asarray(np.all(same, axis=0))


def _repeated(table: Table, lines: NDArray[np.intp]) -> Finding:
    return Finding(
        "note", str(table.path), int(lines[0]), "", f"{len(lines)} rows repeat the one before them",
        "they are left out; no number changes by that",
    )  # fmt: skip


def _standing(coarse: CoarseStamps, lines: NDArray[np.intp]) -> Iterator[Fault]:
    for row in coarse.standing:
        text = f"the clock stands still at {coarse.stamps_s[row]:.10g} s while the car drives on"
        yield Fault(
            int(lines[row]), "time_s", f"{text}; cut the recording there, or repair its times"
        )


def _shared_out(table: Table, coarse: CoarseStamps, times_s: FloatArray, line: int) -> Finding:
    moved = float(np.max(np.abs(times_s - coarse.stamps_s)))
    return Finding(
        "note", str(table.path), line, "time_s",
        f"{coarse.shared} of {len(times_s)} samples have the stamp of the one before, up to "
        f"{coarse.longest} share one: stamps are coarser ({coarse.step_s:.3g} s) than samples",
        f"samples were spread evenly, by {moved:.2g} s at most; the times of interventions are "
        "that uncertain",
        "write more decimals of time, for exact times",
    )  # fmt: skip


def _back_in_time(table: Table, time_s: FloatArray, clock: str) -> Iterator[Fault]:
    for row in np.flatnonzero(np.diff(time_s) < 0.0).tolist():
        text = f"time runs backwards, from {time_s[row]:.10g} s to {time_s[row + 1]:.10g} s"
        yield table.fault(row + 1, clock, f"{text}; {_BACKWARDS}")
