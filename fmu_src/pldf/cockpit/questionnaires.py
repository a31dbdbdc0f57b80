"""Questionnaires from a TOML file, checked as a whole: every problem is told at once.

How such a file is written stands in ``questionnaires.toml``, the packaged one.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

from ..analysis.questionnaires.scales import BOXES, SCALES, asked_by
from ..toml_file import Key, TomlFile, shown
from .problems import Problems
from .question_tables import MOMENTS, ItemTable, OptionTable, QuestionnaireTable, Words

PACKAGED: Final = Path(__file__).parent / "questionnaires.toml"
_ID: Final = re.compile(r"[a-z][a-z0-9_]*")
# Columns of questionnaire.csv that are none of an item.
_TAKEN: Final = ("participant", "system", "phase", "drive")
_ITEM_KEYS: Final = ItemTable.__struct_fields__
_INCLUDE: Final = "include"
_ASK: Final = ("cockpit", "ask")

T = TypeVar("T")


class Asked(NamedTuple):
    """What the study says of questionnaires, in its table ``[cockpit.ask]``.

    Attributes:
        file: the study file.
        when: when a questionnaire is asked, by its id, in place of what its own file says.
        phases: the drives of the study.
    """

    file: TomlFile
    when: Mapping[str, Any]
    phases: Sequence[str]


def read_questionnaires(path: Path, asked: Asked, problems: Problems) -> list[dict[str, Any]]:
    """Return the questionnaires of a file in the form of the page (``Questionnaire``).

    Args:
        path: the file.
        asked: what the study says; it may name those that come with the package, too.
        problems: gets all that is wrong, each with file, line, key and the way out.

    Raises:
        ModelError: the file cannot be read, or is no TOML.
    """
    reading = _Reading(TomlFile(path), asked.phases, problems)
    packaged = _Reading(TomlFile(PACKAGED), asked.phases, problems).questionnaires()
    own = {} if path == PACKAGED else reading.questionnaires()
    found = {name: packaged[name] for name in reading.included(packaged)}
    if path == PACKAGED:
        found = packaged
    found |= own
    for name, when in asked.when.items():
        key = (*_ASK, name)
        if name in found or name in packaged:
            after = _moments(asked.file, key, when, asked.phases, problems)
            found[name] = {**(found.get(name) or packaged[name]), "after": after}
        elif name not in reading.names:
            problems.tried(partial(asked.file.unknown, key, [*reading.names, *packaged]))
    reading.check(found)
    return [one for one in found.values() if one["after"]]


def _moments(
    file: TomlFile, key: Key, after: object, phases: Sequence[str], problems: Problems
) -> list[str]:
    """Return when something is asked, checked."""
    known = [*phases, *MOMENTS]
    if isinstance(after, list) and all(moment in known for moment in after):
        return after
    text = f"{shown(after)} must be a list out of {', '.join(map(shown, known))}"
    problems.wrong(file, key, text)
    return []


class _Reading:
    """One file, read for a study with these drives."""

    def __init__(self, file: TomlFile, phases: Sequence[str], problems: Problems) -> None:
        self._file = file
        self._phases = phases
        self._problems = problems

    @property
    def names(self) -> list[str]:
        """What the tables of the file are called."""
        return [name for name, table in self._file.table.items() if isinstance(table, dict)]

    def wrong(self, key: Key, problem: str) -> None:
        """Note that something is wrong with a key."""
        self._problems.wrong(self._file, key, problem)

    def included(self, packaged: Collection[str]) -> list[str]:
        """Return the names of the ``packaged`` questionnaires that the file asks for."""
        names = self._file.table.get(_INCLUDE, [])
        if isinstance(names, list) and all(name in packaged for name in names):
            return names
        known = ", ".join(map(shown, packaged))
        self.wrong((_INCLUDE,), f"{shown(names)} must be a list out of {known}")
        return []

    def questionnaires(self) -> dict[str, dict[str, Any]]:
        """Return the file's own questionnaires by id."""
        made = {}
        for name, table in self._file.table.items():
            if name == _INCLUDE:
                continue
            if not isinstance(table, dict):
                self.wrong((name,), f"unknown; write [{name}] for a questionnaire")
            elif (one := self._questionnaire(name, table)) is not None:
                made[name] = one
        return made

    def check(self, found: Mapping[str, Mapping[str, Any]]) -> None:
        """Check what concerns more than one questionnaire: names of items, whole scales."""
        where: dict[str, str] = {}
        for name, one in found.items():
            for item in one["items"]:
                key = (name, "items", item["id"])
                if item["id"] in where:
                    self.wrong(key, f"an item of [{where[item['id']]}], too; choose another name")
                where[item["id"]] = name
        self._check_scales(found, where)

    def _check_scales(
        self, found: Mapping[str, Mapping[str, Any]], where: Mapping[str, str]
    ) -> None:
        items = {asked.item: name for name in where if (asked := asked_by(name)) is not None}
        for scale, members in SCALES.items():
            there = [where[items[member]] for member in members if member in items]
            absent = [member for member in members if member not in items]
            if there and absent:
                self.wrong(
                    (there[0],),
                    f"{', '.join(absent)} is missing of the scale {scale}: it could not be scored; "
                    "ask all of its items or none",
                )
        for name in {where[item] for item in items.values()}:
            if wrong := [m for m in found[name]["after"] if m in ("start", "practice", "end")]:
                self.wrong(
                    (name, "after"),
                    f"{shown(wrong[0])}: answers on the system belong to drives; write phases, "
                    '"A" or "B"',
                )

    def _questionnaire(self, name: str, table: Mapping[str, Any]) -> dict[str, Any] | None:
        items = self._items(name, table)
        about = {k: v for k, v in table.items() if k != "items" and k not in _ITEM_KEYS}
        read = self._problems.tried(lambda: self._read(QuestionnaireTable, about, (name,)))
        if read is None or not self._named((name,)):
            return None
        return {
            "id": name,
            "title": _both(read.title),
            "intro": _both(read.intro),
            "after": _moments(
                self._file, (name, "after"), list(read.after), self._phases, self._problems
            ),
            "items": items,
        }

    def _items(self, name: str, table: Mapping[str, Any]) -> list[dict[str, Any]]:
        raw = table.get("items")
        if not isinstance(raw, dict) or not raw:
            self.wrong((name, "items"), f"no items; write [{name}.items] and a line for each")
            return []
        shared = {key: value for key, value in table.items() if key in _ITEM_KEYS}
        made: list[dict[str, Any]] = []
        for item, own in raw.items():
            key = (name, "items", item)
            if not isinstance(own, dict):
                self.wrong(key, f'{shown(own)} must be a table, such as {{ text = "..." }}')
                continue
            content = {**shared, **own}
            read = self._problems.tried(partial(self._read, ItemTable, content, key))
            if read is not None and self._named(key) and self._item_fits(key, read, own, made):
                made.append(_item(item, read))
        return made

    def _item_fits(
        self,
        key: Key,
        read: ItemTable,
        own: Collection[str],
        before: Sequence[Mapping[str, Any]],
    ) -> bool:
        """Whether the keys of an item, its ``own`` among them, fit together; tells what not."""
        problems = list(_misfits(key[-1], read, [item["id"] for item in before]))
        if not any(_both(read.text).values()) and not {"left", "right"} <= set(own):
            problems.append('no text: write text = { en = "...", de = "..." }')
        for problem in problems:
            self.wrong(key, problem)
        return not problems

    def _named(self, key: Key) -> bool:
        if _ID.fullmatch(key[-1]) and key[-1] not in _TAKEN:
            return True
        self.wrong(key, "as a name: small letters, digits and _ only, and no column of the table")
        return False

    def _read(self, kind: type[T], content: Mapping[str, Any], key: Key) -> T:
        """Return ``content`` as a structure, as if it stood at ``key`` of the file."""
        standing: Any = self._file.table
        for name in key[:-1]:
            standing = standing[name]
        before, standing[key[-1]] = standing[key[-1]], dict(content)
        try:
            return self._file.read(kind, *key)  # type: ignore[type-var]
        finally:
            standing[key[-1]] = before


def _misfits(name: str, read: ItemTable, before: Sequence[str]) -> Iterator[str]:
    """Yield what does not fit together in an item."""
    if read.kind == "choice" and not read.options:
        yield 'a choice without options: write options = [{ key = "...", en = "..." }, ...]'
    keys = [option.key for option in read.options]
    if len(set(keys)) < len(keys):
        yield "two options have the same key; the answers could not be told apart"
    if read.kind == "number" and read.low >= read.high:
        yield f"low = {read.low:g} must be below high = {read.high:g}"
    if asked_by(name) is not None and (read.kind != "scale" or read.boxes != BOXES):
        yield f'its scale has {BOXES} boxes: write kind = "scale" and boxes = {BOXES}'
    if read.only_if is not None and read.only_if.id not in before:
        yield f"only_if: {shown(read.only_if.id)} is no earlier item of this questionnaire"


def _item(name: str, read: ItemTable) -> dict[str, Any]:
    condition = read.only_if
    return {
        "id": name,
        "kind": read.kind,
        "text": _both(read.text),
        "options": [_option(option) for option in read.options],
        "boxes": read.boxes,
        "left": _both(read.left),
        "right": _both(read.right),
        "low": read.low,
        "high": read.high,
        "required": read.required,
        "only_if": condition and {"id": condition.id, "is": list(condition.is_)},
    }


def _option(option: OptionTable) -> dict[str, Any]:
    english, german = option.en or option.de, option.de or option.en
    return {"key": option.key, "text": {"en": english or option.key, "de": german or option.key}}


def _both(words: Words) -> dict[str, str]:
    """Return a text in both languages; what one of them lacks is said in the other."""
    if isinstance(words, str):
        return {"en": words, "de": words}
    english, german = words.get("en", ""), words.get("de", "")
    return {"en": english or german, "de": german or english}
