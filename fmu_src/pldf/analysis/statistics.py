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
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import scipy  # loads scipy.stats, which takes a second, when it is first used
from numpy.typing import ArrayLike

from ..kernel.arrays import FloatArray

Method = Literal["exact", "normal"]

EXACT_PAIRS_MAX: Final = 50
# Differences (and their spread) below this are rounding, not an effect.
ZERO: Final = 1e-12


@dataclass(frozen=True)
class PairedT:
    """Paired t test: ``t`` with ``df`` degrees of freedom and its p value."""

    t: float
    df: int
    p: float


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
    """

    mean_first: float
    mean_second: float
    difference: MeanInterval
    t: PairedT
    signed_rank: SignedRank
    d_z: float
    rank_biserial: float
    fell: int


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
        int((d > ZERO).sum()),
    )


def differences(first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Return first minus second; ValueError unless these are at least 2 pairs of numbers."""
    a, b = np.asarray(first, float), np.asarray(second, float)
    if a.ndim != 1 or a.shape != b.shape or len(a) < 2:
        raise ValueError(
            f"needs two equally long lists of at least 2 values, not {a.shape}, {b.shape}"
        )
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("every person needs both values; leave out people with a missing one")
    difference: FloatArray = a - b
    return difference


def paired_t(first: ArrayLike, second: ArrayLike) -> PairedT:
    """Paired t test. Without any spread: t = 0 and p = 1 if nothing differs, else infinite t."""
    d = differences(first, second)
    if _spread(d) <= 0.0:
        t = _without_spread(d)
        return PairedT(t, len(d) - 1, 0.0 if t else 1.0)
    result = scipy.stats.ttest_rel(np.asarray(first, float), np.asarray(second, float))
    return PairedT(float(result.statistic), int(result.df), float(result.pvalue))


def signed_rank(first: ArrayLike, second: ArrayLike) -> SignedRank:
    """Wilcoxon signed rank test by the rule of this module; p = 1 if nothing differs."""
    d = differences(first, second)
    kept = _not_zero(d)
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
    spread = _spread(d)
    return float(d.mean() / spread) if spread > 0.0 else _without_spread(d)


def rank_biserial(first: ArrayLike, second: ArrayLike) -> float:
    """Share of the rank sum of falls minus that of rises, -1..1; 0 if nothing differs."""
    kept = _not_zero(differences(first, second))
    if not len(kept):
        return 0.0
    ranks = scipy.stats.rankdata(np.abs(kept))
    return float((np.sign(kept) * ranks).sum() / ranks.sum())


def mean_interval(values: ArrayLike, level: float = 0.95) -> MeanInterval:
    """Mean with its t interval (normally distributed mean), from at least 2 values."""
    x = np.asarray(values, float)
    quantile = float(scipy.stats.t.ppf(0.5 + 0.5 * level, len(x) - 1))
    mean, half = float(x.mean()), quantile * _standard_error(x)
    return MeanInterval(mean, mean - half, mean + half)


def _not_zero(d: FloatArray) -> FloatArray:
    kept: FloatArray = d[np.abs(d) > ZERO]
    return kept


def _standard_error(values: FloatArray) -> float:
    return float(np.std(values, ddof=1) / np.sqrt(len(values)))


def _spread(d: FloatArray) -> float:
    """Return the standard deviation of differences, 0 if it is but rounding."""
    spread = float(_standard_error(d) * np.sqrt(len(d)))
    return spread if spread > ZERO else 0.0


def _without_spread(d: FloatArray) -> float:
    """Return what mean by spread is if all differences are the same."""
    mean = float(d.mean())
    return float(np.copysign(np.inf, mean)) if abs(mean) > ZERO else 0.0
