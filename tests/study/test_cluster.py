"""A study on a Dask cluster: the same bytes, and nothing lost with a worker."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from laboratory import files
from pldf import cli
from pldf.study.runner import in_processes, on_cluster, run_missing
from pldf.study.study_file import read_study
from pldf.study.unit import Job, ParticipantResult
from small_study import opened, write_study


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as found:
        yield found


def test_a_cluster_gives_the_same_bytes(
    cluster: Any, finished: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    file, out = str(finished / "small.toml"), tmp_path / "out"
    address = cluster.scheduler_address
    assert cli.main(["study", file, "--out", str(out), "--scheduler", address]) == 0
    assert files(out) == expected


def test_a_killed_worker_of_a_cluster_loses_nothing(cluster: Any, tmp_path: Path) -> None:
    study = read_study(write_study(tmp_path, count=40))
    folder = opened(study, tmp_path / "out")
    victims = [worker.process.pid for worker in cluster.workers.values()][:1]
    seen: list[str] = []

    def kill_in_the_middle(done: ParticipantResult) -> None:
        seen.append(done.participant)
        if len(seen) == 5:
            os.kill(victims.pop(), signal.SIGKILL)

    run = on_cluster(cluster.scheduler_address)
    run_missing(folder, Job(study.settings), run, kill_in_the_middle)
    assert not victims
    assert sorted(seen) == [one.id for one in study.participants]
    local = opened(study, tmp_path / "local")
    run_missing(local, Job(study.settings), in_processes(2), lambda _: None)
    assert files(tmp_path / "out") == files(tmp_path / "local")


def test_a_scheduler_that_does_not_answer_is_an_error(
    finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: Any
) -> None:
    monkeypatch.setattr("pldf.study.runner._ANSWER_S", 0.2)
    file, out = str(finished / "small.toml"), str(tmp_path / "out")
    assert cli.main(["study", file, "--out", out, "--scheduler", "tcp://127.0.0.1:1"]) == 1
    assert "pldf: --scheduler tcp://127.0.0.1:1: " in capsys.readouterr().err
