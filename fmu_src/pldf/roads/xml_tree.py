"""XML elements that know their line, and tolerance for what real files put before the XML.

The standard library's tree drops line numbers; errors without them cost the user an hour in a file
of a hundred thousand lines.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import AnyStr, Final
from xml.parsers import expat

from ..errors import ModelError
from ..files.encodings import encoding_of
from ..findings import Finding

_WIDE: Final = re.compile(r"(?i)utf[-_]?(16|32)")
_UTF_8: Final = re.compile(r"(?i)utf[-_]?8")
# Programs declare the older set and write letters of the one that contains it.
_LARGER: Final = {"gb2312": "gb18030", "gbk": "gb18030", "shift_jis": "cp932"}
# OpenDRIVE 1.8 is nine elements deep; tools put some of their own into userData.
_DEPTH_MAX: Final = 64
_DECLARED: Final = re.compile(rb"""<\?xml [^>]*?encoding\s*=\s*["']([\w.:-]+)""", re.ASCII)


@dataclass(slots=True)
class Element:
    """One XML element: tag without namespace prefix, attributes, children, line in the file."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)

    def find(self, tag: str) -> Element | None:
        """Return the first child called ``tag``."""
        return next(self.all(tag), None)

    def all(self, *path: str) -> Iterator[Element]:
        """Yield the descendants at the end of ``path``, in file order."""
        for child in self.children:
            if child.tag == path[0]:
                if len(path) == 1:
                    yield child
                else:
                    yield from child.all(*path[1:])


@dataclass(frozen=True, slots=True)
class Place:
    """Where in which file something stands, for errors."""

    path: Path
    road: str = ""

    def error(self, element: Element, text: str) -> ModelError:
        """Return the error that names file, line, road and what to do about it."""
        road = f", road {self.road}" if self.road else ""
        return ModelError(f"{self.path}, line {element.line}{road}: {text}")

    def number(self, element: Element, name: str, default: float | None = None) -> float:
        """Return the attribute as a finite number; ModelError when it is none."""
        text = element.attributes.get(name)
        if text is None and default is not None:
            return default
        try:
            value = float(text if text is not None else "")
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            problem = "is missing" if text is None else f"= {text[:40]!r} is not a finite number"
            raise self.error(element, f"<{element.tag}> attribute {name} {problem}")
        return value


def parse_xml(data: bytes, root: str, path: Path, notes: list[Finding]) -> Element:
    """Return the root element, which must be called ``root``.

    A byte order mark, comments or any other text before the XML declaration is skipped.

    Args:
        data: the content of the file.
        root: name of the element that holds all others.
        path: of the file.
        notes: a declaration that is not true is added to them.

    Raises:
        ModelError: with file and line.
    """
    text, skipped_lines = _text(data, root, path, notes)
    top = Element("", {}, 0)
    parser = _parser(top, skipped_lines, path)
    try:
        parser.Parse(text, True)  # a text is no longer in the encoding that it declares
    except expat.ExpatError as error:
        line = error.lineno + skipped_lines
        raise ModelError(
            f"{path}, line {line}: not well-formed XML ({expat.ErrorString(error.code)})"
        ) from None
    element = top.children[0]
    if element.tag != root:
        raise ModelError(f"{path}, line {element.line}: <{element.tag}> where <{root}> should be")
    return element


def _text(data: bytes, root: str, path: Path, notes: list[Finding]) -> tuple[str, int]:
    """Return the text from the XML declaration on, and how many lines were before it.

    It is in the encoding that the bytes show, else in the one that they declare: the parser itself
    knows four, and refuses those with several bytes per letter.
    """
    encoding, mark = encoding_of(data)
    data = data.removeprefix(mark)
    named, skipped = encoding, 0
    if encoding == "utf-8":
        start = _start(data, b"<?xml ", f"<{root}".encode())
        skipped, data = data.count(b"\n", 0, start), data[start:]
        declared = _DECLARED.match(data)
        named = declared[1].decode() if declared else encoding
        if _WIDE.match(named) or (mark and not _UTF_8.match(named)):
            # Nobody could have read the declaration if it were true.
            told = f"declares {named} and is in UTF-8, as which it was read"
            notes.append(Finding("note", str(path), skipped + 1, "", told))
        else:
            encoding = named
    try:
        text = _decoded(data, encoding, path, skipped + 1, notes)
    except LookupError:
        told = f"unknown encoding {encoding!r}; save the file as UTF-8, and declare that"
        raise ModelError(f"{path}, line {skipped + 1}: {told}") from None
    except UnicodeError as error:
        start = error.start if isinstance(error, UnicodeDecodeError) else 0
        line = skipped + data.count(b"\n", 0, start) + 1
        told = f"not {named.upper()}, which the file seems to be; save it as UTF-8"
        raise ModelError(f"{path}, line {line}: {told}") from None
    start = _start(text, "<?xml ", f"<{root}")
    return text[start:], skipped + text.count("\n", 0, start)


def _decoded(data: bytes, encoding: str, path: Path, line: int, notes: list[Finding]) -> str:
    """Return the text; in the larger set of letters if it has some that the declared one lacks."""
    larger = _LARGER.get(encoding.lower())
    try:
        return data.decode(encoding)
    except UnicodeDecodeError:
        if not larger:
            raise
    text = data.decode(larger)
    told = (
        f"declares {encoding} and has letters that only {larger.upper()} has, as which it was read"
    )
    notes.append(Finding("note", str(path), line, "", told))
    return text


def _start(data: AnyStr, declaration: AnyStr, root: AnyStr) -> int:
    start = data.find(declaration)
    return start if start >= 0 else max(data.find(root), 0)


def _parser(top: Element, skipped_lines: int, path: Path) -> expat.XMLParserType:
    parser = expat.ParserCreate()
    open_elements = [top]

    def start(tag: str, attributes: dict[str, str]) -> None:
        line = parser.CurrentLineNumber + skipped_lines
        if len(open_elements) > _DEPTH_MAX:  # told at once, not when the memory is full
            outer = open_elements[-1]
            raise ModelError(
                f"{path}, line {line}: an element inside {_DEPTH_MAX} others, OpenDRIVE has 9;"
                f" probably <{outer.tag[:40]}> of line {outer.line} is not closed"
            )
        element = Element(tag.rpartition(":")[2], attributes, line)
        open_elements[-1].children.append(element)
        open_elements.append(element)

    def end(_: str) -> None:
        open_elements.pop()

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    return parser
