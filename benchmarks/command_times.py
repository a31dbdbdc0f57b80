"""How long a person waits for a command that only says something: whole processes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from typing import Final

COMMANDS: Final = (("--help",), ("route", "study"))
RUNS: Final = 9


def command_times(runs: int = RUNS) -> dict[str, float]:
    """Return the processor's time in s of each command, start of Python included; medians."""
    rounds = [[_cpu_s(command) for command in COMMANDS] for _ in range(runs + 1)]
    measured = zip(*rounds[1:], strict=True)  # the first one fills the caches of files
    return {
        f"pldf {' '.join(command)}": median(times)
        for command, times in zip(COMMANDS, measured, strict=True)
    }


def _cpu_s(arguments: Sequence[str]) -> float:
    before = getrusage(RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-m", "pldf", *arguments], check=True, stdout=subprocess.DEVNULL
    )
    after = getrusage(RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
