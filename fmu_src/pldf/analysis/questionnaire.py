"""Questionnaire answers: reading, checking and scoring.

The acceptance scale is that of Van der Laan, Heino and De Waard, "A simple procedure for the
assessment of acceptance of advanced transport telematics", Transportation Research Part C 5 (1997):
nine pairs of words, five boxes between each, scored from -2 to +2 so that the favourable word is
+2. It stands on the left in items 1, 2, 4, 5, 7 and 9, on the right in items 3, 6 and 8. Usefulness
is the mean of the odd items, satisfying the mean of the even ones.

The six items on the speed profile are the study's own; 5 is full agreement. Their score is the mean
after items worded negatively (``_reversed`` behind the column's name) have been turned round.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..instance import ModelError

LAAN: Final = tuple(f"laan_{number}" for number in range(1, 10))
LAAN_WORDS: Final = (
    "useful - useless",
    "pleasant - unpleasant",
    "bad - good",
    "nice - annoying",
    "effective - superfluous",
    "irritating - likeable",
    "assisting - worthless",
    "undesirable - desirable",
    "raising alertness - sleep-inducing",
)
PROFILE: Final = tuple(f"profile_{number}" for number in range(1, 7))
REVERSED: Final = "_reversed"

_USEFULNESS: Final = LAAN[0::2]
_SATISFYING: Final = LAAN[1::2]
_FAVOURABLE_RIGHT: Final = ("laan_3", "laan_6", "laan_8")
SCALES: Final = {"usefulness": _USEFULNESS, "satisfying": _SATISFYING, "speed_profile": PROFILE}
SCALE_RANGES: Final = {"usefulness": (-2, 2), "satisfying": (-2, 2), "speed_profile": (1, 5)}
_BOXES: Final = 5

Key = tuple[str, str]


@dataclass(frozen=True)
class Questionnaire:
    """Scored items and scores.

    Attributes:
        items: item -> (participant, system) -> value, the favourable answer being the higher one;
            the mean where a participant answered after several drives with the same system.
        scores: scale (a key of ``SCALES``) -> (participant, system) -> mean of its items.
    """

    items: Mapping[str, Mapping[Key, float]]
    scores: Mapping[str, Mapping[Key, float]]

    def reliability(self, scale: str) -> float:
        """Return Cronbach's alpha of a scale over all answers; NaN when nothing varies."""
        table = np.array([list(self.items[item].values()) for item in SCALES[scale]])
        total = float(np.var(table.sum(axis=0), ddof=1)) if table.shape[1] > 1 else 0.0
        if total == 0.0:
            return float("nan")
        count = len(table)
        return count / (count - 1) * (1.0 - float(np.sum(np.var(table, axis=1, ddof=1))) / total)


def read_questionnaire(path: Path, without: Collection[str] = ()) -> Questionnaire:
    """Read ``participant,system`` (or ``phase``) and items from the CSV file ``path``.

    A scale counts if all of its items are columns. Answers are numbered boxes, 1 (left) to 5.

    Args:
        path: the file.
        without: participants to pass over.

    Raises:
        ModelError: naming file, line and column of what is missing or no answer.
    """
    (header_line, header), *lines = _rows(path)
    names = [name.removesuffix(REVERSED) for name in header]
    group = next((name for name in ("system", "phase") if name in names), None)
    if group is None or "participant" not in names:
        raise ModelError(
            f"{path}, line {header_line}: needs the columns participant and system (or phase)"
        )
    turned = frozenset(name.removesuffix(REVERSED) for name in header if name not in names)
    scales = _scales_of(path, header_line, names)
    found: dict[str, dict[Key, list[float]]] = {i: {} for scale in scales for i in SCALES[scale]}
    lines_of: dict[Key, int] = {}
    for line, cells in lines:
        if len(cells) != len(header):
            raise ModelError(f"{path}, line {line}: {len(cells)} values for {len(header)} columns")
        row = dict(zip(names, cells, strict=True))
        if row["participant"] in without:
            continue
        answered = row["participant"], row[group]
        where = f"{path}, line {line}, participant {answered[0]}, {group} {answered[1]}"
        if lines_of.setdefault(answered, line) != line:
            raise ModelError(f"{where}: answered in line {lines_of[answered]} already")
        key = _key(where, *answered)
        for item, answers in found.items():
            answers.setdefault(key, []).append(_scored(where, item, row[item], item in turned))
    return _with_scores(found, scales)


def _with_scores(
    found: Mapping[str, Mapping[Key, Sequence[float]]], scales: Sequence[str]
) -> Questionnaire:
    items = {
        item: {key: float(np.mean(values)) for key, values in answers.items()}
        for item, answers in found.items()
    }
    scores = {
        scale: {
            key: float(np.mean([items[item][key] for item in SCALES[scale]]))
            for key in items[SCALES[scale][0]]
        }
        for scale in scales
    }
    return Questionnaire(items, scores)


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield (line number, cells) of each line that is neither empty nor a comment."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ModelError(f"{path}: cannot be read as a CSV text file ({error})") from error
    count = 0
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip() and not line.startswith("#"):
            count += 1
            yield number, [cell.strip() for cell in next(csv.reader(io.StringIO(line)))]
    if not count:
        raise ModelError(f"{path}: empty; the first line names the columns")


def _scales_of(path: Path, line: int, names: Sequence[str]) -> list[str]:
    """Return the scales whose items are there; a scale that is there in part is an error."""
    present = []
    for scale, items in SCALES.items():
        missing = [item for item in items if item not in names]
        if not missing:
            present.append(scale)
        elif len(missing) < len(items):
            raise ModelError(
                f"{path}, line {line}: missing column {', '.join(missing)} of the scale "
                f"{scale} ({', '.join(items)})"
            )
    if not present:
        raise ModelError(
            f"{path}, line {line}: no items; columns are laan_1 .. laan_9, profile_1 .. profile_6"
        )
    return present


def _key(where: str, participant: str, group: str) -> Key:
    if not participant:
        raise ModelError(f"{where}: no participant")
    if not re.fullmatch(r"[AB]\d*", group):
        raise ModelError(f"{where}: neither a system, A or B, nor one of its drives, such as A1")
    return participant, group[0]


def _scored(where: str, item: str, text: str, turned: bool) -> float:
    if not text:
        raise ModelError(f"{where}: no answer to {item}; leave the participant out with --without")
    if text not in ("1", "2", "3", "4", "5"):
        raise ModelError(
            f"{where}, {item}: {text!r} is no answer; give the number of the box ticked, "
            "1 (left) to 5 (right)"
        )
    box = int(text)
    if item in PROFILE:
        return float(_BOXES + 1 - box if turned else box)
    return float(box - 3 if item in _FAVOURABLE_RIGHT else 3 - box)
