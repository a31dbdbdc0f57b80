"""From the bytes of a table to its records: encoding, separator, comments, quotes.

What every table may have: any encoding that ``encodings`` knows; commas, semicolons, tabs or bars
between the cells; any line ends; lines that begin with ``#``; empty lines; quoted cells with
separators and line breaks in them; blanks around cells.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from ..encodings import NotTextError, Text, text_of
from .declared import Fault, TableError

SEPARATORS: Final = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars"}
_QUOTED: Final = re.compile('"(?:[^"]|"")*"')
# Excel's own line, which tells it what separates the cells of the rest.
_SEPARATOR_LINE: Final = re.compile(r'\s*"?sep=([,;\t|])"?\s*', re.IGNORECASE)

Record = tuple[int, list[str]]  # line in which it begins, and its cells


@dataclass
class Content:
    """A table's text in lines.

    Attributes:
        path: the file.
        text: its text and encoding.
        lines: with their ends, which are LF.
        separator: comma, semicolon, tab or bar.
        quoted: there are quotation marks.
        comments: lines before the header that begin with ``#``, without it.
        passed_over: such lines below the header, with their numbers.
        line: of the header, from 1; 0: there is none.
        header: names of the columns, without blanks around.
    """

    path: Path
    text: Text
    lines: Sequence[str]
    separator: str = ","
    quoted: bool = False
    comments: list[str] = field(default_factory=list)
    passed_over: list[tuple[int, str]] = field(default_factory=list)
    line: int = 0
    header: list[str] = field(default_factory=list)
    _end: int = 0  # lines that the header and all before it take

    @property
    def body(self) -> Sequence[str]:
        """The lines below the header."""
        return self.lines[self._end :]

    @property
    def body_line(self) -> int:
        """Number of the first line below the header."""
        return self._end + 1

    def records(self) -> Iterator[Record]:
        """Yield the records below the header.

        Raises:
            TableError: quotes do not fit.
        """
        if self.quoted:
            yield from _quoted_records(self, self._end)
            return
        for number, line in enumerate(self.body, self.body_line):
            if self._is_row(number, line):
                yield number, line.rstrip("\n").split(self.separator)

    def _is_row(self, number: int, line: str) -> bool:
        stripped = line.strip()
        if stripped and stripped[0] == "#":
            self.passed_over.append((number, stripped[1:]))
            return False
        return bool(stripped)


def content_of(data: bytes, path: Path) -> Content:
    """Return what ``data``, the content of ``path``, holds.

    Raises:
        TableError: it is no text, or quotes of the header do not fit.
    """
    try:
        text = text_of(data)
    except NotTextError as error:
        raise TableError(path, [Fault(error.line, "", str(error))]) from None
    lines = list(io.StringIO(text.text, newline=None))
    content = Content(path, text, lines, quoted='"' in text.text)
    begun = _take_comments(content)
    if begun < len(lines):
        _take_header(content, begun)
    return content


def _take_comments(content: Content) -> int:
    """Take what stands before the header; return how many lines that are."""
    for number, line in enumerate(content.lines):
        stripped = line.strip()
        if stripped and stripped[0] != "#":
            return number
        if stripped:
            content.comments.append(stripped[1:].strip())
    return len(content.lines)


def _take_header(content: Content, begun: int) -> None:
    if told := _SEPARATOR_LINE.fullmatch(content.lines[begun].rstrip("\n")):
        content.separator, begun = told[1], begun + 1
    else:
        content.separator = _separator(content.lines[begun:])
    if content.quoted:
        records = _quoted_records(content, begun)
        content.line, header = next(records, (0, []))
    else:
        content.line, content._end = begun + 1, begun + 1
        header = content.lines[begun].rstrip("\n").split(content.separator)
    content.header = [name.strip() for name in header]


def _separator(lines: Sequence[str]) -> str:
    """Return what separates cells: of what the header has, what the next line has as often.

    If that is not one, what the header has most of; commas, if there is nothing.
    """
    header, first = _outside_quotes(lines)
    counts = {mark: header.count(mark) for mark in SEPARATORS}
    return max(counts, key=lambda m: (counts[m] > 0 and counts[m] == first.count(m), counts[m]))


def _outside_quotes(lines: Sequence[str]) -> tuple[str, str]:
    """Return the first two records without what is quoted in them."""
    records: list[str] = []
    held = ""
    for line in lines:
        held += line
        if held.count('"') % 2 == 0 and held.strip() and not (records and held.strip()[0] == "#"):
            records.append(_QUOTED.sub("", held).strip("\n"))
            if len(records) == 2:
                break
        elif held.count('"') % 2:
            continue
        held = ""
    return (*records, "", "")[:2]  # type: ignore[return-value]


def _quoted_records(content: Content, skipped: int) -> Iterator[Record]:
    """Yield records that may be quoted; ``content`` learns where the first one ends.

    A quoted cell may go on over lines: only between records is a line with # a comment.
    """
    begun = 0  # line in which the present record begins

    def lines() -> Iterator[str]:
        nonlocal begun
        for number, line in enumerate(content.lines[skipped:], start=skipped + 1):
            if begun or content._is_row(number, line):
                begun = begun or number
                content._end = content._end if content.line else number
                yield line

    records = csv.reader(lines(), delimiter=content.separator, skipinitialspace=True, strict=True)
    try:
        for cells in records:
            yield begun, cells
            begun = 0
    except csv.Error as error:
        fault = Fault(begun, "", f'quotes that do not fit ({error}); write "" within quotes')
        raise TableError(content.path, [fault]) from None
