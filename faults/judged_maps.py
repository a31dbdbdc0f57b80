"""Mapping files: a recording in a laboratory's words, and what a map makes of it.

The judge is the standard library's TOML, and what docs/recordings.md says of columns, units,
factors, values and words.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from fnmatch import filter as filter_names
from math import isfinite
from pathlib import Path
from typing import Any, Final
from unicodedata import decimal

from pldf.errors import ModelError
from pldf.recordings.mapping import read_map
from pldf.recordings.recording import read_recording

from .judged_kinds import MODES, Answer, Values
from .sheets import NUMBER, Unclear

MAP: Final = """\
# of M\u00fcller's laboratory
[recording]
time_s = { column = "Zeit", unit = "ms" }
s_m = { column = "Weg", unit = "km", add = 0.25 }
speed_mps = { column = "v", unit = "km/h" }
mode = "Betriebsart"
gas_pedal = { column = "Gas", unit = "%" }
brake_pedal = { column = "Bremse", factor = 0.5 }
set_speed_mps = { column = "vset", unit = "mph" }
limit_mps = { value = 27.5 }

[mode]
"1" = "STANDBY"
"2" = "ACTIVE"
"Gas" = "GAS_OVERRIDE"
"""
_UNITS: Final = {
    "time_s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "s_m": {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3},
    "_mps": {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704},
    "pedal": {"1": 1.0, "%": 0.01},
}
_ROWS: Final = 20
_LABORATORY: Final[Mapping[str, list[Any]]] = {
    "Zeit": [100.0 * n for n in range(_ROWS)],
    "Weg": [round(0.0025 * n, 4) for n in range(_ROWS)],
    "v": [90.0 + n for n in range(_ROWS)],
    "Betriebsart": ["Gas" if n in range(5, 9) else 1 + (n > 2) for n in range(_ROWS)],
    "Gas": [40.0 if n in range(5, 9) else 0.0 for n in range(_ROWS)],
    "Bremse": [0.5 * (n < 3) for n in range(_ROWS)],
    "vset": [60.0] * _ROWS,
}


def read(path: Path) -> Answer:
    """Read the laboratory's recording by the map in ``path``."""
    recorded = path.with_name("P001_A1.csv")
    rows = zip(*_LABORATORY.values(), strict=True)
    lines = [",".join(_LABORATORY), *(",".join(map(str, row)) for row in rows)]
    recorded.write_text("\n".join(lines) + "\n")
    mapping = read_map(path)
    try:
        columns = read_recording(recorded, mapping).columns
    except ModelError as error:  # the recording is to blame as well as its map
        raise ModelError(f"{path}: {error}") from error
    return Answer({name: _rounded(values.tolist()) for name, values in columns.items()})


def judge(text: str) -> Values:
    """Return the columns that this map makes; Unclear if it is none."""
    try:
        file = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise Unclear("no TOML") from None
    known = tomllib.loads(MAP)
    lines, words = file.get("recording", {}), file.get("mode", {})
    if not isinstance(lines, dict) or not isinstance(words, dict) or set(file) - set(known):
        raise Unclear("unknown parts")
    if set(lines) - set(known["recording"]) or any(word not in MODES for word in words.values()):
        raise Unclear("unknown columns or modes")
    if {"time_s", "s_m", "speed_mps", "mode"} - set(lines):
        raise Unclear("no line for what is needed")
    values = {name: _column(name, line, words) for name, line in lines.items()}
    if any(not b > a for a, b in zip(values["time_s"], values["time_s"][1:], strict=False)):
        raise Unclear("time does not run forwards")
    if not all(isfinite(value) for column in values.values() for value in column):
        raise Unclear("beyond all numbers")
    return {name: _rounded(column) for name, column in values.items()}


def _rounded(values: Sequence[float]) -> list[float]:
    """Return the values without the digits in which two ways to calculate differ."""
    return [float(f"{value:.9g}") for value in values]


def _column(name: str, line: Any, words: Mapping[str, str]) -> list[float]:
    line = line if isinstance(line, dict) else {"column": line}
    if set(line) - {"column", "unit", "factor", "add", "value"}:
        raise Unclear(f"{name}: unknown keys")
    if "value" in line:
        if "column" in line or not _is_number(line["value"]):
            raise Unclear(f"{name}: no value")
        return [float(line["value"])] * _ROWS
    source = line.get("column")
    if not isinstance(source, str) or len(found := filter_names(_LABORATORY, source)) != 1:
        raise Unclear(f"{name}: no such column")
    cells = _LABORATORY[found[0]]
    if name == "mode":
        codes = {_plain(word): float(MODES.index(mode)) for word, mode in words.items()}
        if set(line) > {"column"} or any(_plain(cell) not in codes for cell in cells):
            raise Unclear("modes")
        return [codes[_plain(cell)] for cell in cells]
    units = next(known for end, known in _UNITS.items() if name.endswith(end))
    factor, added, unit = line.get("factor", 1.0), line.get("add", 0.0), line.get("unit", "")
    if not _is_number(factor) or factor == 0 or not _is_number(added):
        raise Unclear(f"{name}: no factor")
    if unit and unit not in units:
        raise Unclear(f"{name}: no unit")
    if any(isinstance(cell, str) for cell in cells):
        raise Unclear(f"{name}: no numbers")
    return [(cell * factor + added) * units.get(unit, 1.0) for cell in cells]


def _plain(word: object) -> str:
    text = "".join(str(decimal(c)) if c.isdecimal() else c for c in str(word).strip().lower())
    return f"{float(text):g}" if NUMBER.fullmatch(text) else text


def _is_number(value: object) -> bool:
    return type(value) in (int, float) and isfinite(value)  # type: ignore[arg-type]
