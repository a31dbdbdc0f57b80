"""Places of a route that have names: as lines of files, and in words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from math import floor
from typing import Final

from .route import Mark, MarkKind

NAME_BYTES_MAX: Final = 80
# How the kind of a mark is written, (kind, driven against its drawing direction).
KIND_WORDS: Final[dict[tuple[MarkKind, bool], str]] = {
    ("road", False): "road",
    ("road", True): "road_against",
    ("sign", False): "sign",
}
_LINE: Final = re.compile(rf"mark (\S+) ({'|'.join(KIND_WORDS.values())}) (\S.*)")
# Printf formats, the same in the native FMUs (build/runtime/outcome.c).
ROAD: Final = " (road %s)"
ROADS: Final = " (road %s to road %s)"


def plain_name(name: str) -> str:
    """Return ``name`` as one line of printable characters, at most 80 bytes of UTF-8."""
    printable = "".join(c if c.isprintable() else " " for c in name)
    short = " ".join(printable.split()).encode("utf-8", "replace")[:NAME_BYTES_MAX]
    return short.decode("utf-8", "ignore").strip() or "?"


def millimetres(s_m: float) -> int:
    """Return a place as whole millimetres, so that text and numbers agree on it."""
    return floor(1000.0 * s_m + 0.5)


def mark_lines(marks: Iterable[Mark], *, exact: bool) -> list[str]:
    """Return a line per mark; places in m that read back to the bit, or in whole millimetres."""
    return [
        f"mark {_place(mark.s_m, exact=exact)} "
        f"{KIND_WORDS[mark.kind, mark.against]} {plain_name(mark.name)}"
        for mark in marks
    ]


def _place(s_m: float, *, exact: bool) -> str:
    return repr(float(s_m)) if exact else str(millimetres(s_m))


def marks_in(lines: Iterable[str], length_m: float) -> tuple[Mark, ...]:
    """Return the marks among ``lines``, whose places are exact, of a route of this length.

    Other lines are passed over.
    """
    kinds = {word: kind for kind, word in KIND_WORDS.items()}
    marks = []
    for line in lines:
        found = _LINE.fullmatch(line)
        if found is None:
            continue
        try:
            s_m = float(found[1])
        except ValueError:
            continue
        kind, against = kinds[found[2]]
        if 0.0 <= s_m <= length_m:
            marks.append(Mark(s_m, kind, found[3], against))
    return tuple(sorted(marks, key=lambda mark: mark.s_m))


def road_words(marks: Sequence[Mark], from_m: float, to_m: float) -> str:
    """Return on which roads of the file a piece of the route lies; empty if there is one only."""
    roads = [mark for mark in marks if mark.kind == "road"]
    if len(roads) < 2:
        return ""
    first, last = (_road_at(roads, place) for place in (from_m, to_m))
    return ROAD % first if first == last else ROADS % (first, last)


def _road_at(roads: Sequence[Mark], s_m: float) -> str:
    at = millimetres(s_m)
    begun = [mark for mark in roads if millimetres(mark.s_m) <= at]
    return plain_name((begun or roads)[-1 if begun else 0].name)
