"""The tests of the study against the paper's published numbers, scipy and cases worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pldf.analysis.rounding import as_written, decimals_of
from pldf.analysis.statistics import (
    cohen_dz,
    compare,
    paired_t,
    rank_biserial,
    signed_rank,
)
from scipy import stats


def rates(seed: int, people: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, 0.6, people), rng.uniform(0.0, 0.4, people)


def ranks_with(w: int, pairs: int) -> np.ndarray:
    """Return differences 1 .. pairs, of which the one of rank ``w`` alone is negative."""
    ranks = np.arange(1.0, pairs + 1.0)
    ranks[w - 1] *= -1.0
    return ranks


def test_published_p_values_follow_from_the_published_statistics() -> None:
    spread = rates(1, 43)[0]
    standard = (spread - spread.mean()) / spread.std(ddof=1)
    t = paired_t(standard + 6.42 / np.sqrt(43), np.zeros(43))
    assert (t.t, t.df) == (pytest.approx(6.42), 42)
    assert t.p == pytest.approx(9.78e-8, rel=0.02)  # t is rounded to 6.42
    combined = signed_rank(ranks_with(1, 43), np.zeros(43))
    assert (combined.w, combined.method) == (1.0, "exact")
    assert combined.p == pytest.approx(4.55e-13, rel=2e-3)
    set_speed = signed_rank(ranks_with(24, 41), np.zeros(41))
    assert set_speed.p_normal == pytest.approx(1.38e-7, rel=2e-3)
    # What the paper did not do: none of these would round to its numbers.
    assert combined.p_normal > 1e-8
    assert set_speed.p < 1e-8
    assert set_speed.p_corrected == pytest.approx(1.43e-7, rel=2e-3)
    all_pairs = signed_rank(ranks_with(24, 43), np.zeros(43))
    assert all_pairs.p_normal == pytest.approx(5.9e-8, rel=2e-3)


def test_two_drivers_without_lever_reproduce_the_published_set_speed_test() -> None:
    found = signed_rank(np.append(ranks_with(24, 41), [0.0, 0.0]), np.zeros(43))
    assert (found.w, found.pairs, found.zeros, found.method) == (24.0, 41, 2, "normal")
    assert found.p == found.p_normal == pytest.approx(1.38e-7, rel=2e-3)
    assert found.p_corrected > found.p


@pytest.mark.parametrize("people", [5, 43, 50, 51])
def test_agrees_with_scipy(people: int) -> None:
    first, second = rates(people, people)
    t, w = stats.ttest_rel(first, second), stats.wilcoxon(first, second)
    assert paired_t(first, second).t == pytest.approx(t.statistic)
    assert paired_t(first, second).p == pytest.approx(t.pvalue)
    assert signed_rank(first, second).w == w.statistic
    assert signed_rank(first, second).p == pytest.approx(w.pvalue, rel=1e-9)
    assert signed_rank(first, second).method == ("exact" if people <= 50 else "normal")
    interval = t.confidence_interval()
    difference = compare(first, second).difference
    assert (difference.low, difference.high) == pytest.approx((interval.low, interval.high))


def test_zeros_and_ties_agree_with_scipys_approximation() -> None:
    first = np.array([3.0, 2.0, 2.0, 1.0, 5.0, 4.0, 0.0, 1.0, 7.0])
    second = np.array([1.0, 0.0, 4.0, 1.0, 2.0, 0.0, 0.0, 0.0, 2.0])
    found = signed_rank(first, second)
    for corrected, p in ((False, found.p), (True, found.p_corrected)):
        expected = stats.wilcoxon(first, second, method="asymptotic", correction=corrected)
        assert (found.w, p) == (expected.statistic, pytest.approx(expected.pvalue))
    assert (found.zeros, found.method) == (2, "normal")


def test_effect_sizes_by_hand() -> None:
    first, second = [5.0, 7.0, 6.0, 1.0], [1.0, 1.0, 4.0, 2.0]  # 4, 6, 2, -1: ranks 3, 4, 2, 1
    assert rank_biserial(first, second) == pytest.approx((9 - 1) / 10)
    assert cohen_dz(first, second) == pytest.approx(2.75 / np.std([4, 6, 2, -1], ddof=1))
    assert compare(first, second).fell == 3


def test_no_difference_is_no_effect() -> None:
    same = compare([0.1, 0.2, 0.3], [0.1, 0.2, 0.3])
    assert (same.t.t, same.t.p, same.signed_rank.p) == (0.0, 1.0, 1.0)
    assert (same.d_z, same.rank_biserial, same.fell) == (0.0, 0.0, 0)
    assert paired_t([1.5, 2.5], [1.0, 2.0]).t == np.inf


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=2, max_size=20))
def test_swapping_the_systems_changes_the_sign_only(pairs: list[tuple[int, int]]) -> None:
    first, second = np.array(pairs, float).T
    there, back = compare(first, second), compare(second, first)
    assert back.signed_rank == there.signed_rank
    assert back.t.p == pytest.approx(there.t.p)
    assert (back.d_z, back.rank_biserial) == pytest.approx((-there.d_z, -there.rank_biserial))


@pytest.mark.filterwarnings("error")
def test_differences_that_are_all_the_same_have_no_spread() -> None:
    first, second = [0.3, 0.5, 0.7], [0.1, 0.3, 0.5]  # 0.2 each, but for rounding
    found = compare(first, second)
    assert (found.t.t, found.t.df, found.t.p, found.d_z) == (np.inf, 2, 0.0, np.inf)
    back = compare(second, first)
    assert (back.t.t, back.t.p, back.d_z) == (-np.inf, 0.0, -np.inf)
    none = compare([0.1 + 0.2, 0.7, 0.1], [0.3, 0.7, 0.1])  # rounding is no effect
    assert (none.t.t, none.t.p, none.d_z, none.signed_rank.pairs) == (0.0, 1.0, 0.0, 0)


def test_students_sleep_data() -> None:
    """Student, "The probable error of a mean", Biometrika 6 (1908), as R's manual prints its tests.

    R: t = -4.0621, df = 9, p-value = 0.002833, interval -2.4598858 to -0.7001142 (``t.test``);
    V = 0, p-value = 0.009091, the approximation with continuity correction (``wilcox.test``).
    """
    first = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0]
    second = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4]
    found = compare(first, second)
    assert (found.t.t, found.t.df) == (pytest.approx(-4.0621, abs=5e-5), 9)
    assert found.t.p == pytest.approx(0.002833, abs=5e-7)
    interval = (found.difference.low, found.difference.high)
    assert interval == pytest.approx((-2.4598858, -0.7001142), abs=5e-8)
    ranks = found.signed_rank
    assert (ranks.w, ranks.zeros, ranks.pairs, ranks.method) == (0.0, 1, 9, "normal")
    assert ranks.p_corrected == pytest.approx(0.009091, abs=5e-7)


def test_hollanders_and_wolfes_depression_scores() -> None:
    """Hollander and Wolfe, Nonparametric Statistical Methods (1973), p. 29: R prints p = 0.01953.

    That is one-sided; two-sided it is twice that, 20 of the 512 patterns of signs.
    """
    first = [1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30]
    second = [0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29]
    found = signed_rank(first, second)
    assert (found.w, found.method) == (45 - 40, "exact")  # R prints V = 40
    assert found.p == pytest.approx(20 / 512)


def test_darwins_maize() -> None:
    """Darwin's crossed and self-fertilised plants, differences in eighths of an inch.

    Fisher, The Design of Experiments (1935): t = 2.148 with 14 degrees of freedom; Wilcoxon's test
    as SciPy's manual prints it: W = 24, p = 0.0413.
    """
    eighths = np.array([6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75.0])
    found = compare(12.0 + eighths / 8.0, np.full(15, 12.0))
    assert (found.t.t, found.t.df) == (pytest.approx(2.148, abs=5e-4), 14)
    assert found.signed_rank.w == 24.0
    assert found.signed_rank.p == pytest.approx(0.041259765625)


def test_differences_that_are_equal_on_paper_are_ties() -> None:
    tenths = np.array([3, 4, 5, 6, 7, 8, 2, 9]), np.array([2, 3, 4, 5, 6, 9, 3, 8])
    halves = np.array([35, 45, 55, 65, 25, 75]), np.array([15, 25, 35, 45, 35, 55])
    first, second = (np.append(10 * a, b) for a, b in zip(tenths, halves, strict=True))
    found = signed_rank(first / 100.0, second / 100.0)
    for corrected, p in ((False, found.p), (True, found.p_corrected)):
        expected = stats.wilcoxon(first - second, method="asymptotic", correction=corrected)
        assert (found.w, p) == (expected.statistic, pytest.approx(expected.pvalue))
    assert (found.w, found.method) == (15.0, "normal")


PAIRS = st.lists(st.tuples(st.integers(0, 200), st.integers(0, 200)), min_size=2, max_size=30)


@settings(max_examples=100, deadline=None)
@given(PAIRS, st.integers(1, 6), st.sampled_from([np.float64, np.float32]))
def test_decimal_numbers_are_tested_as_the_integers_they_are(
    pairs: list[tuple[int, int]], decimals: int, kind: type[np.floating]
) -> None:
    if kind is np.float32:
        decimals = min(decimals, 4)
    whole = np.array(pairs, float)
    a, b = as_written((whole / 10.0**decimals).astype(kind)).T
    expected, found = compare(*whole.T), compare(a, b)
    assert found.signed_rank == expected.signed_rank
    assert (found.t.t, found.t.p) == pytest.approx((expected.t.t, expected.t.p), rel=1e-9)
    assert (found.d_z, found.fell) == (pytest.approx(expected.d_z, rel=1e-9), expected.fell)
    differences = whole[:, 0] - whole[:, 1]
    if differences.any():
        scipys = stats.wilcoxon(differences, method="asymptotic")
        assert (found.signed_rank.w, found.signed_rank.p_normal) == (
            scipys.statistic,
            pytest.approx(scipys.pvalue, rel=1e-9),
        )


def test_thirds_of_three_drives_are_ties_too() -> None:
    parts = np.array([[1, 2, 4], [3, 5, 9], [2, 2, 6], [8, 9, 4]]) / 10.0
    first, second = parts.mean(axis=1), (parts - 0.1).mean(axis=1)
    assert len(np.unique(np.abs(first - second))) > 1  # so plain subtraction sees no ties
    found = compare(first, second)
    assert (found.signed_rank.w, found.signed_rank.method) == (0.0, "normal")
    assert (found.t.t, found.t.has_spread) == (np.inf, False)


def test_the_rounding_of_values_is_found_from_them() -> None:
    assert decimals_of([0.0, 1.0, np.nan]) == 0
    assert decimals_of([0.25, 0.5, 0.1 + 0.2]) == 2
    assert decimals_of([0.294117, 0.5]) == 6
    assert decimals_of(np.float32([0.2941, 0.3, 0.7])) == 4
    assert decimals_of([0.300000012, 0.699999988]) == 1  # float32 printed with nine digits
    assert decimals_of([0.3000001, 0.2000003]) == 7  # no numbers of single precision
    assert decimals_of(rates(3, 20)[0]) is None
    assert decimals_of([np.nan]) is None
    unrounded = rates(4, 20)[0]
    assert (as_written(unrounded) == unrounded).all()


def exact_by_counting(w: int, pairs: int) -> float:
    """Count in how many of the 2**pairs equally likely sign patterns each rank sum occurs."""
    counts = [1] + [0] * (pairs * (pairs + 1) // 2)
    for rank in range(1, pairs + 1):
        for total in range(len(counts) - 1, rank - 1, -1):
            counts[total] += counts[total - rank]
    return 2 * sum(counts[: w + 1]) / 2**pairs


@pytest.mark.parametrize(("w", "pairs"), [(1, 43), (24, 41), (10, 12), (50, 50)])
def test_exact_p_values_count_all_patterns_of_signs(w: int, pairs: int) -> None:
    found = signed_rank(ranks_with(w, pairs), np.zeros(pairs))
    assert (found.w, found.method) == (w, "exact")
    assert found.p == pytest.approx(exact_by_counting(w, pairs), rel=1e-12)


@pytest.mark.parametrize(
    ("first", "second"), [([1.0], [2.0]), ([1.0, 2.0], [1.0]), ([1.0, np.nan], [1.0, 2.0])]
)
def test_unusable_values_are_refused(first: list[float], second: list[float]) -> None:
    with pytest.raises(ValueError, match=r"at least 2 values|leave out"):
        compare(first, second)
