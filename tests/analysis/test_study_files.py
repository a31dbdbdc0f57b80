"""Exclusions, names spelled in two ways, and all that is wrong with a study at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pldf.analysis.analysis import Analysis, analyse
from pldf.analysis.checks.files import Known, check_file
from pldf.analysis.checks.folder import with_copies
from pldf.analysis.problems import StudyError
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE
from pldf.recordings.recording import Recording, write_recording

ACTING = ("A1", "A2", "B1", "B2")
PEOPLE = ("P1", "P2", "P3", "P4")


def share(who: int, phase: str) -> float:
    """The pedal rate of a drive, all different."""
    return 0.3 + 0.02 * who + 0.003 * ACTING.index(phase) - (0.2 if phase[0] == "B" else 0.0)


def table(folder: Path) -> Path:
    lines = ["participant,phase,pedal_rate,set_speed_rate,combined_rate"]
    for at, who in enumerate(PEOPLE):
        lines += [f"{who},{p},{share(at, p)!r},0.0,{share(at, p)!r}" for p in ACTING]
    path = folder / "drives.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


def recordings(folder: Path) -> Path:
    """The same drives as recordings of 1000 rows."""
    (folder / "recordings").mkdir()
    time = 0.1 * np.arange(1001.0)
    for at, who in enumerate(PEOPLE):
        for phase in ACTING:
            gas = np.arange(1001) < round(1000 * share(at, phase))
            columns = {
                "time_s": time, "s_m": 20.0 * time, "speed_mps": 20.0 + 0.0 * time,
                "mode": np.where(gas, float(GAS_OVERRIDE), float(ACTIVE)),
                "brake_pedal": 0.0 * time, "set_speed_offset_mps": 0.0 * time,
            }  # fmt: skip
            write_recording(folder / "recordings" / f"{who}_{phase}.csv", Recording(columns))
    return folder / "recordings"


def exclude(folder: Path, *rows: str) -> None:
    (folder / "exclusions.csv").write_text("\n".join(("participant,phase,reason", *rows)) + "\n")


def problems(study: StudyFolder) -> list[str]:
    with pytest.raises(StudyError) as refused:
        analyse(study)
    assert all(finding.severity == "error" for finding in refused.value.findings)
    return [str(finding) for finding in refused.value.findings]


def pedal(found: Analysis, system: str) -> dict[str, float]:
    return dict(
        zip(found.participants, found.per_participant("pedal", system).tolist(), strict=True)
    )


@pytest.mark.parametrize("kind", [table, recordings])
def test_a_drive_left_out_leaves_the_mean_of_the_others(tmp_path: Path, kind: object) -> None:
    (table if kind is table else recordings)(tmp_path)
    exclude(tmp_path, "P2,B1,simulator sickness", "P3,,fell asleep", "P4,A1,brake pedal broken")
    found = analyse(StudyFolder(tmp_path))
    assert found.participants == ("P1", "P2", "P4")
    assert pedal(found, "B")["P2"] == pytest.approx(share(1, "B2"), abs=1e-9)
    assert pedal(found, "A")["P4"] == pytest.approx(share(3, "A2"), abs=1e-9)
    mean = (share(0, "B1") + share(0, "B2")) / 2.0
    assert pedal(found, "B")["P1"] == pytest.approx(mean, abs=1e-9)
    assert [(one.what, one.reason) for one in found.exclusions] == [
        ("P2 B1", "simulator sickness"), ("P3", "fell asleep"), ("P4 A1", "brake pedal broken"),
    ]  # fmt: skip
    told = [(note.severity, note.text) for note in found.notes]
    assert ("note", "B1 left out, so B is the mean of B2") in told
    assert ("note", "A1 left out, so A is the mean of A2") in told


def test_who_has_no_drive_left_with_a_system_leaves_the_study(tmp_path: Path) -> None:
    table(tmp_path)
    exclude(tmp_path, "P2,B1,sick", "P2,B2,gave up")
    (tmp_path / "questionnaire.csv").write_text(
        "participant,system,laan_2,laan_4,laan_6,laan_8\n"
        + "".join(f"{who},{s},2,2,4,{5 if s == 'B' else 4}\n" for who in PEOPLE for s in "AB")
    )
    found = analyse(StudyFolder(tmp_path))
    assert found.participants == ("P1", "P3", "P4")
    assert {drive.participant for drive in found.drives} == {"P1", "P3", "P4"}
    assert found.comparisons["satisfying"].people == 3
    (warning,) = [note for note in found.notes if note.severity == "warning"]
    assert warning.place == "participant P2"
    assert "no drive with system B is left (B1, B2 left out)" in warning.text


def test_an_absent_drive_may_be_said_to_be_absent(tmp_path: Path) -> None:
    path = recordings(tmp_path)
    (path / "P2_B1.csv").unlink()
    assert "participant P2 has no drive B1" in problems(StudyFolder(tmp_path))[0]
    exclude(tmp_path, "P2,B1,simulator broke down")
    found = analyse(StudyFolder(tmp_path))
    assert pedal(found, "B")["P2"] == pytest.approx(share(1, "B2"), abs=1e-9)


@pytest.mark.parametrize("without", ["P2", "P2_B1", "p2 _b1"])
def test_without_takes_participants_and_drives(tmp_path: Path, without: str) -> None:
    table(tmp_path)
    found = analyse(StudyFolder(tmp_path, without=frozenset({without})))
    assert ("P2" in found.participants) == (without != "P2")
    if without != "P2":
        assert pedal(found, "B")["P2"] == pytest.approx(share(1, "B2"))
    assert found.exclusions[0].source == "--without"


@pytest.mark.parametrize("listed", [True, False])
def test_files_with_bad_names_or_contents_can_be_left_out(tmp_path: Path, listed: bool) -> None:
    path = recordings(tmp_path)
    (path / "P2-B1 (copy).csv").write_text("no recording")
    (path / "P3_B1.csv").write_bytes(b"\x00\x01\x02")
    names = ["P2-B1 (copy)", "P3_B1"]
    told = problems(StudyFolder(tmp_path))
    assert len(told) == 2
    assert any("P2-B1 (copy).csv: not named PARTICIPANT_PHASE" in one for one in told)
    assert any("P3_B1.csv" in one for one in told)
    without = frozenset() if listed else frozenset(names)
    if listed:
        exclude(tmp_path, *(f"{name},,bad file" for name in names))
    found = analyse(StudyFolder(tmp_path, without=without))
    assert found.participants == PEOPLE
    assert pedal(found, "B")["P3"] == pytest.approx(share(2, "B2"), abs=1e-9)


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    path = recordings(tmp_path)
    (path / "P1_C1.csv").write_text("x")
    (path / "nobody.csv").write_text("x")
    (path / "P2_A1.csv").write_text("time_s,s_m\n1,2\n")
    (path / "P3_B2.csv").unlink()
    text = (path / "P4_B1.csv").read_text()
    (path / "P4_B1.csv").write_text(text.replace("20.0", "fast", 3))
    (tmp_path / "questionnaire.csv").write_text("participant,system,laan_2\nP1,A,7\n")
    told = problems(StudyFolder(tmp_path))
    for wrong in ("P1_C1.csv", "nobody.csv", "P2_A1.csv", "P3 has no drive B2", "P4_B1.csv, line 2",
                  "P4_B1.csv, line 3", "questionnaire.csv"):  # fmt: skip
        assert any(wrong in one for one in told), wrong
    assert not any("P2 has no drive" in one or "P4 has no drive" in one for one in told)


def test_names_that_differ_in_case_or_blanks_are_one_and_told(tmp_path: Path) -> None:
    path = recordings(tmp_path)
    (path / "P2_B1.csv").rename(path / "p 2_B1.csv")
    exclude(tmp_path, "p3,b1,sick".replace("b1", "B1"))
    (tmp_path / "questionnaire.csv").write_text(
        "participant,system,laan_2,laan_4,laan_6,laan_8\n"
        + "".join(f"{who},{s},2,2,4,4\n" for who in ("P1", "p2", "P3", "P 4") for s in "AB")
    )
    found = analyse(StudyFolder(tmp_path))
    assert found.participants == PEOPLE
    assert found.comparisons["satisfying"].people == 4
    assert pedal(found, "B")["P2"] == pytest.approx((share(1, "B1") + share(1, "B2")) / 2, abs=1e-9)
    assert pedal(found, "B")["P3"] == pytest.approx(share(2, "B2"), abs=1e-9)
    told = [note.text for note in found.notes if note.severity == "warning"]
    assert len(told) == 3
    assert "'p 2' and 'P2'" in told[0]
    (path / "p1_A1.csv").write_bytes((path / "P1_A1.csv").read_bytes())
    (again,) = problems(StudyFolder(tmp_path))
    assert "p1_A1.csv: the same drive as" in again


def test_an_exclusion_of_nobody_and_one_without_a_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table(tmp_path)
    exclude(tmp_path, "P7,,never came")
    assert main(["analyse", str(tmp_path), "--without", "P8"]) == 0
    told = capsys.readouterr().err
    assert "exclusions.csv, line 2: there is no participant P7" in told
    assert "--without: there is no participant P8" in told
    exclude(tmp_path, "P1,,", "P2,C1,sick", ",A1,sick")
    assert main(["analyse", str(tmp_path)]) == 1
    told = capsys.readouterr().err
    for wrong in ("line 2, participant P1, reason", "line 3", "line 4"):
        assert wrong in told


def test_files_and_drives_that_count_nowhere_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = recordings(tmp_path)
    (path / "P5_A1.xlsx").write_bytes(b"PK")
    (path / ".DS_Store").write_bytes(b"")
    (path / "P1_A4.csv").write_bytes((path / "P1_A1.csv").read_bytes())
    told = [str(note) for note in analyse(StudyFolder(tmp_path)).notes]
    assert len(told) == 2
    assert "P5_A1.xlsx: not read: no recording ends in .xlsx" in told[0]
    assert "A4 are none of the study's drives, A1, A2, A3, B1, B2, B3" in told[1]

    only = tmp_path / "rates"
    only.mkdir()
    table(only)
    assert main(["analyse", str(only), "--report", str(only / "report.html")]) == 0
    assert "no road was named, so the report shows the study road" in capsys.readouterr().err


@pytest.mark.parametrize(("gas", "copies"), [(0.0, 0), (0.2, 1)])
def test_equal_drives_are_copies_unless_nobody_did_anything(
    tmp_path: Path, gas: float, copies: int
) -> None:
    time = 0.1 * np.arange(101.0)
    columns = {
        "time_s": time, "s_m": 20.0 * time, "speed_mps": 20.0 + 0.0 * time,
        "mode": np.full(101, float(ACTIVE)), "gas_pedal": np.full(101, gas),
        "brake_pedal": 0.0 * time, "set_speed_offset_mps": 0.0 * time,
    }  # fmt: skip
    paths = [tmp_path / f"{who}_A3.csv" for who in ("P1", "P2")]
    for path in paths:
        write_recording(path, Recording(columns))
    files = list(with_copies([check_file(path, Known()) for path in paths]))
    told = [one for file in files for one in file.findings if "under another name" in one.text]
    assert len(told) == copies
