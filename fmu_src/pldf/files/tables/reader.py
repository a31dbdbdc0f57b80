"""The reader of all tables.

Reading takes three steps: bytes to records (``content``), the header (``_positions``), cells to
values (``cells``). All that is wrong with the cells is found before a file is refused; what was
read otherwise than it is written is told in the notes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding
from ...kernel.arrays import FloatArray
from ..disk import reason
from .cells import allowed, values_of, why_wrong, with_points
from .content import Content, content_of
from .declared import Column, Fault, Format, TableError
from .names import meant_names, misspelt, told_meant, told_misspelt
from .told import how_written, rows_in_comments
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
        notes: what was read otherwise than it is written: encoding, separator, decimal commas,
            missing values, numbers for words.
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
    content = content_of(_content(path), Path(path))
    if not content.line:
        raise TableError(Path(path), [Fault(0, "", "no header")])
    return tuple(content.header)


def _content(path: str | os.PathLike[str]) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({reason(error)}); check the path") from error


def parse_table(data: bytes, path: Path, form: Format, left_out: LeftOut | None = None) -> Table:
    """Return the table that ``data``, the content of ``path``, holds; as ``read_table``."""
    content = content_of(data, path)
    if not content.line:
        raise TableError(path, [Fault(0, "", f"no header; {_has(form)}")])
    table = Table(path, form, content.line, comments=tuple(content.comments))
    at = _positions(table, content.header)
    if left_out or not _fill_fast(table, content, at):
        _fill(table, content, at, left_out)
    table.refuse(_too_few(table))
    read = [name for name in form.names if name in table]
    table.notes[:0] = how_written(content, read, table.texts)
    table.notes.extend(rows_in_comments(content))
    return table


def _fill_fast(table: Table, content: Content, at: Mapping[str, int]) -> bool:
    """Fill a table of plain rows with NumPy's parser of numbers; False if there is more to it.

    That parser takes nothing that ``_fill`` would refuse, and reads the same bits. Comments, empty
    lines or quotes are left to ``_fill`` as well, and so is all that is told.
    """
    body, separator, width = content.body, content.separator, len(content.header)
    columns = [column for column in table.form.columns if column.name in at]
    numeric = [c for c in columns if c.kind not in ("word", "text")]
    plain = body and numeric and not content.quoted and not any(c.blank for c in numeric)
    if not plain or any(line.count(separator) != width - 1 or line[0] == "#" for line in body):
        return False
    try:
        at_numbers = [at[c.name] for c in numeric]
        cells = np.loadtxt(body, delimiter=separator, comments=None, usecols=at_numbers, ndmin=2)
    except ValueError:
        return False
    numbers = {c.name: np.ascontiguousarray(cells[:, k]) for k, c in enumerate(numeric)}
    if len(cells) != len(body) or not all(allowed(c, numbers[c.name]).all() for c in numeric):
        return False
    table.lines.extend(range(content.body_line, content.body_line + len(body)))
    faults: list[Fault] = []
    for column in columns:
        if column.name in numbers:
            table.numbers[column.name] = numbers[column.name]
        else:
            place = at[column.name]
            faults += _convert(table, column, [row.split(separator)[place] for row in body])
    table.refuse(faults)
    return True


def _fill(table: Table, content: Content, at: Mapping[str, int], left_out: LeftOut | None) -> None:
    """Fill ``table`` with the records of ``content``; refuse it with all that is wrong."""
    width, places = len(content.header), list(at.values())
    rows: list[list[str]] = []
    faults: list[Fault] = []
    empty = long = 0
    may_be_empty = all(c.blank for c in table.form.columns if c.name in at)
    for line, row in content.records():
        if left_out and left_out(_cells(row, at)):
            continue
        if len(row) > width and not any(map(str.strip, row[width:])):
            del row[width:]  # some programs end every line with a separator
            long += 1
        if len(row) != width:
            faults.append(Fault(line, "", _ragged(content, row, width)))
        elif not may_be_empty and not any(map(str.strip, row)):
            empty += 1
        else:
            table.lines.append(line)
            rows.append([row[place] for place in places])
    columns = zip(*rows, strict=True) if rows else ((),) * len(places)
    cells: dict[str, Sequence[str]] = dict(zip(at, columns, strict=True))
    faults += _convert_all(table, cells)
    table.refuse(faults)
    if empty:
        table.note(0, "", f"{empty} rows without any value passed over")
    if long:
        table.note(0, "", f"{long} rows have more cells than the header; these are empty")


def _ragged(content: Content, row: Sequence[str], width: int) -> str:
    text = f"{len(row)} values for {width} columns"
    if content.separator == "," and len(row) == 2 * width:
        text += "; with decimal commas, separate columns by semicolons"
    return text


def _convert_all(table: Table, cells: dict[str, Sequence[str]]) -> list[Fault]:
    """Put all columns into ``table``; return all cells that are not what they should be."""
    kinds = {column.name: column.kind for column in table.form.columns}
    numeric = {name: cells[name] for name in cells if kinds[name] not in ("word", "text")}
    pointed, example, doubt = with_points(numeric)
    if doubt:
        return [table.fault(doubt.line, doubt.place, doubt.text)]
    if example:
        read = example.replace(",", ".")
        table.note(0, "", f"decimal commas: {example} is read as {float(read):.10g}")
    cells.update(pointed)
    columns = (column for column in table.form.columns if column.name in cells)
    return list(chain(*[_convert(table, column, cells[column.name]) for column in columns]))


def _too_few(table: Table) -> Iterator[Fault]:
    rows, least = len(table), table.form.rows_min
    if rows < least:
        present = f"{rows or 'no'} {table.form.row}{'' if rows == 1 else 's'} below the header"
        more = f"; at least {least} are needed" if least > 1 else ""
        yield Fault(0, "", f"{present} (line {table.header_line}){more}")


def _has(form: Format) -> str:
    return f"a {form.name} has the columns {form.header}"


def _positions(table: Table, header: Sequence[str]) -> dict[str, int]:
    """Return where each known column that is there stands."""
    form = table.form
    meant = meant_names(header, form.names)
    for title, name in meant.items():
        table.note(table.header_line, name, told_meant(title[:_CELL_MAX], name))
    names = [meant.get(name, name) for name in header]
    # R writes the numbers of the rows into a first column without a name.
    unknown = [name for name in names if name and name not in form.names]
    missing = [c.name for c in form.columns if c.needed and c.name not in names]
    twice = [name for name in form.names if names.count(name) > 1]
    wrong = (("missing", missing), ("repeated", twice), ("unknown", unknown * form.closed))
    told = [f"{what} column {', '.join(which)[:_HEADER_MAX]}" for what, which in wrong if which]
    if missing and len(names) == 1 and re.search(r"\W", names[0]):
        told.append(f"no comma, semicolon or tab in the header {names[0][:_CELL_MAX]!r}")
    if told:
        table.refuse([Fault(table.header_line, "", f"{'; '.join(told)}; {_has(form)}")])
    for title, name in misspelt(unknown, [n for n in form.names if n not in names]).items():
        table.note(table.header_line, name, told_misspelt(title[:_CELL_MAX], name))
    return {name: names.index(name) for name in form.names if name in names}


def _cells(row: Sequence[str], at: Mapping[str, int]) -> dict[str, str]:
    return {name: row[place].strip() if place < len(row) else "" for name, place in at.items()}


def _convert(table: Table, column: Column, cells: Sequence[str]) -> list[Fault]:
    """Put a column into ``table``; return the cells that are not what they should be."""
    if column.kind == "text":
        texts = table.texts[column.name] = [plain_text(cell).strip() for cell in cells]
        fits = re.compile(column.pattern or r"(?s:.+)").fullmatch
        wrong = [row for row, text in enumerate(texts) if not fits(text)]
        reasons = [""] * len(wrong)
    else:
        values = values_of(column, cells)
        table.numbers[column.name], wrong = values.numbers, values.wrong
        for text in values.told:
            table.note(0, column.name, text)
        numbers = values.numbers[wrong].tolist()
        reasons = [
            why_wrong(column, cells[row].strip(), number)
            for row, number in zip(wrong, numbers, strict=True)
        ]
    return [
        table.fault(row, column.name, f"{cell[:_CELL_MAX]!r} is not {column.description}{why}")
        for row, cell, why in (
            (r, cells[r].strip(), why) for r, why in zip(wrong, reasons, strict=True)
        )
        if cell or not column.blank
    ]
