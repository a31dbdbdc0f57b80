"""Spoilt tables: each reader's values are those of an independent judge, or it told, or refused.

The judge (``sheets``) knows how a file was written, and reads it with the standard library.
"""

from __future__ import annotations

import random
import re
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from math import nan
from pathlib import Path
from typing import Any, Final

from . import judged_kinds, judged_people
from .byte_changes import DAMAGES
from .experiment import Counts, Experiment, Progress
from .judged_kinds import Answer, Kind, Values
from .sheet_changes import CONTENTS, DRESSES, PLAIN
from .sheets import Dress, Unclear, column, number, understood
from .verdicts import Verdict, Word, asked, counted, same

KINDS: Final = (*judged_kinds.KINDS, *judged_people.KINDS)
# A note that the letters may be others than were meant.
_ENCODED: Final = re.compile(r"UTF|encod|Latin|Windows|cp1252|GB|Shift", re.IGNORECASE)
# What stands for a missing number where it cannot be one.
_CODES: Final = ("-99", "-999")
# How alike a name has to be to a known one to be a slip of it.
_ALIKE: Final = 0.8


def judged(kind: Kind, data: bytes, dress: Dress) -> Values:
    """Return what the file says; Unclear if it says nothing that one could rely on."""
    header, rows = understood(data, dress)
    header = [_meant_name(title, header, kind.columns) for title in header]
    columns: Values = {}
    for name, cells_are in kind.columns.items():
        cells = column(header, rows, name)
        if cells is None:
            if name in kind.needed:
                raise Unclear(f"no column {name}")
            if slip := [title for title in header if _slip(title, name, kind.columns)]:
                raise Unclear(f"{slip[0]!r} for {name}")
        else:
            columns[name] = [_cell(cell, cells_are, dress) for cell in cells]
    if len(rows) < kind.rows_min:
        raise Unclear("no rows")
    return kind.judge(columns)


def _meant_name(title: str, header: Sequence[str], known: Iterable[str]) -> str:
    """Return the known name that ``title`` is but for case, blanks and dashes."""
    same = [name for name in known if name not in header and _plain(name) == _plain(title)]
    return same[0] if same else title


def _plain(name: str) -> str:
    return re.sub(r"[\s_.\u200b-]+", "_", name).strip("_").lower()


def _slip(title: str, name: str, known: Iterable[str]) -> bool:
    return title not in known and SequenceMatcher(None, title.lower(), name).ratio() > _ALIKE


def _cell(cell: str, cells_are: tuple[str, ...] | str, dress: Dress) -> Any:
    if cells_are == "text":
        return cell
    if isinstance(cells_are, str):
        value = float(cell) if cells_are == "place" and cell in _CODES else number(cell, dress)
        return nan if value is None else value
    if cell in cells_are:
        return float(cells_are.index(cell))
    for at, word in enumerate(cells_are):
        if cell.lower() == word.lower():
            return float(at)
    value = number(cell, dress)  # a code instead of the word
    if value is None:
        return nan
    if value not in range(len(cells_are)):
        raise Unclear(f"{cell!r} is no code")
    return value


def spoilt(kind: Kind, chance: random.Random) -> tuple[str, bytes, Dress]:
    """Return what was done to a sound file, the file, and how it is written."""
    sheet, done = kind.sheet(chance), []
    if chance.random() < 0.7:
        done.append(chance.choice(list(CONTENTS)))
        CONTENTS[done[-1]](sheet, chance)
    if not done or chance.random() < 0.5:
        done.append(chance.choice(list(DRESSES)))
        DRESSES[done[-1]](sheet, chance)
    data = sheet.written()
    if chance.random() < 0.2:
        done.append(chance.choice(list(DAMAGES)))
        data = DAMAGES[done[-1]](data, chance)
    return " ".join(done), data, sheet.dress


def verdict(kind: Kind, path: Path, dress: Dress) -> tuple[Word, str]:
    """Return right, told, refused or violation, and what speaks for it."""
    try:
        meant: Values | None = judged(kind, path.read_bytes(), dress)
        why = ""
    except Unclear as unclear:
        meant, why = None, str(unclear)
    answer = asked(kind.read, path)
    if not isinstance(answer, Answer):
        return answer
    if meant is None:
        told: Word = "told" if answer.told else "violation"
        return told, answer.told or f"taken without a word, though unclear: {why}"
    wrong = [name for name in answer.values if not same(answer.values[name], meant.get(name))]
    wrong += [name for name in meant if name not in answer.values]
    if not wrong:
        return "right", ""
    if any(name in answer.told for name in wrong) or _ENCODED.search(answer.told):
        return "told", answer.told
    got, wanted = answer.values.get(wrong[0]), meant.get(wrong[0])
    return "violation", f"{wrong[0]} is {_first_differing(got, wanted)}"


def _first_differing(got: Any, meant: Any) -> str:
    if not (isinstance(got, list) and isinstance(meant, list) and len(got) == len(meant)):
        return f"{len(got or ())} values, not {len(meant or ())}"
    return next(f"{a!r}, not {b!r}" for a, b in zip(got, meant, strict=True) if not same(a, b))


def trials(kind: Kind, count: int, seed: int) -> Iterator[Verdict]:
    """Spoil a table of this kind so often; yield what came of it."""
    chance = random.Random(f"{kind.name} {seed}")
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        path = Path(folder, kind.name)
        for _ in range(count):
            done, data, dress = spoilt(kind, chance)
            path.write_bytes(data)
            word, why = verdict(kind, path, dress)
            closed = done == "more_columns" and "unknown column" in why
            if word == "refused" and done in PLAIN and not closed:
                word = "violation"
            yield Verdict(done, word, why)


def tables(count: int, seed: int, progress: Progress) -> Counts:
    """Spoil so many tables of every kind; count the verdicts."""
    return counted(KINDS, trials, count, seed, progress)


EXPERIMENTS: Final = (
    Experiment(
        "judged_tables",
        "A table that was spoilt is read as an independent parser reads it, told, or refused.",
        tables,
        count=18_000,
        short=200 * len(KINDS),
    ),
)
