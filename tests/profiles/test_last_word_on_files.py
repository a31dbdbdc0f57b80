"""Forgetting and undoing in a profile file, without a road; which lessons are in force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, after, function, play_override, road
from pldf.errors import ModelError
from pldf.profiles.last_word import forgotten, undone
from pldf.profiles.learned_columns import LEARNED
from pldf.profiles.lessons import lessons_in_force
from pldf.profiles.stored_profile import StoredProfile

LIMIT = 100.0 * KMH
ROAD = road(2000.0)


def lessons(*spans: tuple[float, float]) -> StoredProfile:
    """Drives that taught 20 km/h more, one per span."""
    stored: StoredProfile | None = None
    for first, last in spans:
        made = function(ROAD, stored, apply_learned=1)
        play_override(
            made, lambda s, a=first, b=last: np.where((s > a) & (s < b), LIMIT + 4.0, LIMIT),
            [(first, last)],
        )  # fmt: skip
        stored = after(made, made.learn())
    assert stored is not None
    return stored


def test_what_is_forgotten_is_at_base_and_its_edges_are_comfortable() -> None:
    stored = lessons((500.0, 900.0))
    new = forgotten(stored, 780.0, 850.0).iteration()
    old = stored.iteration()
    assert np.array_equal(new.learned_mps[780:851], old.base_mps[780:851])
    assert np.all(new.learned_mps <= old.learned_mps)
    assert new.lessons[800] == 0.0
    acceleration = 0.5 * np.diff(new.learned_mps**2)[700:780]
    assert acceleration.min() >= -1.0 - 1e-6  # as the planner
    assert acceleration.max() <= 1.2 + 1e-6
    assert new.learned_mps[:550].tobytes() == old.learned_mps[:550].tobytes()


def test_offsets_go_in_the_metres_named_alone() -> None:
    stored = lessons((500.0, 900.0))
    offset = np.full(stored.nodes, 3.0)
    stored = stored.with_iteration(stored.next_iteration("drive", "", 0, {"offset_mps": offset}))
    new = forgotten(stored, 1200.0, 1300.0).iteration()
    assert not new.offset_mps[1200:1300].any()
    assert np.all(np.delete(new.offset_mps, slice(1200, 1300)) == 3.0)


def test_where_nothing_is_learned_nothing_is_written() -> None:
    stored = lessons((500.0, 900.0))
    assert forgotten(stored, 1500.0, 1600.0) is stored


@pytest.mark.parametrize("ends", [(5.0, 5.0), (-1.0, 5.0), (1990.0, 2001.0), (np.nan, 3.0)])
def test_places_off_the_road_are_refused(ends: tuple[float, float]) -> None:
    with pytest.raises(ModelError, match="no piece of this road"):
        forgotten(lessons((500.0, 900.0)), *ends)


def test_undo_goes_back_to_the_bit_and_further() -> None:
    stored = lessons((300.0, 500.0), (900.0, 1200.0), (1000.0, 1400.0))
    for expected in (3, 2, 1):
        stored, number = undone(stored)
        assert number == expected
        for name in LEARNED:
            before = getattr(stored.iteration(expected - 1), name)
            assert getattr(stored.iteration(), name).tobytes() == before.tobytes(), name
    assert undone(stored) == (stored, 0)


def test_a_forgotten_place_stays_so_through_an_undo() -> None:
    stored = lessons((300.0, 500.0), (900.0, 1200.0))
    stored, number = undone(forgotten(stored, 200.0, 600.0))
    assert number == 2
    assert np.array_equal(stored.iteration().learned_mps, stored.base_mps)


@settings(deadline=None, max_examples=60)
@given(hs.lists(hs.sampled_from(["teach", "undo", "back", "forget"]), max_size=14), hs.data())
def test_lessons_in_force_are_a_stack(words: list[str], data: hs.DataObject) -> None:
    """Against a plain list per iteration, by whatever way the history went."""
    base = np.full(50, 20.0)
    profile = StoredProfile(1, "0" * 16, base)
    stacks: list[list[int]] = [[]]
    for word in words:
        number, stack = len(profile.iterations) + 1, stacks[-1]
        if word == "teach":
            drive = profile.iteration().drive.copy()
            drive[data.draw(hs.integers(0, 49))] = number
            changed = {"drive": drive}
            profile = profile.with_iteration(profile.next_iteration("drive", "", 1, changed))
            stacks.append([*stack, number])
        elif word == "undo" and stack:
            undo = profile.next_iteration("undo", f"undo of {stack[-1]}", 0, {})
            profile = profile.with_iteration(undo)
            stacks.append(stack[:-1])
        elif word == "back":
            to = data.draw(hs.integers(0, number - 1))
            profile = profile.rolled_back(to)
            stacks.append(stacks[to])
        elif word == "forget":
            profile = profile.with_iteration(profile.next_iteration("forget", "", 0, {}))
            stacks.append(stack)
    assert list(lessons_in_force(profile)) == stacks[-1][::-1]


def test_a_note_that_leads_forward_is_passed_over() -> None:
    stored = lessons((300.0, 500.0))
    wrong = replace(stored.rolled_back(1).iteration(), note="rollback of 7")
    assert list(lessons_in_force(stored.with_iteration(wrong))) == [1]
