"""``learning.set_speed_gain``: how far towards the driver's set speed a drive brings the plan."""

from __future__ import annotations

from typing import Final

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, Array, after, function, plain, play
from lever_drives import LIMIT, ROAD, set_by
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, LEARN_CONSISTENT, LEARN_FAITHFUL
from pldf.outcome_words import lines_of
from pldf.outcomes import outcomes_of
from pldf.profiles.stored_profile import Iteration, StoredProfile

# Set under each of the two limits: 10 km/h more, and 6 less.
PRESSES: Final = [(1400.0, 2000.0, 90.0), (2500.0, 3001.0, 94.0)]


def lesson(
    gain: float, wishes_kmh: list[float], learn: int = 1
) -> tuple[list[Iteration], StoredProfile]:
    """Drive with one set speed after another from 1400 m on, learning after each drive."""
    stored, learned = None, []
    for wish in wishes_kmh:
        made = set_by([(1400.0, 2000.0, wish)], stored=stored)
        made.record.learning_set_speed_gain = gain
        made.record.learn = learn
        learned.append(made.learn())
        stored = after(made, learned[-1])
    assert stored is not None
    return learned, stored


def test_at_one_half_what_is_missing_is_halved_by_every_drive() -> None:
    learned, _ = lesson(0.5, [90.0] * 5)
    missing_kmh = [10.0 - one.offset_mps[1700] / KMH for one in learned]
    np.testing.assert_allclose(missing_kmh, [5.0, 2.5, 1.25, 0.625, 0.3125])


@settings(max_examples=5, deadline=None)
@given(gain=hs.floats(0.0, 1.0), wishes=hs.lists(hs.floats(60.0, 98.0), min_size=1, max_size=4))
def test_the_offset_is_the_weighted_mean_of_all_wishes(gain: float, wishes: list[float]) -> None:
    """Exponential smoothing in closed form: weights gain (1 - gain)^age."""
    # Within half a displayed unit of the set speed in force it is no press.
    learned, _ = lesson(gain, wishes)
    known = 0.0
    for one, wish in zip(learned, wishes, strict=True):
        if abs(wish - (80.0 + known)) > 0.5 + 1e-9:
            known = float(np.average([known, wish - 80.0], weights=[1.0 - gain, gain]))
        assert one.offset_mps[1700] / KMH == pytest.approx(known, abs=1e-9)
        assert not np.any(one.offset_mps[:1400])


def test_a_gain_of_one_is_what_was_always_learned_to_the_bit() -> None:
    without = set_by(PRESSES)
    told = [np.array(column) for column in vars_of(without.learn())]
    made = set_by(PRESSES)
    made.record.learning_set_speed_gain = 1.0
    for before, now in zip(told, vars_of(made.learn()), strict=True):
        assert before.tobytes() == now.tobytes()


def vars_of(learned: Iteration) -> list[Array]:
    return [learned.offset_mps, learned.learned_mps, learned.drive, learned.lessons]


def test_nothing_is_learned_of_the_lever_with_a_gain_of_nothing() -> None:
    learned, _ = lesson(0.0, [90.0, 70.0])
    assert not np.any(learned[-1].offset_mps)


def test_where_no_lever_was_moved_nothing_changes_to_the_bit() -> None:
    first, stored = lesson(0.81, [91.0])
    made = set_by([(2500.0, 3001.0, 94.0)], stored=stored)
    made.record.learning_set_speed_gain = 0.81
    second = made.learn()
    before, after_it = np.array(first[0].offset_mps), np.array(second.offset_mps)
    assert before[1700] > 0.0 and after_it[2700] < 0.0
    assert after_it[:2000].tobytes() == before[:2000].tobytes()


def test_the_plan_is_that_of_the_smaller_offset() -> None:
    """As if the driver had set half as much, and all of it had been learned."""
    halved, _ = lesson(0.5, [90.0])
    whole, _ = lesson(1.0, [85.0])
    np.testing.assert_allclose(halved[0].learned_mps, whole[0].learned_mps, atol=1e-12)


def test_consistent_approaches_only_what_is_accepted() -> None:
    learned, _ = lesson(0.5, [90.0, 90.0, 90.0], LEARN_CONSISTENT)
    found = [one.offset_mps[1700] / KMH for one in learned]
    np.testing.assert_allclose(found, [0.0, 5.0, 7.5])


def pressed_in_between(
    gain: float, speed_over_set_mps: float, learn: int = LEARN_FAITHFUL
) -> Iteration:
    """Learn from gas between 1600 and 1700 m, with +10 km/h set under the whole limit."""
    stored = None
    learned = None
    for _ in range(1 if learn == LEARN_FAITHFUL else 2):
        settings = {"learning_set_speed_gain": gain, "learning_stretch_factor": 0.0}
        made = plain(function(ROAD, stored, learn=learn, **settings))
        s_m = np.arange(0.0, 3000.5, 0.5)
        gas = (s_m >= 1600.0) & (s_m < 1700.0)
        limit = np.array(made.route.limit_mps)[s_m.astype(int)]
        set_mps = limit + np.where((s_m >= 1000.0) & (s_m < 2000.0), 10.0 * KMH, 0.0)
        speed = np.minimum(set_mps, 27.0) + speed_over_set_mps * gas
        offset = set_mps - limit - np.array(made.profile.offset_mps)[s_m.astype(int)]
        play(
            made, s_m, speed, mode=np.where(gas, GAS_OVERRIDE, ACTIVE), set_speed_mps=set_mps,
            set_speed_offset_mps=offset,
        )  # fmt: skip
        learned = made.learn()
        stored = after(made, learned)
    assert learned is not None
    return learned


@pytest.mark.parametrize("learn", [LEARN_FAITHFUL, LEARN_CONSISTENT])
def test_what_the_lever_still_lacks_is_not_learned_from_the_pedals(learn: int) -> None:
    """Eq. (3) for 2 m/s over the set speed is 1 m/s over the plan, whichever plan that is."""
    for gain in (1.0, 0.5, 0.0):
        learned = pressed_in_between(gain, 2.0, learn)
        plan = LIMIT + learned.offset_mps[1650]
        assert learned.learned_mps[1650] - plan == pytest.approx(1.0, abs=1e-9)
        assert learned.learned_mps[1400] == pytest.approx(LIMIT + learned.offset_mps[1400])


def test_the_log_says_how_far_the_profile_goes() -> None:
    made = set_by([(1400.0, 2000.0, 90.0)])
    made.record.learning_set_speed_gain = 0.81
    made.learn()
    told = list(lines_of(outcomes_of(made.record, made.trace, made.following)))
    assert any("+10.0 km/h learned, the profile goes 81 percent of the way" in t for t in told)
