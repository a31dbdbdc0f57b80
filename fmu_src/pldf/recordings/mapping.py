"""Mapping files: which column of a laboratory's files is which of ours, in which unit.

A TOML file for people who are no programmers: one line per column under ``[recording]``, the words
that stand for modes under ``[mode]``, those for yes and no under ``[eligible]``, and, for whoever
reads questionnaires, ``[questionnaire]``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any, Final

from ..errors import ModelError
from ..files.tables import Column
from ..kernel.codes import MODE
from ..toml_file import Key, TomlFile, line_of, shown
from .columns import RECORDING
from .units import unit_named, units_of

MAP_FILE: Final = "map.toml"  # in the folder of a study

PARTS: Final = ("recording", "mode", "eligible", "questionnaire")
_ENTRIES: Final = ("column", "plus", "unit", "factor", "add", "value")
_EXAMPLE: Final = '{ column = "Speed", unit = "km/h" }'
_COLUMNS: Final = {column.name: column for column in RECORDING.columns}


@dataclass(frozen=True)
class Source:
    """Where one of our columns comes from.

    Attributes:
        line: in the mapping file; 0: the column may be absent.
        column: names in the recording, the first that is there counts; a ``*`` in one stands for
            any characters; none: ``value`` counts.
        plus: names of a column of the same unit that is added; none: nothing is.
        unit: as ``units`` writes it; empty: what the file says, else ours.
        factor: that a number is multiplied with, before its unit counts.
        add: that is added then, in that unit.
        value: the same in every row: a number, or a mode's name.
    """

    line: int
    column: tuple[str, ...] = ()
    plus: tuple[str, ...] = ()
    unit: str = ""
    factor: float = 1.0
    add: float = 0.0
    value: float | str | None = None


@dataclass(frozen=True)
class RecordingMap:
    """What a mapping file says.

    Attributes:
        name: the file, or the name of a ready map.
        columns: our column -> where it comes from; a column that is not among them keeps our name.
        modes: what stands for a mode, in plain form -> code.
        flags: what stands for eligible, in plain form -> 0 or 1.
        questionnaire: the part for questionnaires, as it was parsed.
    """

    name: str
    columns: Mapping[str, Source] = field(default_factory=dict)
    modes: Mapping[str, float] = field(default_factory=dict)
    flags: Mapping[str, float] = field(default_factory=dict)
    questionnaire: Mapping[str, Any] = field(default_factory=dict)


def plain(text: str) -> str:
    """Return ``text`` as words are compared: 2.0 is 2, and capitals do not count."""
    text = " ".join(text.split()).casefold()
    try:
        number = float(text)
    except ValueError:
        return text
    return f"{number:.12g}" if math.isfinite(number) else text


def read_map(path: str | Path) -> RecordingMap:
    """Return the map in the file ``path``, or the ready map of that name.

    Raises:
        ModelError: the file cannot be read, or naming line, key, value and way out of all that is
            wrong with it.
    """
    if str(path) in ready_maps():
        return ready_maps()[str(path)]
    if not Path(path).exists():
        ready = ", ".join(ready_maps())
        raise ModelError(f"{path}: no such mapping file; ready maps are {ready}")
    return _checked(TomlFile(Path(path)), str(path))


def remembered_map(recording: Path) -> RecordingMap | None:
    """Return the map that is kept beside ``recording`` or in the folder of its study."""
    folders = [recording.parent]
    if recording.absolute().parent.name == "recordings":
        folders.append(recording.parent / "..")
    for folder in folders:
        if (path := folder / MAP_FILE).is_file():
            return read_map(path)
    return None


@cache
def ready_maps() -> Mapping[str, RecordingMap]:
    """Return the maps that come with this package, by name."""
    found = {}
    for entry in sorted(files(__package__).joinpath("maps").iterdir(), key=lambda e: e.name):
        name, _, ending = entry.name.rpartition(".")
        if ending == "toml":
            with as_file(entry) as path:
                found[name] = _lenient(_checked(TomlFile(path), name))
    return found


def _lenient(ready: RecordingMap) -> RecordingMap:
    """Return a ready map for files that lack what a recording may lack."""
    columns = {
        ours: source if _COLUMNS[ours].needed else replace(source, line=0)
        for ours, source in ready.columns.items()
    }
    return replace(ready, columns=columns)


def map_bytes(path: str | Path) -> bytes:
    """Return the content of a mapping file, or of the ready map of that name."""
    if str(path) in ready_maps():
        return files(__package__).joinpath("maps", f"{path}.toml").read_bytes()
    return Path(path).read_bytes()


def _checked(file: TomlFile, name: str) -> RecordingMap:
    if wrong := list(_wrong(file)):
        told = (f"{name}, line {line_of(file.text, key)}, {dotted(key)}: {t}" for key, t in wrong)
        raise ModelError("\n  ".join(told))
    table = file.table
    columns = {
        ours: _source(entry, line_of(file.text, ("recording", ours)))
        for ours, entry in table.get("recording", {}).items()
    }
    modes = {plain(word): float(MODE.code(mode)) for word, mode in table.get("mode", {}).items()}
    flags = {plain(word): float(flag) for word, flag in table.get("eligible", {}).items()}
    return RecordingMap(name, columns, modes, flags, table.get("questionnaire", {}))


def _source(entry: Any, line: int) -> Source:
    entry = entry if isinstance(entry, Mapping) else {"column": entry}
    told = {name: _names(entry[name]) for name in ("column", "plus") if name in entry}
    return Source(line, **{**entry, **told, "unit": unit_named(entry.get("unit", ""))})


def _names(value: str | list[str]) -> tuple[str, ...]:
    return (value,) if isinstance(value, str) else tuple(value)


def _are_names(value: object) -> bool:
    names = value if isinstance(value, list) else [value]
    return bool(names) and all(isinstance(name, str) and name.strip() for name in names)


def dotted(key: Key) -> str:
    """Return a key as it would be written in a TOML file, if all of it were on one line."""
    return ".".join(key)


def _wrong(file: TomlFile) -> Iterator[tuple[Key, str]]:
    """Yield all that is wrong with a mapping file: key, and what is wrong with it."""
    for part, content in file.table.items():
        if part in _COLUMNS and part not in PARTS:
            yield (part,), "stands outside of [recording]; write it below that line"
        elif part not in PARTS:
            yield (part,), _unknown(part, PARTS)
        elif not isinstance(content, Mapping):
            yield (part,), f"{shown(content)} is no table; write [{part}] and a line below it"
        else:
            yield from _CHECKS[part](content) if part in _CHECKS else ()


def _wrong_columns(content: Mapping[str, Any]) -> Iterator[tuple[Key, str]]:
    for ours, entry in content.items():
        key = ("recording", ours)
        if ours not in _COLUMNS:
            yield key, _unknown(ours, tuple(_COLUMNS))
        elif isinstance(entry, Mapping):
            yield from ((key, text) for text in _wrong_source(entry, _COLUMNS[ours]))
        elif not _are_names(entry):
            yield key, f"{shown(entry)} is no column; write {_EXAMPLE}"


def _wrong_source(entry: Mapping[str, Any], column: Column) -> Iterator[str]:
    unknown = [name for name in entry if name not in _ENTRIES]
    yield from (f"{name}: {_unknown(name, _ENTRIES)}" for name in unknown)
    if ("column" in entry) == ("value" in entry) and not unknown:
        yield f"needs either column or value; write {_EXAMPLE}"
    for name in ("column", "plus"):
        if name in entry and not _are_names(entry[name]):
            yield f"{name}: {shown(entry[name])} is not the name of a column"
    if "plus" in entry and not column.unit:
        yield f"plus: {column.name} has no numbers to add"
    for name in ("factor", "add"):
        number = entry.get(name, 1.0)
        if not _is_number(number) or (name == "factor" and number == 0.0):
            yield f"{name}: {shown(number)} is not a number"
        elif name in entry and not column.unit:
            yield f"{name}: {column.name} has no numbers to calculate with"
    yield from _wrong_unit(entry, column)
    if "value" in entry:
        yield from _wrong_value(entry["value"], column)


def _wrong_unit(entry: Mapping[str, Any], column: Column) -> Iterator[str]:
    if "unit" not in entry:
        return
    unit, allowed = entry["unit"], units_of(column.unit)
    if not allowed:
        yield f"unit: {column.name} has none; [{column.name}] says what stands for what"
    elif not (isinstance(unit, str) and unit_named(unit) in allowed):
        yield f"unit: {shown(unit)} is none of {', '.join(allowed)}; factor = ... is for others"


def _wrong_value(value: Any, column: Column) -> Iterator[str]:
    if column.kind == "word":
        if value not in column.words:
            yield f"value: {shown(value)} is not {column.description}"
    elif column.kind == "flag":
        if not isinstance(value, bool) and value not in (0, 1):
            yield f"value: {shown(value)} is neither true nor false"
    elif column.name == "time_s":
        yield "value: time cannot stand still; name a column"
    elif not _is_number(value):
        yield f"value: {shown(value)} is not a number"


def _wrong_modes(content: Mapping[str, Any]) -> Iterator[tuple[Key, str]]:
    for word, mode in content.items():
        if mode not in MODE.items:
            yield ("mode", word), f"{shown(mode)} is not one of {', '.join(MODE.items)}"


def _wrong_flags(content: Mapping[str, Any]) -> Iterator[tuple[Key, str]]:
    for word, flag in content.items():
        if not isinstance(flag, bool):
            yield ("eligible", word), f"{shown(flag)} is neither true nor false"


def _is_number(value: object) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value)  # type: ignore[arg-type]


def _unknown(name: str, known: tuple[str, ...]) -> str:
    near = get_close_matches(name, known, 1)
    return f"not known; is {near[0]} meant?" if near else f"not known; one of {', '.join(known)}"


# Whoever reads questionnaires knows the keys of that part.
_CHECKS: Final[Mapping[str, Callable[[Mapping[str, Any]], Iterator[tuple[Key, str]]]]] = {
    "recording": _wrong_columns,
    "mode": _wrong_modes,
    "eligible": _wrong_flags,
}
