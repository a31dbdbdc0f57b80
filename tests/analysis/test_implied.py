"""What the paper's tests imply, against scipy and against all ways to sign a few ranks."""

from __future__ import annotations

from itertools import product
from math import sqrt

import numpy as np
import pytest
import scipy
from pldf.analysis import implied
from pldf.analysis.published import TESTS, PublishedTest


def test_effect_of_the_papers_t_test() -> None:
    test = TESTS["pedal"]
    d_z = implied.d_z(test)
    assert f"{d_z:.2f}" == "0.98"
    assert 2.0 * scipy.stats.t.sf(d_z * sqrt(43), 42) == pytest.approx(test.p, rel=0.02)


def test_drivers_of_the_papers_rank_tests() -> None:
    assert implied.without_difference(TESTS["set_speed"]) == 2
    assert implied.fell(TESTS["set_speed"]) == (35, 40)
    assert implied.without_difference(TESTS["combined"]) == 0
    assert implied.fell(TESTS["combined"]) == (42, 42)


def test_a_p_value_that_no_number_of_drivers_gives_is_told() -> None:
    with pytest.raises(ValueError, match=r"W = 24, p = 1.00e-02: .* could be \[\]"):
        implied.without_difference(PublishedTest("wilcoxon", 24.0, 0.01))


@pytest.mark.parametrize("pairs", [1, 2, 5, 9])
def test_who_fell_against_all_ways_to_rise(pairs: int) -> None:
    ranks = np.arange(1, pairs + 1)
    fell_by_w: dict[int, set[int]] = {}
    for rose in product([False, True], repeat=pairs):
        w = int(ranks[np.array(rose)].sum())
        fell_by_w.setdefault(w, set()).add(pairs - sum(rose))
    for w in range(pairs * (pairs + 1) // 4 + 1):
        assert implied.fell_between(w, pairs) == (min(fell_by_w[w]), max(fell_by_w[w])), w


def test_who_fell_lies_within_the_bounds_with_ties_too() -> None:
    rng = np.random.default_rng(3)
    for _ in range(300):
        d = rng.choice([-3, -2, -1, 1, 2, 3, 4, 5], size=12)
        ranks = scipy.stats.rankdata(np.abs(d))
        low, high = implied.fell_between(float(ranks[d < 0].sum()), 12)
        assert low <= (d > 0).sum() <= high
