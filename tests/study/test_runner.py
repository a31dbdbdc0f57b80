"""Running a study: the same bytes wherever and however often interrupted, nothing driven twice."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from laboratory import files
from pldf import cli
from pldf.analysis.drives_table import read_drives
from pldf.build_version import build_version
from pldf.recordings.recording import read_recording
from pldf.study.drive_row import COLUMNS
from pldf.study.participants import Participant
from pldf.study.participants_file import read_participants
from pldf.study.results import StudyResults
from pldf.study.runner import ResultStream, in_processes, run_missing
from pldf.study.study_file import Study, read_study
from pldf.study.unit import Job, ParticipantResult, do_unit
from small_study import COUNT, opened, write_study

CROWD = 150  # so many that a study of them can be interrupted in the middle


def test_what_is_written(finished: Path, expected: dict[str, bytes]) -> None:
    out = finished / "one"
    recordings = {f"recordings/P002_{phase}.csv" for phase in ("A2", "B1")}
    (profile,) = (name for name in expected if name.startswith("profiles/"))
    assert set(expected) == {
        "drives.csv", "participants.csv", "study.toml", "versions.json", profile, *recordings,
    }  # fmt: skip
    assert expected["study.toml"] == (finished / "small.toml").read_bytes()
    assert expected["drives.csv"].decode().splitlines()[0] == ",".join(COLUMNS)
    drives = read_drives(out / "drives.csv")
    assert [(d.participant, d.phase, d.position) for d in drives] == [
        (f"P{k:03d}", phase, position)
        for k in range(1, COUNT + 1)
        for position, phase in enumerate(("A2", "B1"), start=1)
    ]
    assert all(drive.combined_rate > 0.0 for drive in drives if drive.phase == "A2")
    recording = read_recording(out / "recordings" / "P002_A2.csv")
    assert recording["time_s"][-1] == drives[2].duration_s
    assert read_participants(out / "participants.csv")[1].seed == (
        read_study(finished / "small.toml").participants[1].seed
    )
    versions = json.loads(expected["versions.json"])
    assert versions["parameters"]["pldf"]["learning.stretch_factor"] == 0.5
    assert not any("time" in name or "date" in name for name in versions)
    assert cli.main(["profiles", "show", str(out / profile)]) == 0


def test_more_processes_give_the_same_bytes(
    finished: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    arguments = ["study", str(finished / "small.toml"), "--out", str(tmp_path / "two")]
    assert cli.main([*arguments, "--jobs", "2"]) == 0
    assert files(tmp_path / "two") == expected


def test_the_fmus_give_the_same_bytes(fmu_folder: Path, tmp_path: Path) -> None:
    study = write_study(tmp_path, count=2)
    text = study.read_text().replace('"A2", "B1"', '"A2"').replace("0.05", "0.1")
    study.write_text(text)
    for out, more in (("kernels", []), ("fmus", ["--fmu", "python", "--fmus", str(fmu_folder)])):
        assert (
            cli.main(["study", str(study), "--out", str(tmp_path / out), "--jobs", "2", *more]) == 0
        )
    one, other = files(tmp_path / "kernels"), files(tmp_path / "fmus")
    through = json.loads(other.pop("versions.json"))["through"]
    assert through == f"Python FMU, version {build_version()}"
    assert json.loads(one.pop("versions.json"))["through"] == "kernels"
    assert one == other


def test_missing_fmus_leave_nothing_behind(
    finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["study", str(finished / "small.toml"), "--out", str(tmp_path / "out")]
    assert cli.main([*arguments, "--fmu", "python", "--fmus", str(tmp_path)]) == 1
    assert "no Python FMUs are there" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def interrupted_after(count: int) -> Callable[[Job, list[Participant]], ResultStream]:
    def run(job: Job, participants: list[Participant]) -> ResultStream:
        for one in participants[:count]:
            yield do_unit(job, one)
        raise KeyboardInterrupt

    return run


def test_an_interrupted_study_goes_on_where_it_was(
    study: Study, expected: dict[str, bytes], tmp_path: Path
) -> None:
    driven: list[str] = []

    def note(done: ParticipantResult) -> None:
        driven.append(done.participant)

    for count in (2, 0, 3):
        folder = opened(study, tmp_path / "out")
        with pytest.raises(KeyboardInterrupt):
            run_missing(folder, Job(study.settings), interrupted_after(count), note)
        assert not folder.complete
        assert len(folder.missing()) == COUNT - len(driven)
    folder = opened(study, tmp_path / "out")
    run_missing(folder, Job(study.settings), in_processes(1), note)
    assert sorted(driven) == [one.id for one in study.participants]
    assert files(tmp_path / "out") == expected
    # Nothing is left to do.
    run_missing(opened(study, tmp_path / "out"), Job(study.settings), interrupted_after(0), note)
    assert files(tmp_path / "out") == expected


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def begun(arguments: list[str], out: Path, on_ctrl_c: signal.Handlers) -> subprocess.Popen[str]:
    """Return the process of a study that has begun, whatever Ctrl-C does to this one."""
    before = signal.signal(signal.SIGINT, on_ctrl_c)  # inherited
    try:
        process = subprocess.Popen(
            [sys.executable, "-m", "pldf.cli", *arguments, "2"],
            stderr=subprocess.PIPE, text=True, start_new_session=True,
        )  # fmt: skip
    finally:
        signal.signal(signal.SIGINT, before)
    wait_for(lambda: len(list(out.glob("parts/*.json"))) > 2)
    return process


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_where_ctrl_c_is_ignored_a_study_lives_through_it(tmp_path: Path) -> None:
    """As with nohup, and in a script's background."""
    study, out = write_study(tmp_path, count=COUNT), tmp_path / "out"
    process = begun(["study", str(study), "--out", str(out), "--jobs"], out, signal.SIG_IGN)
    os.killpg(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert (process.returncode, told) == (0, "")
    assert (out / "drives.csv").exists()


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_ctrl_c_and_a_killed_study_lose_nothing(how: signal.Signals, tmp_path: Path) -> None:
    study = write_study(tmp_path, count=CROWD)
    out = tmp_path / "out"
    arguments = ["study", str(study), "--out", str(out), "--jobs"]
    process = begun(arguments, out, signal.SIG_DFL)
    os.killpg(process.pid, how)
    _, told = process.communicate(timeout=60)
    kept = {path: path.stat().st_mtime_ns for path in out.glob("parts/P*.json")}
    assert 2 < len(kept) < CROWD
    if how == signal.SIGINT:
        assert process.returncode == 130
        assert told.splitlines() == [
            f"pldf: {len(kept)} of {CROWD} participants are done; "
            "the same command goes on with the others",
            "pldf: interrupted",
        ]
    folder = StudyResults(read_study(study), out)
    assert len(folder.missing()) == CROWD - len(kept)
    assert cli.main([*arguments, "1"]) == 0
    with (out / "drives.csv").open() as file:
        drives = [(row["participant"], row["phase"]) for row in csv.DictReader(file)]
    assert drives == [(f"P{k:03d}", phase) for k in range(1, CROWD + 1) for phase in ("A2", "B1")]
    assert not (out / "parts").exists()


def test_a_failing_drive_stops_the_study_with_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "people.csv").write_text("seed\n1\n2\n")
    study = tmp_path / "stuck.toml"
    study.write_text(
        '[participants]\nfile = "people.csv"\n[vehicle]\n"body.force_max_n" = 1.0\n'
        "start_speed_mps = 1.0\n[drives]\nstep_s = 0.1\n"
    )
    assert cli.main(["study", str(study), "--out", str(tmp_path / "out"), "--jobs", "2"]) == 1
    told = capsys.readouterr().err
    assert "drive A1 was given up: the vehicle stood still for 60 s" in told
    assert told.count("\n") == 1
