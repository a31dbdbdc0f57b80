"""Names of participants that look like those of people."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from ...findings import Finding

# Words that stand in codes of participants.
_NEUTRAL: Final = frozenset(
    (
        "anon", "anonymous", "case", "code", "control", "demo", "driver", "dummy", "expert",
        "fahrer", "female", "group", "gruppe", "guest", "kontrolle", "male", "none", "novice",
        "old", "part", "participant", "participants", "person", "pers", "pilot", "prob",
        "proband", "probandin", "sim", "simulator", "sub", "subj", "subject", "tester", "test",
        "teilnehmer", "tln", "unknown", "user", "versuch", "vpn", "young", "alt", "jung",
    )
)  # fmt: skip
_WORD: Final = re.compile(r"[^\W\d_]+")
_VOWEL: Final = re.compile(r"[aeiouyäöüáéíóúàèìòùâêîôûåæøœ]", re.IGNORECASE)
_NAMED_MAX: Final = 5


def looks_like_a_person(name: str) -> bool:
    """Tell names and mail addresses from codes.

    Codes hold digits, or capitals only, or words such as subject; a name is a word that can be
    spoken. 'P01', 'VP_12', 'S3', 'x7Gk2' and 'KXQZ' are codes; 'anna.mueller' and 'Mueller, Anna'
    are people.
    """
    if "@" in name:
        return True
    words = [word for word in _WORD.findall(name) if word.casefold() not in _NEUTRAL]
    spoken = [word for word in words if _is_spoken(word)]
    with_digits = any(sign.isdigit() for sign in name)
    written_out = [word for word in spoken if not (word.isascii() and word.isupper())]
    return len(spoken) > 1 if with_digits or not written_out else True


def people(names: Iterable[str], file: str) -> Iterator[Finding]:
    """Yield one warning if some of ``names``, in ``file``, look like people."""
    found = [name for name in dict.fromkeys(names) if looks_like_a_person(name)]
    if found:
        more = f" and {len(found) - _NAMED_MAX} more" if len(found) > _NAMED_MAX else ""
        are = "looks like the name of a person" if len(found) == 1 else "look like names of people"
        yield Finding(
            "warning", file, 0, "participant",
            f"{', '.join(map(repr, found[:_NAMED_MAX]))}{more} {are}",
            "tables, figures and the report name them, too",
            "use codes such as P01, and keep the list of who is who apart",
        )  # fmt: skip


def _is_spoken(word: str) -> bool:
    if not word.isascii() and not _VOWEL.search(word):
        return len(word) > 1  # in scripts without capitals two signs are a name
    return len(word) > 2 and bool(_VOWEL.search(word))
