"""From text to records: what separates the cells, and where each record begins."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from .declared import Fault, TableError

_SEPARATORS: Final = (",", ";", "\t", "|")  # of two that divide alike, the first
_LOOKED_AT: Final = 30  # lines that say what the separator is


class Record(NamedTuple):
    """Cells, and the line in which they begin."""

    line: int
    cells: list[str]


class Comment(NamedTuple):
    """A line that begins with #, without it."""

    line: int
    text: str


def separator_of(lines: Sequence[str]) -> str:
    """Return what separates the cells: what divides all lines alike, else most of the header.

    Decimal commas divide the rows, but not the header.
    """
    rows = [line for line in lines[: 4 * _LOOKED_AT] if line.strip() and line.lstrip()[0] != "#"]
    widths = {mark: _widths(rows[:_LOOKED_AT], mark) for mark in _SEPARATORS}
    alike = [mark for mark, wide in widths.items() if len(set(wide)) == 1 and wide[0] > 1]
    return max(alike or _SEPARATORS, key=lambda mark: (widths[mark] or [0])[0])


def _widths(rows: Sequence[str], separator: str) -> list[int]:
    try:
        return [len(cells) for cells in csv.reader(rows, delimiter=separator)]
    except csv.Error:
        return []


def records(
    lines: Sequence[str], path: Path, separator: str, comments: list[Comment]
) -> Iterator[Record]:
    """Yield the records; take the comments between them.

    A quoted cell may go on over lines: only between records is a line with # a comment.

    Raises:
        TableError: quotes do not fit.
    """
    begun = 0  # line in which the present record begins

    def wanted() -> Iterator[str]:
        nonlocal begun
        for number, line in enumerate(lines, start=1):
            if not begun:
                stripped = line.strip()
                if not stripped or stripped[0] == "#":
                    if stripped:
                        comments.append(Comment(number, stripped[1:].strip()))
                    continue
                begun = number
            yield line

    reader = csv.reader(wanted(), delimiter=separator, skipinitialspace=True, strict=True)
    try:
        for cells in reader:
            yield Record(begun, cells)
            begun = 0
    except csv.Error as error:
        fault = Fault(begun, "", f'quotes that do not fit ({error}); write "" within quotes')
        raise TableError(path, [fault]) from None


def cells_in(text: str, separator: str) -> int:
    """Return how many cells a line has."""
    return _widths([text], separator)[0] if text else 0
