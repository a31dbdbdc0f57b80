"""The reader of all tables.

What every table may have: any encoding, separator and line ends (``text``, ``records``), decimal
commas and thousands apart (``numbers``), lines that begin with ``#``, empty lines, quoted cells
(with commas and line breaks in them), blanks around cells, columns in any order.

Reading takes four steps: bytes to text, text to records, the header (``_positions``), cells to
values (``_convert``). All that is wrong with the cells is found before a file is refused. What is
read otherwise than it stands there, and what was guessed, is in the notes.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from math import nan
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding
from ...kernel.arrays import FloatArray
from ..disk import reason
from .declared import Column, Fault, Format, TableError
from .names import meant_names, misspelt
from .numbers import MISSING, marks_of, numbers_of
from .records import Comment, Record, cells_in, records, separator_of
from .text import decoded
from .writer import plain_text

# Says of the cells of a row, by column, whether nothing of it is wanted.
LeftOut = Callable[[Mapping[str, str]], bool]

_CELL_MAX: Final = 40  # characters of a wrong cell that an error repeats
_HEADER_MAX: Final = 120  # the same for names of columns
_FLAGS: Final = {"true": "1", "false": "0"}


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
        notes: what was read otherwise than it stands there, or guessed.
    """

    path: Path
    form: Format
    header_line: int
    comments: tuple[str, ...] = ()
    lines: list[int] = field(default_factory=list)
    numbers: dict[str, FloatArray] = field(default_factory=dict)
    texts: dict[str, list[str]] = field(default_factory=dict)
    notes: list[Finding] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.lines)

    def __contains__(self, name: str) -> bool:
        return name in self.numbers or name in self.texts

    def fault(self, row: int, column: str, text: str) -> Fault:
        """Return a fault of ``row``, in ``column`` or, if that is empty, in the row as a whole."""
        keys = (k for k in self.form.key if k != column and self.texts.get(k))
        place = [f"{key} {self.texts[key][row]}" for key in keys if self.texts[key][row]]
        return Fault(self.lines[row], ", ".join(filter(None, (*place, column))), text)

    def note(self, line: int, place: str, text: str, consequence: str = "") -> None:
        """Add a note."""
        self.notes.append(Finding("note", str(self.path), line, place, text, consequence))

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
    path = Path(path)
    lines, separator, _ = _lines(_content(path), path)
    header = next(records(lines, path, separator, []), None)
    if header is None:
        raise TableError(path, [Fault(0, "", "no header")])
    return tuple(name.strip() for name in header.cells)


def _content(path: str | os.PathLike[str]) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({reason(error)}); check the path") from error


def parse_table(data: bytes, path: Path, form: Format, left_out: LeftOut | None = None) -> Table:
    """Return the table that ``data``, the content of ``path``, holds; as ``read_table``."""
    lines, separator, notes = _lines(data, path)
    comments: list[Comment] = []
    rows = records(lines, path, separator, comments)
    line, header = next(rows, Record(0, []))
    if not line:
        raise TableError(path, [Fault(0, "", f"no header; {_has(form)}")])
    table = Table(path, form, line, comments=tuple(one.text for one in comments), notes=notes)
    at = _positions(table, header)
    quick = not left_out and len(at) == len(header)
    if not (quick and _fill_with_numbers(table, lines, separator, at)):
        body = list(rows)
        if left_out:
            body = [record for record in body if not left_out(_cells(record.cells, at))]
        _fill(table, body, separator, at, len(header))
        _tell_rows_in_comments(table, comments, separator, len(header))
    table.refuse(_too_few(table))
    return table


def _fill_with_numbers(
    table: Table, lines: Sequence[str], separator: str, at: Mapping[str, int]
) -> bool:
    """Fill a table that holds nothing but numbers, in half the time; False if there is more to it.

    NumPy's parser takes nothing that ``_fill`` would refuse, and reads the same bits. Comments or
    empty lines between the rows are left to ``_fill`` as well.
    """
    columns = [column for column in table.form.columns if column.name in at]
    body = lines[table.header_line :]
    if not body or body[0].isspace() or any(c.blank or c.kind in ("word", "text") for c in columns):
        return False
    try:
        cells = np.loadtxt(body, delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return False
    if cells.shape != (len(body), len(at)):
        return False
    values = {c.name: np.ascontiguousarray(cells[:, at[c.name]]) for c in columns}
    if not all(c.allows(values[c.name]).all() for c in columns):
        return False
    table.lines.extend(range(table.header_line + 1, len(lines) + 1))
    table.numbers.update(values)
    return True


def _fill(
    table: Table, body: Sequence[Record], separator: str, at: Mapping[str, int], width: int
) -> None:
    """Fill ``table`` with the records of ``body``; refuse it with all that is wrong with them."""
    ragged = [
        Fault(line, "", f"{len(row)} values for {width} columns")
        for line, row in body
        if len(row) != width
    ]
    whole = [record for record in body if len(record.cells) == width]
    table.lines.extend(record.line for record in whole)
    cells = list(zip(*(row for _, row in whole), strict=True)) or [()] * width
    columns = [column for column in table.form.columns if column.name in at]
    numeric = (cells[at[c.name]] for c in columns if c.kind in ("number", "whole"))
    decimal = _decimal_mark(table, list(chain(*numeric)), separator)
    wrong = [_convert(table, c, cells[at[c.name]], decimal) for c in columns]
    table.refuse(chain(ragged, *wrong))


def _decimal_mark(table: Table, cells: Sequence[str], separator: str) -> str:
    marks = marks_of(cells, separator)
    if marks.example and marks.decimal:
        (value,) = numbers_of([marks.example], marks.decimal).tolist()
        comma = "decimal commas" if marks.decimal == "," else "commas between thousands"
        table.note(0, "", f"{comma}: {marks.example} is read as {value:.10g}")
    return marks.decimal


def _tell_rows_in_comments(
    table: Table, comments: Sequence[Comment], separator: str, width: int
) -> None:
    """Tell of lines with # that have as many cells as a row: somebody may be called #7."""
    rows = [c for c in comments if c.line > table.header_line and width > 1]
    rows = [c for c in rows if cells_in(c.text, separator) == width]
    if rows:
        more = f" ({len(rows)} lines like it)" if len(rows) > 1 else ""
        told = f"begins with # and is passed over, though it has {width} cells{more}"
        table.note(rows[0].line, "", told, "it counts nowhere; quote its first cell if it should")


def _too_few(table: Table) -> Iterator[Fault]:
    rows, least = len(table), table.form.rows_min
    if rows < least:
        present = f"{rows or 'no'} {table.form.row}{'' if rows == 1 else 's'} below the header"
        more = f"; at least {least} are needed" if least > 1 else ""
        yield Fault(0, "", f"{present} (line {table.header_line}){more}")


def _has(form: Format) -> str:
    return f"a {form.name} has the columns {form.header}"


def _lines(data: bytes, path: Path) -> tuple[list[str], str, list[Finding]]:
    """Return the lines, what separates their cells, and what was guessed."""
    text, notes = decoded(data, path)
    lines = list(io.StringIO(text, newline=None))
    return lines, separator_of(lines), notes


def _positions(table: Table, header: Sequence[str]) -> dict[str, int]:
    """Return where each known column that is there stands."""
    form = table.form
    meant = meant_names([name.strip() for name in header], form.names)
    for title, name in meant.items():
        table.note(table.header_line, name, f"the column {title[:_CELL_MAX]!r} is read as {name}")
    names = [meant.get(name.strip(), name.strip()) for name in header]
    unknown = [name for name in names if name not in form.names]
    missing = [c.name for c in form.columns if c.needed and c.name not in names]
    twice = [name for name in form.names if names.count(name) > 1]
    wrong = (("missing", missing), ("repeated", twice), ("unknown", unknown * form.closed))
    told = [f"{what} column {', '.join(which)[:_HEADER_MAX]}" for what, which in wrong if which]
    if told:
        table.refuse([Fault(table.header_line, "", f"{'; '.join(told)}; {_has(form)}")])
    for title, name in misspelt(unknown, [n for n in form.names if n not in names]).items():
        told_ = f"the column {title[:_CELL_MAX]!r} is not known and passed over; is {name} meant?"
        table.note(table.header_line, name, told_)
    return {name: names.index(name) for name in form.names if name in names}


def _cells(row: Sequence[str], at: Mapping[str, int]) -> dict[str, str]:
    return {name: row[place].strip() if place < len(row) else "" for name, place in at.items()}


def _convert(table: Table, column: Column, cells: Sequence[str], decimal: str) -> list[Fault]:
    """Put a column into ``table``; return the cells that are not what they should be."""
    if column.kind == "text":
        texts = table.texts[column.name] = [plain_text(cell).strip() for cell in cells]
        fits = re.compile(column.pattern or r"(?s:.+)").fullmatch
        wrong = [row for row, text in enumerate(texts) if not fits(text)]
        missing: Collection[str] = ("",)
    else:
        missing = MISSING if column.blank else ()
        values = table.numbers[column.name] = _values(column, cells, decimal, missing)
        wrong = np.flatnonzero(~column.allows(values)).tolist()
        _tell_codes(table, column, [cells[row].strip() for row in wrong])
    return [
        table.fault(row, column.name, f"{cell[:_CELL_MAX]!r} is not {column.description}")
        for row, cell in ((row, cells[row].strip()) for row in wrong)
        if not (column.blank and cell.lower() in missing)
    ]


def _values(
    column: Column, cells: Sequence[str], decimal: str, missing: Collection[str]
) -> FloatArray:
    """Return the values of ``cells``: numbers, flags, or places of words; NaN for others."""
    if column.kind == "word":
        places = {word: float(place) for place, word in enumerate(column.words)}
        codes = np.array([places.get(cell.strip(), nan) for cell in cells], dtype=np.float64)
        if column.coded and np.isnan(codes).any():
            numbers = numbers_of(cells, decimal)
            known = np.isin(numbers, range(len(column.words)))
            codes = np.where(np.isnan(codes) & known, numbers, codes)
        return codes
    if column.kind == "flag":
        cells = [_FLAGS.get(cell.strip().lower(), cell) for cell in cells]
    values = numbers_of(cells, decimal)
    if missing:
        values[[cell.strip().lower() in missing for cell in cells]] = nan
    return values


def _tell_codes(table: Table, column: Column, cells: Sequence[str]) -> None:
    """Tell of numbers that were taken for missing ones."""
    codes = [cell for cell in cells if column.blank and cell[:1] == "-" and cell in MISSING]
    if codes:
        told = f"{codes[0]} is read as missing, in {len(codes)} cells"
        table.note(0, column.name, told)
