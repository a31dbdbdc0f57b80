"""``pldf study FILE``: a study file's participants, on all cores or a cluster."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from ..cosim.fmu import Fmu
from ..study.results import DRIVES, PARTICIPANTS, Results
from ..study.runner import in_processes, on_cluster, run_missing
from ..study.study_file import Study, read_study, study_path
from ..study.unit import Job
from .coupled import chosen_fmus, stderr_progress


def add_running(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say where and how a study file's participants are driven."""
    parser.add_argument(
        "file", nargs="?", metavar="FILE",
        help="study file (TOML), or 'paper', the paper's study; without it one driver drives the "
        "six drives, with figures",
    )  # fmt: skip
    group = parser.add_argument_group("with FILE")
    group.add_argument(
        "--jobs", type=_jobs, default=_cores(), metavar="N",
        help="processes (default: all cores); the results are the same",
    )  # fmt: skip
    group.add_argument(
        "--scheduler", metavar="ADDRESS",
        help="drive on the Dask cluster with this scheduler, e.g. tcp://host:8786",
    )  # fmt: skip
    group.add_argument(
        "--restart", action="store_true", help="forget what was driven before and start anew"
    )


def run_file(options: argparse.Namespace) -> None:
    """Drive what is missing of a study; print where to look."""
    study = read_study(study_path(options.file))
    out: Path = options.out or study.out
    with ExitStack() as stack:
        fmus = stack.enter_context(chosen_fmus(options)) if options.fmu else None
        results = Results(study, out, through=_through(fmus))
        results.open(options.restart)
        run = on_cluster(options.scheduler) if options.scheduler else in_processes(options.jobs)
        bar = stack.enter_context(_progress(study, results))
        try:
            run_missing(
                results, Job(study.settings, fmus), run, lambda _: bar.advance(bar.task_ids[0])
            )
        except KeyboardInterrupt:
            bar.stop()
            count = len(study.participants)
            print(
                f"pldf: {count - len(results.missing())} of {count} participants are done; "
                "the same command goes on with the others",
                file=sys.stderr,
            )
            raise
    drives = len(study.participants) * len(study.settings.phases)
    print(f"{study.title}: {len(study.participants)} participants, {drives} drives")
    print(f"Drives are in {out / DRIVES}, drivers in {out / PARTICIPANTS}.")
    print(f"Look at the result with: pldf analyse {out}")


def _through(fmus: Mapping[str, Fmu] | None) -> str:
    """Return what drives, for the results."""
    return ", ".join(sorted({fmu.about for fmu in fmus.values()})) if fmus else "kernels"


@contextmanager
def _progress(study: Study, results: Results) -> Iterator[Progress]:
    """Show a bar on stderr with the time left; nothing when stderr is not a terminal."""
    with stderr_progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    ) as bar:
        count = len(study.participants)
        bar.add_task("participants", total=count, completed=count - len(results.missing()))
        yield bar


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _jobs(text: str) -> int:
    if not text.isdigit() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 to 1024")
    return int(text)
