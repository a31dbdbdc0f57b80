"""The generated table of a model, ``table.c``; ``table_header`` makes ``table.h``.

A model's signals, the ranges of its memory, and where the runtime finds what in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields
from math import inf
from typing import Any, Final

from ...fmi.phases import Phase
from ...instance import Watch
from ...kernel.arrays import NextArrays, ProfileArrays, TraceArrays
from ...kernel.codes import (
    BOUND,
)
from ...kernel.sentences import EVENTS, NUMBERS, REASONS
from ...kernel.signals import Signal, by_reference, parameters_of, time_reference, variables_of
from ...outcome_words import BOUND_WORDS
from ...own_recording import COLUMNS as RECORDED
from ...own_recording import HEAD_FIELDS
from ...profiles.file_parts import COLUMNS, Column
from ...profiles.stored_profile import KINDS
from ...roads.marks import KIND_WORDS
from .c_source import literal, number
from .model import NativeModel
from .range_table import cell_ranges, column_ranges

_KINDS: Final = {
    "Real": "KIND_REAL",
    "Integer": "KIND_INTEGER",
    "Enumeration": "KIND_ENUMERATION",
    "Boolean": "KIND_BOOLEAN",
    "String": "KIND_STRING",
}
# Field of the C struct, field of the record.
_LEARNING_CELLS: Final = {
    "driver_id": "driver_id",
    "apply_learned": "apply_learned",
    "localization": "localization",
    "first_node": "first_node",
    "nodes": "nodes",
    "intervening": "intervening",
    "interventions": "drive_interventions",
    "set_series": "set_series",
    "holds": "holds",
    "places": "evidence_places",
    "accept": "learning_evidence_accept",
    "set_speed_gain": "learning_set_speed_gain",
    "speed_min": "learning_speed_min_mps",
    "profile_iteration": "profile_iteration",
    "profile_status": "profile_status",
    "time_ns": "time_ns",
    "s_m": "s_m",
    "input_state": "input_state",
    "teach_wanted": "teach_wanted",
    "words": "words",
    "taken_back": "taken_back",
}


def source(model: NativeModel, guid: str, token: str) -> str:
    """Return ``table.c``; ``guid`` belongs to FMI 2.0, ``token`` to FMI 3.0."""
    cells = [f.name for f in fields(model.record)]
    lines = ['#include "model.h"', "", "#include <math.h>", "#include <stddef.h>", ""]
    lines += [f"Entry model_{entry};" for entry in model.entries]
    lines += _array("static const Variable variables", _variables(model))
    lines += ["", "static const Cell defaults[] = {"]
    lines += [f"    {_cell(f.default)}, /* {f.name} */" for f in fields(model.record)]
    lines += ["};"]
    lines += _array("static const Range ranges", cell_ranges(model, cells))
    lines += _array("static const Range column_ranges", column_ranges(model))
    for at, watch in enumerate(model.watches):
        lines += _array(f"static const Said said_{at}", _said(watch))
    lines += _array("static const Watch watches", _watches(model, cells))
    lines += _texts("const char *const phase_names", (phase.name for phase in Phase))
    lines += _array("const ProfileColumn profile_columns", map(_column, COLUMNS))
    lines += _texts("const char *const profile_kinds", KINDS)
    lines += _texts("const char *const mark_kinds", KIND_WORDS.values())
    lines += _texts(
        "const char *const bound_words", (BOUND_WORDS[code] for code in range(len(BOUND.items)))
    )
    learning = "learn" in model.entries
    if learning:
        lines += _recorded(model)
        lines += _array("static const Bound bounds", (_references(p, model) for p in model.bounds))
        lines += _struct("static const Learning learning", _learning(model, cells))
    cluster = "hmi_sentence" in cells
    if cluster:
        for name, rows in (("reasons", REASONS), ("events", EVENTS)):
            lines += _texts(f"static const char *const {name}_en", (r.english for r in rows))
            lines += _texts(f"static const char *const {name}_de", (r.german for r in rows))
        lines += _struct("static const Cluster cluster", _cluster(cells))
    tokens = {"guid": literal(guid), "token": literal(token)}
    pointer = {
        "learning": "&learning" if learning else "NULL",
        "cluster": "&cluster" if cluster else "NULL",
    }
    members = [*tokens.items(), *_members(model, cells), *pointer.items()]
    return "\n".join([*lines, *_struct("const Model model", members), ""])


def _array(name: str, rows: Iterable[Iterable[str]]) -> list[str]:
    return ["", f"{name}[] = {{", *(f"    {{{', '.join(row)}}}," for row in rows), "};"]


def _texts(name: str, texts: Iterable[str]) -> list[str]:
    return ["", f"{name}[] = {{", *(f"    {literal(text)}," for text in texts), "};"]


def _struct(name: str, members: Iterable[tuple[str, str]]) -> list[str]:
    return ["", f"{name} = {{", *(f"    .{field} = {value}," for field, value in members), "};"]


def _column(column: Column) -> Iterator[str]:
    yield literal(column.name)
    yield literal(column.unit)
    yield number(column.low)
    yield number(column.high)
    yield str(int(column.whole))


def signals(model: NativeModel) -> tuple[Signal, ...]:
    """Return the variables in the order of their value references."""
    return variables_of(model.record, model.texts)


def _variables(model: NativeModel) -> list[Iterable[str]]:
    """Return one row per value reference; ``time``, which only FMI 3.0 asks for, is among them."""
    known = signals(model)
    rows: list[Iterable[str]] = [_variable(signal, model) for signal in known]
    time = ('"time"', "KIND_TIME", "INDEPENDENT", "0", "0", number(-inf), number(inf))
    rows.insert(time_reference(known), time)
    return rows


def _variable(signal: Signal, model: NativeModel) -> Iterator[str]:
    yield literal(signal.name)
    yield _KINDS[signal.kind]
    yield signal.causality.upper()
    yield str(int(signal.tunable))
    yield str(_place(signal, model))
    low, high = signal.range
    yield number(low)
    yield number(high)


def _place(signal: Signal, model: NativeModel) -> int:
    """Return the cell of a number, the index of a String parameter; of a String output 0."""
    if signal.kind != "String":
        return [f.name for f in fields(model.record)].index(signal.field)
    given = parameters_of(model.texts)
    return given.index(signal.field) if signal.field in given else 0


def _references(names: tuple[str, ...], model: NativeModel) -> Iterator[str]:
    known = {signal.field: reference for reference, signal in by_reference(signals(model)).items()}
    return (str(known[name]) for name in names)


def _said(watch: Watch) -> Iterator[Iterable[str]]:
    """Yield level and text of each value."""
    for value, text in enumerate(watch.texts):
        yield ("INFO" if value in watch.quiet else "WARNING", literal(text))


def _watches(model: NativeModel, cells: list[str]) -> Iterator[Iterable[str]]:
    for at, watch in enumerate(model.watches):
        flag = cells.index(watch.flag) if watch.once else -1
        time = 0 if watch.once else cells.index("time_ns")
        field = cells.index(watch.field)
        yield (*map(str, (field, flag, time, len(watch.texts))), f"said_{at}")


def _members(model: NativeModel, cells: list[str]) -> Iterator[tuple[str, str]]:
    texts = parameters_of(model.texts)
    yield "variables", "variables"
    yield "variable_count", str(len(_variables(model)))
    yield "defaults", "defaults"
    yield "ranges", "ranges"
    yield "column_ranges", "column_ranges"
    for entry in ("start", "refresh", "step"):
        yield entry, f"model_{entry}" if entry in model.entries else "NULL"
    yield "node_columns", str(model.node_columns)
    yield "kept_columns", str(model.kept_columns)
    yield "script_columns", str(model.event_columns)
    yield "route_column", str(model.first(model.route))
    for name, (field, value) in (("route_if", model.route_if), ("script_if", model.events_if)):
        always = "-1" if name == "route_if" else "-2"
        yield name, str(cells.index(field)) if field else always
        yield f"{name}_value", str(value)
    yield "route_id", str(cells.index("route_id"))
    yield "script_id", str(cells.index("script_id") if model.events else 0)
    yield "route_text", str(texts.index("route_file"))
    yield "script_text", str(texts.index("script_file") if model.events else -1)
    yield "watches", "watches"


def _learning(model: NativeModel, cells: list[str]) -> Iterator[tuple[str, str]]:
    texts = parameters_of(model.texts)
    for entry in ("adopt", "learn", "forget", "mark", "take_back"):
        yield entry, f"model_{entry}"
    yield "bounds", "bounds"
    yield "bound_count", str(len(model.bounds))
    yield "recorded", "recorded"
    yield "recorded_count", str(len(RECORDED))
    yield "head", "head"
    yield "head_count", str(len(HEAD_FIELDS))
    yield "recording_text", str(texts.index("recording_folder"))
    yield "store_text", str(texts.index("profile_store"))
    asked = (cells.index(name) for name in ("learn", "learn_faithful", "learn_consistent"))
    yield "learn_if", f"{{{', '.join(map(str, asked))}}}"
    for name, field in _LEARNING_CELLS.items():
        yield name, str(cells.index(field))
    yield "base_column", str(model.first(ProfileArrays, "base_mps"))
    # Both times the columns of LEARNED follow one another, as in the file.
    yield "learned_column", str(model.first(ProfileArrays, "learned_mps"))
    yield "trace_column", str(model.first(TraceArrays))
    yield "next_column", str(model.first(NextArrays))


def _cluster(cells: list[str]) -> Iterator[tuple[str, str]]:
    yield "reasons", "{reasons_en, reasons_de}"
    yield "events", "{events_en, events_de}"
    yield "sentence", str(cells.index("hmi_sentence"))
    yield "language", str(cells.index("hmi_language"))
    yield "names", f"{{{', '.join(literal(f'{{{name}}}') for name in NUMBERS)}}}"
    places = (str(cells.index(f"hmi_sentence_{name}")) for name in NUMBERS)
    yield "numbers", f"{{{', '.join(places)}}}"


def _recorded(model: NativeModel) -> list[str]:
    """Return the columns and the head of the function's own recording."""
    lines, columns = [], []
    for column in RECORDED:
        words = f"words_of_{column.name}" if column.words else "NULL"
        if column.words:
            lines += _texts(f"static const char *const {words}", column.words)
        at = model.first(column.group, column.field) if column.group else -1
        columns.append((literal(column.name), str(at), words, str(len(column.words))))
    head = ", ".join(_references(HEAD_FIELDS, model))
    lines += _array("static const RecordedColumn recorded", columns)
    return [*lines, "", f"static const int32_t head[] = {{{head}}};"]


def _cell(value: Any) -> str:
    return f"{{.integer = {value}}}" if isinstance(value, int) else f"{{.real = {number(value)}}}"
