"""A TOML file whose errors name file, line and key; knows nothing of studies.

The standard library's parser does not tell the lines of what it has read, so the line of a key is
looked up in the text when something is wrong with its value.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from difflib import get_close_matches
from math import isfinite
from pathlib import Path
from typing import Any, Final, NoReturn

from ..instance import ModelError
from ..kernel.signals import Signal

Key = tuple[str, ...]

_HEADER: Final = re.compile(r"\s*\[\s*([^\[\]]+?)\s*\]\s*(#.*)?$")
_ASSIGNMENT: Final = re.compile(r"\s*([^=#]+?)\s*=")
_PART: Final = re.compile(r'"([^"]*)"|\'([^\']*)\'|([^.\s]+)')


class StudyText:
    """The content of a TOML file.

    Attributes:
        path: the file as named by the user.
        text: its content.
        table: the parsed content.

    Raises:
        ModelError: from every method, when file or value cannot be used.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self.text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "not a UTF-8 text file"
            raise ModelError(f"{path}: cannot be read ({reason})") from error
        try:
            self.table: dict[str, Any] = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            raise ModelError(f"{path}: not valid TOML: {error}") from None

    def fail(self, key: Key, problem: str) -> NoReturn:
        """Raise ModelError for ``key``."""
        raise ModelError(f"{self.path}, line {line_of(self.text, key)}, {'.'.join(key)}: {problem}")

    def check_keys(self, allowed: Mapping[str, Collection[str]]) -> None:
        """Fail at the first table or key that is not allowed ("": the top level)."""
        for name, value in self.table.items():
            if isinstance(value, dict):
                if name not in allowed:
                    self.unknown((name,), [table for table in allowed if table])
                for key in value:
                    if key not in allowed[name]:
                        self.unknown((name, key), allowed[name])
            elif name in allowed:
                self.fail((name,), f"{shown(value)} must be a table: write [{name}]")
            elif name not in allowed[""]:
                self.unknown((name,), [*allowed[""], *(table for table in allowed if table)])

    def unknown(self, key: Key, known: Iterable[str]) -> NoReturn:
        """Fail because ``key`` is not one of ``known``."""
        known = list(known)
        near = get_close_matches(key[-1], known, n=1)
        hint = f"; did you mean {near[0]}?" if near else f"; known are {', '.join(known)}"
        self.fail(key, f"unknown{hint}")

    def value(self, key: Key) -> Any:
        """Return the value of ``key``, None if it is absent."""
        found: Any = self.table
        for part in key:
            found = found.get(part)
            if found is None:
                return None
        return found

    def words(self, key: Key, default: str) -> str:
        """Return a text."""
        found = self.value(key)
        if found is None:
            return default
        if not isinstance(found, str) or not found.strip():
            self.fail(key, f"{shown(found)} must be a text in quotes")
        return found

    def choice(self, key: Key, allowed: tuple[str, ...]) -> str:
        """Return one of ``allowed``; the first one if the key is absent."""
        found = self.value(key)
        if found is None:
            return allowed[0]
        if found not in allowed:
            self.fail(key, f"{shown(found)} must be one of {', '.join(map(shown, allowed))}")
        return str(found)

    def whole(self, key: Key, low: int, high: int, default: int) -> int:
        """Return a whole number from ``low`` to ``high``."""
        found = self.value(key)
        if found is None:
            return default
        if not isinstance(found, int) or isinstance(found, bool) or not low <= found <= high:
            self.fail(key, f"{shown(found)} must be a whole number from {low} to {high}")
        return found

    def number(self, key: Key, low: float, high: float, default: float) -> float:
        """Return a number from ``low`` to ``high``."""
        found = self.value(key)
        if found is None:
            return default
        is_number = isinstance(found, int | float) and not isinstance(found, bool)
        if not is_number or not isfinite(found) or not low <= found <= high:
            self.fail(key, f"{shown(found)} must be a number from {low:g} to {high:g}")
        return float(found)

    def list_of(self, key: Key, allowed: Iterable[str], default: tuple[str, ...]) -> list[str]:
        """Return a list of different texts out of ``allowed``."""
        found = self.value(key)
        if found is None:
            return list(default)
        allowed = list(allowed)
        some = ", ".join(map(shown, allowed[:6])) + (", ..." if len(allowed) > 6 else "")
        if not isinstance(found, list):
            self.fail(key, f"{shown(found)} must be a list out of {some}")
        for item in found:
            if item not in allowed:
                self.fail(key, f"{shown(item)} must be one of {some}")
        if len(set(found)) < len(found):
            self.fail(key, "an item occurs twice")
        return found

    def parameter(self, key: Key, signal: Signal) -> float | int:
        """Return a value of a model's parameter, checked against its range."""
        found = self.value(key)
        if signal.enumeration is not None:
            items = signal.enumeration.items
            if found not in items:
                self.fail(key, f"{shown(found)} must be one of {', '.join(map(shown, items))}")
            return items.index(found)
        if signal.kind == "Boolean":
            if not isinstance(found, bool):
                self.fail(key, f"{shown(found)} must be true or false")
            return int(found)
        low, high = float(signal.low or 0.0), float(signal.high or 0.0)
        if signal.kind == "Integer":
            return self.whole(key, int(low), int(high), 0)
        return self.number(key, low, high, 0.0)


def shown(value: object) -> str:
    """Return a value as it is written in a TOML file."""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)


def line_of(text: str, key: Key) -> int:
    """Return the line of ``text`` in which ``key`` is assigned, else its table's, else 1."""
    table: Key = ()
    best = (0, 1)  # parts of the key found, line
    for number, line in enumerate(text.splitlines(), start=1):
        header, assignment = _HEADER.match(line), _ASSIGNMENT.match(line)
        if header:
            table = _parts(header[1])
            here = table
        elif assignment:
            here = (*table, *_parts(assignment[1]))
        else:
            continue
        if here == key[: len(here)] and len(here) > best[0]:
            best = (len(here), number)
    return best[1]


def _parts(dotted: str) -> Key:
    return tuple(a or b or c for a, b, c in _PART.findall(dotted))
