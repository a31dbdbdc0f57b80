"""The tables and keys of a questionnaires file, and what of a questionnaire holds for its items."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from msgspec import Meta, Struct, field

Kind = Literal["choice", "scale", "text", "number"]
# Where between the drives something is asked, besides after a phase (A1 .. B3).
MOMENTS: Final = ("start", "practice", "A", "B", "end")
BOXES_MAX: Final = 101

Boxes = Annotated[
    int, Meta(ge=2, le=BOXES_MAX, description=f"a whole number from 2 to {BOXES_MAX}")
]
Words = Annotated[
    dict[Literal["en", "de"], str] | str,
    Meta(description='a text in quotes, or { en = "...", de = "..." }'),
]
Moments = Annotated[
    tuple[str, ...], Meta(description='a list of phases (A1 .. B3) and "start", "A", "B", "end"')
]
Answers = Annotated[tuple[str | int, ...], Meta(min_length=1, description="a list of answers")]


class OptionTable(Struct, forbid_unknown_fields=True, frozen=True):
    """One option of a choice."""

    key: Annotated[str, Meta(pattern=r"\S", description="a text in quotes: what is stored")]
    en: str = ""
    de: str = ""


class ConditionTable(Struct, forbid_unknown_fields=True, frozen=True):
    """When an item is asked: an earlier one was answered with one of these."""

    id: str
    is_: Answers = field(name="is")


class ItemTable(Struct, forbid_unknown_fields=True, frozen=True):
    """An item; what is left out is as the questionnaire says."""

    kind: Kind = "scale"
    text: Words = ""
    options: tuple[OptionTable, ...] = ()
    boxes: Boxes = 5
    left: Words = ""
    right: Words = ""
    low: float = 0.0
    high: float = 100.0
    required: bool = True
    only_if: ConditionTable | None = None


class QuestionnaireTable(Struct, forbid_unknown_fields=True, frozen=True):
    """A questionnaire without its items, and without what holds for all of them."""

    title: Words
    after: Moments
    intro: Words = ""
