"""The generated part of the C code: a model's signals and layout as ``table.h`` and ``table.c``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from math import inf
from typing import Any, Final

from ...kernel.arrays import NextArrays, ProfileArrays
from ...kernel.signals import Signal, signals_of
from .model import ENTRY_NAMES, NativeModel

_KINDS: Final = {
    "Real": "KIND_REAL",
    "Integer": "KIND_INTEGER",
    "Enumeration": "KIND_ENUMERATION",
    "Boolean": "KIND_BOOLEAN",
    "String": "KIND_STRING",
}
# Field of the C struct, field of the record; for models that learn.
_LEARNING_CELLS: Final = {
    "driver_id": "driver_id",
    "apply_learned": "apply_learned",
    "localization": "localization",
    "first_node": "first_node",
    "nodes": "nodes",
    "intervening": "intervening",
    "interventions": "drive_interventions",
    "profile_iteration": "profile_iteration",
    "profile_status": "profile_status",
}


def header(model: NativeModel) -> str:
    """Return ``table.h``: the sizes that the compiler must know."""
    return (
        f"enum {{ MODEL_CELLS = {len(fields(model.record))}, "
        f"MODEL_TEXTS = {len(fields(model.texts))} }};\n"
    )


def source(model: NativeModel, guid: str, token: str) -> str:
    """Return ``table.c``; ``guid`` belongs to FMI 2.0, ``token`` to FMI 3.0."""
    cells = [f.name for f in fields(model.record)]
    lines = ['#include "model.h"', "", "#include <math.h>", "#include <stddef.h>", ""]
    lines += [f"Entry model_{entry};" for entry in model.entries]
    lines += ["", "static const Variable variables[] = {"]
    lines += [f"    {{{', '.join(_variable(s, model))}}}," for s in signals(model)]
    lines += ["};", "", "static const Cell defaults[] = {"]
    lines += [f"    {_cell(f.default)}, /* {f.name} */" for f in fields(model.record)]
    lines += ["};", "", "static const char *const watch_texts[] = {"]
    lines += [f"    {_text(text)}," for text in model.watch.texts]
    if model.bounds:
        lines += ["};", "", "static const Bound bounds[] = {"]
        lines += [f"    {{{', '.join(_references(pair, model))}}}," for pair in model.bounds]
    lines += ["};", "", "const Model model = {"]
    lines += [f"    .guid = {_text(guid)},", f"    .token = {_text(token)},"]
    lines += [f"    .{name} = {value}," for name, value in _members(model, cells)]
    return "\n".join([*lines, "};", ""])


def signals(model: NativeModel) -> tuple[Signal, ...]:
    """Return the variables in the order of their value references."""
    return signals_of(model.record) + signals_of(model.texts)


def _variable(signal: Signal, model: NativeModel) -> Iterator[str]:
    record = model.texts if signal.kind == "String" else model.record
    yield _text(signal.name)
    yield _KINDS[signal.kind]
    yield signal.causality.upper()
    yield str([f.name for f in fields(record)].index(signal.field))
    low, high = signal.range
    yield _number(low)
    yield _number(high)


def _references(names: tuple[str, ...], model: NativeModel) -> Iterator[str]:
    known = [signal.field for signal in signals(model)]
    return (str(known.index(name)) for name in names)


def _members(model: NativeModel, cells: list[str]) -> Iterator[tuple[str, str]]:
    texts = [f.name for f in fields(model.texts)]
    yield "variables", "variables"
    yield "variable_count", str(len(signals(model)))
    yield "defaults", "defaults"
    for entry in ENTRY_NAMES:
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
    yield "watch", str(cells.index(model.watch.field))
    yield "watch_flag", str(cells.index(model.watch.flag) if model.watch.once else -1)
    yield "watch_time", str(0 if model.watch.once else cells.index("time_ns"))
    yield "watch_texts", "watch_texts"
    yield "watch_count", str(len(model.watch.texts))
    yield "bounds", "bounds" if model.bounds else "NULL"
    yield "bound_count", str(len(model.bounds))
    if "learn" in model.entries:
        yield from _learning(model, cells, texts)


def _learning(model: NativeModel, cells: list[str], texts: list[str]) -> Iterator[tuple[str, str]]:
    yield "store_text", str(texts.index("profile_store"))
    yield "learn_if", f"{{{cells.index('learn')}, {cells.index('learn_faithful')}}}"
    for name, field in _LEARNING_CELLS.items():
        yield name, str(cells.index(field))
    yield "base_column", str(model.first(ProfileArrays, "base_mps"))
    # Both times learned, offset, drive and intervention follow one another, as in the file.
    yield "learned_column", str(model.first(ProfileArrays, "learned_mps"))
    yield "following_column", str(model.first(NextArrays, "learned_mps"))


def _cell(value: Any) -> str:
    return f"{{.integer = {value}}}" if isinstance(value, int) else f"{{.real = {_number(value)}}}"


def _number(value: float) -> str:
    if abs(value) == inf:
        return "INFINITY" if value > 0 else "-INFINITY"
    return float(value).hex()


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
