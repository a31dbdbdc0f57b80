"""Where in a file what an XPath names stands: its line, and the road with the metre along it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

_STEP: Final = re.compile(r"/([^/\[]+)(?:\[(\d+)\])?")


@dataclass
class Places:
    """Places in one file.

    Attributes:
        of_xpath: line and place in words of each element asked for.
        roads: first and last line of each road, and its id.
    """

    of_xpath: dict[str, tuple[int, str]] = field(default_factory=dict)
    roads: list[tuple[int, int, str]] = field(default_factory=list)

    def road_at(self, line: int) -> str:
        """Return the road that stands in this line, in words; empty if none does."""
        within = (road for first, last, road in self.roads if first <= line <= last)
        return next((f"road {road}" for road in within), "")


def places_in(data: bytes, xpaths: Collection[str]) -> Places:
    """Return where the elements ``xpaths`` stand in the OpenDRIVE file ``data``.

    What cannot be found, for the file is no XML that expat reads, is left out.
    """
    walk = _Walk(xpaths)
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda tag, values: walk.enter(
        tag, values, parser.CurrentLineNumber
    )
    parser.EndElementHandler = lambda tag: walk.leave(tag, parser.CurrentLineNumber)
    with suppress(expat.ExpatError):  # told elsewhere; what stands before the fault is found
        parser.Parse(data, True)
    return walk.places


class _Walk:
    """One pass through a file, element by element."""

    def __init__(self, xpaths: Collection[str]) -> None:
        self.places = Places()
        self._wanted = {_whole(xpath): xpath for xpath in xpaths}
        self._path = [""]
        self._children = [Counter[str]()]
        self._s: list[str] = [""]  # along the road, of the elements around
        self._road, self._road_line = "", 0

    def enter(self, tag: str, values: dict[str, str], line: int) -> None:
        self._children[-1][tag] += 1
        self._path.append(f"{self._path[-1]}/{tag}[{self._children[-1][tag]}]")
        self._children.append(Counter())
        self._s.append(values.get("s", self._s[-1]))
        if tag == "road" and len(self._path) == 3:
            self._road, self._road_line = values.get("id", ""), line
        if xpath := self._wanted.get(self._path[-1]):
            self.places.of_xpath[xpath] = (line, self._place())

    def leave(self, tag: str, line: int) -> None:
        if tag == "road" and len(self._path) == 3:
            self.places.roads.append((self._road_line, line, self._road))
            self._road = ""
        for around in (self._path, self._children, self._s):
            around.pop()

    def _place(self) -> str:
        if not self._road:
            return ""
        try:
            return f"road {self._road}, s = {float(self._s[-1]):.0f} m"
        except ValueError:
            return f"road {self._road}"


def _whole(xpath: str) -> str:
    """Return the path with a number at each step; without one the first is meant."""
    return "".join(f"/{tag}[{number or 1}]" for tag, number in _STEP.findall(xpath))
