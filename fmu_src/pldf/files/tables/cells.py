"""From cells to values: numbers, flags and words, and what is read otherwise than it is written."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import nan
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from .declared import Column, Fault

# What programs write for "no value", in small letters; and numbers that people agree upon for it.
MISSING: Final = frozenset(("", "na", "nan", "n/a", "#n/a", "null", "none", "."))
CODES_OF_MISSING: Final = (-99.0, -999.0, -9999.0)
_MINUS: Final = "\u2212"  # as typesetters write it
_FLAGS: Final = {"true": 1.0, "false": 0.0}
_DECIMAL_COMMA: Final = re.compile(r"\s*[+-]?(\d+,\d*|,\d+)([eE][+-]?\d+)?\s*", re.ASCII)
# What a comma groups in thousands looks so, too.
_GROUPED: Final = re.compile(r"\s*[+-]?[1-9]\d{0,2},\d{3}\s*", re.ASCII)
_THOUSANDS: Final = re.compile(
    r"[+-]?\d{1,3}(([.,' \xa0\u2009\u202f]\d{3})+([.,]\d+)?|[.,]\d+)", re.ASCII
)


@dataclass
class Values:
    """What the cells of a column hold.

    Attributes:
        numbers: NaN where there is none.
        wrong: rows whose cells are not what they should be.
        told: what was read otherwise than it is written.
    """

    numbers: FloatArray
    wrong: list[int]
    told: list[str] = field(default_factory=list)


def values_of(column: Column, cells: Sequence[str]) -> Values:
    """Return the values of ``cells``, which have decimal points."""
    told: list[str] = []
    if column.kind == "word":
        numbers = _places(column, cells, told)
    else:
        numbers = _numbers(column, cells, told)
    wrong = np.flatnonzero(~allowed(column, numbers)).tolist()
    if wrong and column.blank:
        wrong = list(_not_missing(column, numbers, cells, wrong, told))
    return Values(numbers, wrong, told)


def allowed(column: Column, values: FloatArray) -> NDArray[np.bool_]:
    """Tell which of ``values`` are what a column may hold, and no code for a missing one."""
    fits = column.allows(values)
    if column.kind in ("number", "whole"):
        fits &= ~_codes_of_missing(values)
    return fits


def _codes_of_missing(values: FloatArray) -> NDArray[np.bool_]:
    """Tell which of ``values`` are such as -99 and stand so far below the rest that they mean it.

    A coordinate that runs from -120 to 0 passes -99 as a number.
    """
    coded: NDArray[np.bool_] = values <= CODES_OF_MISSING[0]
    if coded.any():
        coded = np.isin(values, CODES_OF_MISSING)
        others = values[~coded & np.isfinite(values)]
        if not len(others) or np.min(others) <= CODES_OF_MISSING[0] / 2.0:
            coded[:] = False
    return coded


def _not_missing(
    column: Column, numbers: FloatArray, cells: Sequence[str], wrong: list[int], told: list[str]
) -> Iterator[int]:
    """Yield the rows of ``wrong`` that are more than missing; set these to NaN, and tell them."""
    count: dict[str, int] = {}
    for row in wrong:
        cell = cells[row].strip()
        if cell.lower() in MISSING or numbers[row] in CODES_OF_MISSING:
            numbers[row] = nan
            count[cell] = count.get(cell, 0) + 1
        else:
            yield row
    count.pop("", None)
    if count:
        listed = ", ".join(f"{cell} ({number})" for cell, number in count.items())
        told.append(f"{listed}: read as missing")


def why_wrong(column: Column, cell: str, number: float) -> str:
    """Return what to say of a wrong cell beside what it is not."""
    if cell and (cell.lower() in MISSING or number in CODES_OF_MISSING):
        return "; it stands for a missing value: fill it in, or leave the row out"
    if (
        column.kind in ("number", "whole")
        and _THOUSANDS.fullmatch(cell)
        and not np.isfinite(number)
    ):
        return "; write it with a decimal point and nothing between thousands"
    return ""


def _places(column: Column, cells: Sequence[str], told: list[str]) -> FloatArray:
    """Return the places of the words in ``cells``, NaN for others."""
    places = {word: float(place) for place, word in enumerate(column.words)}
    as_other = {word.lower(): place for word, place in places.items()}
    read: dict[str, float] = {}
    numbered, cased = dict[str, str](), list[str]()
    for cell in dict.fromkeys(cells):
        text = cell.strip()
        place = places.get(text, nan)
        if np.isnan(place) and text.lower() in as_other:
            place = as_other[text.lower()]
            cased.append(text)
        elif np.isnan(place) and column.coded and _number(text) in places.values():
            place = _number(text)
            numbered[text] = column.words[int(place)]
        read[cell] = place
    if numbered:
        told.append("numbers for words: " + ", ".join(f"{n} is {w}" for n, w in numbered.items()))
    if cased:
        told.append(f"read without regard to capitals: {', '.join(cased)}")
    return np.array([read[cell] for cell in cells], dtype=np.float64)


def _numbers(column: Column, cells: Sequence[str], told: list[str]) -> FloatArray:
    """Return the numbers in ``cells``, NaN where there is none."""
    try:
        if _is_plain("".join(cells)):
            return np.fromiter(map(float, cells), np.float64, len(cells))
    except ValueError:
        pass  # the slow way finds out where
    numbers = np.array([_number(cell) for cell in cells], dtype=np.float64)
    if column.kind == "flag":
        for row in np.flatnonzero(np.isnan(numbers)).tolist():
            numbers[row] = _FLAGS.get(cells[row].strip().lower(), nan)
            if np.isfinite(numbers[row]) and not told:
                told.append(f"{cells[row].strip()} is read as {numbers[row]:g}")
    return numbers


def _number(cell: str) -> float:
    cell = cell.strip().replace(_MINUS, "-")
    try:
        return float(cell) if _is_plain(cell) else nan
    except ValueError:
        return nan


def _is_plain(text: str) -> bool:
    """Tell whether ``text`` has nothing that only Python takes for a number: 1_000, Thai digits."""
    return "_" not in text and text.isascii()


def with_points(
    columns: Mapping[str, Sequence[str]],
) -> tuple[Mapping[str, Sequence[str]], str, Fault | None]:
    """Return columns of numbers with decimal points.

    A comma is taken for a decimal one only where nothing else is possible: all cells that have one
    are numbers with it, one at least is no group of thousands, and none has a decimal point.

    Returns:
        The columns; a cell that had a decimal comma, empty if none had; and what is in doubt, with
        the row for a line.
    """
    commas = [
        (name, row)
        for name, cells in columns.items()
        if any("," in cell for cell in cells)
        for row, cell in enumerate(cells)
        if "," in cell
    ]
    written = [columns[name][row] for name, row in commas]
    if not commas or not all(map(_DECIMAL_COMMA.fullmatch, written)):
        return columns, "", None
    (name, row), cell = commas[0], written[0].strip()
    if point := next((c for cells in columns.values() for c in cells if _has_point(c)), ""):
        text = f"{cell!r} has a comma and {point.strip()!r} a point; write points throughout"
        return columns, "", Fault(row, name, text)
    if all(map(_GROUPED.fullmatch, written)):
        text = (
            f"{cell!r} may be {cell.replace(',', '.')} or {cell.replace(',', '')}; write decimal "
            "points, and nothing between thousands"
        )
        return columns, "", Fault(row, name, text)
    pointed = {name: [cell.replace(",", ".") for cell in cells] for name, cells in columns.items()}
    return pointed, cell, None


def _has_point(cell: str) -> bool:
    return "." in cell and bool(np.isfinite(_number(cell)))
