"""From cells to numbers, as programs of all countries write them.

Which of comma and point is the decimal mark is decided for a table as a whole: 1,5 cannot be a
number with thousands apart, nor can 12.5, and 1,234.5 and 1.234,5 say it themselves. Where a table
contradicts itself, what has a comma is no number.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from math import nan
from typing import Final, NamedTuple

import numpy as np

from ...kernel.arrays import FloatArray

# What stands for a number that is missing, in lower case.
MISSING: Final = frozenset(
    ("", "na", "n/a", "#n/a", "nan", "null", "none", ".", "-99", "-999", "-99.0", "-999.0")
)

_EXPONENT: Final = r"(?:[eE][+-]?\d+)?"
_COMMA_APART: Final = re.compile(
    rf"[+-]?[1-9]\d{{0,2}}(?:,\d{{3}})+(?:\.\d*)?{_EXPONENT}", re.ASCII
)
_POINT_APART: Final = re.compile(r"[+-]?[1-9]\d{0,2}(?:\.\d{3})+", re.ASCII)
_COMMA_DECIMAL: Final = re.compile(
    rf"[+-]?(?:\d*|[1-9]\d{{0,2}}(?:\.\d{{3}})+),\d+{_EXPONENT}", re.ASCII
)
_POINT_DECIMAL: Final = re.compile(rf"[+-]?\d*\.\d*{_EXPONENT}", re.ASCII)
_OTHER_APART: Final = re.compile(r"(?<=\d)['\u2019\u00a0\u202f\u2009](?=\d{3}(?!\d))")
_MINUS: Final = str.maketrans({"\u2212": "-"})


class Marks(NamedTuple):
    """How the numbers of a table are written.

    Attributes:
        decimal: the decimal mark.
        example: a cell that another mark would make another number; empty if there is none.
    """

    decimal: str = "."
    example: str = ""


def marks_of(cells: Iterable[str], separator: str) -> Marks:
    """Return how the numbers in ``cells`` are written."""
    written = [_plain(cell) for cell in cells if "," in cell or "." in cell]
    commas = [cell for cell in written if "," in cell]
    several = [cell for cell in written if cell.count(".") > 1 and _POINT_APART.fullmatch(cell)]
    if not commas and not several:
        return Marks()
    by_comma = [c for c in commas if _COMMA_DECIMAL.fullmatch(c) and not _COMMA_APART.fullmatch(c)]
    by_comma += several
    by_point = [c for c in commas if _COMMA_APART.fullmatch(c) and not _COMMA_DECIMAL.fullmatch(c)]
    points = (c for c in written if "," not in c and not _POINT_APART.fullmatch(c))
    by_point += [c for c in points if _POINT_DECIMAL.fullmatch(c)]
    if by_comma and not by_point:
        return Marks(",", by_comma[0])
    if by_point and not by_comma:
        return Marks(".", next((c for c in commas if _COMMA_APART.fullmatch(c)), ""))
    if not by_comma and separator != ",":
        return Marks(",", commas[0])
    return Marks("", (by_comma or commas)[0])


def numbers_of(cells: Sequence[str], decimal: str) -> FloatArray:
    """Return the numbers in ``cells``, NaN where there is none."""
    try:
        if decimal != "," and _is_ascii("".join(cells)):
            return np.fromiter(map(float, cells), np.float64, len(cells))
    except ValueError:
        pass  # the slow way finds out where
    return np.array([_number(_plain(cell), decimal) for cell in cells], dtype=np.float64)


def _plain(cell: str) -> str:
    """Return a cell without what separates thousands whatever the decimal mark."""
    return _OTHER_APART.sub("", cell.strip().translate(_MINUS))


def _number(cell: str, decimal: str) -> float:
    if decimal == "," and (_COMMA_DECIMAL.fullmatch(cell) or _POINT_APART.fullmatch(cell)):
        cell = cell.replace(".", "").replace(",", ".")
    elif decimal == "." and _COMMA_APART.fullmatch(cell):
        cell = cell.replace(",", "")
    try:
        return float(cell) if _is_ascii(cell) else nan
    except ValueError:
        return nan


def _is_ascii(text: str) -> bool:
    """Tell whether ``text`` has nothing that only Python takes for a number: 1_000, Thai digits."""
    return "_" not in text and text.isascii()
