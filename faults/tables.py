"""Names that a spreadsheet would take for formulas, in every table that people open."""

from __future__ import annotations

import csv
import io
import random
from pathlib import Path
from typing import Final

from pldf.files.tables import Column, Format, parse_table, table_csv

from faults.experiment import Counts, Experiment, Progress

_STARTS: Final = tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20")
_LETTERS: Final = (*_STARTS, *"'\"a1., ;|!")
_FORM: Final = Format(
    "list", "row", (Column("name", "text", pattern="(?s:.*)"), Column("end", "number"))
)
_NAMES_PER_TABLE: Final = 50


def formulas(count: int, seed: int, progress: Progress) -> Counts:
    """Write tables of hostile names; look for formulas, and for names that do not come back."""
    chance = random.Random(seed)
    violations = 0
    for round_ in range(count):
        names = [
            "".join(chance.choices(_LETTERS, k=chance.randint(0, 8)))
            for _ in range(_NAMES_PER_TABLE)
        ]
        data = table_csv({"name": names, "end": [0.0] * len(names)})
        cells = [row[0] for row in csv.reader(io.StringIO(data.decode(), newline=""))][1:]
        read = parse_table(data, Path("names.csv"), _FORM).texts["name"]
        violations += sum(map(_is_formula, cells))
        violations += sum(
            _lines_alike(a) != _lines_alike(b) for a, b in zip(names, read, strict=True)
        )
        progress(round_ + 1)
    return {"names": count * _NAMES_PER_TABLE, "violations": violations}


def _lines_alike(text: str) -> str:
    return text.strip().replace("\r\n", "\n").replace("\r", "\n")


def _is_formula(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return cell.startswith(_STARTS)
    return False


EXPERIMENTS = (
    Experiment(
        "formulas_in_tables",
        "No name in a table becomes a formula in a spreadsheet, and every name is read back.",
        formulas,
        count=8000,
        short=20,
    ),
)
