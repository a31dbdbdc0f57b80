"""The page's cluster says the sentences of the project's table, as the FMUs do."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from node import node
from pldf.hmi_texts import as_json, text_of
from pldf.kernel.codes import EVENT_TAKE_OVER, LANGUAGE_DE, LANGUAGE_EN
from pldf.kernel.sentences import EVENT_SENTENCES, EVENTS, REASONS
from pldf.kernel.state import PldfState

SCRIPT = Path(__file__).parent / "javascript/say_sentences.mjs"
NUMBERS = ("speed", "base", "limit", "drive")


def states() -> list[PldfState]:
    """Return a state for each sentence, with a drive that taught it and without."""
    codes = [*range(len(REASONS)), *(EVENT_SENTENCES + code for code in range(len(EVENTS)))]
    made = []
    for code in codes:
        for drive in (0, 7):
            state = PldfState()
            state.hmi_sentence = code
            for at, name in enumerate(NUMBERS):
                setattr(state, f"hmi_sentence_{name}", 31 + 10 * at)
            state.hmi_sentence_drive = drive
            made.append(state)
    return made


def values_of(state: PldfState) -> dict[str, int]:
    names = ("sentence", *(f"sentence_{name}" for name in NUMBERS))
    return {f"hmi.{name}": getattr(state, f"hmi_{name}") for name in names}


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("sentences")
    (folder / "texts.json").write_bytes(as_json())
    drives: list[dict[str, Any]] = [values_of(state) for state in states()]
    drives += [{"hmi.reason": 12, "hmi.event": 0}, {"hmi.reason": 0, "hmi.event": 8}]
    drives += [{"hmi.reason": 0, "hmi.take_over": True}, {}, {"hmi.sentence": 99}]
    (folder / "drives.json").write_text(json.dumps(drives), encoding="utf-8")
    done = node(SCRIPT, folder / "texts.json", folder / "drives.json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_each_sentence_is_that_of_the_fmus(page: Any) -> None:
    for state, said in zip(states(), page["said"], strict=False):
        for language, key in ((LANGUAGE_EN, "en"), (LANGUAGE_DE, "de")):
            state.hmi_language = language
            assert said[key] == text_of(state)


def test_what_a_simulator_may_leave_out_is_found_by_reason_and_event(page: Any) -> None:
    following, limit, take_over, nothing, unknown = page["said"][len(states()) :]
    assert following["name"] == "FOLLOWING"
    assert limit["name"] == "NEW_LIMIT"
    assert take_over["name"] == EVENTS[EVENT_TAKE_OVER].name
    assert nothing is None
    assert unknown is None


def test_there_is_a_pictogram_for_each_row_and_no_other(page: Any) -> None:
    assert set(page["icons"]) == {row.icon for row in (*REASONS, *EVENTS)} - {""}


def test_without_explanation_only_what_one_must_know_to_drive_is_said(page: Any) -> None:
    assert page["none"] == page["icon"] == [
        "OVERRIDE", "STANDBY", "FAULT", "OFF", "HELD", "FORGOTTEN", "NOTHING_TO_FORGET", "UNDONE",
        "NOTHING_TO_UNDO", "PAUSED", "RESUMED", "TAKE_OVER",
    ]  # fmt: skip
