"""From what an export holds for an answer to the box that was ticked, 1 (left) to 5 (right).

An answer is the number of the box (2, 2.0), one of the codes that LimeSurvey gives by itself (A1 to
A5, AO01 to AO05), a label or, in the acceptance scale, one of the two words beside the boxes.
Labels are known in English and German. Some mean different boxes in different wordings ("agree" is
the fifth box beside "disagree" as the first, the fourth beside "strongly agree"), so all that occur
are looked at together, and what stays ambiguous is none.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import product
from math import nan
from typing import Final

from .scales import BOXES, LAAN

# What stands for no answer; that of SoSci Survey (-9) and of LimeSurvey (N/A) among them.
MISSING: Final = frozenset({"", "na", "n/a", "nan", "-99", "-9"})
UNKNOWN: Final = nan

_CODE: Final = re.compile("(?:a|ao)0*([1-5])")
_NUMBER: Final = re.compile(r"[+-]?\d+(?:[.,]\d*)?", re.ASCII)

# The favourable word is not always the left one; these are as printed, left and right.
_ENDS: Final[Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    "laan_1": (("useful", "nützlich"), ("useless", "nutzlos")),
    "laan_2": (("pleasant", "angenehm"), ("unpleasant", "unangenehm")),
    "laan_3": (("bad", "schlecht"), ("good", "gut")),
    "laan_4": (("nice", "nett"), ("annoying", "nervig")),
    "laan_5": (("effective", "effektiv", "effizient"), ("superfluous", "überflüssig", "unnötig")),
    "laan_6": (("irritating", "ärgerlich", "irritierend"), ("likeable", "erfreulich")),
    "laan_7": (("assisting", "hilfreich", "unterstützend"), ("worthless", "wertlos")),
    "laan_8": (("undesirable", "nicht wünschenswert"), ("desirable", "wünschenswert")),
    "laan_9": (
        ("raising alertness", "aktivierend", "aufmerksamkeitsfördernd"),
        ("sleep-inducing", "einschläfernd"),
    ),
}

_NEUTRAL: Final = (
    "neither agree nor disagree", "neither disagree nor agree", "neither", "neutral", "undecided",
    "teils teils", "teils/teils", "teils, teils", "teils-teils", "weder noch", "unentschieden",
    "stimme teilweise zu", "trifft teilweise zu", "stimme weder zu noch nicht zu",
)  # fmt: skip
# The two lowest and the two highest boxes, in all the ways that occur together; one word each.
_PAIRS: Final = (
    (
        (("strongly disagree", "disagree"), ("strongly disagree", "somewhat disagree"),
         ("completely disagree", "disagree"), ("completely disagree", "somewhat disagree"),
         ("totally disagree", "disagree"), ("disagree", "somewhat disagree"),
         ("disagree", "rather disagree"), ("strongly disagree", "rather disagree")),
        (("agree", "strongly agree"), ("somewhat agree", "strongly agree"),
         ("agree", "completely agree"), ("somewhat agree", "completely agree"),
         ("agree", "totally agree"), ("somewhat agree", "agree"),
         ("rather agree", "agree"), ("rather agree", "strongly agree")),
    ),
    *(
        (
            (*((f"{verb} {not_at_all} zu", f"{verb} {no} zu")
               for not_at_all in ("überhaupt nicht", "gar nicht", "ganz und gar nicht")
               for no in ("nicht", "eher nicht")), (f"{verb} nicht zu", f"{verb} eher nicht zu")),
            (*((f"{verb} {yes}zu", f"{verb} {fully} zu")
               for fully in ("voll", "voll und ganz", "völlig", "vollkommen")
               for yes in ("", "eher ")), (f"{verb} eher zu", f"{verb} zu")),
        )
        for verb in ("stimme", "trifft")
    ),
)  # fmt: skip


def _wordings() -> Iterator[dict[str, float]]:
    """Yield, per wording of agreement, label -> box."""
    neutral = dict.fromkeys(_NEUTRAL, 3.0)
    for low, high in _PAIRS:
        for (first, second), (fourth, fifth) in product(low, high):
            yield neutral | {first: 1.0, second: 2.0, fourth: 4.0, fifth: 5.0}


def plain(text: str) -> str:
    """Return ``text`` as it is compared: small letters, no blanks or dots around, 2.0 as 2."""
    text = " ".join(text.split()).casefold().strip(" .")
    if _NUMBER.fullmatch(text):
        return f"{float(text.replace(',', '.')):g}"
    return text


def agreement(labels: Collection[str]) -> dict[str, float]:
    """Return the boxes of labels of agreement that occur together, in plain form.

    Returns:
        label -> box, of those that every wording with all of ``labels`` puts into the same box;
        without any such wording, nothing.
    """
    boxes = [w for w in _wordings() if w.keys() >= set(labels)]
    found = {label: {wording[label] for wording in boxes} for label in labels}
    return {label: one.pop() for label, one in found.items() if len(one) == 1}


def boxes_of(
    texts: Mapping[str, Iterable[str]],
    given: Mapping[str, Mapping[str, int]],
    missing: Collection[str],
) -> dict[tuple[str, str], float]:
    """Return the boxes of all answers that are known.

    Args:
        texts: item -> its answers, in plain form.
        given: item, or "" for all of them -> answer in plain form -> box, as the map says.
        missing: answers that are none, in plain form.

    Returns:
        (item, answer) -> box 1 to 5; what is missing or not known is not there.
    """
    asked = {item: set(answers).difference(missing) for item, answers in texts.items()}
    labels = {a for item, answers in asked.items() if item not in LAAN for a in answers}
    in_words = {a for a in labels if not _NUMBER.fullmatch(a) and not _CODE.fullmatch(a)}
    known = agreement(in_words.difference(given.get("", {})))
    return {
        (item, answer): box
        for item, answers in asked.items()
        for answer in answers
        if (box := _box(item, answer, {**given.get("", {}), **given.get(item, {})}, known))
    }


def _box(
    item: str, answer: str, given: Mapping[str, int], agreed: Mapping[str, float]
) -> float | None:
    """Return one box; of numbers only those that the map gives, if it gives any."""
    if answer in given:
        return float(given[answer])
    if _NUMBER.fullmatch(answer):
        number = float(answer)
        renumbered = any(map(_NUMBER.fullmatch, given))
        in_range = number.is_integer() and 1 <= number <= BOXES
        return number if in_range and not renumbered else None
    if code := _CODE.fullmatch(answer):
        return float(code[1])
    if item in LAAN:
        left, right = _ENDS[item]
        return 1.0 if answer in left else float(BOXES) if answer in right else None
    return agreed.get(answer)
