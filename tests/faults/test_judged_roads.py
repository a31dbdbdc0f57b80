"""The judge of roads: what it reads of known lines, and whether it sees what is wrong."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from pldf.roads import Route, read_route
from pldf.roads.options import RoadOptions
from scipy.special import fresnel

from faults.judged_roads import differences
from faults.judged_roads_changes import BYTE_CHANGES, TREE_CHANGES, changed
from faults.judged_roads_maps import DRAWINGS, drawn
from faults.judged_roads_pen import Piece, Road, Sketch, between
from faults.judged_roads_reader import Way, parse
from faults.judged_roads_spoilt import verdict
from faults.sheets import Unclear

LIMITS = (
    '<type s="0.3" type="rural"><speed max="70" unit="km/h"/></type>'
    '<type s="60" type="town"><speed max="25" unit="mph"/></type>'
    '<type s="90" type="town"/>'
)


def bend() -> Sketch:
    """100 m straight on, 40 m clothoid to R 25 m, 30 m arc; then another road of 80 m."""
    pieces = [Piece(5.0, -3.0, 0.7, 100.0)]
    for length, first, last in ((40.0, 0.0, 0.04), (30.0, 0.04, 0.04)):
        pieces.append(Piece(*pieces[-1].end, length, first, last))
    made = Sketch([Road("1", pieces, front="2 start", limit=LIMITS)])
    made.roads.append(Road("2", [Piece(*pieces[-1].end, 80.0)], rear="1 end"))
    return made


def test_a_line_is_where_fresnel_says() -> None:
    line = parse(bend().text).line("1")
    s = np.linspace(0.0, 40.0, 9)
    scale = np.sqrt(40.0 / 0.04 * pi)  # clothoid parameter A = sqrt(R L), times sqrt(pi)
    sine, cosine = fresnel(s / scale)
    along, left = scale * cosine, scale * sine
    x = 5.0 + np.cos(0.7) * (100.0 + along) - np.sin(0.7) * left
    y = -3.0 + np.sin(0.7) * (100.0 + along) + np.cos(0.7) * left
    np.testing.assert_allclose(np.interp(100.0 + s, line.s_m, line.x_m), x, atol=1e-5)
    np.testing.assert_allclose(np.interp(100.0 + s, line.s_m, line.y_m), y, atol=1e-5)
    turned = np.interp(100.0 + s, line.s_m, line.turned_rad)
    np.testing.assert_allclose(turned, 0.0005 * s * s, atol=1e-9)


def test_a_cubic_joins_what_it_has_to() -> None:
    piece = between((1.0, 2.0, 0.3), (21.0, 14.0, 1.5))
    np.testing.assert_allclose(piece.end, (21.0, 14.0, 1.5), atol=1e-9)
    line = parse(Sketch([Road("1", [piece])]).text).line("1")
    assert abs(line.turned_rad[-1] - 1.2) < 1e-3
    np.testing.assert_allclose((line.x_m[-1], line.y_m[-1]), (21.0, 14.0), atol=1e-3)
    np.testing.assert_allclose(piece.turned.end[:2], (1.0, 2.0), atol=1e-9)


def test_limits_and_links_of_a_file() -> None:
    town = parse(bend().text)
    stated = town.stated(Way("1", against=False), "m/s")
    assert stated == [(0.0, pytest.approx(70.0 / 3.6)), (60.0, 25.0 * 0.44704), (90.0, None)]
    assert town.onward(Way("1", against=False)) == [Way("2", against=False)]
    assert town.onward(Way("2", against=True)) == [Way("1", against=True)]
    assert town.onward(Way("2", against=False)) == []


def test_the_ways_out_of_a_loop_are_those_of_the_end_that_is_left() -> None:
    town = parse(DRAWINGS["loop"](random.Random(1)).text)
    assert town.onward(Way("arm", against=False)) == [Way("J0", False), Way("J2", False)]
    assert town.onward(Way("ring", against=False)) == [Way("J1", False)]
    assert town.onward(Way("ring", against=True)) == [Way("J3", False)]


@pytest.mark.parametrize("name", DRAWINGS)
def test_turning_a_road_leaves_it_where_it_is(name: str) -> None:
    made = DRAWINGS[name](random.Random(3))
    before = parse(made.text).line(made.roads[0].name)
    made.turn(made.roads[0].name)
    after = parse(made.text).line(made.roads[0].name)
    s = np.linspace(0.0, before.s_m[-1], 50)
    for one, other in ((after.x_m, before.x_m), (after.y_m, before.y_m)):
        got = np.interp(before.s_m[-1] - s, after.s_m, one)
        np.testing.assert_allclose(got, np.interp(s, before.s_m, other), atol=0.01)
    np.testing.assert_allclose(after.turned_rad[-1], -before.turned_rad[-1], atol=1e-6)


def read(tmp_path: Path, text: str, options: RoadOptions | None = None) -> Route:
    path = tmp_path / "road.xodr"
    path.write_text(text)
    return read_route(path, options or RoadOptions(start_road="1"))


def found(route: Route, text: str) -> set[str]:
    options = RoadOptions(start_road="1")
    return {each.what for each in differences(route, parse(text), options) if not each.told}


def test_a_sound_road_is_as_the_judge_reads_it(tmp_path: Path) -> None:
    assert found(read(tmp_path, bend().text), bend().text) == set()


def limited(route: Route, low_m: float, high_m: float) -> Route:
    """Return the route with 20 m/s from one place to another."""
    there = (route.s_m >= low_m) & (route.s_m < high_m)
    return replace(route, speed_limit_mps=np.where(there, 20.0, route.speed_limit_mps))


def marked(route: Route, s_m: float = 170.0, *, against: bool = False) -> Route:
    """Return the route with another mark where its second road begins."""
    last = [mark for mark in route.marks if mark.kind == "road"][-1]
    other = last._replace(s_m=s_m, against=against)
    return replace(route, marks=tuple(other if mark is last else mark for mark in route.marks))


LIES: dict[str, tuple[Callable[[Route], Route], set[str]]] = {
    "no curve": (
        lambda r: replace(r, curvature_per_m=np.zeros(len(r.s_m))),
        {"missed curve"},
    ),
    "half a curve": (
        lambda r: replace(r, curvature_per_m=0.5 * r.curvature_per_m),
        {"missed curve"},
    ),
    "a curve where none is": (
        lambda r: replace(r, curvature_per_m=r.curvature_per_m + 0.02 * (r.s_m < 100.0)),
        {"invented curve"},
    ),
    "the other hand": (lambda r: replace(r, curvature_per_m=-r.curvature_per_m), set()),
    "another limit": (lambda r: limited(r, 60.0, 90.0), {"limit"}),
    "another limit in a gap": (lambda r: limited(r, 90.0, 170.0), {"limit"}),
    "nothing told": (lambda r: replace(r, notes=()), {"limit"}),
    "another line": (lambda r: replace(r, y_m=r.y_m + 0.01 * r.s_m), {"line"}),
    "another direction": (lambda r: marked(r, against=True), {"way"}),
    "another place": (lambda r: marked(r, s_m=171.0), {"length"}),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_reader_that_lies_is_found_out(lie: str, tmp_path: Path) -> None:
    told, wanted = LIES[lie]
    got = found(told(read(tmp_path, bend().text)), bend().text)
    assert wanted <= got
    if not wanted:  # which hand a curve turns to is no matter for speed
        assert "limit" not in got


def test_what_is_told_excuses_only_what_it_is_about(tmp_path: Path) -> None:
    """That the limit has a gap says nothing about a curve that was repaired."""
    route = read(tmp_path, bend().text)
    assert any("limit" in str(note) for note in route.notes)
    assert found(replace(route, curvature_per_m=0.0 * route.s_m), bend().text) == {"missed curve"}


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: text.replace('length="30.0"', 'length="29.0"'),
        lambda text: text.replace('curvature="0.04"', 'curvature="0,04"'),
        lambda text: text.replace('curvature="0.04"', 'curvature="0.0_4"'),
        lambda text: text.replace('id="2"', 'id="1"'),
        lambda text: text.replace('max="70"', 'max="\u0667\u0660"'),
        lambda text: text[:-20],
    ],
)
def test_what_nobody_can_know(spoil: Callable[[str], str]) -> None:
    text = spoil(bend().text)
    with pytest.raises(Unclear):
        town = parse(text)
        town.stated(Way("1", against=False), "m/s")
        town.line("1")


def test_a_refusal_without_a_place_is_a_violation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pldf.errors import ModelError  # noqa: PLC0415 - only here

    path = tmp_path / "road.xodr"
    path.write_text(bend().text)

    def refuse(text: str) -> str:
        def raised(path: Path, options: RoadOptions) -> Route:
            raise ModelError(f"{path}: {text}")

        monkeypatch.setattr("faults.judged_roads_spoilt.read_route", raised)
        return verdict(path, bend().text, RoadOptions(), set())[0]

    assert refuse("knot 301 is wrong") == "violation"
    assert refuse("line 12, road 1: length -3 m; a road must be longer than 0") == "refused"


def test_every_change_changes_most_files() -> None:
    for name in (*TREE_CHANGES, *BYTE_CHANGES):
        chance = random.Random(name)
        texts = [drawn("chain", chance) for _ in range(10)]
        same = sum(changed(text, name, chance)[1] == text.encode() for text in texts)
        assert same < 5, name
