"""What is told about a file that people brought: one form for every reader, check and report."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Literal, NamedTuple, get_args

import numpy as np

# error: it cannot be used; warning: it can, but a number may not mean what one takes it for;
# note: how it was read, or what was repaired.
Severity = Literal["error", "warning", "note"]
SEVERITIES: Final[tuple[Severity, ...]] = get_args(Severity)


class Finding(NamedTuple):
    """One thing that somebody who trusts a number has to know about a file.

    Attributes:
        severity: error, warning or note.
        file: path as it was given.
        line: in the file, from 1; 0 for the file as a whole.
        place: participant, drive, column, metre or time, as far as that says more than the line.
        text: what is the matter, with the value that was found.
        consequence: what it does to which number; empty if that goes without saying.
        way_out: what to do about it; empty if there is nothing to do.
    """

    severity: Severity
    file: str
    line: int
    place: str
    text: str
    consequence: str = ""
    way_out: str = ""

    @property
    def where(self) -> str:
        """File, line and place, as an error begins."""
        line = f"line {self.line}" if self.line else ""
        return ", ".join(filter(None, (self.file, line, self.place)))

    def __str__(self) -> str:
        """Return the whole as one line for people."""
        return f"{self.where}: " + "; ".join(
            filter(None, (self.text, self.consequence, self.way_out))
        )


def short(value: float) -> str:
    """Return a number to three digits, as people read it: 1000, never 1e+03."""
    return np.format_float_positional(value, precision=3, fractional=False, trim="-")


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Return each finding once, errors first, then by file and line."""
    return sorted(
        dict.fromkeys(findings),
        key=lambda one: (SEVERITIES.index(one.severity), one.file, one.line),
    )
