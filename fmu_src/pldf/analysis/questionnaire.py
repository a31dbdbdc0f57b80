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

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..files.tables import Column, Fault, Format, Table, read_table
from ..kernel.arrays import FloatArray

LAAN: Final = tuple(f"laan_{number}" for number in range(1, 10))
PROFILE: Final = tuple(f"profile_{number}" for number in range(1, 7))
REVERSED: Final = "_reversed"

_USEFULNESS: Final = LAAN[0::2]
_SATISFYING: Final = LAAN[1::2]
_FAVOURABLE_RIGHT: Final = ("laan_3", "laan_6", "laan_8")
SCALES: Final = {"usefulness": _USEFULNESS, "satisfying": _SATISFYING, "speed_profile": PROFILE}
_BOXES: Final = 5

GROUPS: Final = ("system", "phase")  # either says after which drives the answers were given
_TICKED: Final = (
    "the number of a box, 1 (left) to 5 (right); correct it or leave the participant out "
    "with --without"
)
QUESTIONNAIRE: Final = Format(
    "questionnaire",
    "answer",
    (
        Column("participant", "text", wanted="the name of a participant"),
        *(
            Column(
                name,
                "text",
                pattern="[AB][0-9]*",
                wanted="a system, A or B, or one of its drives, such as A1",
                needed=False,
            )
            for name in GROUPS
        ),
        *(
            Column(name, "whole", low=1.0, high=_BOXES, wanted=_TICKED, needed=False)
            for name in (*LAAN, *PROFILE, *(item + REVERSED for item in PROFILE))
        ),
    ),
    rows_min=0,
    key=("participant", *GROUPS),
)

# Participant and system.
Answered = tuple[str, str]


@dataclass(frozen=True)
class Questionnaire:
    """Scored items and scores.

    Attributes:
        items: item -> (participant, system) -> value, the favourable answer being the higher one;
            the mean where a participant answered after several drives with the same system.
        scores: scale (a key of ``SCALES``) -> (participant, system) -> mean of its items.
    """

    items: Mapping[str, Mapping[Answered, float]]
    scores: Mapping[str, Mapping[Answered, float]]

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
        ModelError: naming file, line, column and value of what is missing or no answer.
    """
    table = read_table(path, QUESTIONNAIRE, {"participant": without})
    scales = _scales_of(table)
    keys = _keys(table)
    answers_of: dict[str, dict[Answered, list[float]]] = {}
    for item in (item for scale in scales for item in SCALES[scale]):
        answers = answers_of[item] = {}
        for key, value in zip(keys, _scored(table, item).tolist(), strict=True):
            answers.setdefault(key, []).append(value)
    return _with_scores(answers_of, scales)


def _with_scores(
    answers_of: Mapping[str, Mapping[Answered, Sequence[float]]], scales: Sequence[str]
) -> Questionnaire:
    items = {
        item: {key: float(np.mean(values)) for key, values in answers.items()}
        for item, answers in answers_of.items()
    }
    scores = {
        scale: {
            key: float(np.mean([items[item][key] for item in SCALES[scale]]))
            for key in items[SCALES[scale][0]]
        }
        for scale in scales
    }
    return Questionnaire(items, scores)


def _scales_of(table: Table) -> list[str]:
    """Return the scales whose items are there; a scale that is there in part is an error."""
    faults = []
    if not any(name in table for name in GROUPS):
        faults.append(f"missing column {' or '.join(GROUPS)}")
    present = []
    for scale, items in SCALES.items():
        missing = [item for item in items if not _columns_of(table, item)]
        if not missing:
            present.append(scale)
        elif len(missing) < len(items):
            absent = ", ".join(missing)
            faults.append(f"missing column {absent} of the scale {scale} ({', '.join(items)})")
    if not present and not faults:
        faults.append("no items; columns are laan_1 .. laan_9, profile_1 .. profile_6")
    twice = [item for item in PROFILE if len(_columns_of(table, item)) > 1]
    faults += [f"columns {item} and {item}{REVERSED}; keep one of them" for item in twice]
    table.refuse(Fault(table.header_line, "", text) for text in faults)
    return present


def _columns_of(table: Table, item: str) -> list[str]:
    return [name for name in (item, item + REVERSED) if name in table]


def _keys(table: Table) -> list[Answered]:
    """Return participant and system of each row; nobody answers twice after the same drives."""
    group = next(name for name in GROUPS if name in table)
    answered = list(zip(table.texts["participant"], table.texts[group], strict=True))
    table.refuse(
        table.fault(row, "", f"answered in line {line} already")
        for row, line in table.repeated(answered)
    )
    return [(participant, drives[0]) for participant, drives in answered]


def _scored(table: Table, item: str) -> FloatArray:
    """Return the answers to an item, the favourable being the higher one."""
    (name,) = _columns_of(table, item)
    boxes = table.numbers[name]
    if item in PROFILE:
        return _BOXES + 1.0 - boxes if name.endswith(REVERSED) else boxes
    return boxes - 3.0 if item in _FAVOURABLE_RIGHT else 3.0 - boxes
