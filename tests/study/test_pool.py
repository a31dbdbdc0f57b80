"""Processes of a study that die: nothing hangs, nothing is lost, and nobody is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

import psutil
import pytest
from deadly import KILL, DeadlyJob, DeadlyParticipant
from laboratory import files
from pldf.errors import ModelError
from pldf.study import pool
from pldf.study.participants import Participant
from pldf.study.runner import in_processes, run_missing
from pldf.study.study_file import Study, read_study
from pldf.study.unit import Job
from small_study import COUNT, opened, write_study

# Far more than any of this takes: who waits longer hangs.
HANGS_S = 120.0
POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


@pytest.fixture(autouse=True)
def nothing_hangs() -> Iterator[None]:
    """Let a test that hangs fail: all that a study waits for are its processes."""
    if os.name == "nt":
        yield
        return

    def hang(*_: Any) -> None:
        raise AssertionError("it hangs")

    before = signal.signal(signal.SIGALRM, hang)
    signal.alarm(int(HANGS_S))
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def driven(study: Study, job: Any, people: Sequence[Participant]) -> list[str]:
    return sorted(result.participant for result in in_processes(2)(job, list(people)))


def deadly(study: Study, at: int, deaths: Path, times: int) -> list[Participant]:
    deaths.mkdir(exist_ok=True)
    people = list(study.participants)
    one = people[at]
    people[at] = DeadlyParticipant(one.id, one.seed, one.values, deaths=deaths, times=times)
    return people


def test_what_a_killed_process_had_in_hand_is_driven_again(study: Study, tmp_path: Path) -> None:
    people = deadly(study, 1, tmp_path / "deaths", pool.TRIES - 1)
    assert driven(study, Job(study.settings), people) == [one.id for one in study.participants]
    assert len(list((tmp_path / "deaths").iterdir())) == pool.TRIES - 1


def test_who_kills_each_process_is_named_and_the_others_are_done(
    study: Study, tmp_path: Path
) -> None:
    folder = opened(study, tmp_path / "out")
    people = deadly(study, 2, tmp_path / "deaths", 99)

    def run(job: Job, _: list[Participant]) -> Any:
        return in_processes(2)(job, people)

    with pytest.raises(ModelError, match=r"^P003: given up.*the same command drives what is miss"):
        run_missing(folder, Job(study.settings), run, lambda _: None)
    assert [one.id for one in folder.missing()] == ["P003"]
    assert len(list((tmp_path / "deaths").iterdir())) == pool.TRIES


@pytest.mark.parametrize("times", [1, pool.TRIES - 1])
def test_a_process_that_dies_while_it_starts_is_started_again(
    times: int, study: Study, tmp_path: Path
) -> None:
    (tmp_path / "deaths").mkdir()
    job = DeadlyJob(Job(study.settings), tmp_path / "deaths", times)
    assert driven(study, job, study.participants) == [one.id for one in study.participants]


def test_processes_that_never_start_are_an_error_that_says_what_to_do(
    study: Study, tmp_path: Path
) -> None:
    (tmp_path / "deaths").mkdir()
    job: Any = DeadlyJob(Job(study.settings), tmp_path / "deaths", 99)
    folder = opened(study, tmp_path / "out")
    with pytest.raises(ModelError, match="the same command goes on; --jobs 1 needs none"):
        run_missing(folder, job, in_processes(2), lambda _: None)
    assert len(folder.missing()) == COUNT


class Start:
    """Counts processes that start, and kills those that are listed."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, kill: Callable[[int, Any], None]) -> None:
        made = pool._Worker.__init__

        def start(worker: Any, context: Any) -> None:
            made(worker, context)
            self.count += 1
            kill(self.count, worker)

        self.count = 0
        monkeypatch.setattr(pool._Worker, "__init__", start)


def test_a_process_killed_before_it_reads_is_replaced(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    def kill(count: int, worker: Any) -> None:
        if count < pool.TRIES:
            os.kill(worker.process.pid, KILL)

    starts = Start(monkeypatch, kill)
    job = Job(study.settings)
    assert driven(study, job, study.participants) == [one.id for one in study.participants]
    assert starts.count >= pool.TRIES


def test_each_process_has_its_tries(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """One killed forking process takes with it all that have begun: more than ``TRIES`` of them."""

    def kill(count: int, worker: Any) -> None:
        if count <= pool.TRIES + 1:
            os.kill(worker.process.pid, KILL)

    Start(monkeypatch, kill)
    job = Job(study.settings)
    assert driven(study, job, study.participants) == [one.id for one in study.participants]


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="processes are not forked there")
def test_the_process_that_forks_may_die_too(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    def kill(count: int, _: Any) -> None:
        if count == 1:
            os.kill(forkserver._forkserver._forkserver_pid, KILL)  # type: ignore[attr-defined]

    starts = Start(monkeypatch, kill)
    job = Job(study.settings)
    assert driven(study, job, study.participants) == [one.id for one in study.participants]
    assert starts.count > 1


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + HANGS_S
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.mark.parametrize("begun", [False, True])
def test_no_process_outlives_a_killed_study(begun: bool, tmp_path: Path) -> None:
    """Killed while its processes start, and while they drive."""
    out = tmp_path / "out"
    command = [sys.executable, "-m", "pldf", "study", str(write_study(tmp_path, count=1000))]
    main = subprocess.Popen([*command, "--out", str(out), "--jobs", "2"])
    watched = psutil.Process(main.pid)
    least = 3 if begun else 1
    wait_for(lambda: len(watched.children(recursive=True)) >= least)
    wait_for(lambda: not begun or any(out.glob("parts/*.json")))
    others = watched.children(recursive=True)
    main.kill()
    main.wait()
    _, alive = psutil.wait_procs(others, timeout=HANGS_S)
    assert not alive


@POSIX
def test_workers_are_killed_at_random_and_the_tables_are_the_same(tmp_path: Path) -> None:
    study = read_study(write_study(tmp_path, count=40))
    seen: list[str] = []

    def kill_now_and_then(done: Any) -> None:
        seen.append(done.participant)
        if len(seen) in (5, 20):
            forked = psutil.Process().children(recursive=True)
            victims = [one for one in forked if one.children() == [] and one.ppid() != os.getpid()]
            victims[0].kill()

    folder = opened(study, tmp_path / "out")
    run_missing(folder, Job(study.settings), in_processes(2), kill_now_and_then)
    assert sorted(seen) == [one.id for one in study.participants]
    alone = opened(study, tmp_path / "alone")
    run_missing(alone, Job(study.settings), in_processes(1), lambda _: None)
    assert files(tmp_path / "out") == files(tmp_path / "alone")
