"""OpenDRIVE: geometry and elevation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import RIGHT_100, SHAPES, geometry, link, road, straight
from pldf.errors import ModelError
from pldf.roads import Route, route_arrays

Reader = Callable[..., Route]


@pytest.mark.parametrize("shape", SHAPES)
def test_the_line_turns_as_the_curvature_says(read: Reader, shape: str) -> None:
    plan = geometry(0, 80, SHAPES[shape], 'x="50" y="-3" hdg="2.5"')
    route = read(road("1", plan, length=80))
    s, line = route.s_m, route.x_m + 1j * route.y_m
    heading = np.unwrap(np.angle(np.diff(line)))
    middle = 0.5 * (s[1:] + s[:-1])
    turn = np.diff(heading) / np.diff(middle)
    expected = np.interp(0.5 * (middle[1:] + middle[:-1]), s, route.curvature_per_m)
    assert line[0] == 50.0 - 3.0j
    assert heading[0] - turn[0] * middle[0] == pytest.approx(2.5, abs=1e-3)
    np.testing.assert_allclose(np.abs(np.diff(line)), np.diff(s), rtol=0.02)
    np.testing.assert_allclose(turn, expected, atol=2e-4)


@pytest.mark.parametrize("shape", SHAPES)
def test_driven_backwards_everything_is_mirrored(read: Reader, shape: str) -> None:
    plan = geometry(0, 80, SHAPES[shape], 'x="50" y="-3" hdg="2.5"')
    curve = read(road("1", plan, length=80))
    towards = np.arctan2(*(np.diff(v[-2:])[0] for v in (curve.y_m, curve.x_m)))
    towards += 0.5 * curve.curvature_per_m[-1] * np.diff(curve.s_m[-2:])[0] + np.pi
    start = np.array([curve.x_m[-1], curve.y_m[-1]])
    start -= 30.0 * np.array([np.cos(towards), np.sin(towards)])
    end = f'x="{start[0]}" y="{start[1]}" hdg="{towards}"'
    first = road("0", geometry(0, 30, pose=end), length=30, link=link("successor", "1", "end"))
    second = road("1", plan, length=80, link=link("successor", "0", "end"))
    arrays, mirror = route_arrays(read(first, second)), route_arrays(curve)
    behind = slice(30, None)
    np.testing.assert_allclose(arrays.x_m[behind], mirror.x_m[::-1], atol=1e-9)
    np.testing.assert_allclose(arrays.y_m[behind], mirror.y_m[::-1], atol=1e-9)
    joined = read(first, second)
    back = np.interp(30.0 + 80.0 - curve.s_m[1:-1], joined.s_m, joined.curvature_per_m)
    np.testing.assert_allclose(back, -curve.curvature_per_m[1:-1], atol=1e-12)


def test_geometries_follow_each_other_with_their_jump(read: Reader) -> None:
    plan = geometry(0, 40.5) + geometry(40.5, 59.5, '<arc curvature="0.01"/>')
    route = read(road("1", plan))
    at = np.flatnonzero(route.s_m == 40.5)
    assert list(route.curvature_per_m[at]) == [0.0, 0.01]
    curvature = np.asarray(route_arrays(route).curvature_per_m)
    assert (curvature[39], curvature[40], curvature[41]) == (0.0, 0.01, 0.01)


def test_a_gap_of_rounding_is_closed_and_a_real_one_refused(read: Reader) -> None:
    assert read(road("1", geometry(0, 49.9) + geometry(50, 50))).length_m == 100.0
    with pytest.raises(ModelError, match="line 7, road 1: gap of 5 m in planView at s = 45 m"):
        read(road("1", geometry(0, 45) + geometry(50, 50)))
    with pytest.raises(ModelError, match="overlap of 3 m in planView"):
        read(road("1", geometry(0, 53) + geometry(50, 50)))
    with pytest.raises(ModelError, match="gap of 20 m in planView at s = 80 m"):
        read(road("1", geometry(0, 80)))
    with pytest.raises(ModelError, match="road 1: the line jumps by 7 m at 50 m"):
        read(road("1", geometry(0, 50) + geometry(50, 50, pose='x="50" y="7" hdg="0"')))


def test_grade_is_the_slope_of_the_elevation(read: Reader) -> None:
    inside = RIGHT_100 + (
        '<elevationProfile><elevation s="0" a="50" b="0.01" c="0.0001" d="-0.000001"/>'
        '<elevation s="50" a="60" b="-0.02" c="0" d="0"/></elevationProfile>'
    )
    grade = np.asarray(route_arrays(read(straight("1", inside=inside))).grade)
    s = np.arange(0.0, 50.0)
    np.testing.assert_allclose(grade[:50], 0.01 + 0.0002 * s - 0.000003 * s * s, atol=1e-12)
    np.testing.assert_allclose(grade[50:], -0.02)


def test_heights_that_no_road_has_are_refused_with_their_place(read: Reader) -> None:
    """What is read can be exported, and a route file takes no grade above 1."""
    inside = RIGHT_100 + (
        '<elevationProfile><elevation s="0" a="0" b="0" c="0" d="0"/>'
        '<elevation s="60" a="0" b="1.125" c="0" d="0"/></elevationProfile>'
    )
    message = r"line \d+, road 1, s = 60.0 m.*grade = 1\.125, steeper than 45 degrees; are heights"
    with pytest.raises(ModelError, match=message):
        read(straight("1", inside=inside))
    assert read(straight("1", inside=inside.replace("1.125", "1.0"))).length_m == 100.0
