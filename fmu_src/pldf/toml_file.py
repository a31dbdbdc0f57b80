"""TOML files read into msgspec structures; errors name file, line, key and what is allowed.

Knows nothing of studies. Neither the standard library's parser nor msgspec tells the line of a key,
so it is looked up in the text when something is wrong.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NoReturn, TypeVar, get_args, get_origin

import msgspec

from .errors import ModelError

Key = tuple[str, ...]
StructT = TypeVar("StructT", bound=msgspec.Struct)

_AT: Final = re.compile(r" - at (?:`key` in )?`\$\.?(?P<path>.*?)(\[(?:(?P<item>\d+)|\.\.\.)\])?`$")
_UNKNOWN: Final = re.compile(r"contains unknown field `(.*?)`(?= - at `|$)")
_MISSING: Final = re.compile(r"missing required field `(.*?)`")
_HEADER: Final = re.compile(r"\s*\[\s*([^\[\]]+?)\s*\]\s*(#.*)?$")
_ASSIGNMENT: Final = re.compile(r"\s*([^=#]+?)\s*=")
_PART: Final = re.compile(r'"([^"]*)"|\'([^\']*)\'|([^.\s]+)')
_BARE: Final = re.compile(r"[A-Za-z0-9_-]+")
_LISTED_MAX: Final = 6


class TomlFile:
    """The content of a TOML file.

    Attributes:
        path: the file as named by the user.
        text: its content, with the changes.
        table: the parsed content.

    Raises:
        ModelError: from every method, when file or value cannot be used.
    """

    def __init__(self, path: Path, changes: Mapping[Key, Any] | None = None) -> None:
        self.path = path
        try:
            self.text = path.read_text(encoding="utf-8-sig")  # Notepad marks it
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "not a UTF-8 text file"
            raise ModelError(f"{path}: cannot be read ({reason})") from error
        try:
            self.table: dict[str, Any] = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            raise ModelError(f"{path}: not valid TOML: {error}") from None
        if changes:
            for (table, key), value in changes.items():
                self.table.setdefault(table, {})[key] = value
            self.text = toml_text(self.table)

    def fail(self, key: Key, problem: str) -> NoReturn:
        """Raise ModelError for ``key``."""
        raise ModelError(f"{self.path}, line {line_of(self.text, key)}, {'.'.join(key)}: {problem}")

    def read(self, kind: type[StructT], *table: str) -> StructT:
        """Return the file, or one of its tables, or a table within, as a structure."""
        raw = self.within(*table)
        try:
            return msgspec.convert(raw, kind)
        except msgspec.ValidationError as error:
            self._explain(kind, table, str(error))

    def problems(self, kind: type[msgspec.Struct], table: str) -> list[str]:
        """Return what is wrong with each key of a table by itself; ``kind`` needs none of them."""
        found = []
        for key, value in self.within(table).items():
            try:
                msgspec.convert({key: value}, kind)
            except msgspec.ValidationError as error:
                try:
                    self._explain(kind, (table,), str(error))
                except ModelError as problem:
                    found.append(str(problem))
        return found

    def within(self, *table: str) -> Any:
        """Return what stands in the file, in one of its tables, or in a table within."""
        found: Any = self.table
        for name in table:
            found = found.get(name, {})
        return found

    def _explain(self, kind: type[msgspec.Struct], table: Key, text: str) -> NoReturn:
        """Fail with what msgspec found wrong; only the file itself has tables within."""
        at, unknown = _AT.search(text), _UNKNOWN.search(text)
        path = at["path"] if at else ""
        names = [path] if table and path else path.split(".") if path else []
        value: Any = self.within(*table)
        declared: Any = kind
        for name in names:
            declared, value = _fields(declared)[name], value[name]
        key = (*table, *names)
        if missing := _MISSING.search(text):
            self.fail((*key, missing[1]), "missing; it is needed")
        if unknown:
            self._unknown_here((*key, unknown[1]), declared, isinstance(value[unknown[1]], dict))
        if at and at["item"] and get_origin(declared) is not Annotated:
            declared, value = get_args(declared)[0], value[int(at["item"])]
        self.fail(key, f"{shown(value)} must be {_allowed(declared, key)}")

    def _unknown_here(self, key: Key, declared: type[msgspec.Struct], is_table: bool) -> NoReturn:
        """Fail because the structure declared has no ``key``."""
        known = [n for n, t in _fields(declared).items() if _is_table(t) or not is_table]
        if not known:
            self.fail(
                key,
                f"is a table, and [{'.'.join(key[:-1])}] has none within; a name with dots is "
                'written in quotes, such as "learning.weight"',
            )
        self.unknown(key, known)

    def unknown(self, key: Key, known: Iterable[str]) -> NoReturn:
        """Fail because ``key`` is not one of ``known``."""
        known = list(known)
        near = get_close_matches(key[-1], known, n=1)
        hint = f"; did you mean {near[0]}?" if near else f"; known are {', '.join(known)}"
        self.fail(key, f"unknown{hint}")


def _fields(kind: type[msgspec.Struct]) -> dict[str, Any]:
    """Return the declared types of a structure by their names in the file."""
    return {field.encode_name: field.type for field in msgspec.structs.fields(kind)}


def _is_table(declared: Any) -> bool:
    kind = get_origin(declared) or declared
    return isinstance(kind, type) and issubclass(kind, (msgspec.Struct, dict))


def _allowed(declared: Any, key: Key) -> str:
    """Return what a value of the declared type may be, for people."""
    for note in getattr(declared, "__metadata__", ()):
        return str(note.description)
    if get_origin(declared) is Literal:
        return f"one of {', '.join(map(shown, get_args(declared)))}"
    if get_origin(declared) is tuple:
        return f"a list out of {listed(get_args(get_args(declared)[0]))}"
    return f"a table: write [{key[-1]}]" if _is_table(declared) else "true or false"


def listed(values: Iterable[object]) -> str:
    """Return the first few values as they are written in a TOML file."""
    texts = list(map(shown, values))
    return ", ".join(texts[:_LISTED_MAX]) + (", ..." if len(texts) > _LISTED_MAX else "")


def shown(value: object) -> str:
    """Return a value as it is written in a TOML file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(shown, value))}]"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(key)} = {shown(one)}" for key, one in value.items())
        return f"{{ {inner} }}"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else str(value)


def toml_text(table: Mapping[str, Any]) -> str:
    """Return a file with these keys and tables of keys."""
    tables = {name: value for name, value in table.items() if isinstance(value, Mapping)}
    lines = [f"{name} = {shown(value)}" for name, value in table.items() if name not in tables]
    for name, content in tables.items():
        lines += ["", f"[{name}]", *(f"{_key(key)} = {shown(v)}" for key, v in content.items())]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else shown(name)


def line_of(text: str, key: Key) -> int:
    """Return the line of ``text`` in which ``key`` is assigned, else its table's, else 1."""
    table: Key = ()
    best = (0, 1)  # parts of the key that agree, line
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
