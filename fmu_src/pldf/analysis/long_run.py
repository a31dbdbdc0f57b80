"""``long_run.csv``: what becomes of drivers from drive to drive, per variant of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import Final

import numpy as np
import scipy.stats

from ..errors import ModelError
from ..files.tables import Cell, Column, Format, read_table, write_table
from ..kernel.units import KMH_PER_MPS
from ..study.drive_row import PHASE, DriveRow
from ..study.own_files import LONG_RUN_CSV
from .drives_table import read_drives
from .statistics import MeanInterval, mean_interval

Columns = Mapping[str, list[float]]

# Where a study with variants may lie in the folder of the study that it belongs to.
_PLACES: Final = ("", "long_run")
# Means over the drivers: of which value of a drive, times what.
_MEANS: Final = {
    "pedal_percent": ("pedal_rate", 100.0),
    "set_speed_percent": ("set_speed_rate", 100.0),
    "combined_percent": ("combined_rate", 100.0),
    "wish_error_kmh": ("wish_error_mps", KMH_PER_MPS),
    "drive_wish_error_kmh": ("drive_wish_error_mps", KMH_PER_MPS),
}
# The share of drivers who did nothing in the drive.
_CONTENT: Final = "content_percent"
MEASURES: Final = (*_MEANS, _CONTENT)
LONG_RUN: Final = Format(
    "long run",
    "drive",
    (
        Column("variant", "text"),
        PHASE,
        *(Column(name, unit="km/h" if name.endswith("_kmh") else "%") for name in MEASURES),
    ),
    key=("variant", "phase"),
)


def write_long_run(path: Path, drives: Mapping[str, Path]) -> None:
    """Write what became of the drivers in each drive into the CSV file ``path``.

    Per measure there are the value and the ends of its 95 % confidence interval, ``_low`` and
    ``_high``: of a mean by the t distribution, of the share of drivers Wilson's.

    Args:
        path: the file.
        drives: variant -> its ``drives.csv``.

    Raises:
        ModelError: naming file, line, column and value of what is wrong.
    """
    rows = [row for name, table in drives.items() for row in _rows(name, read_drives(table))]
    write_table(path, {name: [row[name] for row in rows] for name in rows[0]})


def _rows(variant: str, drives: Sequence[DriveRow]) -> Iterator[dict[str, Cell]]:
    for phase in dict.fromkeys(drive.phase for drive in drives):
        driven = [drive for drive in drives if drive.phase == phase]
        row: dict[str, Cell] = {"variant": variant, "phase": phase, "participants": len(driven)}
        for name, interval in _intervals(driven).items():
            row[name] = f"{interval.value:.6g}"
            row[f"{name}_low"] = f"{interval.low:.6g}"
            row[f"{name}_high"] = f"{interval.high:.6g}"
        yield row


def _intervals(drives: Sequence[DriveRow]) -> dict[str, MeanInterval]:
    """Return each measure of one drive of all drivers, with its 95 % confidence interval."""
    found = {
        name: _mean([factor * getattr(drive, value) for drive in drives], _most(name))
        for name, (value, factor) in _MEANS.items()
    }
    return {**found, _CONTENT: _share([drive.combined_rate == 0.0 for drive in drives])}


def _share(true: Sequence[bool]) -> MeanInterval:
    """Return how many of 100 are true, with Wilson's interval."""
    ends = scipy.stats.binomtest(sum(true), len(true)).proportion_ci(method="wilson")
    share = sum(true) / len(true)
    return MeanInterval(100.0 * share, 100.0 * float(ends.low), 100.0 * float(ends.high))


def _most(name: str) -> float:
    """Return what a measure is at most."""
    return 100.0 if name.endswith("_percent") else inf


def _mean(values: Sequence[float], most: float) -> MeanInterval:
    """Return a mean with its interval, within 0 and ``most``; one value says nothing of others."""
    if len(values) == 1:
        return MeanInterval(values[0], 0.0, most)
    interval = mean_interval(values)
    return MeanInterval(interval.value, max(interval.low, 0.0), min(interval.high, most))


def long_run_of(folder: Path) -> Path | None:
    """Return the table of the long run that belongs to the study in ``folder``, if there is one."""
    paths = (folder / place / LONG_RUN_CSV for place in _PLACES)
    return next((path for path in paths if path.exists()), None)


def read_long_run(path: Path) -> dict[str, Columns]:
    """Return the columns of the file ``path`` by variant, in its order.

    ``drive`` is the number of the drive with the system that learns, B; of a study without B: with
    A.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    _refuse_older(path)
    table = read_table(path, LONG_RUN)
    phases, variants = table.texts["phase"], np.array(table.texts["variant"])
    system = max(phases, default="B")[0]
    shown = np.array([phase[0] == system for phase in phases])
    numbers = {
        "drive": np.array([float(phase[1:]) for phase in phases]),
        **{name: table.numbers[name] for name in MEASURES},
    }
    return {
        variant: {
            name: column[shown & (variants == variant)].tolist() for name, column in numbers.items()
        }
        for variant in dict.fromkeys(table.texts["variant"])
    }


def _refuse_older(path: Path) -> None:
    """Fail with the way out if the file is one that a script of releases before 0.3 wrote."""
    if path.is_file() and path.read_bytes().startswith(b"stretch_factor,"):
        raise ModelError(
            f"{path}: a long run by stretch factor, as releases before 0.3 wrote it; move it "
            "elsewhere, or drive it anew with 'pldf study studies/stretch_factor.toml'"
        )
