"""Exports of survey tools, each in its true format, with the mapping files of examples/surveys.

The same four people gave the same answers in all of them: P02 left out one item of the acceptance
scale with system B, P04 two items on the speed profile with system A.
"""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest
from pldf.analysis.analysis import analyse
from pldf.analysis.questionnaires import (
    LAAN,
    PROFILE,
    Questionnaire,
    read_questionnaire,
    survey_map,
)
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.errors import ModelError
from pldf.recordings.mapping import read_map

SURVEYS = Path(__file__).parents[2] / "examples" / "surveys"
TOOLS = ("limesurvey", "qualtrics", "soscisurvey", "redcap", "redcap_labels")
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
    names = survey_map(read_map(path).questionnaire, str(path))
    return read_questionnaire(SURVEYS / names.file, names=names)


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


def test_a_study_with_an_export_and_its_map(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = ["participant,phase,pedal_rate,set_speed_rate,combined_rate"]
    lines += [
        f"{who},{phase},{pedal:.2f},0.2,{pedal + 0.15:.2f}"
        for who in ("P01", "P02", "P03", "P04")
        for phase in ("A1", "A2", "B1", "B2")
        for pedal in [0.1 * int(who[2]) + 0.05 * (phase[0] == "A")]
    ]
    (tmp_path / "drives.csv").write_text("\n".join((*lines, "")))
    with pytest.raises(ModelError, match=r"qualtrics.csv: no such file; the mapping file names it"):
        analyse(StudyFolder(tmp_path, map=read_map(SURVEYS / "qualtrics.toml")))
    shutil.copy(SURVEYS / "qualtrics.csv", tmp_path)
    assert main(["analyse", str(tmp_path), "--map", str(SURVEYS / "qualtrics.toml")]) == 0
    said = capsys.readouterr()
    assert "Its first 3 lines are the header" in said.out
    assert "speed_profile: no score of P04 (A)" in said.err
    with (tmp_path / "analysis" / "tests.csv").open() as file:
        counts = {row["measure"]: row["participants"] for row in csv.DictReader(file)}
    assert (counts["pedal"], counts["usefulness"], counts["speed_profile"]) == ("4", "4", "3")


def test_a_map_is_remembered_in_the_folder_of_the_study(tmp_path: Path) -> None:
    shutil.copy(SURVEYS / "redcap.toml", tmp_path / "map.toml")
    source = StudyFolder(tmp_path)
    assert source.questionnaire == tmp_path / "redcap.csv"
    assert source.survey.participant == "record_id"
    (tmp_path / "map.toml").write_text('[questionnaire]\nitems = "laan_1"\n')
    with pytest.raises(ModelError, match=r"map.toml, questionnaire.items: 'laan_1' is not a table"):
        _ = StudyFolder(tmp_path).questionnaire
