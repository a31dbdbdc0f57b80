"""Pause, forget here, undo (section 7), by a car that drives with the function."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import KMH, Array, PointMass, after, bent, function, play_override, road
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    EVENT_FORGOTTEN,
    EVENT_NOTHING_TO_FORGET,
    EVENT_NOTHING_TO_UNDO,
    EVENT_PAUSED,
    EVENT_RESUMED,
    EVENT_UNDONE,
    LEARN_FAITHFUL,
    OUTCOME_FORGOTTEN,
    OUTCOME_LEARNED,
    OUTCOME_UNDONE,
)
from pldf.outcome_words import lines_of
from pldf.profiles.learned_columns import LEARNED
from pldf.profiles.stored_profile import Iteration, StoredProfile

LIMIT = 80.0 * KMH
ROAD = road(1600.0, ((0.0, LIMIT), (1100.0, 50.0 * KMH)))
STEP_S = 0.05


def taught(*spans: tuple[float, float, float]) -> StoredProfile:
    """What is stored after one drive per span (from m, to m, km/h), each an override by gas."""
    stored: StoredProfile | None = None
    for first, last, kmh in spans:
        made = function(ROAD, stored, apply_learned=1, learn=LEARN_FAITHFUL)
        base = np.array(made.profile.learned_mps)
        s_m = np.arange(0.0, ROAD.length_m + 0.25, 0.5)
        speed = driven(s_m, first, last, kmh, base)
        play_override(made, bent(*zip(s_m.tolist(), speed.tolist(), strict=True)), [(first, last)])
        stored = after(made, made.learn())
    assert stored is not None
    return stored


def driven(s_m: Array, first: float, last: float, kmh: float, profile: Array) -> Array:
    """The profile, and ``kmh`` between ``first`` and ``last``."""
    speed = np.interp(s_m, np.arange(float(len(profile))), profile)
    return np.where((s_m >= first) & (s_m < last), kmh * KMH, speed)


def with_offset(stored: StoredProfile, first: int, last: int, kmh: float) -> StoredProfile:
    """The same with an offset learned by the lever in some cells, as a drive of its own."""
    offset = stored.iteration().offset_mps.copy()
    offset[first:last] = kmh * KMH
    return stored.with_iteration(stored.next_iteration("drive", "drive", 0, {"offset_mps": offset}))


def car_at(s_m: float, stored: StoredProfile, **settings: int) -> PointMass:
    """A car under way at ``s_m`` with the function active, at the profile's speed."""
    made = function(ROAD, stored, **{"apply_learned": 1, "learn": 0, **settings})
    car = PointMass(made, float(made.profile.learned_mps[int(s_m)]))
    car.s_m = s_m
    car.run(0.1, STEP_S, lever_resume=1)
    return car


def press(car: PointMass, button: str) -> int:
    """Press once; return the event shown behind the step."""
    car.step(STEP_S, **{button: 1})
    event = car.made.record.hmi_event
    car.step(STEP_S, **{button: 0})
    return event


def learned(made: DrivingFunction) -> Array:
    return np.array(made.profile.learned_mps)


def known(made: DrivingFunction) -> dict[str, Array]:
    """All that a file keeps of what is in force."""
    return {name: np.array(getattr(made.profile, name)) for name in LEARNED}


def assert_same(ours: dict[str, Array], theirs: Iteration | dict[str, Array]) -> None:
    """Equal to the bit."""
    for name, column in ours.items():
        other = theirs[name] if isinstance(theirs, dict) else getattr(theirs, name)
        assert column.tobytes() == np.asarray(other).tobytes(), name


# Forget here


def test_the_piece_around_the_car_goes_back_to_base_at_once_and_nothing_else() -> None:
    stored = taught((300.0, 500.0, 95.0), (800.0, 950.0, 92.0))
    car = car_at(400.0, stored)
    before, base = learned(car.made), np.array(car.made.profile.base_mps)
    assert press(car, "teach_forget_here") == EVENT_FORGOTTEN
    now = learned(car.made)
    piece = np.abs(before - base) > 1.0 * KMH
    piece[650:] = False  # the other lesson
    assert np.count_nonzero(piece) > 200
    np.testing.assert_allclose(now[piece], base[piece], atol=0.3 * KMH)
    far = np.abs(np.arange(len(now)) - np.flatnonzero(piece).mean()) > 250.0
    assert now[far].tobytes() == before[far].tobytes()
    assert np.all(np.array(car.made.profile.lessons)[piece] == 0.0)
    assert press(car, "teach_forget_here") == EVENT_NOTHING_TO_FORGET


def test_forgetting_is_comfortable() -> None:
    car = car_at(400.0, taught((300.0, 500.0, 100.0)))
    car.step(STEP_S, teach_forget_here=1)
    request = [car.made.record.acceleration_request_mps2]
    while car.speed_mps > LIMIT + 0.5:
        car.step(STEP_S)
        request.append(car.made.record.acceleration_request_mps2)
    assert np.abs(np.diff(request)).max() <= 2.5 * STEP_S + 1e-9
    assert min(request) > -1.6  # recovers as it does after an override


def test_a_learned_offset_is_forgotten_for_its_limit_alone() -> None:
    stored = with_offset(taught((300.0, 400.0, 84.0)), 0, 1600, 8.0)
    car = car_at(700.0, stored)
    assert car.made.profile.learned_mps[700] == pytest.approx(LIMIT, abs=1e-6)  # as it was stored
    assert press(car, "teach_forget_here") == EVENT_FORGOTTEN
    offset = np.array(car.made.profile.offset_mps)
    assert not offset[:1100].any()
    np.testing.assert_array_equal(offset[1100:1600], 8.0 * KMH)


@pytest.mark.parametrize("column", ["evidence_slower", "pending_faster", "offset_evidence_faster"])
def test_what_waits_for_evidence_in_the_limit_is_forgotten_too(column: str) -> None:
    stored = taught((300.0, 500.0, 95.0))
    waiting = np.ones(stored.nodes)
    stored = stored.with_iteration(stored.next_iteration("drive", "drive", 0, {column: waiting}))
    car = car_at(900.0, stored)
    assert press(car, "teach_forget_here") == EVENT_FORGOTTEN
    values = known(car.made)[column]
    assert not values[:1100].any()
    assert values[1100:1600].all()


def test_an_intervention_that_began_before_in_the_piece_is_not_learned() -> None:
    car = car_at(350.0, taught((300.0, 500.0, 95.0)), learn=LEARN_FAITHFUL)
    car.run(2.0, STEP_S, driver_gas_pedal=0.5)
    press(car, "teach_forget_here")
    car.run(2.0, STEP_S)
    car.run(1.0, STEP_S, driver_gas_pedal=0.0)
    while abs(car.speed_mps - LIMIT) > 0.2:
        car.step(STEP_S)
    car.run(3.0, STEP_S, driver_gas_pedal=0.5)
    car.run(6.0, STEP_S, driver_gas_pedal=0.0)
    made = car.made
    iteration = made.learn()
    outcome = [made.following.outcome[k] for k in range(2)]
    assert outcome == [OUTCOME_FORGOTTEN, OUTCOME_LEARNED]
    told = list(lines_of(made.outcomes()))
    assert told[0].endswith("not learned: it began before the place was forgotten")
    again = int(made.trace.start_m[1])
    assert np.all(iteration.drive[: again - 200] != iteration.number)
    assert iteration.number == 3  # the word is an iteration of its own


def test_a_car_that_is_slowed_by_hand_after_forgetting_teaches_no_speed_above_base() -> None:
    car = car_at(350.0, taught((300.0, 500.0, 100.0)), learn=LEARN_FAITHFUL)
    press(car, "teach_forget_here")
    car.run(0.8, STEP_S, driver_brake_pedal=0.2)  # helps it down
    car.run(0.5, STEP_S, driver_brake_pedal=0.0)
    car.run(6.0, STEP_S, lever_resume=1)
    iteration = car.made.learn()
    assert np.all(iteration.learned_mps <= np.array(car.made.profile.planned_mps) + 1.0 * KMH)


def test_a_set_speed_of_before_is_not_learned_in_a_forgotten_limit() -> None:
    stored = with_offset(taught((300.0, 400.0, 84.0)), 0, 1100, 8.0)
    car = car_at(500.0, stored, learn=LEARN_FAITHFUL)
    car.tip("lever_up_long")
    car.run(5.0, STEP_S)
    press(car, "teach_forget_here")
    car.run(4.0, STEP_S)
    iteration = car.made.learn()
    assert car.made.following.set_outcome[0] == OUTCOME_FORGOTTEN
    assert not iteration.offset_mps[:1100].any()
    (told,) = lines_of(car.made.outcomes())
    assert told.endswith("+13.0 km/h not learned: set before the place was forgotten")


# Undo


def test_undo_takes_back_what_the_drive_recorded_first_then_older_and_older_lessons() -> None:
    stored = taught((300.0, 500.0, 95.0), (800.0, 950.0, 92.0))
    car = car_at(100.0, stored, learn=LEARN_FAITHFUL)
    car.run(2.0, STEP_S, driver_gas_pedal=0.5)
    car.run(1.0, STEP_S, driver_gas_pedal=0.0)
    car.tip("lever_up_long")
    assert press(car, "teach_undo") == EVENT_UNDONE
    assert_same(known(car.made), stored.iteration(2))
    assert press(car, "teach_undo") == EVENT_UNDONE
    assert_same(known(car.made), stored.iteration(1))
    assert press(car, "teach_undo") == EVENT_UNDONE
    assert not np.any(np.array(car.made.profile.lessons))
    np.testing.assert_array_equal(learned(car.made), np.array(car.made.profile.base_mps))
    assert press(car, "teach_undo") == EVENT_NOTHING_TO_UNDO
    car.made.learn()
    assert car.made.following.outcome[0] == OUTCOME_UNDONE
    told = list(lines_of(car.made.outcomes()))
    assert told[0].endswith("not learned: the driver took it back")
    assert told[1].endswith(" km/h not learned: the driver took it back")
    assert car.made.record.profile_iteration == 4


def test_undo_keeps_what_was_forgotten_since() -> None:
    stored = taught((300.0, 500.0, 95.0), (800.0, 950.0, 92.0))
    car = car_at(400.0, stored)
    press(car, "teach_forget_here")
    forgotten = learned(car.made)
    press(car, "teach_undo")  # the second drive's lesson
    now, base = learned(car.made), np.array(car.made.profile.base_mps)
    assert now[:650].tobytes() == forgotten[:650].tobytes()
    np.testing.assert_array_equal(now[750:], base[750:])


def test_undo_without_learning_does_not_stop_at_what_will_not_be_learned() -> None:
    stored = taught((300.0, 500.0, 95.0))
    car = car_at(100.0, stored, learn=0)
    car.run(1.0, STEP_S, driver_gas_pedal=0.5)
    press(car, "teach_undo")
    np.testing.assert_array_equal(learned(car.made), np.array(car.made.profile.base_mps))


def test_nothing_is_forgotten_or_undone_that_is_not_applied() -> None:
    car = car_at(400.0, taught((300.0, 500.0, 95.0)), apply_learned=0)
    assert press(car, "teach_forget_here") == EVENT_NOTHING_TO_FORGET
    assert press(car, "teach_undo") == EVENT_NOTHING_TO_UNDO
    assert car.made.record.words == 0


# Words as iterations


def test_every_word_is_kept_as_what_was_in_force_behind_it() -> None:
    stored = with_offset(taught((300.0, 500.0, 95.0), (800.0, 950.0, 92.0)), 0, 1100, 6.0)
    car = car_at(400.0, stored, learn=LEARN_FAITHFUL)
    seen = []
    for button in ("teach_forget_here", "teach_undo", "teach_forget_here", "teach_undo"):
        before = car.made.record.words
        press(car, button)
        if car.made.record.words > before:
            seen.append(known(car.made))
        car.run(1.0, STEP_S)
    here = car.made.snapshot()
    kept = car.made.words_kept()
    words = kept.iterations[len(stored.iterations) :]
    assert len(words) == len(seen) >= 3
    for word, in_force in zip(words, seen, strict=True):
        assert_same(in_force, word)
    assert {word.kind for word in words} == {"forget", "undo"}
    assert car.made.snapshot() == here  # nothing is changed by keeping them
    iteration = car.made.learn()
    assert iteration.number == len(kept.iterations) + 1


def test_a_word_is_taken_back_with_the_state() -> None:
    stored = taught((300.0, 500.0, 95.0))
    car = car_at(400.0, stored)
    state = car.made.snapshot()
    press(car, "teach_forget_here")
    assert car.made.record.words == 1
    car.made.restore(state)
    assert car.made.words_kept() is stored
    assert_same(known(car.made), stored.iteration())


# Pause


def test_nothing_is_learned_while_paused() -> None:
    stored = taught((300.0, 500.0, 95.0))
    car = car_at(600.0, stored, learn=LEARN_FAITHFUL)
    car.step(STEP_S, teach_pause=1)
    assert car.made.record.hmi_event == EVENT_PAUSED
    assert car.made.record.hmi_learning == 0
    car.run(3.0, STEP_S, driver_gas_pedal=0.5)
    car.run(1.0, STEP_S, driver_gas_pedal=0.0)
    car.step(STEP_S, teach_pause=0)
    assert car.made.record.hmi_event == EVENT_RESUMED
    assert car.made.record.hmi_learning == 1
    iteration = car.made.learn()
    assert_same({name: getattr(iteration, name) for name in LEARNED}, stored.iteration())


def test_the_buttons_are_heard_at_their_edge_alone() -> None:
    stored = taught((300.0, 500.0, 95.0), (800.0, 950.0, 92.0))
    car = car_at(600.0, stored)
    car.run(1.0, STEP_S, teach_undo=1)
    assert car.made.record.words == 1
    car.step(STEP_S, teach_undo=0)
    press(car, "teach_undo")
    assert car.made.record.words == 2
