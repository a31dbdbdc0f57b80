"""The normal numbers that a wish varies by, against scipy and the tests of randomness."""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import special, stats

from vehicle_models.normal import exponential, natural_log, normal_quantile
from vehicle_models.variation_kernel import (
    LATERAL_OF_PLACE,
    OF_OCCASION,
    OFFSET_OF_PERSON,
    keyed_uniform,
)

Table = NDArray[np.float64]

SEED_MAX: Final = 999_999_999
PURPOSES: Final = range(OFFSET_OF_PERSON, LATERAL_OF_PLACE + OF_OCCASION + 1)
SEEDS: Final = 3000
# Standard errors that the largest of some thousand independent numbers does not reach.
FAR: Final = 5.0


# Arithmetic


def grid_of_chances() -> Table:
    """Return chances that can be drawn: the outermost, the middle, the seams, and some others."""
    near = np.arange(60)
    middle = 2**31 - 30 + near
    seams = [round(seam * 2**32) - 30 + near for seam in (0.075, 0.925)]
    others = np.random.default_rng(1).integers(0, 2**32, 3000)
    chosen = np.concatenate([near, 2**32 - 1 - near, middle, *seams, others])
    return (chosen + 0.5) / 2**32


def test_quantile_is_the_normal_one() -> None:
    chances = grid_of_chances()
    ours = np.array([normal_quantile(u) for u in chances])
    np.testing.assert_allclose(ours, special.ndtri(chances), rtol=4e-15)
    tiny = 10.0 ** -np.linspace(10, 300, 100)  # the far tail, which no draw reaches
    np.testing.assert_allclose([normal_quantile(u) for u in tiny], special.ndtri(tiny), rtol=4e-15)


def test_quantile_turns_around_the_middle_and_never_falls() -> None:
    chances = np.sort(grid_of_chances())
    ours = np.array([normal_quantile(u) for u in chances])
    assert np.array_equal(ours, [-normal_quantile(1.0 - u) for u in chances])
    assert np.all(np.diff(ours) >= 0.0)
    assert normal_quantile(0.5) == 0.0


def test_logarithm_and_exponential_keep_their_stated_errors() -> None:
    rng = np.random.default_rng(2)
    wide = np.concatenate([10.0 ** rng.uniform(-300, 300, 2000), 1.0 + rng.uniform(-1e-3, 1, 2000)])
    exact = np.log(wide.astype(np.longdouble))
    missed = np.abs(np.array([natural_log(x) for x in wide]) - exact)
    assert np.all(missed < 1e-15 * np.maximum(1.0, np.abs(exact)))
    logs = np.concatenate([rng.uniform(-600, 600, 2000), rng.uniform(-2, 2, 2000)])
    exact = np.exp(logs.astype(np.longdouble))
    missed = np.abs(np.array([exponential(x) for x in logs]) - exact)
    assert np.all(missed < (2e-15 + 2e-16 * np.abs(logs)) * exact)
    assert exponential(0.0) == 1.0
    assert natural_log(1.0) == 0.0


# Chance


@cache
def drawn(first_seed: int) -> Table:
    """Return normal numbers for consecutive seeds: by seed, purpose, metre."""
    metres = (0, 1, 2, 1000, 3040)
    return np.array(
        [
            [[normal_quantile(keyed_uniform(seed, what, at)) for at in metres] for what in PURPOSES]
            for seed in range(first_seed, first_seed + SEEDS)
        ]
    )


FIRST_SEEDS: Final = (0, 123_456_789, SEED_MAX - SEEDS + 1)


@pytest.mark.parametrize("first", FIRST_SEEDS)
def test_draws_are_standard_normal_for_each_purpose_and_metre(first: int) -> None:
    columns = drawn(first).reshape(SEEDS, -1).T
    chances = [stats.kstest(column, "norm").pvalue for column in columns]
    assert min(chances) > 1e-3 / len(chances)
    assert np.all(np.abs(columns.mean(axis=1)) < FAR / np.sqrt(SEEDS))
    assert np.all(np.abs(columns.var(axis=1) - 1.0) < FAR * np.sqrt(2.0 / SEEDS))
    for beyond in (2.0, 3.0, 4.0):
        expected = 2.0 * stats.norm.sf(beyond) * columns.size
        found = np.count_nonzero(np.abs(columns) > beyond)
        assert abs(found - expected) < FAR * np.sqrt(expected) + 1.0


@pytest.mark.parametrize("first", FIRST_SEEDS)
def test_draws_of_purposes_and_metres_have_nothing_in_common(first: int) -> None:
    columns = drawn(first).reshape(SEEDS, -1).T
    for compared in (columns, columns**2):
        common = np.corrcoef(compared) - np.eye(len(columns))
        assert np.abs(common).max() < FAR / np.sqrt(SEEDS)


@pytest.mark.parametrize("first", FIRST_SEEDS)
def test_consecutive_drives_have_nothing_in_common(first: int) -> None:
    table = drawn(first).reshape(SEEDS, -1)
    for lag in (1, 2, 3, 4, 5, 8, 16, 64, 256, 1024):
        before, after = table[:-lag], table[lag:]
        common = np.mean(before * after, axis=0) * np.sqrt(len(before))
        assert np.abs(common).max() < FAR, lag
    squares, *_ = np.histogram2d(
        special.ndtr(table[:-1]).ravel(), special.ndtr(table[1:]).ravel(),
        bins=20, range=[[0, 1], [0, 1]],
    )  # fmt: skip
    assert stats.chisquare(squares.ravel()).pvalue > 1e-4


@pytest.mark.parametrize("seed", [0, 1, SEED_MAX])
def test_neighbouring_metres_have_nothing_in_common(seed: int) -> None:
    for what in PURPOSES:
        along = np.array([normal_quantile(keyed_uniform(seed, what, at)) for at in range(2000)])
        assert stats.kstest(along, "norm").pvalue > 1e-5
        for lag in (1, 2, 4, 10, 100):
            count = len(along) - lag
            assert abs(np.sum(along[:-lag] * along[lag:])) < FAR * np.sqrt(count)
