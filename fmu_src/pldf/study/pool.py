"""Processes of this machine that drive participants, watched from their start to their end.

Each has a pipe of its own and one participant at a time. So it is known whom a process drove when
it died (out of memory, most likely), and nothing that it held, no lock and no queue, is missing to
the others. ``concurrent.futures`` knows neither: its pool breaks as a whole, does not say of whom,
and can wait for ever for a process that died while it started. What begins to read a pipe says so
first: nobody ever writes to a process that is not there.
"""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.context import BaseContext
from typing import Any, Final

from ..errors import ModelError
from .endings import die_of_ctrl_c, die_with_parent, end_with_main
from .participants import Participant
from .unit import Job, ParticipantResult, do_unit

# So often a participant is driven again whose process died, and each of the processes started that
# did not come to drive: when the one that forks dies, all that it has begun die with it.
TRIES: Final = 3
# What was killed is seen to be dead only a moment later.
_PAUSE_S: Final = 0.1
_NAMED_MAX: Final = 5

Outcome = ParticipantResult | Exception


def drive_in_pool(
    job: Job, participants: Iterable[Participant], count: int, context: BaseContext
) -> Generator[ParticipantResult, None, None]:
    """Drive ``participants`` in ``count`` processes; give what comes out, in any order.

    Raises:
        ModelError: a drive failed; no process can be started; or, when all others are done, a
            participant's process died each time.
    """
    pool = _Pool(job, participants, count, context)
    try:
        yield from pool.results()
    finally:
        pool.stop()


def killed_units(participants: Sequence[str]) -> ModelError:
    """Return the error that names the participants whose process died each time."""
    more = len(participants) - _NAMED_MAX
    names = ", ".join(participants[:_NAMED_MAX]) + (f" and {more} more" if more > 0 else "")
    return ModelError(
        f"{names}: given up, since each process that drove this participant was killed (out of "
        "memory?); all others are done and kept, the same command drives what is missing"
    )


class _Worker:
    """A process, seen from the one that started it.

    Raises:
        OSError, EOFError: it cannot be started, or is dead.
    """

    def __init__(self, context: BaseContext) -> None:
        self.idle = False  # it has said that it reads
        self.unit: Participant | None = None
        self._has_job = False
        self.connection, its_end = context.Pipe()
        # Nothing that is large: what a process is started with is written before it reads.
        self.process: Any = context.Process(  # type: ignore[attr-defined]
            target=_work, args=(its_end,), daemon=True
        )
        try:
            self.process.start()
        finally:
            its_end.close()

    def receive(self) -> Outcome | None:
        """Return what came out; None if it is only ready for more."""
        if not self.connection.poll():
            raise EOFError
        outcome: Outcome | None = self.connection.recv()
        self.idle, self.unit = True, None
        return outcome

    def hand(self, job: Job, waiting: deque[Participant]) -> None:
        """Hand it what it needs next, if there is something."""
        if not self._has_job:
            self.idle, self._has_job = False, True
            self.connection.send(job)
        elif waiting:
            self.idle, self.unit = False, waiting.popleft()
            self.connection.send(self.unit)

    def stop(self) -> None:
        """End it, if it lives."""
        self.process.kill()
        self.process.join()
        self.connection.close()
        self.process.close()


class _Pool:
    def __init__(
        self, job: Job, participants: Iterable[Participant], count: int, context: BaseContext
    ) -> None:
        self._job = job
        self._waiting = deque(participants)
        self._count = count
        self._context = context
        self._workers: list[_Worker] = []
        self._failed_starts = 0  # since something came out
        self._deaths: Counter[str] = Counter()  # by participant
        self._given_up: list[str] = []

    def results(self) -> Iterator[ParticipantResult]:
        while busy := sum(worker.unit is not None for worker in self._workers) + len(self._waiting):
            self._start(min(self._count, busy))
            for worker in self._heard():
                outcome = self._receive(worker)
                self._feed()  # before the caller writes what came out
                if isinstance(outcome, Exception):
                    raise outcome
                if outcome is not None:
                    yield outcome
        if self._given_up:
            raise killed_units(sorted(self._given_up))

    def stop(self) -> None:
        for worker in self._workers:
            worker.stop()

    def _start(self, count: int) -> None:
        """Start what is missing to ``count``; fewer do, too, where the memory is short."""
        most = TRIES * self._count
        while len(self._workers) < count and self._failed_starts < most:
            try:
                self._workers.append(_Worker(self._context))
            except (OSError, EOFError):  # the latter: the process that forks was killed
                self._failed_starts += 1
                time.sleep(_PAUSE_S)
        if not self._workers:
            raise ModelError(
                f"the processes of the study end while they start, {most} in a row (out of "
                "memory?); what is done is kept, the same command goes on; --jobs 1 needs none"
            )

    def _heard(self) -> list[_Worker]:
        """Wait for workers that have sent something or are dead; return them."""
        of = {
            handle: worker
            for worker in self._workers
            for handle in (worker.connection, worker.process.sentinel)
        }
        return list(dict.fromkeys(of[handle] for handle in wait(list(of))))

    def _receive(self, worker: _Worker) -> Outcome | None:
        if worker not in self._workers:
            return None  # lost while it was fed
        try:
            outcome = worker.receive()
        except (EOFError, OSError):
            self._lose(worker)
            return None
        self._failed_starts = self._failed_starts if outcome is None else 0
        return outcome

    def _feed(self) -> None:
        for worker in [worker for worker in self._workers if worker.idle]:
            try:
                worker.hand(self._job, self._waiting)
            except OSError:
                self._lose(worker)

    def _lose(self, worker: _Worker) -> None:
        """Take a dead worker away; what it drove is driven again, as often as ``TRIES`` says."""
        self._workers.remove(worker)
        worker.stop()
        if worker.unit is None:
            self._failed_starts += 1
            return
        self._deaths[worker.unit.id] += 1
        if self._deaths[worker.unit.id] < TRIES:
            self._waiting.append(worker.unit)
        else:
            self._given_up.append(worker.unit.id)


def _work(connection: Connection) -> None:
    """Be a worker, until the other end of ``connection`` is gone."""
    die_of_ctrl_c()
    die_with_parent()
    end_with_main()
    with suppress(EOFError, OSError):
        connection.send(None)  # reads from now on
        job: Job = connection.recv()
        connection.send(None)
        while True:
            connection.send(_outcome(job, connection.recv()))


def _outcome(job: Job, participant: Participant) -> Outcome:
    try:
        return do_unit(job, participant)
    except Exception as error:  # raised where the study was started
        return error
