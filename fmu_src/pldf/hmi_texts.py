"""The sentence of the instrument cluster as text, and the table of all of them as a file.

The kernel chooses the sentence and its numbers; the native FMUs put them together in the same way
(``build/runtime/cluster.c``).
"""

from __future__ import annotations

import json
import re
from typing import Final, Protocol

from .kernel.codes import LANGUAGE_DE
from .kernel.sentences import EVENT_SENTENCES, EVENTS, NUMBERS, REASONS, Sentence

FILE: Final = "hmi_texts.json"
# What each number in a sentence means, for people.
_MEANINGS: Final = {
    "speed": "hmi.sentence_speed: speed that the car aims at",
    "base": "hmi.sentence_base: speed that it would aim at without lessons",
    "limit": "hmi.sentence_limit: legal limit in force or ahead",
    "drive": "hmi.sentence_drive: number of the drive that taught it last",
}


class Spoken(Protocol):
    """What the sentence depends on, as fields of the record."""

    hmi_language: int
    hmi_sentence: int
    hmi_sentence_speed: int
    hmi_sentence_base: int
    hmi_sentence_limit: int
    hmi_sentence_drive: int


def sentence_of(number: int) -> Sentence | None:
    """Return the row of the table that ``hmi.sentence`` names; None if there is none."""
    if 0 <= number < len(REASONS):
        return REASONS[number]
    if 0 <= number - EVENT_SENTENCES < len(EVENTS):
        return EVENTS[number - EVENT_SENTENCES]
    return None


def text_of(spoken: Spoken) -> str:
    """Return ``hmi.text``: the sentence in the language chosen, with its numbers."""
    row = sentence_of(spoken.hmi_sentence)
    if row is None:
        return ""
    text = row.german if spoken.hmi_language == LANGUAGE_DE else row.english
    known = r"\1" if spoken.hmi_sentence_drive > 0 else ""
    text = re.sub(r"\[(.*?)\]", known, text)
    for name in NUMBERS:
        text = text.replace(f"{{{name}}}", str(getattr(spoken, f"hmi_sentence_{name}")))
    return text


def as_json() -> bytes:
    """Return the table as the FMUs carry it, for clusters that write the sentences themselves."""
    content = {
        "about": "Sentences of hmi.text: hmi.sentence names one, the numbers replace what stands "
        "in braces; speeds and limits are whole numbers in hmi.unit. What stands in square "
        "brackets is left out where the drive is 0",
        "numbers": _MEANINGS,
        "reasons": [_row(code, code, row) for code, row in enumerate(REASONS)],
        "events": [_row(code, EVENT_SENTENCES + code, row) for code, row in enumerate(EVENTS)],
    }
    return json.dumps(content, ensure_ascii=False, indent=2).encode() + b"\n"


def _row(code: int, sentence: int, row: Sentence) -> dict[str, object]:
    return {
        "code": code,
        "name": row.name,
        "sentence": sentence,
        "priority": row.priority,
        "icon": row.icon,
        "EN": row.english,
        "DE": row.german,
        "meaning": row.meaning,
    }
