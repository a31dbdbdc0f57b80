"""Hands the participants of a study to processes of this machine or to a Dask cluster.

Results do not depend on where or in which order participants are driven. Only this process writes.
"""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Callable, Generator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from importlib import import_module
from itertools import islice
from multiprocessing import forkserver
from typing import Any, Final

from ..errors import ModelError
from .interrupt import die_of_ctrl_c
from .participants import Participant
from .results import StudyResults
from .simulation import compile_all
from .through_fmus import Watch
from .unit import Job, ParticipantResult, do_unit

# Processes are forked from one that has the machine code ready. Not on macOS, whose own libraries
# do not like it, and Windows cannot.
_CAN_FORK: Final = sys.platform not in ("win32", "darwin")
_WARM: Final = "pldf.study.warm"
# Participants handed to each process ahead of time.
_AHEAD: Final = 3
# How long a scheduler may take to answer.
_ANSWER_S: Final = 10

# A way to run units; what came out is given as it comes, in any order.
ResultStream = Generator[ParticipantResult, None, None]
Run = Callable[[Job, list[Participant]], ResultStream]


def run_missing(
    folder: StudyResults, job: Job, run: Run, progress: Callable[[ParticipantResult], None]
) -> None:
    """Drive the participants without results and merge all results.

    Raises:
        ModelError: a drive failed; what is done is kept.
    """
    missing = folder.missing()
    if missing:
        with closing(run(job, missing)) as results:
            for result in results:
                folder.keep(result)
                progress(result)
    folder.merge()


def in_processes(jobs: int, watch: Watch = lambda _: None) -> Run:
    """Return a way to run units in ``jobs`` processes.

    A single participant, or all if ``jobs`` is 1, are driven in this process; ``watch`` is told
    how far each of them has come.
    """

    def run(job: Job, participants: list[Participant]) -> ResultStream:
        count = min(jobs, len(participants))
        if count == 1:
            return (do_unit(job, participant, watch) for participant in participants)
        return _in_pool(job, participants, count)

    return run


def prepare_processes() -> None:
    """Begin to get ready what processes need, beside what this process does until then."""
    if _CAN_FORK:
        multiprocessing.set_forkserver_preload([_WARM])
        forkserver.ensure_running()


def _in_pool(job: Job, participants: list[Participant], count: int) -> ResultStream:
    if _CAN_FORK:
        prepare_processes()
    else:
        compile_all(job.settings)  # once, for all processes to load
    context = multiprocessing.get_context("forkserver" if _CAN_FORK else "spawn")
    pool = ProcessPoolExecutor(count, mp_context=context, initializer=_begin, initargs=(job,))
    try:
        waiting = iter(participants)
        pending = {
            pool.submit(_unit, participant) for participant in islice(waiting, _AHEAD * count)
        }
        while pending:
            finished, pending = wait(pending, return_when=FIRST_COMPLETED)
            for future in finished:
                yield future.result()
                pending |= {pool.submit(_unit, participant) for participant in islice(waiting, 1)}
    except BrokenProcessPool:
        raise ModelError(
            "a process of the study was killed (out of memory?); the participants that were done "
            "are kept, start again to go on"
        ) from None
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


_job: Job | None = None


def _begin(job: Job) -> None:
    """Prepare a process."""
    global _job  # noqa: PLW0603 - the only way to hand something to a process once
    die_of_ctrl_c()
    _job = job


def _unit(participant: Participant) -> ParticipantResult:
    assert _job is not None
    return do_unit(_job, participant)


def on_cluster(address: str) -> Run:
    """Return a way to run units on the Dask cluster with the scheduler at ``address``.

    The workers need this package in the same version. A unit whose worker dies runs on another.

    Raises:
        ModelError: dask.distributed is not installed or nobody answers.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise ModelError(
            "--scheduler needs dask.distributed: pip install 'adaptive-pldf[cluster]'"
        ) from None

    def run(job: Job, participants: list[Participant]) -> ResultStream:
        try:
            client = distributed.Client(address, timeout=_ANSWER_S)
        except (OSError, ValueError) as error:
            raise ModelError(f"--scheduler {address}: {error}") from None
        with client:
            # As a task, not scattered: it is made anew when the worker that holds it dies.
            shared = client.submit(_same, job, pure=False)
            units = [
                client.submit(do_unit, shared, participant, pure=False)
                for participant in participants
            ]
            try:
                for unit in distributed.as_completed(units):
                    yield unit.result()
                    unit.release()
            except distributed.KilledWorker as problem:
                raise ModelError(f"--scheduler {address}: {problem}") from None

    return run


def _same(job: Job) -> Job:
    return job
