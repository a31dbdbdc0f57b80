"""Exports of survey tools, each in its true format, with the mapping files of examples/surveys.

The same four people gave the same answers in all of them: P02 left out one item of the acceptance
scale with system B, P04 two items on the speed profile with system A.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from pldf.analysis.questionnaires import (
    LAAN,
    PROFILE,
    Questionnaire,
    read_questionnaire,
    survey_map,
)

SURVEYS = Path(__file__).parents[2] / "examples" / "surveys"
TOOLS = ("qualtrics", "redcap", "redcap_labels")
# Boxes as ticked on the screen: laan_1 to laan_9, profile_1 to profile_6.
TICKED = {
    ("P01", "A"): "333234324 332343", ("P01", "B"): "214122243 515514",
    ("P02", "A"): "424333334 243324", ("P02", "B"): "225-21242 424415",
    ("P03", "A"): "343343433 333333", ("P03", "B"): "123232142 414424",
    ("P04", "A"): "253424333 3-3-33", ("P04", "B"): "314121343 424514",
}  # fmt: skip
RIGHT = ("laan_3", "laan_6", "laan_8")  # the favourable word
NEGATIVE = ("profile_2", "profile_5")


def scored(item: str, box: float) -> float:
    if item in LAAN:
        return box - 3.0 if item in RIGHT else 3.0 - box
    return 6.0 - box if item in NEGATIVE else box


def read(tool: str) -> Questionnaire:
    path = SURVEYS / f"{tool}.toml"
    names = survey_map(tomllib.loads(path.read_text(encoding="utf-8"))["questionnaire"], path)
    return read_questionnaire(SURVEYS / names.file, (), names)


@pytest.mark.parametrize("tool", TOOLS)
def test_every_tool_says_the_same(tool: str) -> None:
    found = read(tool)
    expected = {
        item: {
            who: scored(item, float(box))
            for who, boxes in TICKED.items()
            if (box := boxes.replace(" ", "")[at]) != "-"
        }
        for at, item in enumerate((*LAAN, *PROFILE))
    }
    assert found.items == expected
    useful = [expected[item]["P01", "B"] for item in LAAN[0::2]]
    assert found.scores["usefulness"]["P01", "B"] == pytest.approx(sum(useful) / 5)
    satisfying = [expected[item]["P02", "B"] for item in LAAN[1::2] if item != "laan_4"]
    assert found.scores["satisfying"]["P02", "B"] == pytest.approx(sum(satisfying) / 3)
    assert set(found.scores["speed_profile"]) == TICKED.keys() - {("P04", "A")}
    warned = [(note.place, note.text) for note in found.notes if note.severity == "warning"]
    lost = "2 of 6 items of speed_profile not answered (profile_2, profile_4)"
    assert warned == [("participant P04, system A", lost)]


TOLD = {
    "limesurvey": ["1 rows without any answer", "ao01 = 1"],
    "qualtrics": ["its first 3 lines are the header: names, texts and import ids",
                  "1 rows passed over, as the mapping file wants", "somewhat disagree = 2"],
    "soscisurvey": ["its first two lines are the header: names and labels"],
    "redcap": ["4 rows without any answer"],
    "redcap_labels": ["4 rows without any answer", "unpleasant = 5", "strongly agree = 5"],
}  # fmt: skip


@pytest.mark.parametrize("tool", TOOLS)
def test_it_is_told_how_an_export_was_read(tool: str) -> None:
    told = " | ".join(note.text for note in read(tool).notes if note.line == 0)
    for text in TOLD[tool]:
        assert text in told
