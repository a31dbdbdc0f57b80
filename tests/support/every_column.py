"""A recording with every column there is, each with numbers of its kind."""

from __future__ import annotations

import numpy as np
from pldf.kernel.arrays import FloatArray
from pldf.recordings.columns import KINDS


def every_column(rows: int) -> dict[str, FloatArray]:
    """Return the columns: codes and flags in turn, other numbers by chance."""
    count = np.arange(float(rows))
    columns = {}
    for at, (name, column) in enumerate(KINDS.items()):
        turns = {"word": len(column.words), "flag": 2, "whole": 7}.get(column.kind, 0)
        drawn = np.random.default_rng(at).normal(20.0, 5.0, rows)
        columns[name] = count % turns if turns else drawn
    columns["time_s"] = 0.01 * count
    return columns
