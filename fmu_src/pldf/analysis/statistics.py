"""The tests of the study: paired values of the same people under system A and system B.

``first`` and ``second`` are one number per person, in the same order; differences are first minus
second, so that a positive effect is a fall from A to B. All p values are two-sided.

What the paper computed can be told from its numbers: W = 1 with 43 drivers gives p = 4.55e-13 from
the exact distribution (the normal approximation gives 1.2e-8), and W = 24 gives p = 1.38e-7 from
the normal approximation without continuity correction with n = 41, two differences being zero.
That is scipy's choice ("auto") for such data, and it is the rule here: zero differences are
dropped; the exact distribution if nothing was dropped, no ranks are tied and there are at most 50
pairs; else the normal approximation, its variance corrected for ties, without continuity
correction. (Of at most 13 pairs with ties or zeros scipy would permute the signs; the paper's rule
stays the one that is easy to state.)

Whether a difference is zero and whether two are tied is a question about the numbers as they were
written: 0.3 - 0.2 and 0.4 - 0.3 are the same, though they differ in their 17th digit. So ``equal``
differences are made equal before anything is computed from them, by the roundings of a double; and
``as_written`` takes the rounding of single precision from values that have few decimals.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import scipy  # loads scipy.stats, which takes a second, when it is first used
from numpy.typing import ArrayLike

from ..kernel.arrays import FloatArray
from .rounding import equal

Method = Literal["exact", "normal"]

EXACT_PAIRS_MAX: Final = 50


@dataclass(frozen=True)
class PairedT:
    """Paired t test: ``t`` with ``df`` degrees of freedom and its p value.

    Differences that are all the same have no spread: ``t`` is infinite and p is 0, or t = 0 and
    p = 1 if nothing differs.
    """

    t: float
    df: int
    p: float

    @property
    def has_spread(self) -> bool:
        """Tell whether the differences vary, or nothing differs; else the test says nothing."""
        return bool(np.isfinite(self.t))


@dataclass(frozen=True)
class SignedRank:
    """Wilcoxon signed rank test.

    Attributes:
        w: the smaller of the rank sums of positive and negative differences.
        pairs: pairs that count, the differences that are not zero.
        zeros: pairs dropped because their difference is zero.
        p: p value by ``method``.
        method: "exact", or "normal" for the approximation without continuity correction.
        p_normal: p value of the normal approximation.
        p_corrected: the same with continuity correction; always a little larger.
    """

    w: float
    pairs: int
    zeros: int
    p: float
    method: Method
    p_normal: float
    p_corrected: float


@dataclass(frozen=True)
class MeanInterval:
    """A mean with the ends of its confidence interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Comparison:
    """Everything that is said about one measure under A and B.

    Attributes:
        mean_first, mean_second: means over the people.
        difference: mean of first minus second with its 95 % t interval.
        t, signed_rank: the two tests.
        d_z: Cohen's d of the differences.
        rank_biserial: rank-biserial correlation, from -1 to 1.
        fell: people whose second value is the smaller one.
        people: how many have both values.
    """

    mean_first: float
    mean_second: float
    difference: MeanInterval
    t: PairedT
    signed_rank: SignedRank
    d_z: float
    rank_biserial: float
    fell: int
    people: int


def compare(first: ArrayLike, second: ArrayLike) -> Comparison:
    """Compare paired values; ValueError for fewer than 2 pairs, unequal lengths or NaN."""
    d = differences(first, second)
    return Comparison(
        float(np.asarray(first, float).mean()),
        float(np.asarray(second, float).mean()),
        mean_interval(d),
        paired_t(first, second),
        signed_rank(first, second),
        cohen_dz(first, second),
        rank_biserial(first, second),
        int((d > 0.0).sum()),
        len(d),
    )


def differences(first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Return first minus second, equal ones made the same bits and zeros zero.

    Raises:
        ValueError: these are not at least 2 pairs of numbers.
    """
    a, b = np.asarray(first, float), np.asarray(second, float)
    if a.ndim != 1 or a.shape != b.shape or len(a) < 2:
        raise ValueError(
            f"needs two equally long lists of at least 2 values, not {a.shape}, {b.shape}"
        )
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("every person needs both values; leave out people with a missing one")
    return equal(a - b, max(np.abs(a).max(), np.abs(b).max()))


def paired_t(first: ArrayLike, second: ArrayLike) -> PairedT:
    """Paired t test. Without any spread: t = 0 and p = 1 if nothing differs, else infinite t."""
    d = differences(first, second)
    if _is_constant(d):
        t = _without_spread(d)
        return PairedT(t, len(d) - 1, 0.0 if t else 1.0)
    result = scipy.stats.ttest_1samp(d, 0.0)
    return PairedT(float(result.statistic), int(result.df), float(result.pvalue))


def signed_rank(first: ArrayLike, second: ArrayLike) -> SignedRank:
    """Wilcoxon signed rank test by the rule of this module; p = 1 if nothing differs."""
    d = differences(first, second)
    kept = d[d != 0.0]
    zeros = len(d) - len(kept)
    if not len(kept):
        return SignedRank(0.0, 0, zeros, 1.0, "normal", 1.0, 1.0)
    w, p_normal = _wilcoxon(kept, "asymptotic")
    tied = len(np.unique(np.abs(kept))) < len(kept)
    exact = not zeros and not tied and len(kept) <= EXACT_PAIRS_MAX
    return SignedRank(
        w,
        len(kept),
        zeros,
        _wilcoxon(kept, "exact")[1] if exact else p_normal,
        "exact" if exact else "normal",
        p_normal,
        _wilcoxon(kept, "asymptotic", correction=True)[1],
    )


def _wilcoxon(
    d: FloatArray, method: Literal["exact", "asymptotic"], *, correction: bool = False
) -> tuple[float, float]:
    """Return statistic and p value of differences that are not zero."""
    # The stubs know "asymptotic" by its older name only.
    result = scipy.stats.wilcoxon(d, method=method, correction=correction)  # type: ignore[arg-type]
    return float(result.statistic), float(result.pvalue)


def cohen_dz(first: ArrayLike, second: ArrayLike) -> float:
    """Mean difference in standard deviations of the differences; 0 if nothing differs."""
    d = differences(first, second)
    return _without_spread(d) if _is_constant(d) else float(d.mean() / np.std(d, ddof=1))


def rank_biserial(first: ArrayLike, second: ArrayLike) -> float:
    """Share of the rank sum of falls minus that of rises, -1..1; 0 if nothing differs."""
    d = differences(first, second)
    kept = d[d != 0.0]
    if not len(kept):
        return 0.0
    ranks = scipy.stats.rankdata(np.abs(kept))
    return float((np.sign(kept) * ranks).sum() / ranks.sum())


def mean_interval(values: ArrayLike, level: float = 0.95) -> MeanInterval:
    """Mean with its t interval (normally distributed mean), from at least 2 values."""
    x = np.asarray(values, float)
    quantile = float(scipy.stats.t.ppf(0.5 + 0.5 * level, len(x) - 1))
    mean, half = float(x.mean()), quantile * float(np.std(x, ddof=1) / np.sqrt(len(x)))
    return MeanInterval(mean, mean - half, mean + half)


def _is_constant(d: FloatArray) -> bool:
    """Tell whether all differences are the same; their standard deviation may be 1e-17 then."""
    return bool((d == d[0]).all())


def _without_spread(d: FloatArray) -> float:
    """Return what mean by spread is if all differences are the same."""
    return float(np.copysign(np.inf, d[0])) if d[0] else 0.0
