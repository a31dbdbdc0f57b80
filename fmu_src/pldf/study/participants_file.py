"""``participants.csv``: one line per participant with seed and every parameter of the driver."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from math import nan
from pathlib import Path
from typing import Final

from ..instance import ModelError
from .participants import DRIVER_SIGNALS, Participant
from .phases import SEED_MAX

_FIELDS: Final = {signal.name: field for field, signal in DRIVER_SIGNALS.items()}
_ID: Final = re.compile(r"P\d{1,9}")


def participants_csv(participants: Sequence[Participant]) -> bytes:
    """Return the file's content; every number reads back to the same bits."""
    lines = [",".join(("participant", "seed", *_FIELDS))]
    for one in participants:
        values = (repr(one.value(field)) for field in _FIELDS.values())
        lines.append(",".join((one.id, str(one.seed), *values)))
    return ("\n".join(lines) + "\n").encode()


def read_participants(path: Path) -> tuple[Participant, ...]:
    """Read explicit participants.

    Needed is the column ``seed``. Without the column ``participant`` they are numbered in the order
    of the lines; parameters without a column keep the driver model's defaults.

    Raises:
        ModelError: naming file, line and column of the first thing that cannot be used.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not a UTF-8 text file"
        raise ModelError(f"{path}: cannot be read ({reason})") from error
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    rows = list(zip((n for n, _ in lines), csv.reader(line for _, line in lines), strict=True))
    if len(rows) < 2:
        raise ModelError(f"{path}: no participants; a header and a line for each are needed")
    header = [name.strip() for name in rows[0][1]]
    _check_header(f"{path}, line {rows[0][0]}", header)
    found: dict[str, Participant] = {}
    for number, cells in rows[1:]:
        where = f"{path}, line {number}"
        if len(cells) != len(header):
            raise ModelError(f"{where}: {len(cells)} values for {len(header)} columns")
        one = _participant(where, dict(zip(header, cells, strict=True)), len(found) + 1)
        if one.id in found:
            raise ModelError(f"{where}, participant: {one.id} occurs twice")
        found[one.id] = one
    return tuple(sorted(found.values(), key=lambda one: one.number))


def _check_header(where: str, header: list[str]) -> None:
    if "seed" not in header:
        raise ModelError(f"{where}: no column seed")
    for name in header:
        if name not in _FIELDS and name not in ("participant", "seed"):
            raise ModelError(
                f"{where}: unknown column {name!r}; known are participant, seed, "
                f"{', '.join(_FIELDS)}"
            )
        if header.count(name) > 1:
            raise ModelError(f"{where}: column {name} occurs twice")


def _participant(where: str, row: dict[str, str], number: int) -> Participant:
    name = row.pop("participant", f"P{number:03d}").strip()
    if not _ID.fullmatch(name) or f"P{int(name[1:]):03d}" != name:
        raise ModelError(f"{where}, participant: {name!r} is not P and a number, such as P001")
    seed = _number(f"{where}, seed", row.pop("seed"), (0, SEED_MAX), whole=True)
    values = {}
    for column, text in row.items():
        signal = DRIVER_SIGNALS[_FIELDS[column]]
        flag = signal.kind == "Boolean"
        allowed = (0.0, 1.0) if flag else (float(signal.low or 0), float(signal.high or 0))
        whole = signal.kind != "Real"
        values[signal.field] = _number(f"{where}, {column}", text, allowed, whole=whole)
    return Participant(name, int(seed), values)


def _number(where: str, text: str, allowed: tuple[float, float], whole: bool) -> float:
    try:
        value = float(text)
    except ValueError:
        value = nan
    low, high = allowed
    if not low <= value <= high or (whole and value != int(value)):
        kind = "whole number" if whole else "number"
        raise ModelError(f"{where}: {text.strip()!r} is not a {kind} from {low:g} to {high:g}")
    return value
