"""Hands the participants of a study to processes of this machine or to a Dask cluster.

Results do not depend on where or in which order participants are driven. Only this process writes.
"""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing
from importlib import import_module
from multiprocessing import forkserver
from typing import Any, Final

from ..errors import ModelError
from .drive_row import DriveRow
from .participants import Participant
from .pool import drive_in_pool, killed_units
from .results import StudyResults
from .simulation import compile_all
from .through_fmus import Watch
from .unit import Job, ParticipantResult, do_unit

# Processes are forked from one that has the machine code ready. Not on macOS, whose own libraries
# do not like it, and Windows cannot.
_CAN_FORK: Final = sys.platform not in ("win32", "darwin")
_WARM: Final = "pldf.study.warm"
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


def rows_in_order(
    results: Iterable[ParticipantResult], participants: Sequence[Participant]
) -> list[tuple[DriveRow, ...]]:
    """Return the drives of each of ``participants``, in whatever order ``results`` come."""
    rows = {result.participant: result.rows for result in results}
    return [rows[person.id] for person in participants]


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
    return drive_in_pool(job, participants, count, context)


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
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            # The last two: without a certificate, or without TLS where dask's settings ask for it.
            raise ModelError(f"--scheduler {address}: {error}{_about_tls(address)}") from None
        with client:
            # As a task, not scattered: it is made anew when the worker that holds it dies.
            shared = client.submit(_same, job, pure=False)
            units = {
                client.submit(do_unit, shared, participant, pure=False): participant.id
                for participant in participants
            }
            given_up = []
            for unit in distributed.as_completed(units):
                try:
                    yield unit.result()
                except distributed.KilledWorker:
                    given_up.append(units[unit])
                unit.release()
            if given_up:
                raise killed_units(sorted(given_up))

    return run


def _about_tls(address: str) -> str:
    if not address.startswith("tls:"):
        return ""
    return '; the certificates stand in dask\'s settings, see docs/study.md, "A cluster"'


def _same(job: Job) -> Job:
    return job
