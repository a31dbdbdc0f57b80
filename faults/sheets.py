"""Tables as other programs write them, and what they mean: the judge of the project's readers.

Nothing here is the project's: cells are decoded, split and understood with the standard library,
by one who knows how the file was written. ``Meaning`` is what a person would read out of it.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_BLANKS: Final = " \t\v\f\x1c\x1d\x1e\x1f\x85\u00a0\u202f\u2007\u2009"
_GROUPS: Final = "'\u2019 \u00a0\u202f\u2009"  # what separates thousands, whatever the decimal mark
MISSING: Final = ("", "na", "n/a", "nan", "null", "none", ".", "-99", "-999", "#n/a")


class Unclear(Exception):  # noqa: N818 - it is a verdict, not an error
    """What the file means cannot be known: it has to be refused, or told."""


@dataclass
class Dress:
    """How the cells are written into a file."""

    encoding: str = "utf-8"
    mark: bytes = b""  # byte order mark
    separator: str = ","
    decimal: str = "."
    thousands: str = ""
    quote_all: bool = False
    line_end: str = "\n"
    blank_lines: tuple[int, ...] = ()
    comments: tuple[int, ...] = ()
    padding: str = ""
    last_end: bool = True


@dataclass
class Sheet:
    """Header and cells as texts, numbers with a point; and their dress.

    Attributes:
        header: names of the columns.
        rows: cells.
        dress: how they are written.
        told: something that must be told even where the values are right (columns that mean the
            same, rows that occur twice); empty if there is nothing.
    """

    header: list[str]
    rows: list[list[str]]
    dress: Dress = field(default_factory=Dress)
    told: str = ""

    def copy(self) -> Sheet:
        """Return a sheet that can be changed without changing this one."""
        return Sheet(list(self.header), [list(row) for row in self.rows])

    def written(self) -> bytes:
        """Return the file."""
        dress = self.dress
        lines = [
            dress.separator.join(self._quoted(f"{dress.padding}{c}{dress.padding}") for c in row)
            for row in (self.header, *(map(self._dressed, row) for row in self.rows))
        ]
        for at in dress.blank_lines:
            lines.insert(at % (len(lines) + 1), "")
        for at in dress.comments:
            lines.insert(at % (len(lines) + 1), "# a comment, with a comma")
        text = dress.line_end.join(lines) + dress.line_end * dress.last_end
        return dress.mark + text.encode(dress.encoding, errors="replace")

    def _quoted(self, cell: str) -> str:
        if self.dress.quote_all or any(c in cell for c in (self.dress.separator, *'"\r\n')):
            return '"' + cell.replace('"', '""') + '"'
        return cell

    def _dressed(self, cell: str) -> str:
        """Return a number with the marks of this dress; anything else as it is."""
        if not NUMBER.fullmatch(cell):
            return cell
        whole, point, rest = cell.partition(".")
        if self.dress.thousands and len(whole) > 3 and whole.isdigit():
            whole = f"{int(whole):,}".replace(",", self.dress.thousands)
        return whole + (self.dress.decimal if point else "") + rest


def understood(data: bytes, dress: Dress) -> tuple[list[str], list[list[str]]]:
    """Return header and rows of a file in ``dress``; Unclear if it has no rectangle of cells."""
    try:  # what is no UTF-8 may be any letter
        errors = "replace" if dress.encoding == "utf-8" else "strict"
        text = data.removeprefix(dress.mark).decode(dress.encoding, errors)
    except UnicodeError:
        raise Unclear("encoding") from None
    if "\0" in text:
        raise Unclear("characters")
    try:
        reader = csv.reader(
            io.StringIO(_uncommented(text), newline=""), delimiter=dress.separator, strict=True,
            skipinitialspace=True,
        )  # fmt: skip
        records = [row for row in reader if any(map(str.strip, row))]
    except csv.Error:
        raise Unclear("quotes") from None
    if not records:
        raise Unclear("empty")
    header, *rows = ([_bare(cell) for cell in row] for row in records)
    rows = [row if any(row[len(header) :]) else row[: len(header)] for row in rows]
    if any(len(row) != len(header) for row in rows):
        raise Unclear("ragged")
    return header, rows


def _uncommented(text: str) -> str:
    lines = io.StringIO(text, newline="").readlines() if "\r" not in text else text.splitlines(True)
    return "".join(line for line in lines if not line.lstrip().startswith("#"))


def _bare(cell: str) -> str:
    return cell.strip(_BLANKS + "\r\n")


def number(cell: str, dress: Dress) -> float | None:
    """Return what a cell says, None if the value is missing; Unclear if it is no number."""
    if cell.lower() in MISSING:
        return None
    text = "".join(
        str(unicodedata.decimal(c)) if c.isdecimal() else "-" if c in "\u2212\u2013" else c
        for c in cell
    )
    text = re.sub(rf"(?<=\d)[{_GROUPS}](?=\d\d\d(\D|$))", "", text)
    if dress.decimal == ",":
        text = re.sub(r"(?<=\d)\.(?=\d\d\d(\D|$))", "", text).replace(",", ".")
    else:
        text = re.sub(r"(?<=\d),(?=\d\d\d(\D|$))", "", text)
    if not NUMBER.fullmatch(text) or abs(float(text)) == float("inf"):
        raise Unclear(f"{cell!r} is no number")
    return float(text)


def column(header: Sequence[str], rows: Sequence[Sequence[str]], name: str) -> list[str] | None:
    """Return the cells of a column, None if there is none; Unclear if there are two that differ."""
    found = [[row[at] for row in rows] for at, title in enumerate(header) if title == name]
    if not found:
        return None
    if any(other != found[0] for other in found[1:]):
        raise Unclear(f"two columns {name}")
    return found[0]
