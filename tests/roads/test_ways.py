"""A way through a network of roads: what is chosen, what is told, what is refused."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from networks import BOTH, LEFT, NONE, RIGHT, Map, crossing
from pldf.errors import ModelError
from pldf.roads import RoadOptions, Route, chosen_route, open_route, read_route
from pldf.roads.opendrive.leg import Leg
from pldf.roads.opendrive.xml_parser import parse_xml
from pldf.roads.opendrive.xml_tree import Place
from pldf.roads.ways.network import Network
from pldf.roads.ways.ways import find_way

Driven = Callable[..., list[str]]


@pytest.fixture
def told() -> list[str]:
    """What the last way told, as a person reads it."""
    return []


@pytest.fixture
def driven(tmp_path: Path, told: list[str]) -> Driven:
    """Return a function that returns the roads of a way, those driven against with a minus."""

    def driver(made: Map, **options: object) -> list[str]:
        path = tmp_path / "town.xodr"
        path.write_text(made.text, encoding="utf-8")
        root = parse_xml([path.read_bytes()], "OpenDRIVE", path, [])
        notes: list[object] = []
        legs = find_way(Network(root, Place(path)), RoadOptions(**options), notes)  # type: ignore[arg-type]
        told[:] = [f"{note.severity}: {str(note).removeprefix(str(path))}" for note in notes]  # type: ignore[attr-defined]
        route: Route = read_route(path, RoadOptions(**options))  # type: ignore[arg-type]
        assert route.length_m > 0.0
        return [f"{'-' if leg.against else ''}{leg.id}" for leg in legs]

    return driver


def test_a_named_road_decides_the_way_and_ends_it(driven: Driven, told: list[str]) -> None:
    town = crossing()
    assert driven(town, start_road="w", via=("e",)) == ["w", "we", "e"]
    assert driven(town, start_road="w", to="n") == ["w", "wn", "n"]
    assert driven(town, start_road="w", to="s") == ["w", "ws", "-s"]
    assert driven(town, start_road="w", to="w") == ["w"]
    assert driven(town, start_road="w", via=("wn",)) == ["w", "wn", "n"]
    assert told == []


def test_reverse_drives_the_start_road_against_its_direction(driven: Driven) -> None:
    assert driven(crossing(), start_road="e", reverse=True, to="w") == ["-e", "ew", "-w"]
    assert driven(crossing(), start_road="e") == ["e"]


def test_reverse_without_a_start_road_drives_the_whole_way_the_other_way_round(
    driven: Driven,
) -> None:
    line = Map().road("a", (0.0, 0.0), (100.0, 0.0), front="b end", lanes=BOTH)
    line.road("b", (200.0, 0.0), (100.0, 0.0), rear="c start", front="a end", lanes=BOTH)
    line.road("c", (200.0, 0.0), (300.0, 0.0), rear="b start", lanes=BOTH)
    assert driven(line) == ["a", "-b", "c"]
    assert driven(line, reverse=True) == ["-c", "b", "-a"]
    one_way = Map().road("a", (0.0, 0.0), (100.0, 0.0))
    with pytest.raises(ModelError, match="road a: no lane goes against the direction"):
        driven(one_way, reverse=True)
    with pytest.raises(ModelError, match=r"could start at road w.*--start-road w --reverse"):
        driven(crossing(), reverse=True)
    assert driven(crossing(), reverse=True, via=("e",), to="w") == ["-e", "ew", "-w"]


def test_a_choice_is_refused_with_the_ways_and_what_to_type(driven: Driven) -> None:
    with pytest.raises(ModelError) as refused:
        driven(crossing(), start_road="w")
    text = str(refused.value)
    assert re.search(r"town.xodr, line 4, road w: junction J leads on to road ", text)
    assert "road s (right by 45 degrees, through road ws, 14.1 m)" in text
    assert "road e (straight on, through road we, 20 m)" in text
    assert "road n (left by 45 degrees, through road wn, 14.1 m)" in text
    assert "say where to go: --start-road w --via s (or e, n); --start-road w --to w ends" in text
    for name, way in {"s": ["w", "ws", "-s"], "n": ["w", "wn", "n"]}.items():
        assert driven(crossing(), start_road="w", via=(name,)) == way


def test_what_the_model_of_an_fmu_says_names_a_command(tmp_path: Path) -> None:
    """A model has no such options: the way out is a file with the way in it."""
    path = tmp_path / "my town.xodr"
    path.write_text(crossing().text, encoding="utf-8")
    with pytest.raises(ModelError, match=r"pldf route '.*my town.xodr' --start-road w") as refused:
        chosen_route(0, str(path))
    assert "--export my.csv" in str(refused.value)


def test_what_python_says_names_keywords(tmp_path: Path) -> None:
    path = tmp_path / "town.xodr"
    path.write_text(crossing().text, encoding="utf-8")
    with pytest.raises(ModelError, match=r"say where to go: start_road='w', via=\('s',\) \(or"):
        open_route(str(path), start_road="w")
    for via in (["ws", "s"], "ws,s"):
        assert open_route(str(path), start_road="w", via=via).length_m > 200.0


def test_behind_the_last_named_road_it_goes_on_to_the_next_choice(
    driven: Driven, told: list[str]
) -> None:
    town = crossing().road("x", (310.0, 0.0), (110.0, 0.0), front="e end", lanes=BOTH)
    town.roads[2] = town.roads[2].replace(
        "</link>", '<successor elementType="road" elementId="x" contactPoint="end"/></link>'
    )
    assert driven(town, start_road="w", via=("e",)) == ["w", "we", "e", "-x"]
    assert driven(town, start_road="w", to="e") == ["w", "we", "e"]
    assert driven(town, start_road="x", via=("e",)) == ["x", "-e"]
    (note,) = told
    assert "the way ends here: junction J leads on to road w (straight on, through" in note
    assert "to go on, name one more to pass: w, s, n" in note


def test_the_first_named_road_is_the_start_where_none_is_given(
    driven: Driven, told: list[str]
) -> None:
    assert driven(crossing(), via=("n",), to="s") == ["-n", "ns", "-s"]
    assert "starts with road n, the first that is named, against the direction" in told[0]
    assert driven(crossing(), via=("w", "e")) == ["w", "we", "e"]
    with pytest.raises(ModelError, match=r"could start at road w, s; name one: --start-road w"):
        driven(crossing())


def test_a_road_may_be_passed_twice(driven: Driven, told: list[str]) -> None:
    ring = Map()
    corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    for i, name in enumerate("abcd"):
        before, after = "abcd"[i - 1], "abcd"[(i + 1) % 4]
        ring.road(
            name, corners[i], corners[(i + 1) % 4], rear=f"{before} end", front=f"{after} start"
        )
    assert driven(ring) == ["a", "b", "c", "d"]
    assert told == []
    assert driven(ring, start_road="b") == ["b", "c", "d", "a"]
    assert driven(ring, start_road="a", via=("a", "a"), to="b") == list("abcdab")
    assert driven(ring, start_road="a", via=("b",), to="a") == list("abcda")
    assert driven(ring, start_road="a", via=("a", "a"), to="a") == list("abcda")


def test_a_road_out_of_reach_is_refused_with_what_can_be_reached(driven: Driven) -> None:
    line = Map().road("a", (0.0, 0.0), (100.0, 0.0), front="b start", lanes=BOTH)
    line.road("b", (100.0, 0.0), (200.0, 0.0), rear="a end", lanes=BOTH)
    line.road("c", (200.0, 0.0), (300.0, 0.0), lanes=BOTH)
    with pytest.raises(ModelError, match=r"no way from road a, driven along its direction, to ro"):
        driven(line, start_road="a", to="c")
    with pytest.raises(ModelError, match="c; from there the way leads to road b"):
        driven(line, start_road="a", to="c")
    with pytest.raises(ModelError, match=r"a way from it in the other direction \(reverse\)"):
        driven(line, start_road="b", to="a")
    with pytest.raises(ModelError, match="no road 'z'; it has a, b, c"):
        driven(line, start_road="a", via=("b", "z"))


def test_a_link_that_only_one_road_has_counts_for_both(driven: Driven, told: list[str]) -> None:
    two = Map().road("a", (0.0, 0.0), (100.0, 0.0), lanes=BOTH)
    two.road("b", (100.0, 0.0), (200.0, 0.0), rear="a end", lanes=BOTH)
    assert driven(two) == ["a", "b"]
    assert told == [
        "note: , line 9, road a, s = 100 m: no <successor>, but the start of road b is linked to "
        "here; taken as linked"
    ]
    assert driven(two, start_road="b", reverse=True) == ["-b", "-a"]
    assert told == []


def test_a_junction_whose_roads_are_linked_to_a_road_is_its_own(
    driven: Driven, told: list[str]
) -> None:
    town = crossing()
    town.roads[0] = re.sub("<successor[^>]*>", "", town.roads[0])
    assert driven(town, start_road="w", to="e") == ["w", "we", "e"]
    assert "no <successor>, but the start of road ws is linked to here" in told[0]
    with pytest.raises(ModelError, match="junction J leads on to road s"):
        driven(town, start_road="w")


def test_ids_may_be_words_with_commas_and_blanks(driven: Driven) -> None:
    made = Map()
    names = ["12", "Main St, 3", "a,b", " x"]
    for i, name in enumerate(names):
        front = f"{names[i + 1]} start" if i < 3 else ""
        made.road(name, (100.0 * i, 0.0), (100.0 * i + 100, 0.0), front=front)
    assert driven(made, start_road="12", via=("Main St, 3,a,b",), to=" x") == names
    assert driven(made, start_road="12", via=("Main St, 3", "a,b")) == names
    assert driven(made, start_road=" 12", to="a,b") == names[:3]


def _side_road(
    start: tuple[float, float] = (120.0, 9.0),
    end: tuple[float, float] = (100.0, 0.0),
    **more: object,
) -> Map:
    """Return w -> J -> e, with road ``c`` through it, and road ``x`` at the same junction."""
    made = Map().road("w", (0.0, 0.0), (100.0, 0.0), front="junction J")
    made.road("e", (120.0, 0.0), (220.0, 0.0), rear="junction J")
    made.road("n", (220.0, 9.0), (120.0, 9.0), front="junction J")
    made.road("c", (100.0, 0.0), (120.0, 0.0), rear="w end", front="e start", junction="J")
    made.connect("J", "w", "c")
    made.road("x", start, end, junction="J", **more)  # type: ignore[arg-type]
    return made


def test_a_connecting_road_that_ends_here_is_no_way_out(driven: Driven, told: list[str]) -> None:
    entry = _side_road(rear="n end", front="w end").connect("J", "w", "x")
    assert driven(entry, start_road="w") == ["w", "c", "e"]
    assert told == []


def test_the_lines_decide_where_a_connecting_road_has_no_links(driven: Driven) -> None:
    """It leaves from here if it begins nearer to this end than to the other, and does not go back.

    The start of x lies 120 m from the start of w and 20 m from its end, but x leads back to w.
    """
    entry = _side_road(lanes=NONE).connect("J", "w", "x", "start")
    assert driven(entry, start_road="w") == ["w", "c", "e"]
    leaving = _side_road((100.0, 0.0), (120.0, 9.0), lanes=NONE).connect("J", "w", "x", "start")
    with pytest.raises(ModelError, match=r"road e \(straight on.*, road x \(straight on, 21.9 m"):
        driven(leaving, start_road="w")
    far = _side_road((-9.0, 0.0), (-20.0, 9.0), lanes=NONE).connect("J", "w", "x", "start")
    assert driven(far, start_road="w") == ["w", "c", "e"]


def test_a_contact_point_that_the_road_contradicts_is_told(driven: Driven, told: list[str]) -> None:
    """With a lane that leaves from here, it is the contact point that is wrong."""
    wrong = _side_road(rear="n end", front="w end", lanes=BOTH).connect("J", "w", "x", "start")
    assert driven(wrong, start_road="w", to="n") == ["w", "-x", "-n"]
    assert any(
        "junction J says that road x is met at its start, the road's own link that it is met at "
        "its end; x is driven from its end on" in note
        for note in told
    )


def test_a_connecting_road_that_names_the_wrong_end_is_told(
    driven: Driven, told: list[str]
) -> None:
    """Only the end of w is at the junction, whatever the link says."""
    wrong = _side_road((100.0, 0.0), (120.0, 9.0), rear="w start", front="n end")
    assert driven(wrong.connect("J", "w", "x"), start_road="w", to="x") == ["w", "x"]
    assert told == [
        "warning: , line 28, road w, s = 100 m: <predecessor> of road x (line 24) names the start "
        "of road w, which is met at its end; x is driven from its start on"
    ]


def test_a_connecting_road_that_leads_to_the_wrong_end_is_told(
    driven: Driven, told: list[str]
) -> None:
    town = crossing()
    town.roads[5] = town.roads[5].replace(
        'elementId="e" contactPoint="start"', 'elementId="e" contactPoint="end"'
    )
    assert driven(town, start_road="w", to="e") == ["w", "we", "e"]
    assert "<successor> names the end of road e, which is linked to here by its start" in told[0]
    assert "driven from its start on, where the lines meet" in told[0]


@pytest.mark.parametrize(
    ("lanes", "rule", "open_"),
    [
        (RIGHT, "", True),
        (LEFT, "", False),
        (LEFT, 'rule="LHT"', True),
        (RIGHT, 'rule="LHT"', False),
        (("", "onRamp"), "", True),
        (("", "bidirectional"), 'rule="LHT"', True),
        (("", "sidewalk"), "", False),
        (("sidewalk", "HOV"), "", True),
        (NONE, "", True),
    ],
)
def test_a_connecting_road_needs_a_lane_that_leaves(
    driven: Driven, lanes: tuple[str, str], rule: str, open_: bool
) -> None:
    made = _side_road(
        (100.0, 0.0), (120.0, 9.0), rear="w end", front="n end", lanes=lanes, more=rule
    ).connect("J", "w", "x")
    if open_:
        with pytest.raises(ModelError, match=r"leads on to road e .* road n "):
            driven(made, start_road="w")
    else:
        assert driven(made, start_road="w") == ["w", "c", "e"]


@pytest.mark.parametrize("direction", ["reversed", "both"])
def test_a_lane_may_go_against_its_side(driven: Driven, direction: str) -> None:
    one = Map().road("a", (0.0, 0.0), (100.0, 0.0), lanes=LEFT)
    one.roads[0] = one.roads[0].replace('type="driving"', f'type="driving" direction="{direction}"')
    assert driven(one, start_road="a") == ["a"]


@pytest.mark.parametrize("stated", [True, False])
def test_both_ends_of_a_road_at_one_junction(driven: Driven, stated: bool) -> None:
    """A loop leaves the junction and comes back: only the ways out of its end count."""
    end, start = ("l end", "l start") if stated else ("l ", "l ")
    made = Map().road("w", (-100.0, 0.0), (0.0, 0.0), front="junction J")
    made.road("l", (20.0, 0.0), (20.0, 90.0), rear="junction J", front="junction J")
    made.road("n", (0.0, 100.0), (-100.0, 100.0), rear="junction J")
    made.road("wl", (0.0, 0.0), (20.0, 0.0), rear="w end", front=start, junction="J")
    made.road("ln", (20.0, 90.0), (0.0, 100.0), rear=end, front="n start", junction="J")
    made.road("lw", (20.0, 0.0), (0.0, 5.0), rear=start, front="n start", junction="J")
    made.connect("J", "w", "wl").connect("J", "l", "ln").connect("J", "l", "lw")
    assert driven(made, start_road="w") == ["w", "wl", "l", "ln", "n"]
    assert driven(made, start_road="l") == ["l", "ln", "n"]


def test_a_ring_whose_ends_lie_at_one_place(driven: Driven) -> None:
    """Only the links say which connecting road leaves from which end."""
    made = Map()
    made.road("r", (0.0, 0.0), (60.0, 0.0), rear="junction J", front="junction J", lanes=BOTH)
    made.roads[0] = made.roads[0].replace("<line/>", f'<arc curvature="{math.tau / 60.0!r}"/>')
    made.road("e", (20.0, 0.0), (90.0, 0.0), rear="junction J")
    made.road("s", (10.0, -20.0), (10.0, -90.0), rear="junction J")
    made.road("re", (0.0, 0.0), (20.0, 0.0), rear="r end", front="e start", junction="J")
    made.road("rs", (0.0, 0.0), (10.0, -20.0), rear="r start", front="s start", junction="J")
    made.connect("J", "r", "re").connect("J", "r", "rs")
    assert driven(made, start_road="r") == ["r", "re", "e"]
    assert driven(made, start_road="r", reverse=True) == ["-r", "rs", "s"]


def test_a_way_ends_before_it_turns_back(driven: Driven, told: list[str]) -> None:
    back = Map().road("w", (0.0, 0.0), (100.0, 0.0), front="junction J", lanes=BOTH)
    back.road("u", (100.0, 0.0), (100.0, 5.0), rear="w end", front="w end", junction="J")
    back.connect("J", "w", "u")
    assert driven(back, start_road="w") == ["w", "u"]
    assert told == ["note: , line 9, road u, s = 5 m: road w comes again; the way ends before it"]


def test_a_way_that_was_driven_is_named_by_what_leads_there(driven: Driven) -> None:
    """Naming the road itself would be taken for where it was passed before."""
    town = crossing().connect("J", "w", "u")
    town.road("u", (-10.0, 0.0), (-10.0, 5.0), rear="w end", front="w end", junction="J")
    with pytest.raises(ModelError, match=r"road w \(left.*--via s \(or e, n, u\)"):
        driven(town, start_road="w")


def test_several_connecting_roads_to_one_road_are_no_choice(
    driven: Driven, told: list[str]
) -> None:
    made = _side_road((100.0, 3.0), (120.0, 2.0), rear="w end", front="e start")
    made.connect("J", "w", "x")
    assert driven(made, start_road="w") == ["w", "c", "e"]
    assert "junction J leads on to road e through road c, x; c is driven" in told[0]
    assert driven(made, start_road="w", via=("x",)) == ["w", "x", "e"]


def test_a_road_whose_lanes_all_go_against_it_is_driven_so(driven: Driven, told: list[str]) -> None:
    one = Map().road("a", (0.0, 0.0), (100.0, 0.0), lanes=LEFT)
    for options in ({}, {"start_road": "a"}):
        assert driven(one, **options) == ["-a"]
        assert told == [
            "note: , line 3, road a: all lanes go against the direction in which it is drawn; "
            "it is driven from its end to its start"
        ]
    assert driven(one, start_road="a", reverse=True) == ["-a"]
    other = Map().road("a", (0.0, 0.0), (100.0, 0.0))
    with pytest.raises(ModelError, match=r"line 3, road a: no lane goes against .*leave out"):
        driven(other, start_road="a", reverse=True)


def test_a_road_without_a_lane_this_way_is_told(driven: Driven, told: list[str]) -> None:
    two = Map().road("a", (0.0, 0.0), (100.0, 0.0), front="b start")
    two.road("b", (100.0, 0.0), (200.0, 0.0), rear="a end", lanes=LEFT)
    assert driven(two, start_road="a") == ["a", "b"]
    assert told == [
        "warning: , line 8, road b: no lane for cars along its direction, in which it is driven"
    ]


def test_direct_junctions_lead_both_ways(driven: Driven) -> None:
    """A motorway that splits: 1 to 2 and 3; and back, in the other direction."""
    made = Map().road("1", (0.0, 0.0), (100.0, 0.0), front="junction J", lanes=BOTH)
    made.road("2", (100.0, 0.0), (200.0, 0.0), rear="junction J", lanes=BOTH)
    made.road("3", (100.0, 0.0), (200.0, -50.0), rear="junction J")
    made.kinds["J"] = 'type="direct"'
    made.connect("J", "1", "2", "start", "linkedRoad").connect("J", "1", "3", "start", "linkedRoad")
    with pytest.raises(ModelError, match=r"road 2 \(straight on, 100 m\), road 3 \(straight"):
        driven(made, start_road="1")
    assert driven(made, start_road="1", to="3") == ["1", "3"]
    assert driven(made, start_road="2", reverse=True) == ["-2", "-1"]
    ring = Map().road("1", (0.0, 0.0), (100.0, 0.0), front="junction J", lanes=BOTH)
    ring.road("2", (100.0, 0.0), (103.0, 0.0), rear="junction J", front="junction J", lanes=BOTH)
    ring.kinds["J"] = 'type="direct"'
    ring.connect("J", "1", "2", "start", "linkedRoad")
    assert driven(ring, start_road="1") == ["1", "2"]
    assert driven(ring, start_road="2") == ["2"]


def test_a_main_road_passes_a_virtual_junction_as_it_is(driven: Driven, told: list[str]) -> None:
    made = Map().road("m", (0.0, 0.0), (100.0, 0.0))
    made.road("c", (50.0, 0.0), (60.0, -9.0), rear="m ", front="d start", junction="V")
    made.road("d", (60.0, -9.0), (60.0, -99.0), rear="c end", lanes=BOTH)
    made.roads[1] = made.roads[1].replace('elementId="m"', 'elementId="m" elementS="50"', 1)
    made.roads[1] = made.roads[1].replace('contactPoint=""', "").replace(RIGHT[1], "bidirectional")
    made.connect("V", "m", "c")
    made.kinds["V"] = 'type="virtual" mainRoad="m" sStart="45" sEnd="65" orientation="-"'
    assert driven(made, start_road="m") == ["m"]
    assert driven(made, start_road="d", reverse=True) == ["-d", "-c"]
    assert "leads into the middle of road m, at 50 m; the way ends here" in told[0]


def test_which_end_of_a_ring_a_connecting_road_means_is_told_if_only_the_lines_say_it(
    driven: Driven, told: list[str]
) -> None:
    ring = Map().road(
        "r", (0.0, 0.0), (100.0, 0.0), rear="junction J", front="junction J", lanes=BOTH
    )
    ring.road("c", (100.0, 0.0), (110.0, 0.0), rear="r ", front="e start", junction="J")
    ring.road("e", (110.0, 0.0), (200.0, 0.0), rear="c end")
    ring.connect("J", "r", "c")
    assert driven(ring, start_road="r") == ["r", "c", "e"]
    assert "does not say (contactPoint) which end of road r it means" in told[0]
    assert "the end, where the lines meet; c is driven from its start on" in told[0]


def test_links_that_contradict_each_other_are_told(driven: Driven, told: list[str]) -> None:
    wrong = Map().road("a", (0.0, 0.0), (100.0, 0.0), front="b end")
    wrong.road("b", (100.0, 0.0), (200.0, 0.0), rear="a end")
    assert driven(wrong) == ["a", "b"]
    assert told == [
        "warning: , line 4, road a, s = 100 m: <successor> names the end of road b, which is "
        "linked to here by its start; driven from its start on, where the lines meet"
    ]
    silent = Map().road("a", (0.0, 0.0), (100.0, 0.0), front="b ")
    silent.road("b", (200.0, 0.0), (100.0, 0.0), lanes=BOTH)
    assert driven(silent, start_road="a") == ["a", "-b"]
    assert "does not say at which end road b is met (contactPoint); driven from its end" in told[0]


def test_thousands_of_roads_are_searched() -> None:
    """A grid of one-way streets: the shortest way from corner to corner has 2 n - 2 roads."""
    n = 40
    root = parse_xml([_grid(n).encode()], "OpenDRIVE", Path("grid.xodr"), [])
    network = Network(root, Place(Path("grid.xodr")))
    assert len(network.roads) > 10 * n * n // 2
    legs = find_way(network, RoadOptions(start_road="h0_0", to=f"v{n - 1}_{n - 2}"), [])
    streets = [leg.id for leg in legs if ">" not in leg.id]
    assert len(streets) == 2 * n - 2
    assert len(set(streets)) == len(streets)


def _grid(n: int) -> str:
    made = Map()
    for i in range(n):
        for j in range(n):
            here, inner = (100.0 * i, 100.0 * j), f"junction J{i}_{j}"
            if i < n - 1:
                to = (here[0] + 100.0, here[1])
                made.road(f"h{i}_{j}", here, to, rear=inner, front=f"junction J{i + 1}_{j}")
            if j < n - 1:
                to = (here[0], here[1] + 100.0)
                made.road(f"v{i}_{j}", here, to, rear=inner, front=f"junction J{i}_{j + 1}")
            coming = [f"h{i - 1}_{j}"] * (i > 0) + [f"v{i}_{j - 1}"] * (j > 0)
            leaving = [f"h{i}_{j}"] * (i < n - 1) + [f"v{i}_{j}"] * (j < n - 1)
            for one in coming:
                for other in leaving:
                    name = f"{one}>{other}"
                    near = (here[0] + 0.1, here[1] + 0.1)
                    made.road(
                        name, here, near, rear=f"{one} end", front=f"{other} start",
                        junction=f"J{i}_{j}",
                    )  # fmt: skip
                    made.connect(f"J{i}_{j}", one, name)
    return made.text


def test_a_leg_is_a_road_and_a_direction() -> None:
    root = parse_xml([crossing().text.encode()], "OpenDRIVE", Path("x.xodr"), [])
    road = root.children[0]
    assert Leg(road, against=True) == Leg(road, against=False).turned
    assert len({Leg(road, against=True), Leg(road, against=True).turned.turned}) == 1
    assert Leg(road, against=True) not in (road, None)


def test_an_end_with_two_links_is_told(tmp_path: Path) -> None:
    made = (
        Map().road("1", (0, 0), (50, 0), front="2 start").road("2", (50, 0), (90, 0), rear="1 end")
    )
    made.road("3", (50, 0), (70, 0), rear="1 end")
    text = made.text
    link = '<successor elementType="road" elementId="2" contactPoint="start"/>'
    path = tmp_path / "two.xodr"
    for other, told in ((link, 0), (link.replace('"2"', '"3"'), 1)):
        path.write_text(text.replace(link, link + other))
        route = read_route(path, RoadOptions(start_road="1"))
        notes = [note for note in route.notes if "2 <successor>, which say different" in note.text]
        assert (route.length_m, len(notes)) == (90.0, told)
