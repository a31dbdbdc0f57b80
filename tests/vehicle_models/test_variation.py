"""How a wish varies, judged from the words of the rule, by people drawn in large numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Final

import numpy as np
import pytest
from driver_watch import KMH
from numpy.typing import NDArray
from pldf.errors import ModelError
from pldf.instance import zeros
from pldf.kernel.arrays import RouteArrays, Work
from pldf.kernel.signals import signals_of
from scipy import stats

from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_state import DriverState
from vehicle_models.variation_kernel import fill_lateral_accels, fill_offsets
from vehicle_models.wish_kernel import WishArrays, prepare_wish

Table = NDArray[np.float64]

SEED_MAX: Final = 999_999_999
PEOPLE: Final = 4000
# Standard errors that no honest number reaches.
FAR: Final = 5.0
# The rule: person 3.5, person and place 2.8, occasion 2.2 km/h, 5 km/h in total.
PERSON_KMH, PLACE_KMH, OCCASION_KMH = 3.5, 2.8, 2.2
RULE: Final = {
    "wish_offset_mps": 7.0 * KMH,
    "wish_offset_person_sd_mps": PERSON_KMH * KMH,
    "wish_offset_place_sd_mps": PLACE_KMH * KMH,
    "wish_offset_occasion_sd_mps": OCCASION_KMH * KMH,
    "wish_lateral_person_sigma": 0.175,
    "wish_lateral_place_sigma": 0.14,
    "wish_lateral_occasion_sigma": 0.11,
}
SPREADS: Final = [
    signal.field
    for signal in signals_of(DriverState)
    if signal.name.endswith(("_sd_mps", "_sigma"))
]


def someone(person_seed: int, seed: int, **values: float) -> DriverState:
    """Return a driver as the rule has it, but for ``values``."""
    given = {**RULE, **values}
    return replace(DriverState(), person_seed=person_seed, seed=seed, **given)  # type: ignore[arg-type]


def offsets(who: DriverState, limit: Table) -> Table:
    """Return the wished offsets per metre."""
    filled = np.zeros(len(limit))
    fill_offsets(who, limit, filled)
    return filled


def laterals(who: DriverState, curvature: Table) -> Table:
    """Return the accepted lateral accelerations per metre."""
    filled = np.zeros(len(curvature))
    fill_lateral_accels(who, curvature, filled)
    return filled


def planned(who: DriverState, limit: Table, curvature: Table) -> Table:
    """Return the wished speed per metre."""
    wish, work = zeros(WishArrays, len(limit)), zeros(Work, len(limit))
    route = RouteArrays(limit, curvature, np.zeros(0), np.zeros(0), np.zeros(0))
    prepare_wish(who, route, wish, work)
    return np.array(wish.wish_mps)


def limits(*ends_and_kmh: tuple[int, float]) -> Table:
    """Return legal limits per metre from (end in m, limit in km/h)."""
    filled: list[float] = []
    for end, kmh in ends_and_kmh:
        filled += [kmh * KMH] * (end - len(filled))
    return np.array(filled)


# The rule


PLACES: Final = limits((1, 50), (2, 70), (3, 50), (4, 100))


@cache
def wished_kmh() -> Table:
    """Return offsets in km/h: by person, drive, place; each person drives twice."""
    seeds = np.random.default_rng(7).integers(1, SEED_MAX, PEOPLE)  # as a study draws them
    return np.array(
        [[offsets(someone(seed, seed + d), PLACES) for d in (0, 1)] for seed in seeds.tolist()]
    ) / (KMH)


@cache
def accepted_logs() -> Table:
    """Return logarithms of the accepted lateral acceleration: by person, drive, curve."""
    bends = np.array([0.0, 0.01, 0.0, 0.004, 0.0, 0.02])
    seeds = np.random.default_rng(8).integers(1, SEED_MAX, PEOPLE)
    table = [
        [laterals(someone(seed, seed + d), bends)[1::2] for d in (0, 1)] for seed in seeds.tolist()
    ]
    return np.log(np.array(table))


def correlation(one: Table, other: Table) -> float:
    """Return Pearson's correlation over all people."""
    return float(np.corrcoef(one.ravel(), other.ravel())[0, 1])


@pytest.mark.parametrize("table", [wished_kmh, accepted_logs])
def test_same_driver_again_correlates_as_the_literature_says(table: Callable[[], Table]) -> None:
    speeds = table()
    # Haglund and Aberg (2002): .81 at the same place again, .49 at another place (another day).
    same_place = correlation(speeds[:, 0], speeds[:, 1])
    elsewhere = correlation(speeds[:, 0, :-1], speeds[:, 1, 1:])
    assert same_place == pytest.approx(0.81, abs=0.02)
    assert elsewhere == pytest.approx(0.49, abs=0.03)
    # Half of the occasion is the whole drive: other places on the same day have more in common.
    same_day = correlation(speeds[:, 0, :-1], speeds[:, 0, 1:])
    assert same_day == pytest.approx(0.49 + 0.19 / 2.0, abs=0.03)


def test_total_spread_is_the_published_one() -> None:
    speeds = wished_kmh()
    assert speeds.mean() == pytest.approx(7.0, abs=FAR * 5.0 / np.sqrt(PEOPLE))
    assert np.std(speeds[:, 0], axis=0) == pytest.approx([5.0] * 4, rel=0.05)
    assert stats.kstest((speeds[:, 0, 0] - 7.0) / 5.0, "norm").pvalue > 1e-3
    logs = accepted_logs() - np.log(2.9)
    assert np.std(logs[:, 0], axis=0) == pytest.approx([0.25] * 3, rel=0.05)
    assert stats.kstest(logs[:, 0, 0] / 0.25, "norm").pvalue > 1e-3


@pytest.mark.parametrize(
    ("table", "person", "place", "occasion"),
    [(wished_kmh, PERSON_KMH, PLACE_KMH, OCCASION_KMH), (accepted_logs, 0.175, 0.14, 0.11)],
)
def test_each_part_has_its_share(
    table: Callable[[], Table], person: float, place: float, occasion: float
) -> None:
    speeds = table()
    one, other = speeds[:, 0], speeds[:, 1]
    within = one - other  # person and place are gone: the occasion's variance is left, twice
    assert within.var() == pytest.approx(2.0 * occasion**2, rel=0.06)
    between = np.cov(within.T)  # what the drive is, all places have
    shared = between[np.triu_indices_from(between, 1)]
    assert shared == pytest.approx(occasion**2, rel=0.15)
    lasting = np.mean((one[:, :-1] - one[:, 1:]) * (other[:, :-1] - other[:, 1:]))
    assert lasting == pytest.approx(2.0 * place**2, rel=0.1)
    assert np.mean(
        (one[:, :-1] - one.mean()) * (other[:, 1:] - other.mean())
    ) == pytest.approx(person**2, rel=0.1)  # fmt: skip


def test_offset_and_lateral_acceleration_of_one_seed_have_nothing_in_common() -> None:
    seeds = range(1, PEOPLE + 1)
    limit, bend = np.full(2, 70.0 * KMH), np.array([0.01, 0.01])
    found = [
        (offsets(someone(s, s), limit)[0], math.log(laterals(someone(s, s), bend)[0]))
        for s in seeds
    ]
    assert abs(np.corrcoef(np.array(found).T)[0, 1]) < FAR / np.sqrt(PEOPLE)


# Places


ROAD: Final = limits((300, 100), (700, 80), (1000, 50), (1500, 100))
BENDS: Final = np.zeros(1500)
BENDS[200:260] = 0.01
BENDS[600:680] = 0.006
BENDS[900:990] = 0.012


def test_a_place_is_one_limit_segment_and_one_curve() -> None:
    offset = offsets(someone(3, 4), ROAD)
    assert np.flatnonzero(np.diff(offset)).tolist() == [299, 699, 999]
    lateral = laterals(someone(3, 4), BENDS)
    straight = lateral[0]
    assert np.all(lateral[BENDS == 0.0] == straight)
    ways = [set(lateral[a:b].tolist()) for a, b in ((200, 260), (600, 680), (900, 990))]
    assert [len(way) for way in ways] == [1, 1, 1]
    assert len({straight, *(x for way in ways for x in way)}) == 4


def test_limit_that_is_put_in_elsewhere_changes_nothing_where_limits_begin_as_before() -> None:
    before = offsets(someone(3, 4), ROAD)
    changed = np.array(ROAD)
    changed[450:520] = 60.0 * KMH
    after = offsets(someone(3, 4), changed)
    assert np.array_equal(after[:450], before[:450])
    assert np.array_equal(after[700:], before[700:])
    # The limit behind the new one begins at another metre: another place.
    assert len({before[400], after[450], after[520]}) == 3


def test_another_speed_on_the_same_sign_is_the_same_place() -> None:
    changed = np.where(ROAD == 80.0 * KMH, 70.0 * KMH, ROAD)
    assert np.array_equal(offsets(someone(3, 4), changed), offsets(someone(3, 4), ROAD))


def test_road_that_ends_earlier_is_the_same_as_far_as_it_goes() -> None:
    whole = someone(3, 4)
    assert np.array_equal(offsets(whole, ROAD[:850]), offsets(whole, ROAD)[:850])
    assert np.array_equal(laterals(whole, BENDS[:850]), laterals(whole, BENDS)[:850])


def test_curve_that_is_put_in_elsewhere_changes_no_other() -> None:
    changed = np.array(BENDS)
    changed[400:440] = 0.02
    before, after = (laterals(someone(3, 4), bends) for bends in (BENDS, changed))
    elsewhere = changed != 0.02
    assert np.array_equal(after[elsewhere], before[elsewhere])


def test_curves_are_driven_at_what_is_accepted_there() -> None:
    who = someone(3, 4)
    wish = planned(who, np.full(1500, 40.0), BENDS)
    lateral = laterals(who, BENDS)
    for middle in (230, 640, 945):
        assert wish[middle] == pytest.approx(np.sqrt(lateral[middle] / BENDS[middle]), rel=1e-12)


# Persons and drives


def test_what_lasts_is_the_same_in_every_drive() -> None:
    lasting = {name: 0.0 for name in SPREADS if "occasion" in name}
    one, other = (planned(someone(5, seed, **lasting), ROAD, BENDS) for seed in (5, 6))
    assert np.array_equal(one, other)


def test_occasion_is_the_same_for_every_person() -> None:
    passing = {name: 0.0 for name in SPREADS if "occasion" not in name}
    one, other = (planned(someone(seed, 9, **passing), ROAD, BENDS) for seed in (5, 6))
    assert np.array_equal(one, other)
    assert not np.array_equal(one, planned(someone(5, 10, **passing), ROAD, BENDS))


@pytest.mark.parametrize("varies", SPREADS)
def test_each_part_alone_changes_the_wish_and_only_by_its_own_seed(varies: str) -> None:
    alone = {**dict.fromkeys(SPREADS, 0.0), varies: RULE[varies]}
    wish = planned(someone(5, 6, **alone), ROAD, BENDS)
    constant = planned(someone(5, 6, **dict.fromkeys(SPREADS, 0.0)), ROAD, BENDS)
    assert not np.array_equal(wish, constant)
    by_drive = "occasion" in varies
    other_drive = planned(someone(5, 7, **alone), ROAD, BENDS)
    other_person = planned(someone(6, 6, **alone), ROAD, BENDS)
    assert np.array_equal(wish, other_person) == by_drive
    assert np.array_equal(wish, other_drive) != by_drive


def test_without_variation_seeds_do_not_matter() -> None:
    constant = dict.fromkeys(SPREADS, 0.0)
    for person_seed, seed in ((0, 0), (SEED_MAX, SEED_MAX), (5, 6)):
        who = someone(person_seed, seed, **constant)
        assert set(offsets(who, ROAD)) == {RULE["wish_offset_mps"]}
        assert set(laterals(who, BENDS)) == {who.wish_lateral_accel_max_mps2}


# The ends


@pytest.mark.parametrize("seed", [0, 1, SEED_MAX])
def test_largest_spreads_stay_within_what_a_wish_may_be(seed: int) -> None:
    ends = {signal.field: signal.high for signal in signals_of(DriverState)}
    largest = {name: float(ends[name] or 0.0) for name in SPREADS}
    assert min(largest.values()) > 0.0
    road, bends = np.tile(ROAD, 4), np.tile(BENDS, 4)
    for person in (0, 1, SEED_MAX):
        who = someone(person, seed, **largest)
        assert np.all(np.abs(offsets(who, road) - 5.0) <= 25.0)
        accepted = laterals(who, bends)
        assert np.all((accepted >= 0.1) & (accepted <= 10.0))
        wish = planned(who, road, bends)
        assert np.all(np.isfinite(wish) & (wish > 0.0))


@pytest.mark.parametrize("varies", [*SPREADS, "person_seed"])
def test_negative_spread_or_seed_is_refused_by_name(varies: str) -> None:
    driver = ScriptedDriver()
    setattr(driver.record, varies, -1)
    name = {signal.field: signal.name for signal in signals_of(DriverState)}[varies]
    with pytest.raises(ModelError, match=name.replace(".", r"\.")):
        driver.initialize()
