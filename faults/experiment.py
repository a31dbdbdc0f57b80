"""What an experiment of the fault campaign is.

Every module of this folder with a tuple ``EXPERIMENTS`` takes part: with ``count`` rounds in
``make faults``, with ``short`` rounds in ``make test``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

# What came out, by name: how often something was tried or seen. ``violations`` is always there:
# how often the promise was broken. Largest values seen may stand beside the counts.
Counts = dict[str, float]
# Told how many rounds are done.
Progress = Callable[[int], None]


@dataclass(frozen=True)
class Experiment:
    """One promise and the way to try to break it.

    Attributes:
        name: unique, lower case with underscores, e.g. ``kills_of_native_fmus``.
        promise: what holds whatever happens, in one sentence.
        run: does so many rounds with this seed, tells how many are done, returns what it counted.
        count: rounds in ``make faults``.
        short: rounds in ``make test``.
    """

    name: str
    promise: str
    run: Callable[[int, int, Progress], Counts]
    count: int
    short: int
