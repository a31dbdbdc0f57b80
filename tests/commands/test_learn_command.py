"""``pldf learn``: what it writes where; nobody's history is lost."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pldf import cli
from pldf.commands import learn
from pldf.profiles.store import continue_profile, read_profile, rollback_profile
from pldf.recordings.recording import write_recording
from profile_examples import drive_result
from sample_recording import sample_recording

Run = Callable[..., tuple[int, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Return a function that runs ``pldf learn`` on one recording, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    recording = tmp_path / "recording.csv"
    write_recording(recording, sample_recording())

    def runner(*arguments: str) -> tuple[int, str]:
        given = ["--route", "study", "--recording", str(recording), *arguments]
        status = cli.main(["learn", *given])
        return status, capsys.readouterr().err

    return runner


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


def test_the_same_result_may_be_written_again(run: Run) -> None:
    run("--out", "a.pldf")
    before = Path("a.pldf").read_bytes()
    assert run("--out", "a.pldf") == (0, "")
    assert Path("a.pldf").read_bytes() == before
