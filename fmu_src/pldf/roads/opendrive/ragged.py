"""Groups of different size behind each other in one array."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]
Number = TypeVar("Number", np.float64, np.complex128)


def firsts(counts: Indices) -> Indices:
    """Return where each group begins."""
    begins: Indices = np.cumsum(counts) - counts
    return begins


def within(counts: Indices) -> tuple[Indices, Indices]:
    """Return for each member its group, and its number in that from 0 on."""
    group = np.repeat(np.arange(len(counts)), counts)
    return group, np.arange(len(group)) - np.repeat(firsts(counts), counts)


def distinct_runs(values: Indices) -> tuple[Indices, Indices]:
    """Return the distinct values, and for each value its index among them.

    The same as ``np.unique``, which would sort all of them: here equal ones stand together.
    """
    begins = np.flatnonzero(np.diff(values, prepend=values[0] - 1))
    distinct, index = np.unique(values[begins], return_inverse=True)
    return distinct, np.repeat(index, np.diff(begins, append=len(values)))


def running_sums(values: NDArray[Number], counts: Indices) -> NDArray[Number]:
    """Return the running sums of each group, each with a zero before it.

    A group is summed as if it were alone: one running sum over all would round differently.
    """
    begins = firsts(counts)
    sums = np.zeros(len(values) + len(counts), dtype=values.dtype)
    behind_zero = begins + np.arange(len(counts)) + 1
    for count in np.unique(counts):
        alike = np.flatnonzero(counts == count)
        inside = np.arange(count)
        sums[behind_zero[alike, None] + inside] = np.cumsum(
            values[begins[alike, None] + inside], axis=1
        )
    return sums
