"""How findings are said to a person: the gravest first, many of one kind summed up."""

from __future__ import annotations

import re
import sys
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from ...findings import SEVERITIES, Finding, in_order

_ALIKE_SHOWN: Final = 2  # of many that differ in numbers and names alone
_WIDTH: Final = 96
_INDENT: Final = 13  # of the text beside a severity
# What differs between findings of one kind: numbers, and names in quotes.
_VARIES: Final = re.compile(r"'[^']*'|[-+]?\d[\d.,]*(?:e[-+]?\d+)?")


def tell(findings: Iterable[Finding]) -> None:
    """Say on stderr how files were read and what was repaired."""
    for severity, text in _said(findings):
        print(f"{severity}: {text}", file=sys.stderr)


def listed(findings: Sequence[Finding]) -> Iterator[str]:
    """Yield the lines of a list for people: what is told, by severity, and the count."""
    for severity, text in _said(findings):
        lines = textwrap.wrap(
            text, _WIDTH, initial_indent=f"{severity:12} ", subsequent_indent=" " * _INDENT,
            break_long_words=False, break_on_hyphens=False,
        )  # fmt: skip
        yield from lines
    yield counted(findings)


def counted(findings: Iterable[Finding]) -> str:
    """Return how many there are of each severity, in words."""
    every = [finding.severity for finding in in_order(findings)]
    numbers = [(every.count(severity), severity) for severity in SEVERITIES]
    told = [f"{number} {what}{'s' if number > 1 else ''}" for number, what in numbers if number]
    return ", ".join(told) or "nothing to tell"


def _said(findings: Iterable[Finding]) -> Iterator[tuple[str, str]]:
    """Yield severity and text, the gravest first; of many of a kind two, and how many more."""
    alike: dict[tuple[str, str, str], list[Finding]] = {}
    for finding in in_order(findings):
        kind = (finding.severity, finding.file, _VARIES.sub("", finding.text))
        alike.setdefault(kind, []).append(finding)
    for (severity, file, _), group in alike.items():
        # One more is told as shortly as that there is one more.
        shown = group if len(group) <= _ALIKE_SHOWN + 1 else group[:_ALIKE_SHOWN]
        yield from ((severity, str(finding)) for finding in shown)
        if more := len(group) - len(shown):
            text = f"{more} more like this; pldf check {file}, with the same options, shows all"
            yield severity, text
