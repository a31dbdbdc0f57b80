"""The reader of all tables.

What every table may have: a byte order mark, any line ends, lines that begin with ``#``, empty
lines, quoted cells (with commas and line breaks in them), blanks around cells, columns in any
order.

Reading takes four steps, each a function: bytes to lines (``_lines``), lines to records
(``_records``), the header (``_positions``), cells to values (``_convert``). All that is wrong with
the cells is found before a file is refused.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from math import nan
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...errors import ModelError
from ...kernel.arrays import FloatArray
from ..disk import reason
from .declared import Column, Fault, Format, TableError
from .writer import plain_text

# Says of the cells of a row, by column, whether nothing of it is wanted.
LeftOut = Callable[[Mapping[str, str]], bool]

_CELL_MAX: Final = 40  # characters of a wrong cell that an error repeats
_HEADER_MAX: Final = 120  # the same for names of columns


@dataclass(frozen=True, eq=False)
class Table:
    """What was read from a file.

    Attributes:
        path: the file.
        form: the format it has.
        header_line: line of the header.
        comments: the lines before the header that begin with ``#``, without it.
        lines: line in which each row begins.
        numbers: columns of numbers, flags (0 or 1) and words (their places), float64.
        texts: columns of text, without blanks around.
    """

    path: Path
    form: Format
    header_line: int
    comments: tuple[str, ...] = ()
    lines: list[int] = field(default_factory=list)
    numbers: dict[str, FloatArray] = field(default_factory=dict)
    texts: dict[str, list[str]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.lines)

    def __contains__(self, name: str) -> bool:
        return name in self.numbers or name in self.texts

    def fault(self, row: int, column: str, text: str) -> Fault:
        """Return a fault of ``row``, in ``column`` or, if that is empty, in the row as a whole."""
        keys = (k for k in self.form.key if k != column and self.texts.get(k))
        place = [f"{key} {self.texts[key][row]}" for key in keys if self.texts[key][row]]
        return Fault(self.lines[row], ", ".join(filter(None, (*place, column))), text)

    def repeated(self, keys: Iterable[Hashable]) -> Iterator[tuple[int, int]]:
        """Yield each row whose key, one per row, an earlier one has, and the line of that one."""
        line_of: dict[Hashable, int] = {}
        for row, (key, line) in enumerate(zip(keys, self.lines, strict=True)):
            if line_of.setdefault(key, line) != line:
                yield row, line_of[key]

    def refuse(self, faults: Iterable[Fault]) -> None:
        """Raise TableError if there are ``faults``."""
        if every := tuple(faults):
            raise TableError(self.path, every)


def read_table(
    path: str | os.PathLike[str], form: Format, left_out: LeftOut | None = None
) -> Table:
    """Read the table in the file ``path``.

    Args:
        path: the file.
        form: the format that it should have.
        left_out: says of the cells of a row, by column, whether it is passed over, whatever else
            it holds.

    Raises:
        ModelError: the file cannot be read.
        TableError: it cannot be used; with file, line, column, value and the way out.
    """
    return parse_table(_content(path), Path(path), form, left_out)


def read_header(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """Return the names of the columns of the table in the file ``path``, as they stand there.

    Raises:
        ModelError: the file cannot be read.
        TableError: it has no header.
    """
    data = _content(path)
    _, header = next(_records(_lines(data, Path(path)), Path(path), []), (0, []))
    if not header:
        raise TableError(Path(path), [Fault(0, "", "no header")])
    return tuple(name.strip() for name in header)


def _content(path: str | os.PathLike[str]) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({reason(error)}); check the path") from error


def parse_table(data: bytes, path: Path, form: Format, left_out: LeftOut | None = None) -> Table:
    """Return the table that ``data``, the content of ``path``, holds; as ``read_table``."""
    lines, comments = _lines(data, path), list[str]()
    records = _records(lines, path, comments)
    line, header = next(records, (0, []))
    if not line:
        raise TableError(path, [Fault(0, "", f"no header; {_has(form)}")])
    table = Table(path, form, line, comments=tuple(comments))
    at = _positions(table, header)
    if left_out or not (len(at) == len(header) and _fill_with_numbers(table, lines, at)):
        body = list(records)
        if left_out:
            body = [(line, row) for line, row in body if not left_out(_cells(row, at))]
        _fill(table, body, at, len(header))
    table.refuse(_too_few(table))
    return table


def _fill_with_numbers(table: Table, lines: Sequence[str], at: Mapping[str, int]) -> bool:
    """Fill a table that holds nothing but numbers, in half the time; False if there is more to it.

    NumPy's parser takes nothing that ``_fill`` would refuse, and reads the same bits. Comments or
    empty lines between the rows are left to ``_fill`` as well.
    """
    columns = [column for column in table.form.columns if column.name in at]
    body = lines[table.header_line :]
    if not body or body[0].isspace() or any(c.blank or c.kind in ("word", "text") for c in columns):
        return False
    try:
        cells = np.loadtxt(body, delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return False
    if cells.shape != (len(body), len(at)):
        return False
    values = {c.name: np.ascontiguousarray(cells[:, at[c.name]]) for c in columns}
    if not all(_allowed(c, values[c.name]).all() for c in columns):
        return False
    table.lines.extend(range(table.header_line + 1, len(lines) + 1))
    table.numbers.update(values)
    return True


def _fill(
    table: Table, body: Sequence[tuple[int, Sequence[str]]], at: Mapping[str, int], width: int
) -> None:
    """Fill ``table`` with the records of ``body``; refuse it with all that is wrong with them."""
    ragged = [
        Fault(line, "", f"{len(row)} values for {width} columns")
        for line, row in body
        if len(row) != width
    ]
    whole = [record for record in body if len(record[1]) == width]
    table.lines.extend(line for line, _ in whole)
    cells = list(zip(*(row for _, row in whole), strict=True)) or [()] * width
    wrong = [_convert(table, c, cells[at[c.name]]) for c in table.form.columns if c.name in at]
    table.refuse(chain(ragged, *wrong))


def _too_few(table: Table) -> Iterator[Fault]:
    rows, least = len(table), table.form.rows_min
    if rows < least:
        present = f"{rows or 'no'} {table.form.row}{'' if rows == 1 else 's'} below the header"
        more = f"; at least {least} are needed" if least > 1 else ""
        yield Fault(0, "", f"{present} (line {table.header_line}){more}")


def _has(form: Format) -> str:
    return f"a {form.name} has the columns {form.header}"


def _lines(data: bytes, path: Path) -> list[str]:
    try:
        return list(io.StringIO(data.decode("utf-8-sig"), newline=None))
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        fault = Fault(line, "", "not UTF-8 text; save the file as UTF-8")
        raise TableError(path, [fault]) from None


def _records(
    text: Sequence[str], path: Path, comments: list[str]
) -> Iterator[tuple[int, list[str]]]:
    """Yield the line in which a record begins and its cells; take the comments before the first.

    A quoted cell may go on over lines: only between records is a line with # a comment.
    """
    begun = 0  # line in which the present record begins
    count = 0

    def lines() -> Iterator[str]:
        nonlocal begun
        for number, line in enumerate(text, start=1):
            if not begun:
                stripped = line.strip()
                if not stripped or stripped[0] == "#":
                    if stripped and not count:
                        comments.append(stripped[1:].strip())
                    continue
                begun = number
            yield line

    records = csv.reader(lines(), skipinitialspace=True, strict=True)
    try:
        for cells in records:
            yield begun, cells
            begun, count = 0, count + 1
    except csv.Error as error:
        fault = Fault(begun, "", f'quotes that do not fit ({error}); write "" within quotes')
        raise TableError(path, [fault]) from None


def _positions(table: Table, header: Sequence[str]) -> dict[str, int]:
    """Return where each known column that is there stands."""
    form, names = table.form, [name.strip() for name in header]
    unknown = [name for name in names if name not in form.names] if form.closed else []
    missing = [c.name for c in form.columns if c.needed and c.name not in names]
    twice = [name for name in form.names if names.count(name) > 1]
    wrong = (("missing", missing), ("repeated", twice), ("unknown", unknown))
    told = [f"{what} column {', '.join(which)[:_HEADER_MAX]}" for what, which in wrong if which]
    if missing and len(names) == 1 and re.search("[;\t]", names[0]):
        told.append(f"the header is {names[0][:_CELL_MAX]!r}, commas separate columns")
    if told:
        table.refuse([Fault(table.header_line, "", f"{'; '.join(told)}; {_has(form)}")])
    return {name: names.index(name) for name in form.names if name in names}


def _cells(row: Sequence[str], at: Mapping[str, int]) -> dict[str, str]:
    return {name: row[place].strip() if place < len(row) else "" for name, place in at.items()}


def _convert(table: Table, column: Column, cells: Sequence[str]) -> list[Fault]:
    """Put a column into ``table``; return the cells that are not what they should be."""
    if column.kind == "text":
        texts = table.texts[column.name] = [plain_text(cell).strip() for cell in cells]
        fits = re.compile(column.pattern or r"(?s:.+)").fullmatch
        wrong = [row for row, text in enumerate(texts) if not fits(text)]
    else:
        values = _codes(column, cells) if column.kind == "word" else _numbers(cells)
        table.numbers[column.name] = values
        wrong = np.flatnonzero(~_allowed(column, values)).tolist()
    return [
        table.fault(row, column.name, f"{cell[:_CELL_MAX]!r} is not {column.description}")
        for row, cell in ((row, cells[row].strip()) for row in wrong)
        if cell or not column.blank
    ]


def _codes(column: Column, cells: Sequence[str]) -> FloatArray:
    """Return the places of the words in ``cells``, NaN for others."""
    places = {word: float(place) for place, word in enumerate(column.words)}
    return np.array([places.get(cell.strip(), nan) for cell in cells], dtype=np.float64)


def _numbers(cells: Sequence[str]) -> FloatArray:
    """Return the numbers in ``cells``, NaN where there is none."""
    try:
        if _is_plain("".join(cells)):
            return np.fromiter(map(float, cells), np.float64, len(cells))
    except ValueError:
        pass  # the slow way finds out where
    return np.array([_number(cell) for cell in cells], dtype=np.float64)


def _number(cell: str) -> float:
    try:
        return float(cell) if _is_plain(cell.strip()) else nan
    except ValueError:
        return nan


def _is_plain(text: str) -> bool:
    """Tell whether ``text`` has nothing that only Python takes for a number: 1_000, Thai digits."""
    return "_" not in text and text.isascii()


def _allowed(column: Column, values: FloatArray) -> NDArray[np.bool_]:
    low, high = (0.0, 1.0) if column.kind == "flag" else (column.low, column.high)
    allowed: NDArray[np.bool_] = np.isfinite(values) & (values >= low) & (values <= high)
    if column.kind in ("whole", "flag"):
        allowed &= values == np.floor(values)
    return allowed
