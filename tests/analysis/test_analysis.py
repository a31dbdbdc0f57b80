"""``pldf analyse``: rates, scores and tests against known answers; what is missing is named."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pytest
from pldf.analysis.analysis import analyse
from pldf.analysis.questionnaires import LAAN, PROFILE, read_questionnaire
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.errors import ModelError
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.recordings.recording import Recording, write_recording
from pldf.roads import packed_route
from scipy import stats

PHASES = ("A1", "A2", "A3", "B1", "B2", "B3")
A = np.array([[0.22, 0.40, 0.55], [0.30, 0.10, 0.38], [0.18, 0.52, 0.60], [0.25, 0.33, 0.47]])
B = np.array([[0.11, 0.12, 0.20], [0.21, 0.15, 0.33], [0.10, 0.00, 0.10], [0.12, 0.20, 0.30]])


def drives(rates: Iterable[tuple[str, str, Iterable[float]]]) -> str:
    """A drives.csv of (participant, phase, the three rates)."""
    lines = ["participant,phase,pedal_rate,set_speed_rate,combined_rate"]
    lines += [",".join((who, phase, *map(str, three))) for who, phase, three in rates]
    return "\n".join(lines) + "\n"


def study(folder: Path, text: str | None = None) -> StudyFolder:
    """A folder with four participants whose means per system are ``A`` and ``B``."""
    spread = {"A1": 0.01, "A2": -0.01, "B1": 0.02, "B2": -0.02, "A3": None, "B3": None}
    rows = []
    for at, who in enumerate(("P1", "P2", "P3", "P4")):
        for phase in PHASES:
            mean, by = (A if phase[0] == "A" else B)[at], spread[phase]
            rows.append(
                (who, phase, 0.0 * mean if by is None else np.clip(mean + by, 0.0, 1.0).round(4))
            )
    (folder / "drives.csv").write_text(text or drives(rows))
    return StudyFolder(folder)


def answers(folder: Path, change: Mapping[tuple[str, str, str], str] | None = None) -> Path:
    """A questionnaire of P1 to P4: all boxes 3 for A and favourable ones for B, then changed."""
    header = ["participant", "system", *LAAN, *PROFILE]
    favourable = dict.fromkeys(LAAN, "1") | dict.fromkeys(("laan_3", "laan_6", "laan_8"), "5")
    favourable |= dict.fromkeys(PROFILE, "5")
    path = folder / "questionnaire.csv"
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, header)
        table.writeheader()
        for who in ("P1", "P2", "P3", "P4"):
            for system in "AB":
                row = dict.fromkeys(header, "3") if system == "A" else dict(favourable)
                row |= {"participant": who, "system": system}
                for (name, of, item), box in (change or {}).items():
                    if (name, of) == (who, system):
                        row[item] = box
                table.writerow(row)
    return path


def refusal(source: StudyFolder) -> str:
    with pytest.raises(ModelError) as refused:
        analyse(source)
    return str(refused.value)


def test_means_tests_and_effects_are_those_of_the_numbers(tmp_path: Path) -> None:
    found = analyse(study(tmp_path))
    assert found.participants == ("P1", "P2", "P3", "P4")
    assert found.needed == ("A1", "A2", "B1", "B2")
    for at, measure in enumerate(("pedal", "set_speed", "combined")):
        a, b = A[:, at], np.where(B[:, at] > 0.02, B[:, at], 0.01)  # clipped at 0 in B2
        comparison = found.comparisons[measure]
        assert found.per_participant(measure, "B") == pytest.approx(b)
        assert comparison.mean_first == pytest.approx(a.mean())
        expected = stats.ttest_rel(a, b)
        assert comparison.t.t == pytest.approx(expected.statistic)
        assert comparison.t.p == pytest.approx(expected.pvalue)
        assert comparison.d_z == pytest.approx((a - b).mean() / (a - b).std(ddof=1))
    assert found.interval("A1", "pedal").value == pytest.approx(A[:, 0].mean() + 0.01)
    assert found.interval("A3", "pedal").high == 0.0


def test_recordings_of_a_laboratory_give_the_rates_of_section_4(tmp_path: Path) -> None:
    time = np.arange(0.0, 200.01, 0.1)

    def between(*spans: tuple[float, float]) -> np.ndarray:
        near = time + 0.01  # 9.999999 is 10
        return np.any([(a <= near) & (near < b) for a, b in spans], axis=0)

    mode = np.where(between((10, 14), (30, 33)), GAS_OVERRIDE, ACTIVE)
    mode = np.where(between((50, 58)), STANDBY, mode).astype(float)
    columns = {
        "time_s": time, "s_m": 20.0 * time, "speed_mps": 0.0 * time + 20.0, "mode": mode,
        "brake_pedal": 0.5 * between((50, 52)), "set_speed_offset_mps": 1.0 * between((25, 60)),
    }  # fmt: skip
    (tmp_path / "recordings").mkdir()
    for who in ("anna_k", "ben"):
        for phase in ("A1", "A2", "B1", "B2"):
            write_recording(tmp_path / "recordings" / f"{who}_{phase}.csv", Recording(columns))
    found = analyse(StudyFolder(tmp_path))
    assert found.participants == ("anna_k", "ben")
    rates = [found.comparisons[name].mean_second for name in ("pedal", "set_speed", "combined")]
    assert rates == pytest.approx([0.075, 0.175, 0.195], abs=1e-9)

    few = {name: columns[name] for name in ("time_s", "s_m", "speed_mps", "mode")}
    write_recording(tmp_path / "recordings" / "ben_A1.csv", Recording(few))
    assert "ben_A1.csv: no column brake_pedal, set_speed_offset_mps" in refusal(
        StudyFolder(tmp_path)
    )
    known = StudyFolder(tmp_path, packed_route(0))
    assert "ben_A1.csv: neither set_speed_mps nor set_speed_offset_mps was" in refusal(known)
    for path in (tmp_path / "recordings").glob("*_A?.csv"):
        write_recording(path, Recording(few))
    # Nobody could set the speed with A: that B knows better is no reason to compare.
    assert "rates cannot be compared" in refusal(StudyFolder(tmp_path, packed_route(0)))
    with_zeros = Recording(few | {"set_speed_offset_mps": 0.0 * time})
    for path in (tmp_path / "recordings").glob("*_A?.csv"):
        write_recording(path, with_zeros)
    assert len(analyse(StudyFolder(tmp_path, packed_route(0))).drives) == 8

    (tmp_path / "recordings" / "ben_B2.csv").unlink()
    told = refusal(StudyFolder(tmp_path, packed_route(0)))
    assert "participant ben has no drive B2" in told
    assert "--without ben" in told
    (tmp_path / "recordings" / "ben-B2.csv").write_text("")
    assert "PARTICIPANT_PHASE" in refusal(StudyFolder(tmp_path))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("P2,B1,", "P2,B4,", "participant P2 has no drive B1"),
        ("P2,B1,", "P2,B2,", "line 12: participant P2 has phase B2 already"),
        ("P2,B1,", "P2,C1,", "line 11, participant P2, phase: 'C1' is not A or B and the number"),
        (
            "P2,B1,0.23",
            "P2,B1,23",
            "line 11, participant P2, phase B1, pedal_rate: '23' is not a number from 0 to 1",
        ),
        (
            "P2,B1,0.23,0.17,0.35",
            "P2,B1,0.23,0.17,0.53",
            "line 11, participant P2, phase B1, combined_rate: 0.53 cannot be the share of the "
            "time with pedal (0.23), set speed (0.17) or both, which is from 0.23 to 0.4",
        ),
        ("P2,B1,0.23,0.17,0.35", "P2,B1,0.23,0.17,0.2", "combined_rate: 0.2 cannot be the share"),
        ("P2,B1,0.23", "P2,B1,x", "pedal_rate: 'x' is not a number"),
        ("P2,B1,0.23", "P2,B1,", "pedal_rate: '' is not a number"),
        ("P2,B1,", "P2,B1,1,", "line 11: 6 values for 5 columns"),
        ("P2,B1,", ",B1,", "line 11, participant: '' is not the name of"),
        ("pedal_rate", "pedals", "line 1: missing column pedal_rate"),
    ],
)
def test_what_is_missing_or_wrong_is_named(tmp_path: Path, old: str, new: str, told: str) -> None:
    source = study(tmp_path)
    text = (tmp_path / "drives.csv").read_text()
    assert old in text
    (tmp_path / "drives.csv").write_text(text.replace(old, new, 1))
    assert told in refusal(source)


def test_a_participant_can_be_left_out(tmp_path: Path) -> None:
    study(tmp_path)
    text = (tmp_path / "drives.csv").read_text()
    (tmp_path / "drives.csv").write_text(text.replace("P2,B1,", "P2,B9,"))
    left = analyse(StudyFolder(tmp_path, without=frozenset({"P2"})))
    assert left.participants == ("P1", "P3", "P4")
    assert "1 participant; comparing" in refusal(
        StudyFolder(tmp_path, without=frozenset({"P1", "P2", "P3"}))
    )


def test_nothing_to_analyse(tmp_path: Path) -> None:
    assert "no drives.csv and no recordings" in refusal(StudyFolder(tmp_path))


def test_repeated_phases_of_a_study_file_are_compared_by_what_they_are(tmp_path: Path) -> None:
    study(tmp_path)
    (tmp_path / "study.toml").write_text(
        '[drives]\nphases = ["A1", "A3", "B1", "B3"]\nper_phase = 2\n'
    )
    assert StudyFolder(tmp_path).compared() == {"A": ("A1", "A2"), "B": ("B1", "B2")}
    (tmp_path / "study.toml").write_text('[drives]\nphases = ["A3", "A1", "B1"]\nper_phase = 2\n')
    assert StudyFolder(tmp_path).compared() == {"A": ("A3", "A4"), "B": ("B1", "B2")}


def test_which_drive_shows_what_another_taught(tmp_path: Path) -> None:
    assert StudyFolder(tmp_path).development() == {"A2": "B1", "B1": "B2", "B2": "B3"}
    (tmp_path / "study.toml").write_text('[drives]\nphases = ["A2", "B1"]\nper_phase = 2\n')
    assert StudyFolder(tmp_path).development() == {"A2": "B1", "B1": "B2"}


def test_the_acceptance_scale_is_scored_as_its_authors_do(tmp_path: Path) -> None:
    path = answers(tmp_path, {("P1", "B", item): "1" for item in LAAN})
    scores = read_questionnaire(path).scores
    assert scores["usefulness"]["P2", "A"] == scores["satisfying"]["P2", "A"] == 0.0
    assert scores["usefulness"]["P2", "B"] == scores["satisfying"]["P2", "B"] == 2.0
    # All left boxes: bad, irritating and undesirable stand there too.
    assert scores["usefulness"]["P1", "B"] == pytest.approx((2 + 2 + 2 + 2 - 2) / 5)
    assert scores["satisfying"]["P1", "B"] == pytest.approx((2 + 2 - 2 - 2) / 4)
    assert scores["speed_profile"]["P1", "B"] == 5.0


def test_reversed_items_reliability_and_answers_after_each_drive(tmp_path: Path) -> None:
    path = tmp_path / "questionnaire.csv"
    items = ",".join((*PROFILE[:5], "profile_6_reversed"))
    rows = ["P1,A1,1,1,1,1,1,5", "P1,A2,3,3,3,3,3,3", "P1,B1,5,5,5,5,5,1", "P2,A1,4,4,4,4,4,2"]
    path.write_text(f"# comment\nparticipant,phase,{items}\n" + "\n".join(rows) + "\n")
    found = read_questionnaire(path)
    assert list(found.scores) == ["speed_profile"]
    assert found.scores["speed_profile"] == {("P1", "A"): 2.0, ("P1", "B"): 5.0, ("P2", "A"): 4.0}
    assert found.reliability("speed_profile") == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({("P3", "B", "laan_4"): "\u0e52"}, "laan_4: '\u0e52' is not the number of a box"),
        ({("P3", "B", "laan_4"): "2.5"}, "line 7, participant P3, system B, laan_4: '2.5' is not"),
        (
            {("P3", "B", "laan_4"): "good"},
            "line 7, participant P3, system B, laan_4: 'good' is not",
        ),
        (
            {("P3", "B", "laan_4"): "-2"},
            "P3, system B, laan_4: '-2' is not the number of a box",
        ),
        ({("P3", "B", "profile_2"): "6"}, "profile_2: '6' is not the number of a box"),
        ({("P3", "B", "system"): "A"}, "line 7, participant P3, system A: answered in line 6"),
        ({("P3", "B", "system"): "C"}, "line 7, participant P3, system: 'C' is not a system"),
        ({("P3", "B", "participant"): "P9"}, "answers of P9, of whom there are no drives"),
        ({("P3", "B", "participant"): ""}, "line 7, system B, participant: '' is not the name"),
    ],
)
def test_bad_answers_are_named(
    tmp_path: Path, change: dict[tuple[str, str, str], str], told: str
) -> None:
    source = study(tmp_path)
    answers(tmp_path, change)
    assert told in refusal(source)


def test_questionnaires_with_columns_or_people_too_few_or_too_many(tmp_path: Path) -> None:
    source = study(tmp_path)
    path = answers(tmp_path)
    text = path.read_text()
    path.write_text(text.replace("laan_4", "laan_x"))
    assert "missing column laan_4 of the scale satisfying" in refusal(source)
    path.write_text(text + text.splitlines()[1].replace("P1", "P8") + "\n")
    assert "answers of P8, of whom there are no drives" in refusal(source)
    path.write_text("participant,system\n")
    assert "no items" in refusal(source)


def test_who_has_no_score_leaves_the_comparison_of_that_scale_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = study(tmp_path)
    lost = dict.fromkeys((("P3", "B", "laan_2"), ("P3", "B", "laan_4"), ("P4", "A", "laan_1")), "")
    lost |= dict.fromkeys((("P1", "A", item) for item in PROFILE), "-9")
    answers(tmp_path, lost)
    found = analyse(source)
    counts = {name: comparison.people for name, comparison in found.comparisons.items()}
    assert counts == {
        "pedal": 4, "set_speed": 4, "combined": 4,
        "usefulness": 4, "satisfying": 3, "speed_profile": 3,
    }  # fmt: skip
    told = {note.place: note for note in found.notes if note.severity == "warning"}
    assert told["satisfying"].text == "no score of P3 (B)"
    assert "the other 3 participants" in told["satisfying"].consequence
    b = found.per_participant("satisfying", "B")
    assert np.isnan(b).tolist() == [False, False, True, False]

    assert main(["analyse", str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert "warning: " in said.err
    assert "no score of P1 (A)" in said.err
    assert "satisfying 1.00 (n = 7)" in said.out
    assert "Scores without single items, means of the others: 1." in said.out
    with (tmp_path / "analysis" / "participants.csv").open() as file:
        rows = {(row["participant"], row["system"]): row for row in csv.DictReader(file)}
    assert rows["P3", "B"]["satisfying"] == rows["P1", "A"]["speed_profile"] == ""
    assert float(rows["P3", "B"]["usefulness"]) == 2.0
    with (tmp_path / "analysis" / "tests.csv").open() as file:
        assert [int(row["participants"]) for row in csv.DictReader(file)] == [4, 4, 4, 4, 3, 3]
    with (tmp_path / "analysis" / "items.csv").open() as file:
        items = {row["item"]: row for row in csv.DictReader(file)}
    assert (items["laan_1"]["participants"], items["laan_3"]["participants"]) == ("3", "4")


def test_a_scale_that_one_person_answered_is_not_compared(tmp_path: Path) -> None:
    source = study(tmp_path)
    path = answers(tmp_path)
    path.write_text("\n".join(path.read_text().splitlines()[:4]) + "\n")  # P1; P2 for A only
    found = analyse(source)
    assert list(found.comparisons) == ["pedal", "set_speed", "combined"]
    (told, *_) = [note for note in found.notes if note.place == "satisfying"]
    assert told.text == "no score of P2 (B), P3 (A, B), P4 (A, B)"
    assert "1 participants are left, so A and B are not compared" in told.consequence


def test_the_command_writes_tables_and_tells_the_paper_s_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study(tmp_path)
    answers(tmp_path, {("P1", "A", "laan_1"): "2"})
    assert main(["analyse", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    for text in ("22.32", "12.04", "23.75", "Usefulness", "Cronbach's alpha"):
        assert text in told
    with (tmp_path / "analysis" / "tests.csv").open() as file:
        tests = {row["measure"]: row for row in csv.DictReader(file)}
    assert list(tests) == [
        "pedal", "set_speed", "combined", "usefulness", "satisfying", "speed_profile",
    ]  # fmt: skip
    assert float(tests["pedal"]["mean_a"]) == pytest.approx(A[:, 0].mean())
    assert int(tests["satisfying"]["fell"]) == 0
    with (tmp_path / "analysis" / "participants.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["participant"], row["system"]) for row in rows[:3]] == [
        ("P1", "A"), ("P1", "B"), ("P2", "A"),
    ]  # fmt: skip
    assert float(rows[0]["usefulness"]) == pytest.approx(0.2)
    assert len((tmp_path / "analysis" / "items.csv").read_text().splitlines()) == 16
    assert len((tmp_path / "analysis" / "phases.csv").read_text().splitlines()) == 19
    capsys.readouterr()
    assert main(["analyse", str(tmp_path / "none")]) == 1
    said = capsys.readouterr()
    assert said.out == ""
    assert "no drives.csv" in said.err


def test_the_same_difference_for_everybody_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [
        (f"P{at}", phase, [a - 0.1 * (phase[0] == "B")] * 3)
        for at, a in enumerate((0.3, 0.4, 0.5, 0.7))
        for phase in PHASES
    ]
    study(tmp_path, drives((who, phase, np.round(three, 4)) for who, phase, three in rows))
    assert main(["analyse", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "No spread: pedal, set_speed, combined" in told
    assert "no spread" in next(line for line in told.splitlines() if "*inf" in line)
    with (tmp_path / "analysis" / "tests.csv").open() as file:
        (test, *_) = csv.DictReader(file)
    assert (test["t"], test["p_t"], test["cohen_dz"]) == ("inf", "0.0", "inf")
    assert float(test["p_wilcoxon"]) == stats.wilcoxon([1] * 4, method="asymptotic").pvalue


def test_an_interval_of_rates_ends_at_0_and_1(tmp_path: Path) -> None:
    rates = [0.0, 0.0, 1.0, 1.0]
    half = stats.t.ppf(0.975, 3) * np.std(rates, ddof=1) / 2.0  # of the mean of four
    assert 0.5 - half < 0.0
    rows = [(f"P{at}", phase, (x, x, x)) for at, x in enumerate(rates) for phase in PHASES]
    interval = analyse(study(tmp_path, drives(rows))).interval("A1", "pedal")
    assert (interval.value, interval.low, interval.high) == (0.5, 0.0, 1.0)


def test_how_drives_and_exclusions_were_read_is_told(tmp_path: Path) -> None:
    source = study(tmp_path)
    path = tmp_path / "drives.csv"
    path.write_text(path.read_text().replace("pedal_rate", "Pedal_Rate", 1))
    (tmp_path / "exclusions.csv").write_bytes(
        "participant,phase,reason\nP1,A3,Stra\u00dfe na\u00df\n".encode("latin-1")
    )
    told = list(map(str, analyse(source).notes))
    assert any("the column 'Pedal_Rate' is read as pedal_rate" in note for note in told)
    assert any("exclusions.csv, line 2: not UTF-8: read as Windows-1252" in note for note in told)


@pytest.mark.parametrize("text", ["drives = 5", '[drives]\nphases = ["A1", "X"]', "road = 5"])
def test_a_study_file_that_is_none_is_refused(tmp_path: Path, text: str) -> None:
    source = study(tmp_path)
    (tmp_path / "study.toml").write_text(text)
    assert "study.toml, line" in refusal(source)
