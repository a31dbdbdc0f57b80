"""OpenDRIVE: geometry, links, speeds, elevation, and what is said about unusable files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pldf.instance import ModelError
from pldf.roads import Route, read_route, route_arrays

KMH = 1.0 / 3.6
Reader = Callable[..., Route]

RIGHT_100 = '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'


def geometry(s: float, length: float, shape: str = "<line/>", pose: str = "") -> str:
    pose = pose or f'x="{s}" y="0" hdg="0"'
    return f'<geometry s="{s}" {pose} length="{length}">{shape}</geometry>'


def road(
    road_id: str,
    plan: str,
    *,
    length: float = 100.0,
    link: str = "",
    inside: str = RIGHT_100,
    attributes: str = 'junction="-1"',
) -> str:
    return (
        f'<road id="{road_id}" length="{length}" {attributes}>\n<link>{link}</link>\n'
        f"{inside}\n<planView>\n{plan}\n</planView>\n</road>"
    )


def link(end: str, element: str, contact: str = "", kind: str = "road") -> str:
    point = f'contactPoint="{contact}"' if contact else ""
    return f'<{end} elementType="{kind}" elementId="{element}" {point}/>'


def straight(road_id: str, x: float = 0.0, **more: object) -> str:
    """Return a road of 100 m to the east that begins at ``x``."""
    plan = geometry(0, 100, pose=f'x="{x}" y="0" hdg="0"')
    return road(road_id, plan, **more)  # type: ignore[arg-type]


@pytest.fixture
def read(tmp_path: Path) -> Reader:
    def reader(*roads: str, before: str = "", **options: object) -> Route:
        path = tmp_path / "town.xodr"
        body = "\n".join(roads)
        path.write_text(f'{before}<?xml version="1.0"?>\n<OpenDRIVE>\n{body}\n</OpenDRIVE>\n')
        return read_route(path, **options)  # type: ignore[arg-type]

    return reader


# Geometry

SHAPES = {
    "line": "<line/>",
    "arc": '<arc curvature="-0.012"/>',
    "spiral": '<spiral curvStart="0.004" curvEnd="-0.015"/>',
    "poly3": '<poly3 a="0" b="0" c="0.003" d="-0.00004"/>',
    "arcLength": '<paramPoly3 aU="0" bU="1" cU="0" dU="-0.000002" aV="0" bV="0" cV="0.0015" '
    'dV="-0.000005" pRange="arcLength"/>',
    "normalized": '<paramPoly3 aU="0" bU="79" cU="0" dU="-0.5" aV="0" bV="0" cV="9" dV="-4" '
    'pRange="normalized"/>',
}


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
    end = f'x="{curve.x_m[-1] - 30.0}" y="{curve.y_m[-1]}" hdg="0"'
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


# Links


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
    turned = geometry(0, 100, pose='x="100" y="0" hdg="3.14159265"')
    both = link("predecessor", "b", "end") + link("successor", "b", "start")
    back = link("predecessor", "a", "end") + link("successor", "a", "start")
    assert read(straight("a", link=both), road("b", turned, link=back)).length_m == 200.0


def test_the_start_must_be_clear(read: Reader) -> None:
    two = (straight("7"), straight("8"))
    with pytest.raises(ModelError, match=r"could start at road 7, 8; name one \(--start-road ID\)"):
        read(*two)
    assert read(*two, start_road="8").length_m == 100.0
    with pytest.raises(ModelError, match="no road '9'; it has 7, 8"):
        read(*two, start_road="9")


def test_two_roads_with_one_id_are_refused(read: Reader) -> None:
    with pytest.raises(ModelError, match=r"line \d+: <road> id '7' is that of line \d+ too"):
        read(straight("7"), straight("8"), straight("7"))


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


def test_a_junction_with_a_choice_is_refused(read: Reader) -> None:
    second = '<connection incomingRoad="a" connectingRoad="b" contactPoint="start"/>'
    with pytest.raises(ModelError, match=r"road a: junction j leads on to road c, b; keep one"):
        read(*_crossing(second), start_road="a")


@pytest.mark.parametrize("kind", ["road", "junction"])
def test_a_link_to_nowhere_is_refused(read: Reader, kind: str) -> None:
    with pytest.raises(ModelError, match=r"line 4, road a: .*'x' is not in the file"):
        read(straight("a", link=link("successor", "x", "start", kind)))


def test_linked_roads_must_meet(read: Reader) -> None:
    with pytest.raises(ModelError, match="road b: the line jumps by 400 m at 100 m of the route"):
        read(
            straight("a", link=link("successor", "b", "start")),
            straight("b", 500.0, link=link("predecessor", "a", "end")),
        )


# Speeds


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


def lanes(*sections: str) -> str:
    return f"{RIGHT_100}<lanes>{''.join(sections)}</lanes>"


def lane(speeds: str, kind: str = "driving", side: str = "right", lane_id: int = -1) -> str:
    return f'<{side}><lane id="{lane_id}" type="{kind}">{speeds}</lane></{side}>'


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


def test_a_speed_that_begins_late_leaves_a_hole(read: Reader) -> None:
    late = '<type s="30" type="rural"><speed max="20"/></type>'
    with pytest.raises(ModelError, match="no speed limit from s = 0 m on"):
        read(straight("1", inside=late))
    route = read(straight("1", inside=late), default_limit_mps=9.0)
    assert list(np.asarray(route_arrays(route).limit_mps)[[29, 30]]) == [9.0, 20.0]


# Elevation


def test_grade_is_the_slope_of_the_elevation(read: Reader) -> None:
    inside = RIGHT_100 + (
        '<elevationProfile><elevation s="0" a="50" b="0.01" c="0.0001" d="-0.000001"/>'
        '<elevation s="50" a="60" b="-0.02" c="0" d="0"/></elevationProfile>'
    )
    grade = np.asarray(route_arrays(read(straight("1", inside=inside))).grade)
    s = np.arange(0.0, 50.0)
    np.testing.assert_allclose(grade[:50], 0.01 + 0.0002 * s - 0.000003 * s * s, atol=1e-12)
    np.testing.assert_allclose(grade[50:], -0.02)


# Files


@pytest.mark.parametrize(
    "before", ["\ufeff", "<!-- <OpenDRIVE> by hand -->\n", "exported\n\n", "\n"]
)
def test_text_before_the_xml_is_skipped_and_lines_still_count(read: Reader, before: str) -> None:
    assert read(straight("1"), before=before).length_m == 100.0
    with pytest.raises(ModelError, match=f"line {3 + before.count(chr(10))}, road 1: no planView"):
        read(road("1", ""), before=before)


def test_the_name_comes_from_the_header_else_from_the_file(read: Reader) -> None:
    assert read('<header name=" B 85 "/>', straight("1")).name == "B 85"
    assert read(straight("1")).name == "town"


def test_a_prefix_or_default_namespace_does_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "ns.xodr"
    path.write_text(f'<OpenDRIVE xmlns="http://code.asam.net/x">{straight("1")}</OpenDRIVE>')
    assert read_route(path).length_m == 100.0


@pytest.mark.parametrize(
    ("roads", "message"),
    [
        ("", "line 2: no <road> in this file"),
        ("<road", "not well-formed XML"),
        (road("1", geometry(0, 100), length=0), "line 3, road 1: length 0 m"),
        (road("1", geometry(0, 1e18), length=1e18), "line 3, road 1: length 1e.18 m is beyond"),
        (road("1", ""), "road 1: no planView/geometry"),
        (road("1", geometry(0, 100, "<circle/>")), "road 1: no line, arc, spiral"),
        (
            road("1", geometry(0, 100, '<arc curvature="nan"/>')),
            "line 7, road 1: <arc> attribute curvature = 'nan' is not a finite number",
        ),
        (road("1", geometry(0, 100, "<arc/>")), "<arc> attribute curvature is missing"),
        (road("1", geometry(0, 100, '<arc curvature="3"/>')), "tighter than 1 m"),
        (road("1", geometry(0, 1), length=1), "the route is 1 m long"),
        (
            road("1", geometry(0, 100, SHAPES["normalized"].replace("normalized", "arcLength"))),
            "line 7, road 1: the polynomial is .* check length and pRange",
        ),
        (
            straight("1", inside='<type s="0"><speed max="0"/></type>'),
            r"line 5, road 1: speed limit 0 m/s \(no unit given\) must lie above 0",
        ),
        (straight("1", inside='<type s="0"><speed max="-50" unit="mph"/></type>'), "limit -50 mph"),
        (straight("1", inside='<type s="0"><speed max="100"/></type>'), "limit 100 m/s .no unit"),
        (straight("1", inside='<type s="0"><speed max="9" unit="knots"/></type>'), "unit 'knots'"),
        (straight("1", inside='<type s="0"><speed max="fast"/></type>'), "max = 'fast' is not"),
        (straight("1", inside='<type s="0"><speed unit="mph"/></type>'), "max is missing"),
    ],
)
def test_an_unusable_file_is_refused_with_its_line(read: Reader, roads: str, message: str) -> None:
    with pytest.raises(ModelError, match=message) as caught:
        read(roads)
    assert "town.xodr" in str(caught.value)
    assert str(caught.value).count("\n") <= 1


def test_another_xml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "map.xodr"
    path.write_text("<osm/>")
    with pytest.raises(ModelError, match="line 1: <osm> where <OpenDRIVE> should be"):
        read_route(path)
