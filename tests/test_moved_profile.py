"""What was learned on an older reading of a road is told, and carried over to the newer one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from laboratory import KMH, function, road
from pldf.errors import ModelError
from pldf.function import DrivingFunction
from pldf.kernel.codes import BOUND_LATERAL_ACCEL
from pldf.moved_profile import Moved, move_profile
from pldf.profiles.older_reading import is_older_reading
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.stored_profile import COLUMN_NAMES, StoredProfile
from pldf.roads import Route, fingerprint
from two_readings import GAS, lesson, newer_reading, older_reading, other_road

AROUND = (1360, 1950)  # where the newer reading drives otherwise, with braking before the bend


@pytest.fixture(scope="module")
def learned() -> StoredProfile:
    """Two drives on the older reading."""
    _, first = lesson(older_reading())
    _, second = lesson(older_reading(), first, gas=GAS[1:])
    return second


def moved_to(route: Route, stored: StoredProfile, **settings: float) -> Moved:
    made = DrivingFunction()
    for name, value in settings.items():
        setattr(made.record, name, value)
    return move_profile(stored, route, made)


def base_of(route: Route) -> np.ndarray:
    return np.array(function(route).profile.base_mps)


def test_where_nothing_changed_it_is_what_the_newer_reading_would_have_taught(
    learned: StoredProfile,
) -> None:
    """To the bit, in every drive: speeds, offsets, sources, lessons, bounds."""
    moved = moved_to(newer_reading(), learned)
    _, first = lesson(newer_reading())
    _, expected = lesson(newer_reading(), first, gas=GAS[1:])
    assert moved.profile.route == expected.route == fingerprint(newer_reading())
    far = np.ones(expected.nodes, dtype=bool)
    far[slice(*AROUND)] = False
    assert np.array_equal(moved.profile.base_mps, expected.base_mps)
    assert np.count_nonzero(expected.iterations[0].drive[far]) > 300  # of which something is known
    for carried, taught in zip(moved.profile.iterations, expected.iterations, strict=True):
        assert (carried.number, carried.kind, carried.note) == (
            taught.number, taught.kind, taught.note,
        )  # fmt: skip
        assert carried.interventions == taught.interventions
        for name in COLUMN_NAMES:
            ours, theirs = getattr(carried, name), getattr(taught, name)
            assert np.array_equal(ours[far], theirs[far]), name
    # The bend itself was never driven with a wish: it has the base profile, as there.
    newest, other = moved.profile.iteration(), expected.iteration()
    assert np.array_equal(newest.learned_mps, other.learned_mps)
    assert not moved.cut_mps.any()


def test_the_next_drive_follows_and_learns_as_if_it_had_always_been_read_so(
    learned: StoredProfile,
) -> None:
    route = newer_reading()
    moved = moved_to(route, learned).profile
    _, first = lesson(route)
    _, expected = lesson(route, first, gas=GAS[1:])
    for stored in (moved, expected):
        made = function(route, stored, apply_learned=1)
        assert np.array_equal(np.array(made.profile.learned_mps), stored.iteration().learned_mps)
    (_, after), (_, then) = lesson(route, moved), lesson(route, expected)
    assert encode(after) == encode(then)


def test_a_wish_inside_the_new_bend_keeps_its_difference_and_is_held_by_the_caps() -> None:
    _, stored = lesson(older_reading(), gas=((1560.0, 1700.0),))
    newest = stored.iteration()
    faster = newest.learned_mps.copy()
    faster[1500:1720] = newest.base_mps[1500:1720] + 6.0
    drive = np.where(faster != newest.base_mps, 1.0, 0.0)
    forged = replace(newest, learned_mps=faster, drive=drive, lessons=drive)
    stored = replace(stored, iterations=(forged,))
    moved = moved_to(newer_reading(), stored)
    now, base = moved.profile.iteration(), base_of(newer_reading())
    cap_mps = np.sqrt(4.0 / (1.0 / 60.0))  # learning.lateral_accel_max_mps2 in the bend
    bend = slice(1605, 1655)
    assert np.all(now.learned_mps[bend] <= cap_mps + 1e-9)
    assert np.all(now.learned_mps[bend] >= base[bend])  # the wish is still one
    assert BOUND_LATERAL_ACCEL in now.bound[bend]
    assert moved.cut_mps[bend].max() > 0.5
    # Squares rise and fall no faster than learning allows, whatever was carried.
    slopes = np.diff(now.learned_mps**2)[1450:1760]
    assert slopes.max() <= 2 * 2.0 * (1 + 1e-6) and slopes.min() >= -2 * 3.0 * (1 + 1e-6)
    made = function(newer_reading(), moved.profile, apply_learned=1)
    assert np.array_equal(np.array(made.profile.learned_mps), now.learned_mps)


@pytest.mark.parametrize("length_m", [2990.0, 3012.0])
def test_another_length_goes_metre_by_metre_up_to_the_shorter_end(
    learned: StoredProfile, length_m: float
) -> None:
    route = newer_reading(length_m)
    moved = moved_to(route, learned)
    both = min(learned.nodes, route.nodes)
    newest, before = moved.profile.iteration(), learned.iteration()
    assert moved.profile.nodes == route.nodes
    assert np.array_equal(newest.learned_mps[:1300], before.learned_mps[:1300])
    assert np.array_equal(newest.drive[:both], before.drive[:both])
    tail = slice(both, None)
    assert np.array_equal(newest.learned_mps[tail], base_of(route)[tail])
    assert not newest.drive[tail].any()
    assert encode(decode(encode(moved.profile), "moved")) == encode(moved.profile)


def test_learned_offsets_come_along() -> None:
    _, stored = lesson(older_reading())
    newest = stored.iteration()
    offset = np.where(np.arange(stored.nodes) < 800, 3.0, -2.0)
    stored = replace(stored, iterations=(replace(newest, offset_mps=offset),))
    moved = moved_to(newer_reading(), stored).profile.iteration()
    assert np.array_equal(moved.offset_mps, offset)


def test_the_same_reading_another_road_and_nothing_learned_are_refused(
    learned: StoredProfile,
) -> None:
    with pytest.raises(ModelError, match="learned on this reading of test road"):
        moved_to(older_reading(), learned)
    with pytest.raises(ModelError, match=r"do not look like the same road: \d+ % of the base"):
        moved_to(other_road(), learned)
    with pytest.raises(ModelError, match="nothing learned"):
        moved_to(newer_reading(), replace(learned, iterations=()))


def test_two_roads_do_not_look_like_one() -> None:
    """Other limits, another length, the same road backwards."""
    base = base_of(older_reading())
    assert is_older_reading(base, base_of(newer_reading()))
    assert is_older_reading(base, base_of(newer_reading(3029.0)))
    assert not is_older_reading(base, base_of(newer_reading(3040.0)))
    assert not is_older_reading(base, base_of(other_road()))
    assert not is_older_reading(base, base[::-1])
    assert not is_older_reading(base, base_of(road(3000.0, ((0.0, 50.0 * KMH),))))
