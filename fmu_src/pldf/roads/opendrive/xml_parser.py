"""From the text of an OpenDRIVE file to its elements: only what somebody reads is kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final
from xml.parsers import expat

from ...errors import ModelError
from ...findings import Finding
from .plan_view import GeometryTable, PlanView
from .xml_text import xml_text
from .xml_tree import Element

# OpenDRIVE 1.8 is nine elements deep; tools put some of their own into userData.
_DEPTH_MAX: Final = 64
# Nobody reads them, and they are most of a city's file.
_SKIPPED: Final = frozenset(
    (
        *("access", "border", "dataQuality", "height", "lateralProfile", "material", "objects"),
        *("railroad", "roadMark", "surface", "userData", "vectorLane"),
    )
)
_CUT: Final = frozenset(
    (
        expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS],
        expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_TOKEN],
        expat.errors.codes[expat.errors.XML_ERROR_PARTIAL_CHAR],
        expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION],
    )
)
_NAME_MAX: Final = 40  # characters of a tag that an error shows


def parse_xml(
    blocks: Iterable[bytes],
    root: str,
    path: Path,
    notes: list[Finding],
    *,
    objects: bool = False,
) -> Element:
    """Return the root element, which must be called ``root``.

    A byte order mark, comments or any other text before the XML declaration is skipped. Elements
    that nobody reads are left out; those of a ``planView`` are the rows of a table.

    Args:
        blocks: the content of the file; the first of them holds all that is before the XML.
        root: name of the element that holds all others.
        path: of the file.
        notes: a declaration that is not true is added to them.
        objects: what stands beside the roads is kept, too.

    Raises:
        ModelError: with file and line.
    """
    text = xml_text(iter(blocks), root, path, notes)
    builder = _Builder(text.skipped_lines, path, _SKIPPED - {"objects"} if objects else _SKIPPED)
    parser = builder.parser
    try:
        for block in text.blocks:
            parser.Parse(block)  # a text is no longer in the encoding that it declares
        parser.Parse("", True)
    except expat.ExpatError as error:
        line = error.lineno + text.skipped_lines
        whole = "; is the file whole?" if error.code in _CUT else ""
        told = f"not well-formed XML ({expat.ErrorString(error.code)}){whole}"
        raise ModelError(f"{path}, line {line}: {told}") from None
    element = builder.top.children[0]
    if element.tag != root:
        shown = element.tag[:_NAME_MAX]
        raise ModelError(f"{path}, line {element.line}: <{shown}> where <{root}> should be")
    return element


class _Builder:
    """Makes the tree; a ``planView`` and what is skipped have handlers of their own."""

    def __init__(self, skipped_lines: int, path: Path, skipped: frozenset[str]) -> None:
        self.top = Element("", {}, 0)
        self.parser = expat.ParserCreate()
        self._open = [self.top]
        self._table = GeometryTable()
        self._inside = 0  # elements open in one that is skipped
        self._skipped_lines = skipped_lines
        self._path = path
        self._skipped = skipped
        self._geometries = self._table.handlers(
            self.parser, skipped_lines, self._check_depth, self._end_plan_view
        )
        self._handle(self._start, self._end)

    def _handle(
        self, start: Callable[[str, dict[str, str]], None], end: Callable[[str], None]
    ) -> None:
        self.parser.StartElementHandler = start
        self.parser.EndElementHandler = end

    def _line(self) -> int:
        return self.parser.CurrentLineNumber + self._skipped_lines

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._check_depth()
        tag = tag.rpartition(":")[2]
        if tag in self._skipped:
            self._handle(self._start_skipped, self._end_skipped)
            return
        if tag == "planView":
            self._handle(*self._geometries)
            self._plan = PlanView(attributes, self._line(), self._table)
            element: Element = self._plan
        else:
            element = Element(tag, attributes, self._line())
        self._open[-1].children.append(element)
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _check_depth(self, inside: int = 0) -> None:
        if len(self._open) + inside > _DEPTH_MAX:  # told at once, not when memory is full
            outer = self._open[-1]
            raise ModelError(
                f"{self._path}, line {self._line()}: an element inside {_DEPTH_MAX} others,"
                f" OpenDRIVE has 9; probably <{outer.tag[:_NAME_MAX]}> of line {outer.line}"
                " is not closed"
            )

    def _start_skipped(self, _tag: str, _attributes: dict[str, str]) -> None:
        self._inside += 1
        self._check_depth(self._inside)

    def _end_skipped(self, _: str) -> None:
        if self._inside:
            self._inside -= 1
        else:
            self._handle(self._start, self._end)

    def _end_plan_view(self) -> None:
        self._handle(self._start, self._end)
        self._open.pop()
        self._plan.stop = len(self._table)
