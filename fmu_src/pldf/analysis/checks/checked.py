"""What a check of files comes to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ...findings import SEVERITIES, Finding, Severity, in_order
from ...recordings.quality import Quality
from ..problems import brought_together


@dataclass(frozen=True)
class CheckedFile:
    """What was found in one file.

    Attributes:
        path: the file.
        kind: what it is taken for.
        findings: about it.
        quality: of a recording that could be read.
        participant: whose recording of a study it is; empty for other files.
        phase: and of which drive.
        content: of a recording; equal for equal samples.
    """

    path: Path
    kind: str
    findings: tuple[Finding, ...] = ()
    quality: Quality | None = None
    participant: str = ""
    phase: str = ""
    content: str = ""

    @property
    def worst(self) -> Severity | None:
        """The gravest severity, None if nothing was found."""
        found = {finding.severity for finding in self.findings}
        return next((severity for severity in SEVERITIES if severity in found), None)


@dataclass(frozen=True)
class Checks:
    """All files checked, and what concerns several of them."""

    files: tuple[CheckedFile, ...] = ()
    shared: tuple[Finding, ...] = ()

    def __add__(self, other: Checks) -> Checks:
        return Checks((*self.files, *other.files), (*self.shared, *other.shared))

    @property
    def findings(self) -> list[Finding]:
        """All findings, errors first, then by file and line; each once.

        What is the same of several files of a folder is one finding.
        """
        every = [*(one for file in self.files for one in file.findings), *self.shared]
        return in_order(brought_together(dict.fromkeys(every)))

    def of(self, severity: Severity) -> list[Finding]:
        """Return the findings of one severity."""
        return [finding for finding in self.findings if finding.severity == severity]

    @property
    def drives(self) -> tuple[CheckedFile, ...]:
        """The recordings of a study."""
        return tuple(file for file in self.files if file.participant)


UNCHECKED: Final = Checks()
