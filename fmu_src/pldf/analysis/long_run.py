"""``long_run.csv``: what becomes of drivers who drive again and again, per stretch factor."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Final

from ..instance import ModelError

Columns = Mapping[str, list[float]]

# Column -> what it is, for axes.
PANELS: Final = {
    "combined_percent": "Pedals or set speed<br>(% of the time)",
    "pedal_percent": "Pedals<br>(% of the time)",
    "content_percent": "Drivers who<br>did nothing (%)",
    "wish_error_kmh": "Profile minus wish,<br>RMS (km/h)",
}
NEEDED: Final = ("stretch_factor", "drive", *PANELS)


def read_long_run(path: Path) -> dict[float, Columns]:
    """Return the columns of the file ``path`` by stretch factor, drives in order.

    Raises:
        ModelError: naming file, line and column of what cannot be used.
    """
    found: dict[float, dict[str, list[float]]] = {}
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = csv.DictReader(file)
            missing = [name for name in NEEDED if name not in (rows.fieldnames or ())]
            if missing:
                raise ModelError(f"{path}, line 1: missing column {', '.join(missing)}")
            for row in rows:
                values = {n: _number(f"{path}, line {rows.line_num}", n, row[n]) for n in NEEDED}
                columns = found.setdefault(values["stretch_factor"], {n: [] for n in NEEDED})
                for name, value in values.items():
                    columns[name].append(value)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ModelError(f"{path}: cannot be read as a CSV text file ({error})") from error
    return {factor: found[factor] for factor in sorted(found)}


def _number(where: str, name: str, text: str | None) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise ModelError(f"{where}, {name}: {text!r} is not a number")
    return value
