"""``long_run.csv``: what becomes of drivers who drive again and again, per stretch factor."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from ..files.tables import Column, Format, read_table

Columns = Mapping[str, list[float]]

MEASURES: Final = ("combined_percent", "pedal_percent", "content_percent", "wish_error_kmh")
LONG_RUN: Final = Format(
    "long run",
    "drive",
    (
        Column("stretch_factor"),
        Column("drive", "whole", low=1.0),
        *(Column(name, unit="km/h" if name.endswith("_kmh") else "%") for name in MEASURES),
    ),
)


def read_long_run(path: Path) -> dict[float, Columns]:
    """Return the columns of the file ``path`` by stretch factor, drives in order.

    Raises:
        ModelError: naming file, line, column and value of what cannot be used.
    """
    numbers = read_table(path, LONG_RUN).numbers
    factor = numbers["stretch_factor"]
    return {
        value: {name: column[factor == value].tolist() for name, column in numbers.items()}
        for value in np.unique(factor).tolist()
    }
