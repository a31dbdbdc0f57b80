"""The part of a mapping file that says what the columns and answers of a questionnaire mean."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, Final

from ...errors import ModelError
from .labels import MISSING, plain
from .scales import BOXES, asked_by

ANSWERED_MIN: Final = 0.75
_EXAMPLE: Final = '[questionnaire.items] Q7_1 = "laan_1"'


@dataclass(frozen=True)
class SurveyMap:
    """What the names in an export mean.

    Attributes:
        file: name of the export in the folder of the study.
        participant: column with the name of the participant.
        system: column that says after which system or drive was asked; empty: ``system`` or
            ``phase`` if one of these is there, else the columns say it (``laan_1_A``).
        systems: text in that column, in plain form -> A or B, or a drive such as A1.
        items: column -> item, as ``scales.asked_by`` knows it.
        answers: item, or "" for all -> answer in plain form -> box.
        missing: what stands for no answer, in plain form.
        only: column -> texts in plain form; other rows are passed over.
        header_lines: lines of the header; 0: found out.
        answered_min: share of a scale's items that must be answered for it to have a score.
    """

    file: str = "questionnaire.csv"
    participant: str = "participant"
    system: str = ""
    systems: Mapping[str, str] = field(default_factory=dict)
    items: Mapping[str, str] = field(default_factory=dict)
    answers: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    missing: frozenset[str] = MISSING
    only: Mapping[str, frozenset[str]] = field(default_factory=dict)
    header_lines: int = 0
    answered_min: float = ANSWERED_MIN


def survey_map(table: Mapping[str, Any], path: str) -> SurveyMap:
    """Return what ``[questionnaire]`` of the mapping file ``path`` says.

    Args:
        table: that part, as it was parsed.
        path: the file, for errors.

    Raises:
        ModelError: naming key and value of all that is wrong with it.
    """
    if wrong := list(_wrong(table)):
        raise ModelError("\n  ".join(f"{path}, questionnaire{text}" for text in wrong))
    answers: dict[str, dict[str, int]] = {"": {}}
    for name, value in table.get("answers", {}).items():
        if isinstance(value, Mapping):
            answers[name] = {plain(answer): box for answer, box in value.items()}
        else:
            answers[""][plain(name)] = value
    told = {"missing": MISSING.union(_plain(table.get("missing", ()))), "answers": answers}
    if "systems" in table:
        told["systems"] = {plain(text): group.upper() for text, group in table["systems"].items()}
    if "only" in table:
        told["only"] = {name: _plain(texts) for name, texts in table["only"].items()}
    return SurveyMap(**{**table, **told})


def _wrong(table: Mapping[str, Any]) -> Iterator[str]:
    """Yield all that is wrong, each with the key that it is about."""
    known = SurveyMap.__dataclass_fields__
    for key, value in table.items():
        if key not in known:
            near = ", ".join(get_close_matches(key, known, 1)) or f"one of {', '.join(known)}"
            yield f".{key}: not known; is {near} meant?"
        elif key in _TEXTS and not (isinstance(value, str) and value):
            yield f".{key}: {value!r} is not a text"
        elif key in _TABLES and not isinstance(value, Mapping):
            yield f".{key}: {value!r} is not a table, such as {_EXAMPLE}"
        elif key in _TABLES:
            yield from (f".{key}.{text}" for text in _TABLES[key](value))
        elif key == "missing" and not _are_texts(value):
            yield f'.missing: {value!r} is not a list of texts, such as ["-9", "N/A"]'
        elif key == "header_lines" and not (_is_whole(value) and value >= 1):
            yield f".header_lines: {value!r} is not a number of lines from 1 on"
        elif key == "answered_min" and not (_is_number(value) and 0.0 < value <= 1.0):
            yield f".answered_min: {value!r} is not a share above 0 and up to 1, such as 0.75"


def _wrong_systems(systems: Mapping[str, Any]) -> Iterator[str]:
    for text, group in systems.items():
        if not (isinstance(group, str) and group[:1].upper() in ("A", "B") and _numbered(group)):
            yield f"{text!r}: {group!r} is neither a system, A or B, nor one of its drives, A1"


def _wrong_items(items: Mapping[str, Any]) -> Iterator[str]:
    for column, item in items.items():
        if not (isinstance(item, str) and asked_by(item)):
            yield (
                f"{column!r}: {item!r} is no item; they are laan_1 to laan_9 and profile_1 to "
                "profile_6, with _reversed and with _A or _B behind it where that is so"
            )


def _wrong_answers(answers: Mapping[str, Any]) -> Iterator[str]:
    for name, value in answers.items():
        boxes = value.items() if isinstance(value, Mapping) else [("", value)]
        if isinstance(value, Mapping) and not asked_by(name):
            yield f"{name!r}: no item, so it cannot have answers of its own"
        for answer, box in boxes:
            if not (_is_whole(box) and 1 <= box <= BOXES):
                yield f"{answer or name!r}: {box!r} is not the number of a box, 1 to {BOXES}"


def _wrong_only(only: Mapping[str, Any]) -> Iterator[str]:
    for column, texts in only.items():
        if not _are_texts(texts):
            yield f'{column!r}: {texts!r} is not a list of texts, such as ["Complete"]'


def _are_texts(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) or _is_number(one) for one in value)


def _plain(texts: Iterable[object]) -> frozenset[str]:
    return frozenset(plain(str(text)) for text in texts)


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _numbered(group: str) -> bool:
    return len(group) == 1 or (group[1:].isascii() and group[1:].isdigit())


_TEXTS: Final = ("file", "participant", "system")
_TABLES: Final = {
    "systems": _wrong_systems,
    "items": _wrong_items,
    "answers": _wrong_answers,
    "only": _wrong_only,
}
