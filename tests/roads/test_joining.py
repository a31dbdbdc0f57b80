"""Roads put behind each other: sideways as lanes do, never along, never back."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import geometry, link, road
from pldf.errors import ModelError
from pldf.roads import Route, route_arrays

Reader = Callable[..., Route]


def two(x: float, y: float, heading: float = 0.0, before: str = "<line/>") -> tuple[str, str]:
    """Return a road of 300 m to the east, and one of 600 m linked to it that begins elsewhere."""
    pose = f'x="{x}" y="{y}" hdg="{heading}"'
    first = road("a", geometry(0, 300, before), length=300, link=link("successor", "b", "start"))
    second = road(
        "b", geometry(0, 600, pose=pose), length=600, link=link("predecessor", "a", "end")
    )
    return first, second


@pytest.mark.parametrize("sideways_m", [-35.0, -3.5, 1.75, 14.0, 39.0])
def test_lanes_go_straight_on_where_the_line_moves_sideways(
    read: Reader, sideways_m: float
) -> None:
    route = read(*two(300.0, sideways_m))
    assert route.length_m == 900.0
    assert not np.any(route.curvature_per_m)
    arrays = route_arrays(route)
    x_m, y_m = np.asarray(arrays.x_m), np.asarray(arrays.y_m)
    np.testing.assert_allclose(x_m, np.arange(901.0), atol=1e-9)
    assert y_m[300] == pytest.approx(0.5 * sideways_m, abs=0.2 * abs(sideways_m))
    # Nowhere does it move over faster than a third of the way ahead; far from the link not at all.
    assert np.max(np.abs(np.diff(y_m))) < 0.35
    far = max(5.0 * abs(sideways_m), 1.0)
    assert not np.any(y_m[: int(300 - far)])
    np.testing.assert_array_equal(y_m[int(301 + far) :], sideways_m)
    (note,) = route.notes
    assert note.severity == "note"
    assert f"{abs(sideways_m):.1f} m at 300 m (road b)" in note.text


def test_what_lies_within_a_metre_is_no_move(read: Reader) -> None:
    route = read(*two(300.0, 0.9))
    assert route.notes == ()
    assert list(np.unique(route.y_m)) == [0.0, 0.9]


@pytest.mark.parametrize(
    ("x", "y", "heading", "told"),
    [
        (305.0, 0.0, 0.0, "it begins 5 m along and 0 m beside the end of road a"),
        (290.0, 3.5, 0.0, "10 m along and 3.5 m beside"),
        (300.0, 55.0, 0.0, "0 m along and 55 m beside"),
        (300.0, 0.0, 3.1, "comes .a turn of 178 degrees.; is the contactPoint of the link right"),
        (300.0, 4.0, -2.2, "turn of 126 degrees"),
    ],
)
def test_along_beyond_all_lanes_or_back_is_a_fault(
    read: Reader, x: float, y: float, heading: float, told: str
) -> None:
    with pytest.raises(ModelError, match=rf"line \d+, road b: .*{told}"):
        read(*two(x, y, heading))


def test_lines_that_fan_out_are_apart_lengthways_too(read: Reader) -> None:
    """Ten metres beside the end and 17 degrees aside: measured along either line there is a gap."""
    fan = 17.0 * np.pi / 180.0
    beside = 10.0 * np.exp(1j * (0.5 * np.pi + fan))
    route = read(*two(300.0 + beside.real, beside.imag, fan))
    assert route.length_m == 900.0
    assert any("turns by 17.0 degrees" in note.text for note in route.notes)


def test_a_bend_between_roads_is_a_corner(read: Reader) -> None:
    route = read(*two(300.0, 0.0, 0.35))
    (note,) = route.notes
    assert "turns by 20.1 degrees at a point" in note.text
    assert note.place == "road b, s = 0.0 m (300.0 m of the route)"
    near = np.abs(np.asarray(route_arrays(route).curvature_per_m))
    assert np.sum(near) == pytest.approx(0.35, rel=0.15)


def test_all_bad_links_are_told_at_once(read: Reader) -> None:
    first, second = two(305.0, 0.0)
    second = second.replace("</link>", link("successor", "c", "start") + "</link>")
    third = road("c", geometry(0, 50), length=50, link=link("predecessor", "b", "end"))
    with pytest.raises(ModelError) as caught:
        read(first, second, third)
    assert "road b: it begins 5 m along" in str(caught.value)
    assert "road c: it begins 905 m along" in str(caught.value)
