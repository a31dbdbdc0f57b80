"""What the paper's tests say of its people beyond the means (arXiv:2602.13733).

The paper prints statistic and p value of each test. Together with the number of drivers they tell
the size of the effect in standard deviations (from t), how many drivers' rates were the same with
both systems (from W and p) and within which bounds the number of drivers lies whose rate fell
(from W). ``statistics.signed_rank`` says by which rule W became p.
"""

from __future__ import annotations

from math import ceil, floor, sqrt

import numpy as np

from ..kernel.arrays import FloatArray
from .published import DRIVERS, PublishedTest
from .statistics import signed_rank


def d_z(test: PublishedTest) -> float:
    """Return Cohen's d_z of a paired t test: t is the mean difference in standard errors."""
    return test.statistic / sqrt(DRIVERS)


def without_difference(test: PublishedTest) -> int:
    """Return how many drivers Wilcoxon's test dropped because their difference is zero.

    That is the one number with which W gives p as it is printed.

    Raises:
        ValueError: no number does, or several do.
    """
    w, p = test.statistic, f"{test.p:.2e}"
    found = [
        zeros
        for zeros in range(DRIVERS)
        if w <= _largest_w(DRIVERS - zeros) and f"{_p_value(w, DRIVERS - zeros, zeros):.2e}" == p
    ]
    if len(found) != 1:
        raise ValueError(f"{test.text}, p = {p}: drivers without difference could be {found}")
    return found[0]


def fell_between(w: float, pairs: int) -> tuple[int, int]:
    """Return how many of ``pairs`` fell at least and at most, if W is the rank sum of who rose.

    As many rose as possible if theirs are the smallest ranks: r people have at least
    1 + ... + r = r (r + 1) / 2. As few if theirs are the largest: r people have at most
    r (2 pairs - r + 1) / 2. Both hold with ties too, whose ranks are means of these.
    """
    most = floor((sqrt(8.0 * w + 1.0) - 1.0) / 2.0)
    beside = 2 * pairs + 1
    fewest = ceil((beside - sqrt(beside**2 - 8.0 * w)) / 2.0)
    return pairs - most, pairs - fewest


def fell(test: PublishedTest) -> tuple[int, int]:
    """Return how many drivers' rates fell from A to B, at least and at most, by Wilcoxon's W."""
    return fell_between(test.statistic, DRIVERS - without_difference(test))


def _largest_w(pairs: int) -> float:
    """Return the largest of the smaller rank sums, half of all ranks."""
    return pairs * (pairs + 1) / 4.0


def _p_value(w: float, pairs: int, zeros: int) -> float:
    """Return the p value of people of whom nobody ties, with this W and so many zeros."""
    differences = np.append(_with_rank_sum(w, pairs), np.zeros(zeros))
    return signed_rank(differences, np.zeros(pairs + zeros)).p


def _with_rank_sum(w: float, pairs: int) -> FloatArray:
    """Return 1, ..., pairs with minus signs so that the negative ones sum to -w."""
    differences = np.arange(1.0, pairs + 1.0)
    for rank in range(pairs, 0, -1):
        if rank <= w:
            w -= rank
            differences[rank - 1] = -rank
    return differences
