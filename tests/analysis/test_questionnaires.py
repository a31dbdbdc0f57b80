"""Questionnaires as people have them: labels, codes, missing answers, wide tables, maps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pldf.analysis.questionnaires import (
    LAAN,
    PROFILE,
    Questionnaire,
    read_questionnaire,
    survey_map,
)
from pldf.analysis.questionnaires.labels import agreement
from pldf.errors import ModelError

BOXES = (1, 2, 3, 4, 5, 4, 3, 2, 1)  # of laan_1 to laan_9
SCORES = (2, 1, 0, -1, -2, 1, 0, -1, 2)  # favourable +2; on the right in 3, 6 and 8


def read(folder: Path, text: str, survey: dict[str, object] | None = None) -> Questionnaire:
    path = folder / "questionnaire.csv"
    path.write_text(text, encoding="utf-8")
    return read_questionnaire(path, names=survey_map(survey or {}, "map.toml"))


def refusal(folder: Path, text: str, survey: dict[str, object] | None = None) -> str:
    with pytest.raises(ModelError) as refused:
        read(folder, text, survey)
    return str(refused.value)


def laan(rows: dict[str, tuple[object, ...]]) -> str:
    """A long table of the acceptance scale: "P1,A" -> answers."""
    lines = [",".join((who, *map(str, cells))) for who, cells in rows.items()]
    return "\n".join((f"participant,system,{','.join(LAAN)}", *lines, ""))


def profile(answers: tuple[str, ...]) -> str:
    """A long table of the items on the speed profile, one row per answer given to all of them."""
    rows = [f"P{at},A,{','.join([answer] * 6)}" for at, answer in enumerate(answers)]
    return "\n".join((f"participant,system,{','.join(PROFILE)}", *rows, ""))


@pytest.mark.parametrize("write", ["{}", "{}.0", " {} ", "{},0", "A{}", "AO0{}"])
def test_boxes_are_numbers_however_they_are_written(tmp_path: Path, write: str) -> None:
    cells = tuple(f'"{write.format(box)}"' for box in BOXES)
    found = read(tmp_path, laan({"P1,A": cells}))
    assert tuple(found.items[item]["P1", "A"] for item in LAAN) == SCORES
    assert found.scores["usefulness"]["P1", "A"] == pytest.approx(np.mean(SCORES[0::2]))
    told = [note.text for note in found.notes]
    assert told == ([] if write.strip()[0] == "{" else [told[0]])
    if told:
        assert told[0].startswith("answers read as boxes: a")


def test_a_line_break_in_a_text_that_nobody_needs(tmp_path: Path) -> None:
    header = f"participant,system,comment,{','.join(LAAN)}"
    row = f'P1,A,"quiet, \n\n""late"" brakes",{",".join(map(str, BOXES))}'
    found = read(tmp_path, f"{header}\n{row}\n")
    assert found.scores["satisfying"]["P1", "A"] == pytest.approx(np.mean(SCORES[1::2]))


@pytest.mark.parametrize(
    "labels",
    [
        ("Strongly disagree", "Disagree", "Neither agree nor disagree", "Agree", "Strongly agree"),
        ("Strongly disagree", "Somewhat disagree", "Neutral", "Somewhat agree", "STRONGLY AGREE"),
        ("stimme überhaupt nicht zu", "stimme nicht zu", "teils/teils", "stimme zu",
         "stimme voll zu"),
        ("stimme gar nicht zu", "stimme eher nicht zu", "weder noch", "stimme eher zu",
         "stimme voll und ganz zu"),
        ("trifft nicht zu", "trifft eher nicht zu", "teils, teils", "trifft eher zu",
         "trifft zu"),
    ],
)  # fmt: skip
def test_labels_of_agreement(tmp_path: Path, labels: tuple[str, ...]) -> None:
    found = read(tmp_path, profile(tuple(f'"{label}"' for label in labels)))
    scores = found.scores["speed_profile"]
    assert [scores[f"P{at}", "A"] for at in range(5)] == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert labels[1].lower() + " = 2" in found.notes[0].text


def test_a_label_that_may_mean_two_boxes_is_refused_unless_the_map_says_which(
    tmp_path: Path,
) -> None:
    text = profile(("disagree", "neutral", "agree"))
    assert "line 2, participant P0, system A, profile_1: 'disagree' is not" in refusal(
        tmp_path, text
    )
    found = read(tmp_path, text, {"answers": {"disagree": 1, "agree": 5}})
    assert list(found.scores["speed_profile"].values()) == [1.0, 3.0, 5.0]
    assert agreement({"agree", "somewhat agree", "neutral"}) == {
        "agree": 5.0, "somewhat agree": 4.0, "neutral": 3.0,
    }  # fmt: skip
    assert agreement({"agree", "strongly agree"}) == {"agree": 4.0, "strongly agree": 5.0}
    assert agreement({"agree", "zu weich"}) == {}


def test_the_words_beside_the_boxes(tmp_path: Path) -> None:
    ends = ("useful", "pleasant", "bad", "nice", "effective", "irritating", "assisting",
            "undesirable", "raising alertness")  # fmt: skip
    german = ("nutzlos", "unangenehm", "gut", "nervig", "überflüssig", "erfreulich", "wertlos",
              "wünschenswert", "einschläfernd")  # fmt: skip
    found = read(tmp_path, laan({"P1,A": ends, "P1,B": german, "P2,A": (*ends[:8], 4)}))
    left = (2, 2, -2, 2, 2, -2, 2, -2, 2)
    assert tuple(found.items[item]["P1", "A"] for item in LAAN) == left
    assert tuple(found.items[item]["P1", "B"] for item in LAAN) == tuple(-s for s in left)
    assert found.items["laan_9"]["P2", "A"] == -1.0


@pytest.mark.parametrize("missing", ["", "NA", "n/a", "-99", "-9", "NaN", "-9.0"])
def test_a_missing_item_costs_its_scale_only_if_too_few_are_left(
    tmp_path: Path, missing: str
) -> None:
    """Of five items four suffice, of four three: three quarters."""
    whole, one, two = BOXES, (missing, missing, *BOXES[2:]), (missing, 2, missing, *BOXES[3:])
    found = read(tmp_path, laan({"P1,A": whole, "P1,B": one, "P2,A": two}))
    useful, satisfying = found.scores["usefulness"], found.scores["satisfying"]
    assert useful["P1", "B"] == pytest.approx(np.mean(SCORES[2::2]))  # laan_3, 5, 7 and 9
    assert satisfying["P1", "B"] == pytest.approx(np.mean(SCORES[3::2]))
    assert ("P2", "A") not in useful
    assert satisfying["P2", "A"] == pytest.approx(np.mean(SCORES[1::2]))
    assert ("P2", "A") not in found.items["laan_1"]
    told = {(note.severity, note.line, note.place): note.text for note in found.notes}
    lost = told["warning", 4, "participant P2, system A"]
    assert lost == "2 of 5 items of usefulness not answered (laan_1, laan_3)"
    assert ("note", 3, "participant P1, system B") in told
    assert found.complete["usefulness"].shape == (5, 1)
    assert found.complete["satisfying"].shape == (4, 2)


def test_the_share_that_must_be_answered_is_a_parameter(tmp_path: Path) -> None:
    text = laan({"P1,A": ("", "", *BOXES[2:]), "P1,B": ("", "", "", *BOXES[3:])})
    strict = read(tmp_path, text, {"answered_min": 1.0})
    assert strict.scores["usefulness"] == strict.scores["satisfying"] == {}
    lax = read(tmp_path, text, {"answered_min": 0.5})
    assert lax.scores["usefulness"]["P1", "B"] == pytest.approx(np.mean(SCORES[4::2]))


def test_alpha_is_that_of_complete_answers(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    boxes = np.clip(rng.integers(1, 6, (12, 1)) + rng.integers(-1, 2, (12, 6)), 1, 5)
    cells = [[*map(str, row)] for row in boxes.tolist()]
    cells[3][2] = "NA"
    rows = [f"P{at},A,{','.join(row)}" for at, row in enumerate(cells)]
    text = "\n".join((f"participant,system,{','.join(PROFILE)}", *rows, ""))
    found = read(tmp_path, text)
    assert len(found.scores["speed_profile"]) == 12
    whole = np.delete(boxes, 3, axis=0).T
    covariance = np.cov(whole)  # alpha from the covariances, as Cronbach (1951) writes it
    expected = 6 / 5 * (1.0 - np.trace(covariance) / covariance.sum())
    assert found.reliability("speed_profile") == pytest.approx(expected)
    assert found.complete["speed_profile"].shape == (6, 11)


def test_a_row_per_person_with_a_column_per_system(tmp_path: Path) -> None:
    header = [f"{item}_{system}" for system in ("A", "b") for item in LAAN]
    header += [f"profile_{n}{'_reversed' * (n == 2)}_B1" for n in range(1, 7)]
    cells = [*BOXES, *reversed(BOXES), 1, 5, 1, 1, 1, 1]
    text = f"participant,{','.join(header)}\nP1,{','.join(map(str, cells))}\n"
    found = read(tmp_path, text)
    assert [found.items[item]["P1", "A"] for item in LAAN] == list(SCORES)
    assert found.scores["speed_profile"] == {("P1", "B"): 1.0}
    assert set(found.scores["usefulness"]) == {("P1", "A"), ("P1", "B")}
    assert "both say after which system" in refusal(
        tmp_path, text.replace("participant,", "participant,system,").replace("P1,", "P1,A,", 1)
    )
    assert "missing column laan_9_A of the scale usefulness" in refusal(
        tmp_path, text.replace("laan_9_A", "note")
    )


def test_an_empty_row_is_passed_over_and_told(tmp_path: Path) -> None:
    found = read(
        tmp_path,
        laan({"P1,A": BOXES, ",": ("",) * 9, " , ": ("NA",) * 9, "P2,screening": ("",) * 9}),
    )
    assert [note.text for note in found.notes] == ["3 rows without any answer passed over"]
    assert set(found.items["laan_1"]) == {("P1", "A")}


def test_a_table_from_a_german_spreadsheet(tmp_path: Path) -> None:
    """Semicolons, boxes with a decimal comma, cp1252; that the encoding was guessed is told."""
    rows = [";".join(("P1", "A", *(f"{box},0" for box in BOXES)))]
    rows += [";".join(("P2", "A", *map(str, BOXES[:4]), "überflüssig", *map(str, BOXES[5:])))]
    text = "\r\n".join((f"participant;system;{';'.join(LAAN)}", *rows, ""))
    path = tmp_path / "questionnaire.csv"
    path.write_bytes(text.encode("cp1252"))
    found = read_questionnaire(path)
    for name in ("P1", "P2"):
        assert tuple(found.items[item][name, "A"] for item in LAAN) == SCORES
    assert any("cp1252" in note.text or "1252" in note.text for note in found.notes)


def test_answers_for_a_system_and_for_one_of_its_drives_are_not_mixed(tmp_path: Path) -> None:
    drives = laan({"P1,A1": BOXES, "P1,A2": BOXES, "P2,A": BOXES})
    assert len(read(tmp_path, drives).scores["usefulness"]) == 2
    told = refusal(tmp_path, drives.replace("P2", "P1"))
    assert "line 2, participant P1, system: line 4 has the answers for system A as a whole" in told
    wide = ",".join(f"{item}_{group}" for group in ("A", "A1") for item in LAAN)
    assert "columns laan_1_A1 and laan_1_A" in refusal(tmp_path, f"participant,{wide}\n")


def test_a_questionnaire_without_answers_is_told(tmp_path: Path) -> None:
    for text in (laan({}), laan({"P1,A": ("",) * 9})):
        found = read(tmp_path, text)
        assert found.scores == {"usefulness": {}, "satisfying": {}}
        assert [note.text for note in found.notes if note.severity == "warning"] == [
            "no answers below the header"
        ]


def test_names_and_answers_of_a_laboratory(tmp_path: Path) -> None:
    """Boxes from -2 to +2 from left to right, German names, systems in words, test runs."""
    header = "Kürzel;Bedingung;Art;" + ";".join(f"Frage {n}" for n in range(1, 10))
    rows = [
        f"VP1;mit Lernen;echt;{';'.join(str(box - 3) for box in BOXES)}",
        f"VP1;Grundprofil;echt;{';'.join('x' if n == 2 else '0' for n in range(1, 10))}",
        "egal;?;Probe;" + ";".join("99" for _ in LAAN),
    ]
    survey = {
        "participant": "Kürzel", "system": "Bedingung",
        "systems": {"Grundprofil": "A", "mit Lernen": "B"},
        "items": {f"Frage {n}": f"laan_{n}" for n in range(1, 10)},
        "answers": {"-2": 1, "-1": 2, "0": 3, "1": 4, "2": 5},
        "missing": ["x"], "only": {"Art": ["echt"]},
    }  # fmt: skip
    text = "\n".join((header, *rows, "")).replace(";", ",")
    found = read(tmp_path, text, survey)
    assert tuple(found.items[item]["VP1", "B"] for item in LAAN) == SCORES
    assert found.scores["usefulness"]["VP1", "A"] == found.scores["satisfying"]["VP1", "A"] == 0.0
    assert found.notes[0].text.startswith("1 rows passed over")
    assert "'3' is not the number of a box" in refusal(
        tmp_path, text.replace("-1,0,1", "-1,3,1"), survey
    )
    del survey["systems"]
    assert "line 2, Kürzel VP1, Bedingung: 'mit Lernen' is not a system" in refusal(
        tmp_path, text, survey
    )


def test_all_that_is_wrong_with_a_map_is_told_at_once() -> None:
    with pytest.raises(ModelError) as refused:
        survey_map(
            {
                "particpant": "id", "items": {"Q1": "laan_10"}, "answers": {"yes": 6},
                "systems": {"first": "C"}, "missing": "x", "answered_min": 75,
                "header_lines": 0, "only": {"Status": "done"},
            },
            "map.toml",
        )  # fmt: skip
    told = str(refused.value).splitlines()
    assert len(told) == 8
    for text in (
        "map.toml, questionnaire.particpant: not known; is participant meant?",
        "'laan_10' is no item", "'yes': 6 is not the number of a box", "'C' is neither a system",
        "missing: 'x' is not a list", "answered_min: 75 is not a share", "header_lines: 0",
        "'Status': 'done' is not a list",
    ):  # fmt: skip
        assert any(text in line for line in told), text


def test_columns_that_the_map_names_and_nobody_has(tmp_path: Path) -> None:
    told = refusal(
        tmp_path, laan({"P1,A": BOXES}), {"participant": "id", "items": {"Q1": "profile_1"}}
    )
    assert "missing column id, Q1; the file has participant, system, laan_1" in told
