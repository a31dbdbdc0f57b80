"""Which column of a file is which of ours, by a map and by what the file says of units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import translate
from pathlib import Path
from re import fullmatch
from typing import Final

from ..errors import ModelError
from ..files.tables import Column, Fault, TableError
from ..findings import Finding
from .columns import LABORATORY, RECORDING
from .inputs import Input
from .mapping import RecordingMap, Source, ready_maps
from .units import unit_named, units_of

_LISTED_MAX: Final = 8


@dataclass(frozen=True)
class Found:
    """One of our columns in a file: ``name`` there, empty if ``source`` is a constant.

    To its numbers those of the column ``plus`` are added, if there is one.
    """

    ours: Column
    source: Source
    name: str
    unit: str
    plus: str = ""


def recognised(file: Input) -> RecordingMap | None:
    """Return the ready map that fits a file without our names."""
    if all(column.name in file.names for column in RECORDING.columns if column.needed):
        return None
    fitting = [ready for ready in ready_maps().values() if fits(file, ready)]
    return fitting[0] if len(fitting) == 1 else None


def fits(file: Input, mapping: RecordingMap) -> bool:
    """Tell whether ``file`` has all columns that ``mapping`` and a recording need."""
    return not list(_unresolved(file, mapping))


def found_columns(file: Input, mapping: RecordingMap) -> list[Found]:
    """Return where each of our columns that is there comes from; refuse with all that lacks."""
    if wrong := list(_unresolved(file, mapping)):
        if mapping.name:
            raise ModelError("\n  ".join(wrong))
        try:
            if file.load is None:
                file.table(LABORATORY)  # says it with the line of the header
            lacks = f"{wrong[0]}; a recording has the columns {LABORATORY.header}"
            raise TableError(file.path, [Fault(0, "", lacks)])
        except TableError as error:
            raise ModelError(f"{error}\n  {_way_out(file.path)}") from None
    found = []
    for column in RECORDING.columns:
        source = _source_of(column, mapping)
        names = [""] if source.value is not None else _matching(source.column, file.names)
        plus = _matching(source.plus, file.names)
        if names and (plus or not source.plus):
            unit = source.unit or _unit_in_file(file, names[0], column)
            found.append(Found(column, source, names[0], unit, *plus))
    return found


def _source_of(column: Column, mapping: RecordingMap) -> Source:
    """Return where a column comes from: by default from one of our name."""
    return mapping.columns.get(column.name, Source(0, (column.name,)))


def _way_out(path: Path) -> str:
    return (
        f"other names or units: 'pldf check --suggest-map {path}' writes a mapping file; complete "
        "it and give it with --map"
    )


def _unresolved(file: Input, mapping: RecordingMap) -> Iterator[str]:
    """Yield what a recording needs and ``file`` lacks, or has twice, by ``mapping``."""
    missing: list[str] = []
    twice: list[str] = []
    for column in RECORDING.columns:
        source = _source_of(column, mapping)
        for wanted in (source.column, source.plus):
            names = _matching(wanted, file.names) if wanted else [""]
            if len(names) == 1 or not (names or column.needed or source.line):
                continue
            if source.line:
                at = f"{mapping.name}, line {source.line}, recording.{column.name}"
                yield f"{at}: {_not_one(wanted, names, file)}"
            else:
                (twice if names else missing).append(column.name)
    if missing and mapping.name:
        yield (
            f"{mapping.name}: no line for {', '.join(missing)} under [recording], and {file.path} "
            f"has no column of that name; it has {_listed(file.names)}"
        )
    elif missing or twice:
        wrong = (("missing", missing), ("repeated", twice))
        yield "; ".join(f"{what} column {', '.join(names)}" for what, names in wrong if names)


def _not_one(wanted: tuple[str, ...], names: list[str], file: Input) -> str:
    meant = " or ".join(map(repr, wanted))
    if names:
        return f"{meant} is {len(names)} columns of {file.path}: {_listed(names)}"
    near = get_close_matches(wanted[0], file.names, 1)
    way_out = f"is {near[0]!r} meant?" if near else f"it has {_listed(file.names)}"
    return f"{file.path} has no column {meant}; {way_out}"


def _listed(names: tuple[str, ...] | list[str]) -> str:
    more = f" and {len(names) - _LISTED_MAX} more" if len(names) > _LISTED_MAX else ""
    return ", ".join(map(repr, names[:_LISTED_MAX])) + more


def _matching(wanted: tuple[str, ...], names: tuple[str, ...]) -> list[str]:
    """Return the columns that the first of ``wanted`` means that means any."""
    for one in wanted:
        # A bracket in a header is a bracket, so it is no set of characters as in fnmatch.
        pattern = translate(one.replace("[", "[[]").replace("?", "[?]"))
        same = [name for name in names if name == one]
        if found := same or [name for name in names if fullmatch(pattern, name)]:
            return found
    return []


def _unit_in_file(file: Input, name: str, column: Column) -> str:
    unit = unit_named(file.units.get(name, ""))
    return unit if unit in units_of(column.unit) else column.unit


def is_converted(found: Found) -> bool:
    """Tell whether numbers have another unit than ours."""
    return bool(found.name) and found.unit != found.ours.unit


def other_units(file: Input, mapping: RecordingMap, found: list[Found]) -> Iterator[Finding]:
    """Yield where the map and the file, each by itself, say what unit a column has."""
    for one in found:
        stated = unit_named(file.units.get(one.name, ""))
        if one.source.unit and stated in units_of(one.ours.unit) and stated != one.source.unit:
            yield Finding(
                "warning", str(file.path), 0, one.ours.name,
                f"{one.name!r} says {stated}, the map {mapping.name} {one.source.unit}",
                "the map counts", "correct the map if the file is right",
            )  # fmt: skip


def told_of_map(file: Input, mapping: RecordingMap, found: list[Found]) -> Finding:
    """Return what was read from where."""
    said = []
    for column in found:
        if not column.name:
            value = f"{column.source.value} {column.unit if column.ours.unit else ''}".strip()
            said.append(f"{column.ours.name} is {value} throughout")
        elif column.name != column.ours.name or is_converted(column):
            name = repr(column.name) + (f" + {column.plus!r}" if column.plus else "")
            unit = f" in {column.unit}" if is_converted(column) else ""
            said.append(f"{column.ours.name} from {name}{unit}")
    by = f"read with the map {mapping.name}: " if mapping.name else "read by the units it states: "
    return Finding("note", str(file.path), 0, "", by + (", ".join(said) or "all names are ours"))
