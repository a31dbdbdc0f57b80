"""OpenDRIVE: speeds of types and lanes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import lane, lanes, straight
from pldf.errors import ModelError
from pldf.roads import Route, route_arrays

KMH = 1.0 / 3.6
Reader = Callable[..., Route]


@pytest.mark.parametrize(
    ("speed", "expected"),
    [
        ('max="25"', 25.0),
        ('max="25" unit="m/s"', 25.0),
        ('max="90" unit="km/h"', 25.0),
        ('max="50" unit="mph"', 22.352),
        ('max="no limit"', 130 * KMH),
    ],
)
def test_speed_units(read: Reader, speed: str, expected: float) -> None:
    route = read(straight("1", inside=f'<type s="0" type="rural"><speed {speed}/></type>'))
    np.testing.assert_allclose(route.speed_limit_mps, expected, rtol=1e-14)


def test_lane_speeds_override_from_their_offset_to_the_end_of_the_section(read: Reader) -> None:
    first = '<speed sOffset="10" max="20"/><speed sOffset="25" max="-1"/>'
    second = '<speed sOffset="5" max="15"/>'
    inside = lanes(
        f'<laneSection s="0">{lane(first)}</laneSection>',
        f'<laneSection s="40">{lane(second)}</laneSection>',
        f'<laneSection s="60">{lane("")}</laneSection>',
    )
    limit = np.asarray(route_arrays(read(straight("1", inside=inside))).limit_mps)
    full = 100 * KMH
    stated = {9: full, 10: 20.0, 24: 20.0, 25: full, 44: full, 45: 15.0, 59: 15.0, 60: full}
    np.testing.assert_allclose([limit[s] for s in stated], list(stated.values()))


def test_of_several_driving_lanes_the_lowest_counts_and_others_do_not(read: Reader) -> None:
    inside = lanes(
        '<laneSection s="0">'
        + lane('<speed sOffset="0" max="3"/>', side="left", lane_id=1)
        + lane('<speed sOffset="0" max="4"/>', kind="sidewalk", lane_id=-3)
        + lane('<speed sOffset="0" max="20"/>')
        + lane('<speed sOffset="0" max="15"/>', lane_id=-2)
        + "</laneSection>"
    )
    assert set(read(straight("1", inside=inside)).speed_limit_mps) == {15.0}
    left_hand = 'junction="-1" rule="LHT"'
    assert set(read(straight("1", inside=inside, attributes=left_hand)).speed_limit_mps) == {3.0}


def test_lane_speeds_are_enough(read: Reader) -> None:
    speed = '<speed sOffset="0" max="12"/>'
    inside = f'<lanes><laneSection s="0">{lane(speed)}</laneSection></lanes>'
    assert set(read(straight("1", inside=inside)).speed_limit_mps) == {12.0}


@pytest.mark.parametrize(
    "inside",
    [
        "",
        '<type s="0" type="rural"/>',
        '<type s="0" type="rural"><speed max="undefined"/></type>',
        '<type s="0" type="rural"><speed max="-1" unit="km/h"/></type>',
    ],
)
def test_a_road_without_speed_needs_a_default(read: Reader, inside: str) -> None:
    with pytest.raises(ModelError, match=r"road 1: no speed limit from s = 0 m on; .*--default-"):
        read(straight("1", inside=inside))
    assert set(read(straight("1", inside=inside), default_limit_mps=9.0).speed_limit_mps) == {9.0}


def test_before_a_speed_that_begins_late_it_counts_already(read: Reader) -> None:
    late = '<type s="30" type="rural"><speed max="20"/></type>'
    for options in ({}, {"default_limit_mps": 9.0}):
        route = read(straight("1", inside=late), **options)
        assert set(route.speed_limit_mps) == {20.0}
        assert any("1 gap states no limit (30 m)" in note.text for note in route.notes)
