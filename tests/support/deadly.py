"""Jobs and participants that kill the process that they are handed to, as out of memory does."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pldf.study.participants import Participant

# Windows has no SIGKILL; terminated it looks the same from outside.
KILL = getattr(signal, "SIGKILL", signal.SIGTERM)


@dataclass(frozen=True, kw_only=True)
class DeadlyParticipant(Participant):
    """Kills whom it is handed to so many times; which are counted by the files in ``deaths``."""

    deaths: Path
    times: int

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return _kill_or, (self.deaths, self.times, Participant, self.id, self.seed, self.values)


class DeadlyJob:
    """Kills whom it is handed to, so many times, before it becomes the job."""

    def __init__(self, job: Any, deaths: Path, times: int) -> None:
        self.job, self.deaths, self.times, self.settings = job, deaths, times, job.settings

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return _kill_or, (self.deaths, self.times, replace, self.job)


def _kill_or(deaths: Path, times: int, make: Callable[..., Any], *values: Any) -> Any:
    if len(list(deaths.iterdir())) < times:
        (deaths / str(os.getpid())).touch()
        os.kill(os.getpid(), KILL)
    return make(*values)
