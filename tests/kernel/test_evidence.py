"""Learning only what is consistent: what waits, what is accepted, what goes back (section 6)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from laboratory import (
    BASE,
    KMH,
    Array,
    after,
    bent,
    function,
    outcomes,
    plain,
    play,
    play_override,
    road,
)
from lever_drives import ROAD, set_by
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    ACTIVE,
    GAS_OVERRIDE,
    LEARN_CONSISTENT,
    LEARN_FAITHFUL,
    OUTCOME_LEARNED,
    OUTCOME_PENDING,
    OUTCOME_STOP,
    STANDBY,
)
from pldf.kernel.evidence import lowered, raised
from pldf.kernel.state import PldfState
from pldf.profiles.stored_profile import Iteration, StoredProfile

STRAIGHT = road(2000.0)
FIRST, LAST = 800.0, 1100.0
INSIDE = slice(840, 1060)  # of every lesson below, clear of the slopes at its ends


class Driver:
    """Drives the same road again and again, with CONSISTENT unless told otherwise."""

    def __init__(self, **settings: Any) -> None:
        self.settings = {
            "learn": LEARN_CONSISTENT,
            "learning_stretch_factor": 0.0,
            **settings,
        }
        self.stored: StoredProfile | None = None
        self.made: DrivingFunction

    def start(self, **settings: Any) -> None:
        """Begin a drive."""
        self.made = plain(function(STRAIGHT, self.stored, **{**self.settings, **settings}))

    def end(self) -> Iteration:
        """Learn from it."""
        iteration = self.made.learn()
        self.stored = after(self.made, iteration)
        return iteration

    def press(
        self, change_kmh: float = 10.0, first: float = FIRST, last: float = LAST, **settings: Any
    ) -> Iteration:
        """Override between two places, this much faster or slower than the profile."""
        self.start(**settings)
        profile = np.array(self.made.profile.learned_mps)
        nodes = np.arange(float(len(profile)))
        extra = bent((first, 0.0), (first + 1.0, 1.0), (last, 1.0), (last + 1.0, 0.0))

        def speed(s_m: Array) -> Array:
            return np.interp(s_m, nodes, profile) + change_kmh * KMH * extra(s_m)

        play_override(self.made, speed, gas=[(first, last)])
        return self.end()

    def pass_by(self, **columns: Any) -> Iteration:
        """Drive as the profile does, without any intervention."""
        self.start()
        profile = np.array(self.made.profile.learned_mps)
        nodes = np.arange(float(len(profile)))
        play_override(self.made, lambda s_m: np.interp(s_m, nodes, profile), **columns)
        return self.end()


# Waiting and accepting


def test_one_press_teaches_nothing_and_is_kept() -> None:
    driver = Driver()
    one = driver.press()
    np.testing.assert_array_equal(one.learned_mps, one.base_mps)
    assert not one.drive.any()
    assert set(one.evidence_faster[INSIDE]) == {1.25}
    assert set(one.pending_faster[INSIDE]) == {1.0}
    np.testing.assert_allclose(one.pending_faster_mps[INSIDE], BASE + 10.0 * KMH, atol=1e-9)
    assert not one.evidence_slower.any()
    assert list(outcomes(driver.made)) == [OUTCOME_PENDING]


def test_two_in_a_row_are_learned_with_their_mean() -> None:
    """Eq. (3) with the mean of +10 and +14 km/h: half of 12 km/h."""
    driver = Driver()
    driver.press(10.0)
    two = driver.press(14.0)
    np.testing.assert_allclose(two.learned_mps[INSIDE], BASE + 6.0 * KMH, atol=1e-9)
    assert set(two.evidence_faster[INSIDE]) == {2.2}
    assert not two.pending_faster.any()
    assert not two.pending_faster_mps.any()
    assert list(outcomes(driver.made)) == [OUTCOME_LEARNED]
    assert set(two.drive[INSIDE]) == {2.0}
    assert set(two.intervention[INSIDE]) == {1.0}
    assert set(two.lessons[INSIDE]) == {1.0}


def test_slower_is_learned_in_the_same_way() -> None:
    driver = Driver()
    one = driver.press(-10.0)
    assert set(one.evidence_slower[INSIDE]) == {1.25}
    assert not one.evidence_faster.any()
    two = driver.press(-14.0)
    np.testing.assert_allclose(two.learned_mps[INSIDE], BASE - 6.0 * KMH, atol=1e-9)


def test_two_silent_passes_drop_a_demonstration() -> None:
    driver = Driver()
    driver.press()
    np.testing.assert_allclose(driver.pass_by().evidence_faster[INSIDE], 0.27)
    third = driver.pass_by()
    for name in ("evidence_faster", "pending_faster", "pending_faster_mps"):
        assert not getattr(third, name).any()


def test_the_opposite_is_a_pass_without_a_wish_of_this_sign() -> None:
    driver = Driver()
    driver.press(10.0)
    second = driver.press(-10.0)
    np.testing.assert_allclose(second.evidence_faster[INSIDE], 0.27)
    assert set(second.evidence_slower[INSIDE]) == {1.25}
    np.testing.assert_array_equal(second.learned_mps, second.base_mps)


def test_a_segment_is_accepted_as_a_whole_once_half_of_it_is() -> None:
    driver = Driver()
    driver.press(10.0, 800.0, 1000.0)
    small = driver.press(10.0, 920.0, 1120.0)  # 80 of 320 m twice
    np.testing.assert_array_equal(small.learned_mps, small.base_mps)
    driver = Driver()
    driver.press(10.0, 800.0, 1000.0)
    large = driver.press(10.0, 860.0, 1060.0)  # 140 of 260 m
    # Around 860 m the mean has the foot of the second one in it.
    for part in (slice(820, 840), slice(880, 980), slice(1010, 1040)):
        np.testing.assert_allclose(large.learned_mps[part], BASE + 5.0 * KMH, atol=1e-9)
    assert set(large.intervention[810:1050]) == {1.0}


# Accepted


def test_silence_means_content_once_it_is_accepted() -> None:
    driver = Driver()
    driver.press()
    taught = driver.press()
    for _ in range(4):
        quiet = driver.pass_by()
        np.testing.assert_array_equal(quiet.learned_mps, taught.learned_mps)
        np.testing.assert_array_equal(quiet.evidence_faster, taught.evidence_faster)


def test_the_same_sign_then_teaches_at_once() -> None:
    driver = Driver()
    driver.press()
    before = driver.press()
    third = driver.press(8.0)
    np.testing.assert_allclose(
        third.learned_mps[INSIDE], before.learned_mps[INSIDE] + 4.0 * KMH, atol=1e-9
    )


def test_two_opposite_ones_in_a_row_put_the_base_profile_back() -> None:
    driver = Driver()
    driver.press()
    taught = driver.press()
    against = driver.press(-4.0, FIRST - 150.0, LAST + 50.0)
    np.testing.assert_array_equal(against.learned_mps, taught.learned_mps)
    back = driver.press(-4.0, FIRST - 150.0, LAST + 50.0)
    np.testing.assert_array_equal(back.learned_mps[INSIDE], back.base_mps[INSIDE])
    assert not back.evidence_faster[INSIDE].any()
    assert not back.evidence_slower[INSIDE].any()


def test_with_a_silent_pass_between_them_they_do_not() -> None:
    driver = Driver()
    driver.press()
    taught = driver.press()
    driver.press(-4.0)
    driver.pass_by()
    kept = driver.press(-4.0)
    np.testing.assert_array_equal(kept.learned_mps, taught.learned_mps)


def test_what_was_learned_at_once_counts_as_accepted() -> None:
    driver = Driver()
    taught = driver.press(learn=LEARN_FAITHFUL)
    assert not taught.evidence_faster.any()
    quiet = driver.pass_by()
    np.testing.assert_array_equal(quiet.learned_mps, taught.learned_mps)
    assert set(quiet.evidence_faster[INSIDE]) == {2.2}
    again = driver.press(8.0)
    np.testing.assert_allclose(
        again.learned_mps[INSIDE], taught.learned_mps[INSIDE] + 4.0 * KMH, atol=1e-9
    )


def test_a_lesson_learned_at_once_overtakes_what_is_pending() -> None:
    driver = Driver()
    driver.press()
    taught = driver.press(learn=LEARN_FAITHFUL)
    assert not taught.pending_faster[INSIDE].any()
    assert not taught.evidence_faster[INSIDE].any()


def test_the_flag_wins_over_faithful() -> None:
    driver = Driver(learn=LEARN_FAITHFUL, learn_consistent=1)
    one = driver.press()
    np.testing.assert_array_equal(one.learned_mps, one.base_mps)


# Passes that do not count


@pytest.mark.parametrize(
    "columns",
    [{"eligible": 0.0}, {"mode": float(STANDBY)}],
    ids=["not eligible", "not active"],
)
def test_where_nothing_may_be_learned_no_pass_counts(columns: dict[str, float]) -> None:
    driver = Driver()
    before = driver.press()
    driver.start()
    s_m = np.arange(0.0, 1999.75, 0.5)

    play(driver.made, s_m, BASE, **{"mode": float(ACTIVE), **columns})
    quiet = driver.end()
    np.testing.assert_array_equal(quiet.evidence_faster, before.evidence_faster)


def test_a_stop_counts_neither_way() -> None:
    driver = Driver()
    before = driver.press()
    driver.start()
    speed = bent((0, BASE), (700, BASE), (950, 1.0), (1150, BASE), (2000, BASE))
    play_override(driver.made, speed, brake=[(700, 1150)])
    stopped = driver.end()
    assert list(outcomes(driver.made)) == [OUTCOME_STOP]
    np.testing.assert_array_equal(stopped.evidence_faster, before.evidence_faster)
    assert not stopped.evidence_slower.any()


def test_a_hole_counts_neither_way() -> None:
    driver = Driver()
    before = driver.press()
    driver.start()

    s_m = np.concatenate((np.arange(0.0, 850.0, 0.5), np.arange(950.0, 1999.75, 0.5)))
    play(driver.made, s_m, BASE)
    after_hole = driver.end().evidence_faster
    np.testing.assert_array_equal(after_hole[860:940], before.evidence_faster[860:940])
    np.testing.assert_allclose(after_hole[1000:1080], 0.27)


# The lever


def press_lever(
    pieces: list[tuple[float, float, float]], stored: StoredProfile | None
) -> tuple[DrivingFunction, Iteration, StoredProfile]:
    made = set_by(pieces, stored=stored)
    made.record.learn = LEARN_CONSISTENT
    iteration = made.learn()
    return made, iteration, after(made, iteration)


def test_an_offset_waits_for_a_second_drive() -> None:
    plus_10 = [(1400.0, 2000.0, 90.0)]
    made, one, stored = press_lever(plus_10, None)
    assert not one.offset_mps.any()
    np.testing.assert_array_equal(one.learned_mps, one.base_mps)
    assert int(made.following.set_outcome[0]) == OUTCOME_PENDING
    assert one.offset_evidence_faster[1500] == 1.25
    assert not one.evidence_faster.any()
    made, two, stored = press_lever(plus_10, stored)
    assert int(made.following.set_outcome[0]) == OUTCOME_LEARNED
    np.testing.assert_allclose(two.offset_mps[1400:2000], 10.0 * KMH, atol=1e-9)
    assert not two.offset_pending_faster.any()
    assert two.learned_mps[1700] > two.base_mps[1700] + 2.0


def test_the_mean_of_the_offsets_that_waited_is_adopted() -> None:
    _, _, stored = press_lever([(1400.0, 2000.0, 90.0)], None)
    _, two, _ = press_lever([(1600.0, 2000.0, 84.0)], stored)
    np.testing.assert_allclose(two.offset_mps[1400:1590], 10.0 * KMH, atol=1e-9)
    np.testing.assert_allclose(two.offset_mps[1610:2000], 7.0 * KMH, atol=1e-9)


def test_two_drives_without_the_lever_drop_an_offset() -> None:
    _, _, stored = press_lever([(1400.0, 2000.0, 90.0)], None)
    _, second, stored = press_lever([], stored)
    np.testing.assert_allclose(second.offset_evidence_faster[1500], 0.27)
    _, third, _ = press_lever([], stored)
    assert not third.offset_pending_faster.any()
    assert not third.offset_evidence_faster.any()


def test_another_offset_set_twice_takes_the_place_of_the_first() -> None:
    stored: StoredProfile | None = None
    for _ in range(2):
        _, _, stored = press_lever([(1400.0, 2000.0, 90.0)], stored)
    _, one, stored = press_lever([(1400.0, 2000.0, 84.0)], stored)
    np.testing.assert_allclose(one.offset_mps[1500], 10.0 * KMH, atol=1e-9)
    _, two, _ = press_lever([(1400.0, 2000.0, 84.0)], stored)
    np.testing.assert_allclose(two.offset_mps[1500], 4.0 * KMH, atol=1e-9)


def test_the_pedals_are_judged_against_the_set_speed_that_waits() -> None:
    """+10 km/h by lever is no wish of the pedals, even where a pedal is pressed in between."""
    made = function(ROAD, learn=LEARN_CONSISTENT, learning_stretch_factor=0.0)

    s_m = np.arange(0.0, 3000.5, 0.5)
    set_mps = np.where((s_m >= 1100.0) & (s_m < 2000.0), 90.0 * KMH, 0.0)
    limit = np.array(made.route.limit_mps)[s_m.astype(int)]
    offset = np.where(set_mps > 0.0, set_mps - limit, 0.0)
    mode = np.where((s_m >= 1600.0) & (s_m < 1750.0), GAS_OVERRIDE, ACTIVE)
    planned = set_by([(1100.0, 2000.0, 90.0)])
    planned.learn()  # FAITHFUL: the plan with that set speed
    speed = np.interp(s_m, np.arange(3001.0), np.array(planned.following.planned_mps))
    speed = speed + np.where(mode == GAS_OVERRIDE, 8.0 * KMH, 0.0)
    play(made, s_m, speed, mode=mode, set_speed_mps=np.where(set_mps > 0.0, set_mps, limit),
         set_speed_offset_mps=offset)  # fmt: skip
    one = made.learn()
    assert one.evidence_faster[1700] == 1.25
    assert not one.evidence_faster[1200:1450].any()
    assert not one.evidence_faster[1850:].any()
    np.testing.assert_allclose(one.pending_faster_mps[1700], 98.0 * KMH, atol=0.02)


# The sequential test itself


@pytest.mark.parametrize(("share", "wrong_percent"), [(0.02, 0.35), (0.05, 2.1)])
def test_accidental_presses_teach_as_seldom_as_the_test_promises(
    share: float, wrong_percent: float
) -> None:
    """Ten passes, exactly: the chance to reach acceptance, over all 1024 histories."""
    chance = 0.0
    for history in range(1 << 10):
        presses = [bool(history >> k & 1) for k in range(10)]
        if np.max(walk(presses)) >= 2.2:
            chance += share ** sum(presses) * (1.0 - share) ** (10 - sum(presses))
    assert 100.0 * chance == pytest.approx(wrong_percent, rel=0.05)


def test_a_consistent_wish_is_learned_after_2_3_passes() -> None:
    random = np.random.default_rng(1)
    waited = []
    for _ in range(4000):
        reached = np.flatnonzero(np.array(walk(list(random.random(60) < 0.9))) >= 2.2)
        waited.append(reached[0] + 1)
    assert np.mean(waited) == pytest.approx(2.3, abs=0.05)


def walk(presses: list[bool]) -> list[float]:
    """Evidence of one metre after each pass, by the kernel."""
    st = PldfState()
    evidence, seen = 0.0, []
    for pressed in presses:
        evidence = raised(st, evidence) if pressed else lowered(st, evidence)
        seen.append(evidence)
    return seen
