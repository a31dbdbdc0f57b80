"""From the cells of a file to our numbers: words to codes, dates to seconds, units to ours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import Final

import numpy as np

from ..errors import ModelError
from ..files.tables import Column, Fault, Format, Table
from ..kernel.arrays import FloatArray
from .columns import RECORDING
from .mapping import RecordingMap, plain
from .matching import Found, is_converted
from .stamps import seconds_of_dates
from .units import DATE_TIME, EPOCHS, to_ours

_FLAGS: Final = {"1": 1.0, "true": 1.0, "yes": 1.0, "0": 0.0, "false": 0.0, "no": 0.0}
_DIFFERENT: Final = 20  # texts that stand for nothing, told at once


def format_of(found: list[Found], mapping: RecordingMap) -> Format:
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
    return {"mode": mapping.modes, "eligible": mapping.flags}.get(ours.name, {})


def numbers_of(table: Table, found: list[Found], mapping: RecordingMap) -> dict[str, FloatArray]:
    """Return our columns; refuse the table with all cells that cannot be one of ours."""
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
    return bool(one.plus) or is_converted(one) or (one.source.factor, one.source.add) != (1.0, 0.0)


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
