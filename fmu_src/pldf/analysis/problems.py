"""All that is wrong with the files of a study, told at once."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.tables import TableError
from ..findings import Finding

_TOLD_MAX: Final = 20
_NAMED_MAX: Final = 12
_AT: Final = re.compile(r"line (?P<line>\d+)(, (?P<place>[^:\n]+))?: ")


class StudyError(ModelError):
    """A study cannot be analysed: the text has a line for each problem.

    Attributes:
        findings: all of them.
    """

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        lines = [str(finding) for finding in self.findings[:_TOLD_MAX]]
        if more := len(self.findings) - len(lines):
            lines.append(f"and {more} more")
        super().__init__("\n  ".join(lines))


def findings_of(error: ModelError, file: str) -> list[Finding]:
    """Return what is wrong with ``file``, one finding each."""
    if isinstance(error, StudyError):
        return list(error.findings)
    if isinstance(error, TableError):
        return [Finding("error", file, one.line, one.place, one.text) for one in error.faults]
    text = str(error).removeprefix(file).lstrip(":, ")
    if at := _AT.match(text):
        return [Finding("error", file, int(at["line"]), at["place"] or "", text[at.end() :])]
    return [Finding("error", file, 0, "", text)]


def brought_together(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings; what is the same of several files without lines is told once."""
    groups: dict[Finding, list[Finding]] = {}
    for finding in findings:
        same = finding if finding.line else finding._replace(file="")
        groups.setdefault(same, []).append(finding)
    return [_as_one(group) for group in groups.values()]


def _as_one(group: Sequence[Finding]) -> Finding:
    first = group[0]
    if len(group) == 1:
        return first
    paths = [Path(finding.file) for finding in group]
    named = [path.stem for path in paths[:_NAMED_MAX]]
    more = f" and {len(paths) - len(named)} more" if len(paths) > len(named) else ""
    place = f"{', '.join(named)}{more}"
    return first._replace(
        file=str(paths[0].parent), place=", ".join(filter(None, (place, first.place)))
    )
