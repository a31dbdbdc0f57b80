"""From a file to our columns: which column is which, in which unit, at which time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from fnmatch import translate
from math import inf
from pathlib import Path
from re import fullmatch
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelError
from ..files.tables import Column, Fault, Format, Table, TableError
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .columns import RECORDING
from .inputs import Input, open_input
from .mapping import RecordingMap, Source, plain, ready_maps, remembered_map
from .stamps import CoarseStamps, seconds_of_dates
from .titles import with_meant_names
from .units import DATE_TIME, EPOCHS, to_ours, unit_named, units_of

_LISTED_MAX: Final = 8
_FLAGS: Final = {"1": 1.0, "true": 1.0, "yes": 1.0, "0": 0.0, "false": 0.0, "no": 0.0}
_BACKWARDS: Final = "sort the recording by time, or cut it where the logger began anew"
_DIFFERENT: Final = 20  # texts that stand for nothing, told at once


class Columns(NamedTuple):
    """What was read: our columns by name, comments of the file, and what has to be known."""

    numbers: dict[str, FloatArray]
    comments: tuple[str, ...]
    notes: tuple[Finding, ...]


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


def read_columns(path: Path, mapping: RecordingMap | None) -> Columns:
    """Read a recording with ``mapping``, else with the one kept for it, else with our names.

    Raises:
        ModelError: naming file, line, column and value of all that cannot be used.
    """
    file = open_input(path)
    with file.placed():
        found = _read(file, mapping or remembered_map(path))
    return found._replace(notes=tuple(map(file.place, found.notes)))


def _read(file: Input, mapping: RecordingMap | None) -> Columns:
    if mapping is None:
        mapping = _recognised(file) or RecordingMap("")
    notes: list[Finding] = []
    mapping = with_meant_names(file, mapping, notes)
    found = _found(file, mapping)
    notes += _other_units(file, mapping, found)
    if mapping.name or any(_is_converted(column) for column in found):
        notes.append(_told(file, mapping, found))
    table, told = file.table(_format(found, mapping))
    numbers = _numbers(table, found, mapping)
    notes += [*told, *table.notes]
    table.refuse(_back_in_time(table, numbers["time_s"], found))
    return _with_growing_time(table, numbers, notes)


def _recognised(file: Input) -> RecordingMap | None:
    """Return the ready map that fits a file without our names."""
    if all(column.name in file.names for column in RECORDING.columns if column.needed):
        return None
    fitting = [ready for ready in ready_maps().values() if fits(file, ready)]
    return fitting[0] if len(fitting) == 1 else None


def fits(file: Input, mapping: RecordingMap) -> bool:
    """Tell whether ``file`` has all columns that ``mapping`` and a recording need."""
    return not list(_unresolved(file, mapping))


def _found(file: Input, mapping: RecordingMap) -> list[Found]:
    """Return where each of our columns that is there comes from; refuse with all that lacks."""
    if wrong := list(_unresolved(file, mapping)):
        if mapping.name:
            raise ModelError("\n  ".join(wrong))
        try:
            if file.load is None:
                file.table(RECORDING)  # says it with the line of the header
            lacks = f"{wrong[0]}; a recording has the columns {RECORDING.header}"
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


def _is_converted(found: Found) -> bool:
    return bool(found.name) and found.unit != found.ours.unit


def _other_units(file: Input, mapping: RecordingMap, found: list[Found]) -> Iterator[Finding]:
    """Yield where the map and the file, each by itself, say what unit a column has."""
    for one in found:
        stated = unit_named(file.units.get(one.name, ""))
        if one.source.unit and stated in units_of(one.ours.unit) and stated != one.source.unit:
            yield Finding(
                "warning", str(file.path), 0, one.ours.name,
                f"{one.name!r} says {stated}, the map {mapping.name} {one.source.unit}",
                "the map counts", "correct the map if the file is right",
            )  # fmt: skip


def _told(file: Input, mapping: RecordingMap, found: list[Found]) -> Finding:
    said = []
    for column in found:
        if not column.name:
            value = f"{column.source.value} {column.unit if column.ours.unit else ''}".strip()
            said.append(f"{column.ours.name} is {value} throughout")
        elif column.name != column.ours.name or _is_converted(column):
            name = repr(column.name) + (f" + {column.plus!r}" if column.plus else "")
            unit = f" in {column.unit}" if _is_converted(column) else ""
            said.append(f"{column.ours.name} from {name}{unit}")
    by = f"read with the map {mapping.name}: " if mapping.name else "read by the units it states: "
    return Finding("note", str(file.path), 0, "", by + (", ".join(said) or "all names are ours"))


def _format(found: list[Found], mapping: RecordingMap) -> Format:
    """Return what the file has to hold, by its own names."""
    columns: dict[str, Column] = {}
    for one in (one for one in found if one.name):
        as_text = one.unit == DATE_TIME or (one.name != one.ours.name and one.ours.kind == "flag")
        as_text = as_text or bool(_words(one.ours, mapping))
        kind = "text" if as_text else one.ours.kind
        unit = "" if as_text else one.unit
        column = replace(one.ours, name=one.name, kind=kind, unit=unit, needed=True)
        if _is_calculated(one):  # its range is that of the result, but -99 is missing in any unit
            scaled = bool(one.plus) or (one.source.factor, one.source.add) != (1.0, 0.0)
            column = replace(column, low=-inf if scaled else column.low, high=inf)
        if one.plus:
            columns.setdefault(one.plus, replace(column, name=one.plus))
        if columns.setdefault(one.name, column).kind != kind:
            raise ModelError(
                f"{mapping.name}, line {one.source.line}, recording.{one.ours.name}: the column "
                f"{one.name!r} cannot hold texts and numbers; name another one"
            )
    return replace(RECORDING, columns=tuple(columns.values()))


def _words(ours: Column, mapping: RecordingMap) -> Mapping[str, float]:
    """Return what stands for what in a column of texts; empty if the reader of tables knows."""
    if ours.kind == "word":
        return mapping.modes
    return mapping.flags if ours.kind == "flag" else {}


def _numbers(table: Table, found: list[Found], mapping: RecordingMap) -> dict[str, FloatArray]:
    numbers: dict[str, FloatArray] = {}
    faults: list[Fault] = []
    for one in found:
        if not one.name:
            numbers[one.ours.name] = np.full(len(table), _constant(one))
        elif one.unit == DATE_TIME:
            values = seconds_of_dates(table.texts[one.name])
            numbers[one.ours.name] = values
            wrong = np.flatnonzero(~np.isfinite(values)).tolist()
            text = "is no date and time such as 2026-05-01T12:00:00.250"
            faults += [
                table.fault(r, one.name, f"{table.texts[one.name][r]!r} {text}") for r in wrong
            ]
        elif one.name in table.texts:
            numbers[one.ours.name] = _coded(table, one, mapping, faults)
        else:
            values = table.numbers[one.name]
            values = values + table.numbers[one.plus] if one.plus else values
            numbers[one.ours.name] = _calculated(values, one)
            faults += _beyond(table, one, numbers[one.ours.name])
    table.refuse(faults)
    return numbers


def _is_calculated(one: Found) -> bool:
    return bool(one.plus) or _is_converted(one) or (one.source.factor, one.source.add) != (1.0, 0.0)


def _beyond(table: Table, one: Found, values: FloatArray) -> Iterator[Fault]:
    """Yield where a calculated number is none that our column may hold."""
    for row in np.flatnonzero(~one.ours.allows(values)).tolist():
        yield table.fault(row, one.name, f"{values[row]:g} is not {one.ours.description}")


def _constant(one: Found) -> float:
    value = one.source.value
    if isinstance(value, str):
        return float(one.ours.words.index(value))
    assert value is not None
    return float(_calculated(np.array([float(value)]), one)[0]) if one.ours.unit else float(value)


def _calculated(values: FloatArray, one: Found) -> FloatArray:
    if not one.ours.unit:
        return values
    if one.unit in EPOCHS:
        values = values - values[0]
    if one.source.factor != 1.0 or one.source.add != 0.0:
        values = values * one.source.factor + one.source.add
    return values if one.unit == one.ours.unit else to_ours(values, one.unit, one.ours.unit)


def _coded(table: Table, one: Found, mapping: RecordingMap, faults: list[Fault]) -> FloatArray:
    """Return the codes of words; add the first place of each text that stands for nothing."""
    known = _words(one.ours, mapping) or _FLAGS
    texts = table.texts[one.name]
    codes = {text: known.get(plain(text), np.nan) for text in dict.fromkeys(texts)}
    strange = [text for text, code in codes.items() if np.isnan(code)]
    for text in strange[:_DIFFERENT]:
        faults.append(
            table.fault(
                texts.index(text), one.name,
                f"{text!r} ({texts.count(text)} rows) stands for nothing under [{one.ours.name}] "
                f"of {mapping.name}; add a line {text!r} = ... there",
            )
        )  # fmt: skip
    return np.array([codes[text] for text in texts], dtype=np.float64)


def _back_in_time(table: Table, time_s: FloatArray, found: list[Found]) -> Iterator[Fault]:
    name = next(one.name for one in found if one.ours.name == "time_s")
    for row in np.flatnonzero(np.diff(time_s) < 0.0).tolist():
        text = f"time runs backwards, from {time_s[row]:.10g} s to {time_s[row + 1]:.10g} s"
        yield table.fault(row + 1, name, f"{text}; {_BACKWARDS}")


def _with_growing_time(
    table: Table, numbers: dict[str, FloatArray], notes: list[Finding]
) -> Columns:
    """Drop repeated rows and share out stamps that several samples have; tell either."""
    same = np.append(False, np.diff(numbers["time_s"]) == 0.0)
    lines = np.array(table.lines)
    repeated = same & _as_before(numbers)
    # Where most rows with the stamp before differ from it, stamps are coarse, and equal rows are
    # those of a car that stands.
    if 2 * np.count_nonzero(repeated) > np.count_nonzero(same):
        notes.append(_repeated(table, lines[repeated]))
        numbers = {name: values[~repeated] for name, values in numbers.items()}
        lines, same = lines[~repeated], same[~repeated]
    if not same.any():
        table.refuse(_one_row(table, numbers))
        return Columns(numbers, table.comments, tuple(notes))
    coarse = CoarseStamps(numbers["time_s"])
    table.refuse(_standing(coarse, lines))
    times_s = coarse.times_s()
    notes.append(_shared_out(table, coarse, times_s, int(lines[same][0])))
    return Columns({**numbers, "time_s": times_s}, table.comments, tuple(notes))


def _one_row(table: Table, numbers: dict[str, FloatArray]) -> Iterator[Fault]:
    if len(numbers["time_s"]) < RECORDING.rows_min:
        yield Fault(table.lines[0], "", "all rows are the same; a recording needs two that differ")


def _as_before(numbers: dict[str, FloatArray]) -> NDArray[np.bool_]:
    """Tell which rows are like the one before in every column."""
    same = [np.append(False, v[1:] == v[:-1]) for v in numbers.values()]
    return np.asarray(np.all(same, axis=0))


def _repeated(table: Table, lines: NDArray[np.intp]) -> Finding:
    return Finding(
        "note", str(table.path), int(lines[0]), "", f"{len(lines)} rows repeat the one before them",
        "they are left out; no number changes by that",
    )  # fmt: skip


def _standing(coarse: CoarseStamps, lines: NDArray[np.intp]) -> Iterator[Fault]:
    for row in coarse.standing:
        text = f"the clock stands still at {coarse.stamps_s[row]:.10g} s while the car drives on"
        yield Fault(
            int(lines[row]), "time_s", f"{text}; cut the recording there, or repair its times"
        )


def _shared_out(table: Table, coarse: CoarseStamps, times_s: FloatArray, line: int) -> Finding:
    moved = float(np.max(np.abs(times_s - coarse.stamps_s)))
    return Finding(
        "note", str(table.path), line, "time_s",
        f"{coarse.shared} of {len(times_s)} samples have the stamp of the one before, up to "
        f"{coarse.longest} share one: stamps are coarser ({coarse.step_s:.3g} s) than samples",
        f"samples were spread evenly, by {moved:.2g} s at most; the times of interventions are "
        "that uncertain",
        "write more decimals of time, for exact times",
    )  # fmt: skip
