"""The fault campaign: each experiment in its short form, and the campaign itself."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from faults import built, campaign
from faults.experiment import Counts, Experiment, Progress

EXPERIMENTS = {experiment.name: experiment for experiment in campaign.experiments()}


@pytest.fixture(autouse=True)
def fmus(fmu_folder: Path, native_folder: Path) -> Iterator[None]:
    """Let experiments drive the FMUs of this test run."""
    built.use(fmu_folder, native_folder)
    yield


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_promise_is_kept(name: str) -> None:
    experiment = EXPERIMENTS[name]
    counts = experiment.run(experiment.short, campaign.SEED, lambda _: None)
    assert counts["violations"] == 0, (experiment.promise, counts)
    assert sum(counts.values()) > 0, "nothing was tried"


def test_names_are_unique_and_every_promise_is_a_sentence() -> None:
    known = campaign.experiments()
    assert len(EXPERIMENTS) == len(known) > 0
    for experiment in known:
        assert 0 < experiment.short < experiment.count
        assert experiment.promise[0].isupper() and experiment.promise.endswith(".")


def test_every_experiment_stands_in_the_documentation_with_its_promise() -> None:
    page = (campaign.ROOT / "docs" / "reliability.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| ([^|]+) \| [^|]+ \| 0 \|$", page, re.MULTILINE)
    assert dict(rows) == {name: experiment.promise for name, experiment in EXPERIMENTS.items()}


def _broken(count: int, seed: int, progress: Progress) -> Counts:
    return {"tries": count, "violations": count}


def _ended(count: int, seed: int, progress: Progress) -> Counts:
    raise OSError("the disk is gone")


def test_a_broken_promise_and_an_experiment_that_fails_are_told() -> None:
    broken = Experiment("broken", "It holds.", _broken, 9, 1)
    ended = Experiment("ended", "It goes on.", _ended, 9, 1)
    results = {e.name: campaign.do(e, e.count, 1) for e in (broken, ended)}
    assert results["broken"]["counts"] == {"tries": 9, "violations": 9}
    assert results["ended"]["ended_by"] == "OSError: the disk is gone"
    assert list(campaign._broken(results)) == [
        "broken: It holds.",
        "ended: OSError: the disk is gone",
    ]
    outcome = campaign.report(results, 1)
    assert outcome["violations"] == 10
    assert campaign.table(outcome).splitlines()[0] == "| `broken` | It holds. | 9 tries | 9 |"


def test_an_unknown_experiment_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    assert campaign.main(["--only", "nothing"]) == 2
    assert "no experiment nothing; see --list" in capsys.readouterr().err
