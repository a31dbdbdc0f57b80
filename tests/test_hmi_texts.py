"""The sentence of the cluster as text: in FMI sessions, in the FMUs' table, in every language."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass

import pytest
from pldf.fmi.access import Access
from pldf.fmi.session import Session
from pldf.function import DrivingFunction
from pldf.hmi_texts import as_json, text_of
from pldf.kernel import codes
from pldf.kernel.codes import EVENT, LANGUAGE, REASON
from pldf.kernel.sentences import EVENT_SENTENCES, EVENTS, NUMBERS, REASONS
from pldf.kernel.signals import by_reference


@dataclass
class Record:
    """What a sentence depends on."""

    hmi_language: int = 0
    hmi_sentence: int = REASON.code("LEARNED_FASTER")
    hmi_sentence_speed: int = 75
    hmi_sentence_base: int = 70
    hmi_sentence_limit: int = 80
    hmi_sentence_drive: int = 2


def test_numbers_stand_in_the_sentence() -> None:
    assert text_of(Record()) == "75 instead of 70: you drove faster here in drive 2"
    german = Record(hmi_language=LANGUAGE.code("DE"))
    assert text_of(german) == "75 statt 70: hier fuhren Sie in Fahrt 2 schneller"
    assert text_of(Record(hmi_sentence_drive=0)) == "75 instead of 70: you drove faster here"


@pytest.mark.parametrize("number", [-1, len(REASONS), 99, EVENT_SENTENCES + len(EVENTS), 10**9])
def test_what_is_no_sentence_says_nothing(number: int) -> None:
    assert text_of(Record(hmi_sentence=number)) == ""


@pytest.mark.parametrize("row", [*REASONS, *EVENTS[1:]], ids=lambda row: row.name)
@pytest.mark.parametrize("language", LANGUAGE.items)
def test_every_sentence_is_complete(row: object, language: str) -> None:
    rows = (*REASONS, *EVENTS[1:])
    at = next(i for i, known in enumerate(rows) if known is row)
    number = at if at < len(REASONS) else EVENT_SENTENCES + 1 + at - len(REASONS)
    record = Record(LANGUAGE.code(language), number, 75, 70, 80, 2)
    text = text_of(record)
    assert 5 < len(text) < 80
    assert not re.search(r"[{}\[\]%]", text)


def test_a_code_is_the_place_in_its_list() -> None:
    for prefix, kind in (("REASON", REASON), ("EVENT", EVENT)):
        named = {
            n: v for n, v in vars(codes).items() if n.startswith(f"{prefix}_") and type(v) is int
        }
        assert named == {f"{prefix}_{item}": code for code, item in enumerate(kind.items)}


def test_both_languages_say_the_same_numbers() -> None:
    for row in (*REASONS, *EVENTS):
        found = [re.findall(r"\{(\w+)\}", text) for text in (row.english, row.german)]
        assert sorted(found[0]) == sorted(found[1])
        assert set(found[0]) <= set(NUMBERS)


def test_the_file_lets_others_say_what_hmi_text_says() -> None:
    """A cluster that knows the file and the five numbers alone says the same."""
    content = json.loads(as_json())
    rows = {row["sentence"]: row for row in content["reasons"] + content["events"]}
    assert len(rows) == len(REASONS) + len(EVENTS)
    for number, row in rows.items():
        for language in LANGUAGE.items:
            record = Record(LANGUAGE.code(language), number, 45, 40, 50, 3)
            said = row[language].replace("[", "").replace("]", "")
            values = {"speed": 45, "base": 40, "limit": 50, "drive": 3}
            assert said.format(**values) == text_of(record)


def test_an_importer_reads_the_sentence_up_to_date() -> None:
    session = Session(DrivingFunction)
    place = {s.name: i for i, s in by_reference(session.signals).items()}["hmi.text"]
    group = Access(session.signals, frozenset({"String"})).group([place])
    session.enter()
    assert session.read_texts(group) == ["You drive; RESUME hands over"]
    session.exit()
    before = session.state()
    assert session.read_texts(group) == ["You drive; RESUME hands over"]
    assert session.state() == before
    session.model.record.lever_resume = 1
    session.step(0.0, 0.01)
    assert session.read_texts(group) != ["You drive; RESUME hands over"]
    session.restore(before)
    assert session.read_texts(group) == ["You drive; RESUME hands over"]
