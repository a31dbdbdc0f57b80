"""What a questionnaire says: scores per scale, with what is missing told."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...findings import Finding
from ...kernel.arrays import FloatArray
from .scales import SCALES
from .sheet import Filled, LeftOut, read_sheet
from .survey_map import SurveyMap

# Participant and system.
Answered = tuple[str, str]

_ROUNDING = 1e-9  # three of four are 0.75


@dataclass(frozen=True, eq=False)
class Questionnaire:
    """Scored items and scores.

    Attributes:
        items: item -> (participant, system) -> value, the favourable answer being the higher one;
            the mean where a participant answered after several drives with the same system. Items
            that were not answered are not there.
        scores: scale (a key of ``SCALES``) -> (participant, system) -> mean of its answered items;
            the mean where there are several questionnaires. Not there if too few were answered.
        complete: scale -> scores (items x questionnaires) of the questionnaires in which all of
            its items are answered.
        notes: how the file was read, and what is missing in it.
    """

    items: Mapping[str, Mapping[Answered, float]]
    scores: Mapping[str, Mapping[Answered, float]]
    complete: Mapping[str, FloatArray]
    notes: tuple[Finding, ...] = ()

    def reliability(self, scale: str) -> float:
        """Return Cronbach's alpha of a scale over the complete answers; NaN when nothing varies."""
        table = self.complete[scale]
        total = float(np.var(table.sum(axis=0), ddof=1)) if table.shape[1] > 1 else 0.0
        if total == 0.0:
            return float("nan")
        count = len(table)
        return count / (count - 1) * (1.0 - float(np.sum(np.var(table, axis=1, ddof=1))) / total)


def read_questionnaire(
    path: Path,
    left_out: LeftOut = lambda _who, _drive: False,
    names: SurveyMap | None = None,
    known_as: Callable[[str], str] = str,
) -> Questionnaire:
    """Read the answers in the file ``path``, an export of a survey tool or a table of our own.

    A scale counts if all of its items are columns. A missing answer costs the scale of that
    questionnaire if less than ``names.answered_min`` of its items are answered, else the scale is
    the mean of those that are.

    Args:
        path: the file.
        left_out: says of a participant and a drive, or of the participant if that is empty,
            whether the answers are passed over.
        names: what columns and answers mean; None: they are ours, ``laan_1`` and 1 to 5.
        known_as: returns what a participant is called in the study.

    Raises:
        ModelError: naming file, line, column and value of what is missing or no answer.
    """
    names = names or SurveyMap()
    sheet = read_sheet(path, left_out, names, known_as)
    items, scores = _Means(), _Means()
    notes = list(sheet.notes)
    for filled in sheet.filled:
        answered = filled.participant, filled.group[0]
        for scale in sheet.scales:
            asked = [item for item in SCALES[scale] if item in filled.scored]
            given = {item: filled.scored[item] for item in asked}
            for item, value in given.items():
                items.add(item, answered, [value])
            there = [value for value in given.values() if not np.isnan(value)]
            enough = len(there) + _ROUNDING >= names.answered_min * len(SCALES[scale])
            scores.add(scale, answered, [float(np.mean(there))] if there and enough else [])
            if asked and len(there) < len(asked):
                notes.append(_missing(path, filled, scale, bool(there and enough)))
    return Questionnaire(
        items.taken([item for scale in sheet.scales for item in SCALES[scale]]),
        scores.taken(sheet.scales),
        {scale: _complete(sheet.filled, SCALES[scale]) for scale in sheet.scales},
        tuple(notes),
    )


class _Means:
    """Values by name and by who answered, and their means."""

    def __init__(self) -> None:
        self._values: dict[str, dict[Answered, list[float]]] = {}

    def add(self, name: str, answered: Answered, values: Iterable[float]) -> None:
        """Take up ``values`` but NaN."""
        kept = [value for value in values if not np.isnan(value)]
        if kept:
            self._values.setdefault(name, {}).setdefault(answered, []).extend(kept)

    def taken(self, names: Iterable[str]) -> dict[str, dict[Answered, float]]:
        """Return the means by name, in the order of ``names``."""
        return {
            name: {key: float(np.mean(v)) for key, v in self._values.get(name, {}).items()}
            for name in names
        }


def _missing(path: Path, filled: Filled, scale: str, scored: bool) -> Finding:
    items = SCALES[scale]
    missing = [item for item in items if np.isnan(filled.scored[item])]
    told = f"{len(missing)} of {len(items)} items of {scale} not answered ({', '.join(missing)})"
    if scored:
        return Finding(
            "note", str(path), filled.line, _place(filled), told,
            f"{scale} is the mean of the other {len(items) - len(missing)}",
        )  # fmt: skip
    return Finding(
        "warning", str(path), filled.line, _place(filled), told,
        f"there is no {scale} of this questionnaire; the drives count all the same",
        "fewer suffice with a smaller answered_min in a mapping file, [questionnaire]",
    )  # fmt: skip


def _place(filled: Filled) -> str:
    kind = "system" if len(filled.group) == 1 else "drive"
    return f"participant {filled.participant}, {kind} {filled.group}"


def _complete(sheet: Sequence[Filled], items: Sequence[str]) -> FloatArray:
    rows = [
        [filled.scored[item] for item in items] for filled in sheet if items[0] in filled.scored
    ]
    table = np.array(rows, dtype=np.float64).reshape(-1, len(items))
    whole: FloatArray = table[np.isfinite(table).all(axis=1)].T
    return whole
