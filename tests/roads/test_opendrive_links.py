"""OpenDRIVE: roads in line, backwards, through junctions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from opendrive_text import geometry, link, road, straight
from pldf.errors import ModelError
from pldf.roads import Route, route_arrays

KMH = 1.0 / 3.6
Reader = Callable[..., Route]


def test_two_roads_in_line(read: Reader) -> None:
    slow = '<type s="0" type="town"><speed max="50" unit="km/h"/></type>'
    route = read(
        straight("a", link=link("successor", "b", "start")),
        straight("b", 100.0, link=link("predecessor", "a", "end"), inside=slow),
    )
    limit = np.asarray(route_arrays(route).limit_mps)
    assert route.length_m == 200.0
    np.testing.assert_allclose(limit[[99, 100]], [100 * KMH, 50 * KMH])
    np.testing.assert_allclose(route_arrays(route).x_m, np.arange(201.0))


def test_a_road_driven_against_its_direction(read: Reader) -> None:
    """Order, sign of curvature and grade, and the travel side are all turned round."""
    plan = geometry(0, 60, pose='x="200" y="0" hdg="3.141592653589793"') + geometry(
        60, 40, pose='x="140" y="0" hdg="3.141592653589793"', shape='<arc curvature="0.0001"/>'
    )
    inside = (
        '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'
        '<type s="70" type="town"><speed max="50" unit="km/h"/></type>'
        '<elevationProfile><elevation s="0" a="9" b="0.03" c="0" d="0"/></elevationProfile>'
        '<lanes><laneSection s="0"><left><lane id="1" type="driving"><speed sOffset="0" '
        'max="20" unit="m/s"/></lane></left><right><lane id="-1" type="driving"><speed '
        'sOffset="0" max="5" unit="m/s"/></lane></right></laneSection></lanes>'
    )
    first = straight("a", link=link("successor", "b", "end"))
    route = read(first, road("b", plan, link=link("successor", "a", "end"), inside=inside))
    arrays = route_arrays(route)
    assert arrays.limit_mps[150] == 20.0
    assert np.interp(120.0, route.s_m, route.curvature_per_m) == -0.0001
    assert np.interp(170.0, route.s_m, route.curvature_per_m) == 0.0
    assert arrays.grade[150] == -0.03
    np.testing.assert_allclose(arrays.x_m, np.arange(201.0), atol=0.01)


def test_type_speeds_are_mirrored_on_a_road_driven_backwards(read: Reader) -> None:
    inside = (
        '<type s="0" type="rural"><speed max="10"/></type>'
        '<type s="70" type="town"><speed max="20"/></type>'
    )
    head_to_head = read(
        straight("a", link=link("successor", "b", "end")),
        road(
            "b",
            geometry(0, 100, pose='x="200" y="0" hdg="3.14159265"'),
            link=link("successor", "a", "end"),
            inside=inside,
        ),
    )
    limit = np.asarray(route_arrays(head_to_head).limit_mps)
    assert list(limit[[100, 129, 130, 199]]) == [20.0, 20.0, 10.0, 10.0]


def test_contact_point_may_be_missing(read: Reader) -> None:
    far = geometry(0, 100, pose='x="200" y="0" hdg="3.14159265"')
    route = read(
        straight("a", link=link("successor", "b")), road("b", far, link=link("successor", "a"))
    )
    assert route.x_m[-1] == pytest.approx(200.0)


def test_a_loop_ends_where_it_began(read: Reader) -> None:
    half = f'<arc curvature="{np.pi / 100.0}"/>'
    out = geometry(0, 100, half)
    home = geometry(0, 100, half, f'x="0" y="{200.0 / np.pi}" hdg="{np.pi}"')
    both = link("predecessor", "b", "end") + link("successor", "b", "start")
    back = link("predecessor", "a", "end") + link("successor", "a", "start")
    assert read(road("a", out, link=both), road("b", home, link=back)).length_m == 200.0


def test_the_start_must_be_clear(read: Reader) -> None:
    two = (straight("7"), straight("8"))
    with pytest.raises(
        ModelError, match=r"start at road 7, 8; name one: --start-road 7 \(or 8; pldf route"
    ):
        read(*two)
    assert read(*two, start_road="8").length_m == 100.0
    with pytest.raises(ModelError, match="no road '9'; it has 7, 8"):
        read(*two, start_road="9")


def test_roads_with_one_id_are_refused_all_at_once(read: Reader) -> None:
    with pytest.raises(ModelError, match=r"line \d+: <road> id '7' is that of line \d+ too") as no:
        read(straight("7"), straight("8"), straight("7"), straight("8"))
    assert "<road> id '8' is that of line" in str(no.value)


def test_a_start_road_inside_the_chain_begins_there(read: Reader) -> None:
    chain = (
        straight("a", link=link("successor", "b", "start")),
        straight("b", 100.0, link=link("predecessor", "a", "end")),
    )
    assert read(*chain).length_m == 200.0
    assert read(*chain, start_road="b").length_m == 100.0


JUNCTION = (
    '<junction id="j"><connection id="0" incomingRoad="a" connectingRoad="c" '
    'contactPoint="start"/>{more}</junction>'
)


def _crossing(more: str = "") -> tuple[str, ...]:
    connecting = link("predecessor", "a", "end") + link("successor", "b", "start")
    return (
        straight("a", link=link("successor", "j", kind="junction")),
        straight("c", 100.0, link=connecting, attributes='junction="j"'),
        straight("b", 200.0, link=link("predecessor", "j", kind="junction")),
        JUNCTION.format(more=more),
    )


def test_the_only_way_through_a_junction_is_taken(read: Reader) -> None:
    assert read(*_crossing()).length_m == 300.0


@pytest.mark.parametrize("kind", ["road", "junction"])
def test_a_link_to_nowhere_ends_the_way(read: Reader, kind: str) -> None:
    """Excerpts of larger maps are full of them: they were refused, and are told."""
    route = read(straight("a", link=link("successor", "x", "start", kind)))
    assert route.length_m == 100.0
    (told,) = route.notes
    assert (told.severity, told.line, told.place) == ("note", 4, "road a, s = 100 m")
    assert "'x' is not in the file" in told.text
    assert told.consequence == "the way ends here"


def test_linked_roads_must_meet(read: Reader) -> None:
    with pytest.raises(
        ModelError, match="road b: it begins 400 m along and 0 m beside the end of road a"
    ):
        read(
            straight("a", link=link("successor", "b", "start")),
            straight("b", 500.0, link=link("predecessor", "a", "end")),
        )
