"""``pldf learn``: what it says and writes where; nobody's history is lost."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pldf import cli
from pldf.commands import learn
from pldf.profiles.store import continue_profile, read_profile, rollback_profile
from pldf.recordings.recording import Recording, write_recording
from profile_examples import drive_result
from sample_recording import sample_recording
from told_drive import driven, told_recording, write_road

Run = Callable[..., tuple[int, str]]

ROAD = "s_m,curvature_per_m,speed_limit_mps\n0,0,25\n2000,0,25\n"


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Return a function that runs ``pldf learn`` on one recording, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    recording = tmp_path / "recording.csv"
    whole = sample_recording().columns  # its profile is none of the road's
    write_recording(recording, Recording({n: v for n, v in whole.items() if n != "profile_mps"}))
    Path("road.csv").write_text(ROAD, encoding="utf-8")

    def runner(*arguments: str) -> tuple[int, str]:
        given = ["--route", "road.csv", "--recording", str(recording), *arguments]
        status = cli.main(["learn", *given])
        return status, capsys.readouterr().err

    return runner


def learned(capsys: pytest.CaptureFixture[str], tmp_path: Path, *more: str) -> str:
    """Return what learning from the drive with a bit of everything prints."""
    road = write_road(tmp_path)
    write_recording(tmp_path / "told.csv", told_recording(road))
    given = ["--route", str(road), "--recording", str(tmp_path / "told.csv")]
    assert cli.main(["learn", *given, "--out", str(tmp_path / "told.pldf"), *more]) == 0
    return capsys.readouterr().out


def test_it_says_of_each_intervention_what_the_log_of_an_fmu_says(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    made = driven(write_road(tmp_path))
    said = [message.text for message in made.messages if message.level == "info"]
    lines = learned(capsys, tmp_path).splitlines()
    assert lines[0].startswith("Rates: ")
    assert [line[0].lower() + line[1:] for line in lines[1:-1]] == said
    assert lines[-1].startswith("Iteration 1 written to ")


def test_json_says_it_in_numbers(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    report = json.loads(learned(capsys, tmp_path, "--json"))
    assert report.keys() >= {"iteration", "rates", "interventions", "segments", "offsets"}
    entries = report["interventions"]
    kinds = ["learned", "learned", "hole", "stop", "not_moved", "not_eligible"]
    kinds += ["following", "following"]  # behind the lead, and before the car had caught up
    assert [entry["outcome"] for entry in entries] == kinds
    for entry in entries:
        assert ("why_not" in entry) == (entry["outcome"] != "learned")
        assert entry.get("why_not", "") in entry["told"]
        assert entry["number"] == entries.index(entry) + 1
    assert entries[2]["hole_m"] == pytest.approx(50.0, abs=1.0)
    assert entries[-1]["truncated"] and not entries[0]["truncated"]
    (legal,) = (held for held in entries[1]["held"] if held["bound"] == "legal_limit")
    assert (legal["from_m"], legal["to_m"]) == (1200.0, 1240.0)
    assert legal["low_mps"] == legal["high_mps"] == pytest.approx(70.0 / 3.6)
    assert entries[1]["learned_from_m"] < 1050.0
    assert entries[1]["learned_to_m"] > 1300.0
    assert 0.0 < entries[1]["mean_change_mps"] < entries[1]["largest_change_mps"]
    assert [series["outcome"] for series in report["set_speeds"]] == [
        "taken_back", "learned", "not_eligible", "learned",
    ]  # fmt: skip
    cut = report["set_speeds"][-1]
    assert cut["held_by"] == "legal_limit"
    assert (cut["wish_mps"], cut["offset_mps"]) == pytest.approx((35.0 / 3.6, 20.0 / 3.6))
    assert report["plan_held"]


def test_a_profile_is_continued_in_its_own_file(run: Run) -> None:
    assert run("--out", "a.pldf") == (0, "")
    assert run("--profile-in", "a.pldf", "--out", "a.pldf") == (0, "")
    assert [i.kind for i in read_profile("a.pldf").iterations] == ["learn", "learn"]


@pytest.mark.parametrize("by", ["another drive", "a rollback"])
def test_what_others_write_meanwhile_is_not_lost(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, by: str
) -> None:
    run("--out", "a.pldf")
    really_read = learn.read_recording

    def meanwhile(path: str, mapping: object) -> object:
        profile = read_profile("a.pldf")
        if by == "a rollback":
            rollback_profile("a.pldf", 0)
        else:
            continue_profile("a.pldf", profile.with_iteration(drive_result(profile)))
        return really_read(path, mapping)

    monkeypatch.setattr(learn, "read_recording", meanwhile)
    status, told = run("--profile-in", "a.pldf", "--out", "a.pldf")
    assert status == 1
    assert "changed by another process" in told
    assert "what was learned is kept in" in told and "a.conflict-1.pldf" in told
    kinds = [i.kind for i in read_profile("a.pldf").iterations]
    assert kinds == ["learn", "drive" if by == "another drive" else "rollback"]
    assert [i.kind for i in read_profile("a.conflict-1.pldf").iterations] == ["learn", "learn"]


@pytest.mark.parametrize("other", ["driver", "history"])
def test_another_history_is_overwritten_by_force_only_and_kept(run: Run, other: str) -> None:
    more = ("--set", "driver_id=2") if other == "driver" else ("--set", "learning.speed_min_mps=25")
    run("--out", "a.pldf")
    run("--profile-in", "a.pldf", "--out", "a.pldf")
    before = Path("a.pldf").read_bytes()
    status, told = run("--out", "a.pldf", *more)
    assert status == 1
    assert "a.pldf: holds driver" in told
    assert "with 2 iterations" in told and "not overwritten" in told and "--force" in told
    assert Path("a.pldf").read_bytes() == before
    status, told = run("--out", "a.pldf", "--force", *more)
    assert status == 0 and "a.pldf.replaced-1" in told
    assert Path("a.pldf.replaced-1").read_bytes() == before
    assert len(read_profile("a.pldf").iterations) == 1


def test_a_drive_that_followed_another_profile_is_warned_of(run: Run, tmp_path: Path) -> None:
    write_recording(tmp_path / "recording.csv", sample_recording())
    status, told = run("--out", "a.pldf")
    assert status == 0
    assert "warning: " in told and "recording.csv, profile_mps: up to" in told
    assert "off the base profile: the drive followed another one" in told
    assert "--profile-in" in told


def test_the_same_result_may_be_written_again(run: Run) -> None:
    run("--out", "a.pldf")
    before = Path("a.pldf").read_bytes()
    assert run("--out", "a.pldf") == (0, "")
    assert Path("a.pldf").read_bytes() == before


def test_a_recording_that_contradicts_itself_is_refused_with_all_of_it(run: Run) -> None:
    columns = sample_recording().columns
    wrong = {name: 3.6 * columns[name] for name in ("speed_mps", "set_speed_mps")}
    write_recording("recording.csv", Recording({**columns, **wrong}))
    status, said = run("--out", "a.pldf")
    assert status == 1
    assert "speed_mps in km/h?" in said and "set_speed_mps in km/h?" in said
    assert not Path("a.pldf").exists()


def test_a_recording_with_a_warning_is_learned_and_it_is_told(run: Run) -> None:
    rows = np.r_[0:400, 430:1000]
    columns = {name: values[rows] for name, values in sample_recording().columns.items()}
    write_recording("recording.csv", Recording(columns))
    status, said = run("--out", "a.pldf")
    assert status == 0
    assert "warning: " in said and "3.1 s at 39.9 s (798 to 860 m)" in said
