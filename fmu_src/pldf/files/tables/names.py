"""Names of columns that are almost those of the declaration."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Final

# Names of columns are long and have their unit at the end: one letter of ten is a slip.
_ALIKE: Final = 0.8
_LONGER_MAX: Final = 3  # letters; others are not compared, for there may be thousands


def meant_names(titles: Sequence[str], known: Iterable[str]) -> dict[str, str]:
    """Return title -> known name, for titles that differ in case, blanks, dashes or dots only.

    A known name that is there itself is meant by no other title, nor by two at once.
    """
    plain: dict[str, list[str]] = {}
    for title in titles:
        plain.setdefault(_plain(title), []).append(title)
    found = ((plain.get(_plain(name), []), name) for name in known if name not in titles)
    return {which[0]: name for which, name in found if len(which) == 1}


def misspelt(unknown: Iterable[str], absent: Sequence[str]) -> dict[str, str]:
    """Return title -> name, for titles that are alike to a known name that is absent."""
    near = {
        title: get_close_matches(
            _plain(title), [n for n in absent if abs(len(n) - len(title)) <= _LONGER_MAX], 1, _ALIKE
        )
        for title in unknown
    }
    return {title: names[0] for title, names in near.items() if names}


def told_meant(title: str, name: str) -> str:
    """Say that a title was taken for a known name."""
    return f"the column {title!r} is read as {name}"


def told_misspelt(title: str, name: str) -> str:
    """Say that a title was passed over, and what it may be."""
    return f"the column {title!r} is not known and passed over; is {name} meant?"


def _plain(name: str) -> str:
    return re.sub(r"[\s_.\u200b-]+", "_", name).strip("_").casefold()
