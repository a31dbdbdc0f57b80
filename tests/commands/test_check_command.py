"""``pldf check``: what files are, what is wrong with them, all of it at once."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pldf.analysis.checks import check_folder
from pldf.analysis.checks.kinds import kind_of
from pldf.analysis.checks.names import looks_like_a_person
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.profiles.store import StoredProfile, write_profile
from pldf.recordings.recording import Recording, read_recording, write_recording
from pldf.roads.load import DATA
from pldf.study.study_file import PACKAGED
from sample_recording import sample_recording

from vehicle_models.driver_script import SCRIPTS
from vehicle_models.lead_script import TRAFFIC_SCRIPTS

EXAMPLES = Path(__file__).parents[2] / "examples"
PHASES = ("A1", "A2", "B1", "B2")
RATES = "participant,phase,pedal_rate,set_speed_rate,combined_rate\n"

Change = Callable[[Recording], Recording]
Capture = pytest.CaptureFixture[str]


def with_columns(recording: Recording, **columns: Any) -> Recording:
    return Recording({**recording.columns, **columns})


def laboratory(folder: Path, people: tuple[str, ...] = ("P01", "P02")) -> Path:
    """A study of people: each drive is another one."""
    (folder / "recordings").mkdir(parents=True)
    for number, person in enumerate(people):
        for at, phase in enumerate(PHASES):
            recording = sample_recording()
            shift = 0.01 * (len(PHASES) * number + at)
            changed = with_columns(recording, speed_mps=recording["speed_mps"] + shift)
            write_recording(folder / "recordings" / f"{person}_{phase}.csv", changed)
    return folder


def change(path: Path, new: Change) -> None:
    write_recording(path, new(read_recording(path)))


def found(*arguments: str | Path, capsys: Capture) -> tuple[int, dict[str, Any]]:
    status = main(["check", "--json", *map(str, arguments)])
    return status, json.loads(capsys.readouterr().out)


def test_everything_that_the_project_ships_is_recognised_and_without_fault(
    tmp_path: Path, capsys: Capture
) -> None:
    profile = tmp_path / "own.pldf"
    write_profile(profile, StoredProfile(1, "0" * 16, np.full(20, 10.0)))
    answers = tmp_path / "answers.csv"
    answers.write_text("participant,system,laan_1\n", encoding="utf-8")
    kinds = {
        "road": [*DATA.glob("*.xodr"), *DATA.glob("*.csv"), EXAMPLES / "my_road.csv"],
        "recording": [EXAMPLES / "my_recording.csv"],
        "driver script": [*SCRIPTS.glob("*.csv")],
        "traffic script": [*TRAFFIC_SCRIPTS.glob("*.csv")],
        "study file": [*PACKAGED.glob("*.toml")],
        "profile": [profile],
        "mapping file": [*(EXAMPLES / "surveys").glob("*.toml")],
    }
    paths = [path for same in kinds.values() for path in same]
    status, report = found(*paths, capsys=capsys)
    assert [(file["file"], file["kind"]) for file in report["files"]] == [
        (str(path), kind) for kind, same in kinds.items() for path in same
    ]
    assert (status, report["counts"]["error"], report["counts"]["warning"]) == (0, 0, 0)
    assert kind_of(answers) == "questionnaire"


def test_every_problem_of_every_file_is_told_in_one_run(tmp_path: Path, capsys: Capture) -> None:
    study = laboratory(tmp_path / "study")
    recordings = study / "recordings"
    change(recordings / "P01_A1.csv", lambda r: with_columns(r, speed_mps=3.6 * r["speed_mps"]))
    hole = np.r_[0:400, 430:1000]
    change(
        recordings / "P01_A2.csv", lambda r: Recording({n: v[hole] for n, v in r.columns.items()})
    )
    shutil.copy(recordings / "P01_B1.csv", recordings / "P01_B2.csv")
    text = (recordings / "P02_A1.csv").read_text(encoding="utf-8").splitlines()
    text[7] = text[7].replace("ACTIVE", "ACTIV")
    text[9] = text[9].replace("ACTIVE", "AKTIV")
    (recordings / "P02_A1.csv").write_text("\n".join(text), encoding="utf-8")
    half = np.r_[0:500]
    change(
        recordings / "P02_A2.csv", lambda r: Recording({n: v[half] for n, v in r.columns.items()})
    )
    status, report = found(study, capsys=capsys)
    told = [
        (one["severity"], Path(one["file"]).name, one["line"], one["place"])
        for one in report["findings"]
    ]
    assert status == 1
    assert ("error", "P01_A1.csv", 0, "speed_mps") in told
    assert ("error", "P02_A1.csv", 8, "mode") in told
    assert ("error", "P02_A1.csv", 10, "mode") in told
    assert ("warning", "P01_A2.csv", 0, "") in told
    assert ("warning", "P01_B2.csv", 0, "") in told
    assert ("warning", "P02_A2.csv", 0, "s_m") in told
    assert told == sorted(told, key=lambda one: ("error", "warning", "note").index(one[0]))
    assert len(told) == len(set(told))
    assert all(one["text"] for one in report["findings"])
    texts = " ".join(one["text"] for one in report["findings"])
    assert "a drop-out of more than 1.5 s: 3.1 s at 39.9 s (798 to 860 m)" in texts
    assert "the samples of P01_B1.csv under another name" in texts
    assert "998 m, 50 % of the 1998 m of the other drives" in texts
    lost = {Path(f["file"]).name: f["quality"]["lost_m"] for f in report["files"] if "quality" in f}
    assert lost["P01_A2.csv"] == pytest.approx(62.0)
    assert lost["P01_B1.csv"] == 0.0


def test_a_sound_study_is_without_errors_and_warnings(tmp_path: Path, capsys: Capture) -> None:
    status, report = found(laboratory(tmp_path / "study"), capsys=capsys)
    assert status == 0
    assert (report["counts"]["error"], report["counts"]["warning"]) == (0, 0)
    drives = [(f["participant"], f["phase"]) for f in report["files"] if "participant" in f]
    assert drives == [(who, phase) for who in ("P01", "P02") for phase in PHASES]
    quality = report["files"][0]["quality"]
    assert quality["rate_hz"] == pytest.approx(10.0)
    assert quality["duration_s"] == pytest.approx(99.9)
    assert quality["coverage"] is None and quality["holes"] == []


def test_what_concerns_the_files_together_is_told_beside_what_is_in_them(
    tmp_path: Path, capsys: Capture
) -> None:
    study = laboratory(tmp_path / "study")
    (study / "recordings" / "P02_B2.csv").unlink()
    (study / "questionnaire.csv").write_text("participant,laan_1\nP01,9\n", encoding="utf-8")
    status, report = found(study, capsys=capsys)
    texts = " ".join(one["text"] for one in report["findings"])
    assert status == 1
    assert "participant P02 has no drive B2" in texts
    assert any(Path(one["file"]).name == "questionnaire.csv" for one in report["findings"])


def test_plain_lines_say_severity_place_consequence_and_way_out(
    tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "drive.csv"
    recording = sample_recording()
    write_recording(path, with_columns(recording, speed_mps=3.6 * recording["speed_mps"]))
    assert main(["check", str(path)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(f"error: {path}, speed_mps: speed_mps is 3.6")
    assert "every speed, position or duration would be wrong" in lines[0]
    assert 'speed_mps = { column = "speed_mps", unit = "km/h" }' in lines[0]
    assert lines[-1] == "1 error, 0 warnings, 0 notes in 1 file."


def test_the_map_that_the_way_out_names_resolves_it(tmp_path: Path, capsys: Capture) -> None:
    path, mapping = tmp_path / "drive.csv", tmp_path / "kmh.toml"
    recording = sample_recording()
    write_recording(path, with_columns(recording, speed_mps=3.6 * recording["speed_mps"]))
    mapping.write_text(
        '[recording]\nspeed_mps = { column = "speed_mps", unit = "km/h" }\n', encoding="utf-8"
    )
    status, report = found(path, "--map", mapping, capsys=capsys)
    assert (status, report["counts"]["error"]) == (0, 0)


def test_files_that_are_nothing_known_and_folders_without_any(
    tmp_path: Path, capsys: Capture
) -> None:
    (tmp_path / "picture.png").write_bytes(b"\x89PNG")
    status, report = found(tmp_path / "picture.png", tmp_path / "none.csv", capsys=capsys)
    assert status == 1
    assert [one["severity"] for one in report["findings"]] == ["error", "error"]
    assert main(["check", str(tmp_path)]) == 1
    assert "neither a study" in capsys.readouterr().err


def test_copies_are_told_in_any_folder(tmp_path: Path, capsys: Capture) -> None:
    write_recording(tmp_path / "one.csv", sample_recording())
    write_recording(tmp_path / "two.csv", sample_recording())
    write_recording(tmp_path / "three.csv", sample_recording(0.1))
    _, report = found(tmp_path, capsys=capsys)
    copies = [one for one in report["findings"] if "under another name" in one["text"]]
    assert [Path(one["file"]).name for one in copies] == ["two.csv"]


def test_a_road_tells_what_is_wrong_and_what_is_not(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "road.csv"
    path.write_text(
        "s_m,curvature_per_m,speed_limit_mps\n0,0,20\n10,x,20\n20,0,y\n", encoding="utf-8"
    )
    status, report = found(path, capsys=capsys)
    assert status == 1
    assert [one["line"] for one in report["findings"]] == [3, 4]


CODES = ("P01", "VP_12", "S3", "x7Gk2", "KXQZ", "sub-01", "Proband 3", "ANMU0412", "driver", "7")
PEOPLE = (
    "anna.mueller",
    "Mueller, Anna",
    "Anna",
    "anna.mueller2",
    "ANNA MUELLER",
    "a@b.de",
    "王芳",
)


@pytest.mark.parametrize("name", CODES)
def test_codes_are_no_people(name: str) -> None:
    assert not looks_like_a_person(name)


@pytest.mark.parametrize("name", PEOPLE)
def test_names_of_people_are_told(name: str) -> None:
    assert looks_like_a_person(name)


def test_a_study_with_names_says_to_use_codes(tmp_path: Path) -> None:
    checks = check_folder(StudyFolder(laboratory(tmp_path / "s", ("anna.mueller", "P02"))))
    (warning,) = checks.of("warning")
    assert "'anna.mueller' looks like the name of a person" in warning.text
    assert "codes such as P01" in warning.way_out


def test_analyse_refuses_with_all_errors_and_tells_warnings(
    tmp_path: Path, capsys: Capture
) -> None:
    study = laboratory(tmp_path / "study")
    recordings = study / "recordings"
    change(recordings / "P02_A2.csv", lambda r: Recording(rows(r, np.r_[0:400, 430:1000])))
    assert main(["analyse", str(study)]) == 0
    assert "warning: " in (said := capsys.readouterr().err)
    assert "a drop-out of more than 1.5 s" in said
    change(recordings / "P01_A1.csv", lambda r: with_columns(r, speed_mps=3.6 * r["speed_mps"]))
    change(recordings / "P01_A2.csv", lambda r: with_columns(r, speed_mps=2.237 * r["speed_mps"]))
    (recordings / "P02_B2.csv").unlink()
    assert main(["analyse", str(study)]) == 1
    said = capsys.readouterr().err
    assert "P01_A1.csv, speed_mps: " in said and "speed_mps in km/h?" in said
    assert "P01_A2.csv, speed_mps: " in said and "speed_mps in mph?" in said
    assert "participant P02 has no drive B2" in said


def test_what_is_left_out_is_not_checked(tmp_path: Path, capsys: Capture) -> None:
    study = laboratory(tmp_path / "study", ("P01", "P02", "P03"))
    broken = study / "recordings" / "P03_A1.csv"
    broken.write_text("nothing", encoding="utf-8")
    assert found(study, capsys=capsys)[0] == 1
    assert found(study, "--without", "P03", capsys=capsys)[0] == 0
    (study / "exclusions.csv").write_text("participant,reason\nP03,sick\n", encoding="utf-8")
    assert found(study, capsys=capsys)[0] == 0


def test_a_simulated_study_knows_its_road_and_has_no_finding(
    tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "two.toml"
    file.write_text(
        '[participants]\ncount = 2\nseed = 3\n[recordings]\nparticipants = "all"\n'
        "[drives]\nstep_s = 0.05\n",
        encoding="utf-8",
    )
    assert main(["study", str(file), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    capsys.readouterr()
    status, report = found(tmp_path / "out", capsys=capsys)
    assert (status, report["counts"]["error"], report["counts"]["warning"]) == (0, 0, 0)
    qualities = [file["quality"] for file in report["files"] if "quality" in file]
    assert len(qualities) == 12
    assert all(quality["coverage"] == pytest.approx(1.0, abs=0.01) for quality in qualities)
    kinds = {Path(file["file"]).name: file["kind"] for file in report["files"]}
    assert kinds["study.toml"] == "study file"
    assert kinds["drives.csv"] == "drives"
    assert kinds["participants.csv"] == "participants"


def rows(recording: Recording, kept: Any) -> dict[str, Any]:
    return {name: values[kept] for name, values in recording.columns.items()}


def test_part_of_the_road_is_a_note_of_a_drive_and_a_warning_of_a_study(
    tmp_path: Path, capsys: Capture
) -> None:
    road = tmp_path / "road.csv"
    road.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,25\n4000,0,25\n", encoding="utf-8")
    study = laboratory(tmp_path / "study")
    _, report = found(study / "recordings" / "P01_A1.csv", "--route", road, capsys=capsys)
    (note,) = report["findings"]
    assert note["severity"] == "note" and "covers 50 % of the road" in note["text"]
    _, report = found(study, "--route", road, capsys=capsys)
    assert report["counts"]["warning"] > 0
    assert all("covers 50 %" in w["text"] for w in report["findings"] if w["severity"] == "warning")


def test_many_recordings_have_one_line_and_few_have_one_each(
    tmp_path: Path, capsys: Capture
) -> None:
    study = laboratory(tmp_path / "study", ("P01", "P02", "P03"))
    assert main(["check", str(study)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "12 recordings: 99.9 s at 10 Hz, 0 drop-outs of 0 m in all" in lines
    one = study / "recordings" / "P01_A1.csv"
    assert main(["check", str(one)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"{one}: 100 s at 10 Hz, 0 to 1998 m, 0 drop-outs",
        "0 errors, 0 warnings, 0 notes in 1 file.",
    ]


def test_a_line_that_an_error_names_is_the_line_of_the_finding(
    tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "study.toml"
    path.write_text('title = "t"\n[participants]\ncount = "many"\n', encoding="utf-8")
    status, report = found(path, capsys=capsys)
    (finding,) = report["findings"]
    assert (status, finding["line"], finding["place"]) == (1, 3, "participants.count")


def test_a_network_in_which_no_way_is_named_is_no_error(tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "town.xodr"
    road = (
        '<road id="{0}" length="90" junction="-1"><type s="0" type="town">{1}</type><planView>'
        '<geometry s="0" x="0" y="{0}" hdg="0" length="90"><line/></geometry></planView></road>'
    )
    speed = '<speed max="50" unit="km/h"/>'
    path.write_text(f"<OpenDRIVE>{road.format(1, speed)}{road.format(2, '')}</OpenDRIVE>")
    status, told = found(path, "--no-asam", capsys=capsys)
    (note,) = told["findings"]
    assert (status, note["severity"]) == (0, "note")
    assert "--start-road 1" in note["text"]
    assert "not checked" in note["consequence"]
    status, told = found(path, "--no-asam", "--start-road", "1", capsys=capsys)
    assert (status, told["findings"][0]["text"][:14]) == (0, "a road of 90 m")
    # What is wrong on a way that was named, is.
    assert found(path, "--no-asam", "--start-road", "2", capsys=capsys)[0] == 1
