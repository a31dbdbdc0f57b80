"""XML elements that know their line.

The standard library's tree drops line numbers; errors without them cost the user an hour in a file
of a hundred thousand lines.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from ...errors import ModelError

_SHOWN_MAX: Final = 40  # characters of a text of the file that an error shows
_TOLD_MAX: Final = 3  # faults that are told beside the first


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
        return self.error_at(element.line, text)

    def error_at(self, line: int, text: str) -> ModelError:
        """Return the same for a line of the file."""
        road = f", road {self.road[:_SHOWN_MAX]}" if self.road else ""
        return ModelError(f"{self.path}, line {line}{road}: {text}")

    def errors(self, faults: Iterable[tuple[int, str]]) -> ModelError:
        """Return the error that names the first of ``faults`` (line, text) and the other lines."""
        (line, text), *others = sorted(faults)
        if others:
            told = [f"line {other}: {what}" for other, what in others[:_TOLD_MAX]]
            hidden = len(others) - len(told)
            text += "\n  also " + "; ".join(told) + (f"; and {hidden} more" if hidden else "")
        return self.error_at(line, text)

    def number(self, element: Element, name: str, default: float | None = None) -> float:
        """Return the attribute as a finite number; ModelError when it is none."""
        text = element.attributes.get(name)
        if text is None and default is not None:
            return default
        value = as_number(text)
        if not math.isfinite(value):
            raise self.error(element, no_number(element.tag, name, text))
        return value


def as_number(text: str | None) -> float:
    """Return the number that ``text`` is, NaN if it is missing or none."""
    try:
        return float(text) if text is not None and is_plain(text) else math.nan
    except ValueError:
        return math.nan


def is_plain(text: str) -> bool:
    """Tell whether ``text`` has none of what Python takes in numbers and XML does not.

    Those are underscores (1_0) and the digits of other scripts.
    """
    return "_" not in text and text.isascii()


def no_number(tag: str, name: str, text: str | None) -> str:
    """Return what is the matter with the attribute ``name``; None: it is missing."""
    shown = "" if text is None else repr(text[:_SHOWN_MAX])
    problem = "is missing" if text is None else f"= {shown} is not a finite number"
    return f"<{tag}> attribute {name} {problem}"
