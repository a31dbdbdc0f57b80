"""The tests of the study: paired values of the same people under system A and system B.

``first`` and ``second`` are one number per person, in the same order; differences are first minus
second, so that a positive effect is a fall from A to B. All p values are two-sided.

What the paper computed can be told from its numbers: W = 1 with 43 drivers gives p = 4.55e-13 from
the exact distribution (the normal approximation gives 1.2e-8), and W = 24 gives p = 1.38e-7 from
the normal approximation without continuity correction with n = 41, two differences being zero. This
is what scipy does by itself ("auto"), and it is the rule here: zero differences are dropped; the
exact distribution if nothing was dropped, no ranks are tied and there are at most 50 pairs; else
the normal approximation, its variance corrected for ties, without continuity correction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from ..kernel.arrays import FloatArray

Method = Literal["exact", "normal"]

EXACT_PAIRS_MAX: Final = 50
# Differences of rates below this are rounding, not an effect.
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
class Interval:
    """A mean (or other statistic) with the ends of its confidence interval."""

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
    difference: Interval
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
    mean, error = float(d.mean()), _standard_error(d)
    if error <= 0.0:
        return PairedT(
            float(np.copysign(np.inf, mean)) if mean else 0.0, len(d) - 1, float(not mean)
        )
    t = mean / error
    return PairedT(t, len(d) - 1, t_p_value(t, len(d) - 1))


def t_p_value(t: float, df: int) -> float:
    """Two-sided p value of Student's t."""
    return float(2.0 * stats.t.sf(abs(t), df))


def signed_rank(first: ArrayLike, second: ArrayLike) -> SignedRank:
    """Wilcoxon signed rank test by the rule of this module; p = 1 if nothing differs."""
    d = differences(first, second)
    kept, ranks = _signed_ranks(d)
    zeros = len(d) - len(kept)
    w = float(min(ranks[kept > 0.0].sum(), ranks[kept < 0.0].sum()))
    _, ties = np.unique(ranks, return_counts=True)
    exact = zeros == 0 and len(kept) <= EXACT_PAIRS_MAX and bool((ties == 1).all())
    correction = float((ties**3 - ties).sum()) / 48.0
    p_normal = normal_p_value(w, len(kept), tie_correction=correction)
    return SignedRank(
        w,
        len(kept),
        zeros,
        exact_p_value(w, len(kept)) if exact else p_normal,
        "exact" if exact else "normal",
        p_normal,
        normal_p_value(w, len(kept), tie_correction=correction, continuity=0.5),
    )


def exact_p_value(w: float, pairs: int) -> float:
    """Two-sided p value of a rank sum ``w`` of ``pairs`` differences without ties: exact.

    Counts, rank by rank, in how many of the 2**pairs equally likely sign patterns each sum occurs.
    """
    counts = np.zeros(pairs * (pairs + 1) // 2 + 1)
    counts[0] = 1.0
    for rank in range(1, pairs + 1):
        counts[rank:] += counts[:-rank].copy()
    smaller = min(w, len(counts) - 1 - w)
    return float(min(1.0, 2.0 * counts[: int(smaller) + 1].sum() / 2.0**pairs))


def normal_p_value(
    w: float, pairs: int, *, tie_correction: float = 0.0, continuity: float = 0.0
) -> float:
    """Two-sided p value of a rank sum by the normal approximation; 1 without pairs."""
    mean = pairs * (pairs + 1) / 4.0
    variance = pairs * (pairs + 1) * (2 * pairs + 1) / 24.0 - tie_correction
    if variance <= 0.0:
        return 1.0
    z = max(0.0, abs(w - mean) - continuity) / np.sqrt(variance)
    return float(2.0 * stats.norm.sf(z))


def cohen_dz(first: ArrayLike, second: ArrayLike) -> float:
    """Mean difference in standard deviations of the differences; 0 if nothing differs."""
    d = differences(first, second)
    spread = _standard_error(d) * np.sqrt(len(d))
    if spread <= 0.0:
        return _without_spread(float(d.mean()))
    return float(d.mean() / spread)


def rank_biserial(first: ArrayLike, second: ArrayLike) -> float:
    """Share of the rank sum of falls minus that of rises, -1..1; 0 if nothing differs."""
    kept, ranks = _signed_ranks(differences(first, second))
    return float((np.sign(kept) * ranks).sum() / ranks.sum()) if len(kept) else 0.0


def mean_interval(values: ArrayLike, level: float = 0.95) -> Interval:
    """Mean with its t interval (normally distributed mean), from at least 2 values."""
    x = np.asarray(values, float)
    half = float(stats.t.ppf(0.5 + 0.5 * level, len(x) - 1)) * _standard_error(x)
    return Interval(float(x.mean()), float(x.mean() - half), float(x.mean() + half))


def bootstrap_interval(
    values: ArrayLike,
    statistic: Callable[[FloatArray], float],
    *,
    seed: int = 1,
    count: int = 2000,
    level: float = 0.95,
) -> Interval:
    """Percentile bootstrap over people: the same ``seed`` gives the same interval.

    Args:
        values: one value, or one row of values, per person.
        statistic: of such an array.
        seed: of the resampling.
        count: number of resamples.
        level: share of the resampled statistics inside the interval.
    """
    x = np.asarray(values, float)
    rng = np.random.default_rng(seed)
    found = [statistic(x[rng.integers(0, len(x), len(x))]) for _ in range(count)]
    low, high = np.quantile(found, [0.5 - 0.5 * level, 0.5 + 0.5 * level])
    return Interval(float(statistic(x)), float(low), float(high))


def _signed_ranks(d: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the differences that are not zero and the ranks of their sizes."""
    kept = d[np.abs(d) > ZERO]
    return kept, np.asarray(stats.rankdata(np.abs(kept)), float)


def _standard_error(values: FloatArray) -> float:
    return float(np.std(values, ddof=1) / np.sqrt(len(values)))


def _without_spread(mean: float) -> float:
    return 0.0 if mean == 0.0 else float(np.copysign(np.inf, mean))
