"""What is said of each intervention."""

from __future__ import annotations

import re

import numpy as np
import pytest
from consistent_drives import told_in_python, write_straight_road
from hypothesis import example, given, settings
from hypothesis import strategies as hs
from laboratory import function, play, road, travel_times, within
from pldf.function import DrivingFunction
from pldf.kernel.codes import (
    ACTIVE,
    BOUND_LEGAL_LIMIT,
    GAS_OVERRIDE,
    OUTCOME_HOLE,
    OUTCOME_LEARNED,
)
from pldf.outcome_words import TEXTS, pedal_words, signed, tenths, whole
from pldf.outcomes import held_places
from told_drive import driven, write_road


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> DrivingFunction:
    """Return the function at the end of a drive with a bit of everything."""
    return driven(write_road(tmp_path_factory.mktemp("road")))


def lines(made: DrivingFunction) -> list[str]:
    return [message.text for message in made.messages if message.level == "info"]


WORDS = "[-+a-zA-Z0-9. ()\N{LATIN SMALL LETTER SHARP S}]*?"


def pattern(name: str) -> str:
    return re.escape(TEXTS[name]).replace("%d", "-?[0-9]+").replace("%s", WORDS)


# What have tests of their own.
ELSEWHERE = {"MORE", "FORGOTTEN", "UNDONE", "SET_FORGOTTEN", "SET_SHARE", "SET_UNDONE"}
# Said only where evidence decides.
OF_EVIDENCE = {name for name in TEXTS if "PENDING" in name or "EVIDENCE" in name or "_BY_" in name}


@pytest.mark.parametrize("name", sorted(TEXTS.keys() - OF_EVIDENCE - ELSEWHERE))
def test_the_drive_that_is_compared_has_a_bit_of_everything(
    made: DrivingFunction, name: str
) -> None:
    assert any(re.search(pattern(name), line) for line in lines(made))


def test_each_intervention_has_one_line(made: DrivingFunction) -> None:
    told = lines(made)
    st = made.record
    assert st.drive_interventions == 8
    for k in range(8):
        assert told[k].startswith(f"pedal intervention {k + 1}, ")
    assert sum(line.startswith("set speed, ") for line in told) == st.set_series
    assert len(told) == 8 + st.set_series + 1  # and one about the plan with the set speeds


def test_a_bound_is_told_with_its_place_and_speed(made: DrivingFunction) -> None:
    """50 km/h and 20 km/h of tolerance from the sign at 1200 m to that at 1240 m."""
    held = "held at 70 km/h from 1200 to 1240 m by legal limit + tolerance"
    assert [held in line for line in lines(made)].index(True) == 1
    assert sum(held in line for line in lines(made)) == 1
    assert made.learned is not None
    places = held_places(made.learned.bound, made.learned.learned_mps)
    (legal,) = (hold for hold in places if hold.bound == BOUND_LEGAL_LIMIT)
    assert legal[1:3] == (1200.0, 1240.0)
    assert legal.low_mps == legal.high_mps == pytest.approx(70.0 / 3.6)


def test_what_is_told_of_a_lesson_is_what_was_learned(made: DrivingFunction) -> None:
    assert made.learned is not None
    change = made.learned.learned_mps - np.array(made.profile.learned_mps)
    for pedal in made.outcomes().pedals:
        mine = np.flatnonzero(
            (made.learned.intervention == pedal.number) & (made.learned.drive == 1.0)
        )
        assert pedal.learned_m == len(mine)
        if len(mine) > 0:
            assert (pedal.learned_from_m, pedal.learned_to_m) == (mine[0], mine[-1])
            assert pedal.mean_change_mps == pytest.approx(change[mine].mean())
            assert abs(pedal.largest_change_mps) == np.abs(change[mine]).max()
            assert pedal.largest_change_mps in change[mine]


def test_a_hole_is_told_with_time_and_length(made: DrivingFunction) -> None:
    (lost,) = (pedal for pedal in made.outcomes().pedals if pedal.hole_m)
    assert lost.hole_m == pytest.approx(50.0, abs=1.0)  # 2 s at 25 m/s
    assert lost.hole_s == pytest.approx(2.0, abs=0.04)


@pytest.mark.parametrize("from_m", [500.0, 650.0, 780.0])
def test_a_hole_is_told_whole_wherever_it_touches(from_m: float) -> None:
    """Gas from 600 to 800 m; 60 m are missing where it is stretched to, within, at its end."""
    made = function(road(2000.0))
    s_m = np.arange(0.0, 2000.5, 0.5)
    gas = (s_m >= 600.0) & (s_m < 800.0)
    kept = (s_m <= from_m) | (s_m >= from_m + 60.0)
    mode = np.where(gas, GAS_OVERRIDE, ACTIVE)[kept]
    play(made, s_m[kept], 30.0, time_s=s_m[kept] / 30.0, mode=mode)
    made.learn()
    (pedal,) = made.outcomes().pedals
    assert (pedal.outcome, pedal.hole_m) == (OUTCOME_HOLE, 60.0)
    assert pedal.hole_s == pytest.approx(2.0)


def test_what_was_left_out_of_a_lesson_is_told(made: DrivingFunction) -> None:
    """10 m recorded where learning was not allowed: there, and where stretching took them to."""
    pedal = made.outcomes().pedals[0]
    assert made.learned is not None
    inside = slice(int(pedal.learned_from_m), int(pedal.learned_to_m) + 1)
    assert pedal.barred_m == np.count_nonzero(made.learned.lessons[inside] == 0.0) > 10
    assert f"but for {pedal.barred_m:.0f} m where learning was not allowed" in lines(made)[0]
    series = made.outcomes().set_speeds[1]
    offsets = made.learned.offset_mps[int(series.from_m) : int(series.to_m)]
    assert series.barred_m == np.count_nonzero(offsets == 0.0) > 10


places = hs.lists(hs.floats(5.0, 990.0), min_size=2, max_size=12, unique=True).map(sorted)


@settings(deadline=None, max_examples=60)
@example([5.0, 99.0], [1.0, 1.0, 1.0], [100.0, 102.0])  # a hole just behind the intervention
@given(places, hs.lists(hs.floats(1.0, 45.0), min_size=3, max_size=8), places)
def test_whatever_is_driven_what_is_told_fits_what_was_learned(
    pressed: list[float], speeds: list[float], lost: list[float]
) -> None:
    """Each metre learned is told of one intervention; what is not learned has its reason."""
    made = function(road(1000.0))
    s_m = np.arange(0.0, 999.5, 0.5)
    speed = np.interp(s_m, np.linspace(0.0, 1000.0, len(speeds)), speeds)
    gas = within(s_m, zip(pressed[::2], pressed[1::2], strict=False))
    kept = ~within(s_m, [(lost[0], lost[1])])
    play(
        made,
        s_m[kept],
        speed[kept],
        time_s=travel_times(s_m, speed)[kept],
        mode=np.where(gas, GAS_OVERRIDE, ACTIVE)[kept],
    )
    learned = made.learn()
    pedals = made.outcomes().pedals
    for pedal in pedals:
        assert (pedal.learned_m > 0) == (pedal.outcome == OUTCOME_LEARNED)
        assert (pedal.hole_m > 0) == (pedal.outcome == OUTCOME_HOLE)
        assert (pedal.hole_s > 0) == (pedal.outcome == OUTCOME_HOLE)
        assert not pedal.holds or pedal.outcome == OUTCOME_LEARNED
    assert sum(pedal.learned_m for pedal in pedals) == np.count_nonzero(learned.drive)
    held = sum(hold.to_m - hold.from_m + 1 for pedal in pedals for hold in pedal.holds)
    assert held == np.count_nonzero(learned.bound)


def test_many_bounds_are_counted_not_listed(made: DrivingFunction) -> None:
    hold = held_places(np.full(20, 2.0), np.full(20, 19.0))[0]
    outcomes = made.outcomes()
    many = outcomes.pedals[1]._replace(holds=(hold,) * 13)
    assert pedal_words(outcomes, many).count("held at 68 km/h") == 10
    assert pedal_words(outcomes, many).endswith("; held at 3 more places")


def test_numbers_are_rounded_as_in_c_and_zero_has_no_minus() -> None:
    assert [whole(x) for x in (-0.6, -0.5, 0.49, 0.5, 1.5, 2.5)] == [-1, 0, 0, 1, 2, 3]
    assert [tenths(x) for x in (0.0, 0.04, 0.05, 9.96, -3.25)] == [
        "0.0",
        "0.0",
        "0.1",
        "10.0",
        "3.3",
    ]
    assert [signed(x) for x in (0.0, -0.04, -0.06, 12.34)] == ["+0.0", "+0.0", "-0.1", "+12.3"]


@pytest.fixture(scope="module")
def weighed(tmp_path_factory: pytest.TempPathFactory) -> list[list[str]]:
    """Return what is said after each of the drives that only learn what is consistent."""
    folder = tmp_path_factory.mktemp("consistent")
    return told_in_python(write_straight_road(folder), folder / "store")


@pytest.mark.parametrize("name", sorted(OF_EVIDENCE))
def test_the_drives_in_a_row_have_a_bit_of_everything(weighed: list[list[str]], name: str) -> None:
    assert any(re.search(pattern(name), line) for lines in weighed for line in lines)


def test_a_press_that_waits_is_told_with_its_evidence(weighed: list[list[str]]) -> None:
    gas = weighed[0][0]
    assert re.fullmatch(
        r"pedal intervention 1, 40\d to 60\d m.*: not learned: it waits until it happens again, "
        r"evidence 1\.3 of 2\.2",
        gas,
    )
    assert "learned from " in weighed[1][0]


def test_each_drive_tells_which_places_gained_or_lost_evidence(
    weighed: list[list[str]],
) -> None:
    """In order: gas and brake gain; gas is accepted, brake falls; brake gains, and is dropped."""
    told = [
        [line.split(", ")[0] + ":" + line.split(":")[1] for line in lines if " by " in line[:16]]
        for lines in weighed
    ]
    assert told[0] == [
        "faster by pedal: evidence grew to 1.3 of 2.2",
        "slower by pedal: evidence grew to 1.3 of 2.2",
        "faster by lever: evidence grew to 1.3 of 2.2",
    ]
    assert "faster by pedal: the wish is accepted" in told[1]
    assert "slower by pedal: evidence fell to 0.3 of 2.2" in told[1]
    assert "faster by lever: the wish is accepted" in told[1]
    assert "slower by pedal: evidence fell to 0, what was waiting there is dropped" in told[2]
    assert "faster by pedal: what was accepted is put back" in told[3]
