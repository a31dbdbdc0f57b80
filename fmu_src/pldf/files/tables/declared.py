"""What a table looks like, and what can be wrong with one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import ModelError
from ...kernel.arrays import FloatArray

Kind = Literal["number", "whole", "flag", "word", "text"]

_TOLD_MAX: Final = 5  # places told beside the first fault


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes:
        name: as in the header, with its SI unit: ``speed_mps``.
        kind: number (finite), whole number, flag (0 or 1), word (one of ``words``) or text.
        unit: of the numbers, such as m/s; 1 for a pure number, empty if that says nothing.
        low: smallest number allowed.
        high: largest number allowed.
        words: allowed words; a word is read as its place among them, from 0.
        pattern: regular expression that a whole text must match.
        wanted: what a cell should be, for errors; empty: told from what stands above.
        needed: a table without this column is refused.
        blank: a cell may be empty, or say NA, -99 and the like; it is read as NaN or, a text, as
            it stands.
        coded: a cell may hold the place of its word in place of the word.
    """

    name: str
    kind: Kind = "number"
    unit: str = ""
    low: float = -inf
    high: float = inf
    words: tuple[str, ...] = ()
    pattern: str = ""
    wanted: str = ""
    needed: bool = True
    blank: bool = False
    coded: bool = False

    def allows(self, values: FloatArray) -> NDArray[np.bool_]:
        """Tell which of these numbers the column may hold."""
        low, high = (0.0, 1.0) if self.kind == "flag" else (self.low, self.high)
        allowed: NDArray[np.bool_] = np.isfinite(values) & (values >= low) & (values <= high)
        if self.kind in ("whole", "flag"):
            allowed &= values == np.floor(values)
        return allowed

    @property
    def description(self) -> str:
        """What a cell should be, as an error says it."""
        if self.wanted or self.kind == "text":
            return self.wanted or "a text"
        if self.kind == "word":
            codes = f", nor a code from 0 to {len(self.words) - 1}" if self.coded else ""
            return f"one of {', '.join(self.words)}{codes}"
        if self.kind == "flag":
            return "0 or 1"
        whole = "whole " if self.kind == "whole" else ""
        unit = f" in {self.unit}" if self.unit not in ("", "1") else ""
        return f"a {whole}number{self._range}{unit}"

    @property
    def _range(self) -> str:
        if self.low > -inf and self.high < inf:
            return f" from {self.low:g} to {self.high:g}"
        if self.high < inf:
            return f" of at most {self.high:g}"
        return f" of at least {self.low:g}" if self.low > -inf else ""


@dataclass(frozen=True)
class Format:
    """What a table looks like.

    Attributes:
        name: what the file is, for errors: ``route file``.
        row: what a row is: ``knot``.
        columns: all that are known.
        rows_min: a table with fewer rows is refused.
        key: text columns that tell the rows apart, for errors to name beside the line.
        closed: columns that are not known are refused; otherwise they are passed over.
    """

    name: str
    row: str
    columns: tuple[Column, ...]
    rows_min: int = 1
    key: tuple[str, ...] = ()
    closed: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all columns."""
        return tuple(column.name for column in self.columns)

    @property
    def header(self) -> str:
        """The header as documentation writes it, with what is optional in brackets."""
        needed = ",".join(column.name for column in self.columns if column.needed)
        return needed + "".join(f"[,{c.name}]" for c in self.columns if not c.needed)


class Fault(NamedTuple):
    """One thing wrong with a file.

    Attributes:
        line: in the file, from 1; 0 for the file as a whole.
        place: what row and column it is, as far as that is known.
        text: what is wrong, and the way out.
    """

    line: int
    place: str
    text: str

    @property
    def where(self) -> str:
        """Line and place."""
        line = f"line {self.line}" if self.line else ""
        return ", ".join(filter(None, (line, self.place)))


class TableError(ModelError):
    """A table cannot be used: the text tells the first fault, and where the others are.

    Attributes:
        faults: all of them, in order of the lines.
    """

    def __init__(self, path: Path, faults: Iterable[Fault]) -> None:
        self.faults = tuple(sorted(faults, key=lambda fault: fault.line))
        first, *others = self.faults
        text = f"{', '.join(filter(None, (str(path), first.where)))}: {first.text}"
        if others:
            told = [fault.where for fault in others[:_TOLD_MAX]]
            hidden = len(others) - len(told)
            text += "\n  also " + "; ".join(told) + (f"; and {hidden} more" if hidden else "")
        super().__init__(text)
