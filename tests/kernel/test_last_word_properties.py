"""Forget and undo (section 7) as their words say, in drives on a straight road."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from laboratory import KMH, Array, PointMass, road
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    EVENT_FORGOTTEN,
    EVENT_NOTHING_TO_FORGET,
    EVENT_NOTHING_TO_UNDO,
    EVENT_UNDONE,
)
from pldf.profiles.single_file import read_profile
from pldf.profiles.stored_profile import StoredProfile
from pldf.roads import write_route_csv

STEP_S = 0.05
LIMITS = [(0.0, 80.0 * KMH), (900.0, 70.0 * KMH), (1600.0, 80.0 * KMH)]
LENGTH_M = 2400.0
PLACES = (300.0, 1200.0, 1900.0)
JERK_MPS3 = 2.5


class Cabin:
    """A driver, a car and a folder of profiles; each drive is an instance of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.route_file = folder / "road.csv"
        write_route_csv(road(LENGTH_M, LIMITS), self.route_file)

    def drive(
        self,
        *,
        gas: tuple[float, ...] = (),
        press: dict[str, tuple[float, ...]] | None = None,
        tips: tuple[float, ...] = (),
        **settings: int,
    ) -> Drive:
        """Drive to the end, with gas for 100 m at each place, and presses of buttons at others."""
        made = DrivingFunction()
        made.texts.route_file = str(self.route_file)
        made.texts.profile_store = str(self.folder / "store")
        for name, value in {"learn": 1, **settings}.items():
            setattr(made.record, name, value)
        made.initialize()
        seen = Drive(made)
        car = PointMass(made, float(made.profile.learned_mps[0]))
        while car.s_m < LENGTH_M - 5.0:
            buttons = {
                name: int(any(at <= car.s_m < at + 5.0 for at in places))
                for name, places in (press or {}).items()
            }
            car.step(
                STEP_S,
                lever_resume=int(5.0 < car.s_m < 10.0),
                lever_up_long=int(any(at <= car.s_m < at + 5.0 for at in tips)),
                driver_gas_pedal=0.5 * any(at <= car.s_m < at + 100.0 for at in gas),
                **buttons,
            )
            seen.note()
        made.finish()
        return seen

    def stored(self) -> StoredProfile:
        """Return what the file holds."""
        [path] = (self.folder / "store").glob("*.pldf*")
        return read_profile(path)


class Drive:
    """What a drive began with, and what was seen in it."""

    def __init__(self, made: DrivingFunction) -> None:
        self.made = made
        self.began = np.array(made.profile.learned_mps)
        self.began_offset = np.array(made.profile.offset_mps)
        self.events: list[int] = []
        self.requests: list[float] = []

    def note(self) -> None:
        """Remember the event shown and the request."""
        record = self.made.record
        if not self.events or self.events[-1] != record.hmi_event:
            self.events.append(record.hmi_event)
        self.requests.append(record.acceleration_request_mps2)

    @property
    def now(self) -> Array:
        """What is driven now."""
        return np.array(self.made.profile.learned_mps)


@pytest.fixture
def cabin(tmp_path: Path) -> Cabin:
    return Cabin(tmp_path)


def test_forget_here_takes_the_piece_at_the_car_and_no_other(cabin: Cabin) -> None:
    cabin.drive(gas=PLACES)
    drive = cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0)
    base = np.array(drive.made.profile.base_mps)
    assert drive.began[1250] > base[1250] + KMH  # it was there to be forgotten
    assert EVENT_FORGOTTEN in drive.events
    assert abs(drive.now[1250] - base[1250]) <= KMH
    for place in (PLACES[0], PLACES[2]):
        at = slice(int(place) - 50, int(place) + 150)
        np.testing.assert_array_equal(drive.now[at], drive.began[at])
    assert np.abs(np.diff(drive.requests)).max() <= JERK_MPS3 * STEP_S * (1.0 + 1e-9)


def test_what_was_forgotten_stays_forgotten(cabin: Cabin) -> None:
    """Also with learn = OFF, since the driver said so; and nothing older is lost."""
    cabin.drive(gas=PLACES)
    before = cabin.stored().iterations
    forgot = cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0)
    iterations = cabin.stored().iterations
    assert [one.kind for one in iterations] == ["drive", "forget"]
    for old, new in zip(before, iterations, strict=False):
        np.testing.assert_array_equal(old.learned_mps, new.learned_mps)
    again = cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0)
    np.testing.assert_array_equal(again.began, forgot.now)
    assert EVENT_NOTHING_TO_FORGET in again.events and EVENT_FORGOTTEN not in again.events
    assert len(cabin.stored().iterations) == 2


def test_without_apply_learned_nothing_is_forgotten_in_the_file(cabin: Cabin) -> None:
    cabin.drive(gas=PLACES)
    cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0, apply_learned=0)
    assert [one.kind for one in cabin.stored().iterations] == ["drive"]


def test_the_offset_of_the_limit_is_forgotten_too(cabin: Cabin) -> None:
    cabin.drive(tips=(950.0, 1700.0))
    drive = cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0)
    assert drive.began_offset[1250] > 0.0 and drive.began_offset[2000] > 0.0
    offset = np.array(drive.made.profile.offset_mps)
    assert not offset[900:1600].any()
    np.testing.assert_array_equal(offset[1600:], drive.began_offset[1600:])


def test_an_intervention_that_began_before_the_press_is_not_learned(cabin: Cabin) -> None:
    cabin.drive(gas=PLACES)
    drive = cabin.drive(gas=PLACES[1:], press={"teach_forget_here": (1250.0,)})
    iterations = cabin.stored().iterations
    base = np.array(drive.made.profile.base_mps)
    assert abs(iterations[-1].learned_mps[1250] - base[1250]) <= KMH
    at = slice(1920, 1980)  # another intervention of the same drive still teaches
    assert np.all(iterations[-1].learned_mps[at] > drive.began[at])


def test_undo_takes_back_what_this_drive_recorded_first(cabin: Cabin) -> None:
    cabin.drive(gas=PLACES[:1])
    drive = cabin.drive(gas=PLACES, press={"teach_undo": (1500.0,)})
    assert EVENT_UNDONE in drive.events
    newest = cabin.stored().iterations[-1].learned_mps
    np.testing.assert_array_equal(newest[:1500], drive.began[:1500])  # the lesson before stays
    assert np.all(newest[1920:1980] > drive.began[1920:1980])  # what came after is learned


@pytest.mark.parametrize("seed", range(3))
def test_lessons_and_undos_are_a_stack(cabin: Cabin, seed: int) -> None:
    """Each undo takes the newest lesson that is left; the others stay as they are, to the bit."""
    rng = np.random.default_rng(seed)
    stack: list[Array] = []
    base: Array | None = None
    for _ in range(7):
        if rng.random() < 0.55:
            places = tuple(rng.choice(PLACES, int(rng.integers(1, 4)), replace=False))
            drive = cabin.drive(gas=places)
            base = drive.began if base is None else base
            np.testing.assert_array_equal(drive.began, stack[-1] if stack else base)
            stack.append(cabin.stored().iterations[-1].learned_mps)
            continue
        presses = int(rng.integers(1, 4))
        at = tuple(100.0 + 200.0 * k for k in range(presses))
        drive = cabin.drive(press={"teach_undo": at}, learn=0)
        base = drive.began if base is None else base
        np.testing.assert_array_equal(drive.began, stack[-1] if stack else base)
        undone, missing = min(presses, len(stack)), presses > len(stack)
        del stack[len(stack) - undone :]
        np.testing.assert_array_equal(drive.now, stack[-1] if stack else base)
        assert (EVENT_UNDONE in drive.events) == (undone > 0)
        assert (EVENT_NOTHING_TO_UNDO in drive.events) == missing
        assert np.abs(np.diff(drive.requests)).max() <= JERK_MPS3 * STEP_S * (1.0 + 1e-9)


def test_a_pause_keeps_the_drive_out_of_the_profile(cabin: Cabin) -> None:
    """Pedals and lever; only what was driven outside of the pause is learned."""
    pause = tuple(800.0 + 4.0 * k for k in range(250))  # held down from 800 to 1800 m
    drive = cabin.drive(gas=PLACES, tips=(950.0,), press={"teach_pause": pause})
    newest = cabin.stored().iterations[-1]
    np.testing.assert_array_equal(newest.learned_mps[810:1750], drive.began[810:1750])
    assert not newest.offset_mps[900:1600].any()
    assert np.all(newest.learned_mps[320:380] > drive.began[320:380])


def test_what_was_forgotten_does_not_come_back_by_undoing_something_else(cabin: Cabin) -> None:
    cabin.drive(gas=PLACES[1:2])
    cabin.drive(gas=PLACES[:1])
    cabin.drive(press={"teach_forget_here": (1250.0,)}, learn=0)
    drive = cabin.drive(press={"teach_undo": (600.0,)}, learn=0)
    base = np.array(drive.made.profile.base_mps)
    assert drive.began[350] > base[350] + KMH  # the newest lesson, not forgotten
    assert EVENT_UNDONE in drive.events
    np.testing.assert_array_equal(drive.now[250:450], base[250:450])
    assert abs(drive.now[1250] - base[1250]) <= KMH


def test_a_gas_pedal_while_forgetting_is_no_step_in_the_request(cabin: Cabin) -> None:
    """And it is not learned, but what the driver does at the next place is."""
    cabin.drive(gas=PLACES)
    for at in (1190.0, 1210.0, 1290.0, 1301.0):
        drive = cabin.drive(gas=PLACES[1:], press={"teach_forget_here": (at,)}, learn=0)
        assert np.abs(np.diff(drive.requests)).max() <= JERK_MPS3 * STEP_S * (1.0 + 1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_whatever_is_forgotten_nothing_is_driven_that_was_not_taught_or_planned(
    cabin: Cabin, seed: int
) -> None:
    """Forgetting by chance: each metre is between base and lesson, and no piece is cut sharply."""
    rng = np.random.default_rng(seed)
    cabin.drive(gas=PLACES, tips=(950.0,))
    for _ in range(3):
        at = tuple(float(x) for x in np.sort(rng.uniform(100.0, 2300.0, 2)))
        drive = cabin.drive(press={"teach_forget_here": at}, learn=0)
        base = np.array(drive.made.profile.base_mps)
        assert np.all(drive.now >= np.minimum(base, drive.began) - 1e-9)
        assert np.all(drive.now <= np.maximum(base, drive.began) + 1e-9)
        slope = 0.5 * np.diff(drive.now**2)
        assert slope.min() >= -3.0 - 1e-9 and slope.max() <= 2.0 + 1e-9
        assert np.abs(np.diff(drive.requests)).max() <= JERK_MPS3 * STEP_S * (1.0 + 1e-9)
