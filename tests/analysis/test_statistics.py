"""The tests of the study against the paper's published numbers, scipy and cases worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
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
