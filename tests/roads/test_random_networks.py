"""Random small networks: every way is connected, passes what is named in order, and is shortest.

What leads to what is known from how a network was made, not from its file.
"""

from __future__ import annotations

import math
import random
from collections import defaultdict
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from networks import BOTH, LEFT, NONE, RIGHT, Map
from pldf.errors import ModelError
from pldf.findings import Finding
from pldf.roads import RoadOptions
from pldf.roads.opendrive.leg import Leg
from pldf.roads.opendrive.xml_parser import parse_xml
from pldf.roads.opendrive.xml_tree import Place
from pldf.roads.options import OptionNeededError
from pldf.roads.ways.network import Network
from pldf.roads.ways.ways import find_way

# A road in one direction: its id, and whether it is driven against the one in which it is drawn.
Directed = tuple[str, bool]
_PATH = Path("town.xodr")


@dataclass
class Truth:
    """What was meant when a network was made."""

    text: str = ""
    ends: dict[str, tuple[tuple[float, float], tuple[float, float]]] = field(default_factory=dict)
    lanes: dict[str, tuple[str, str]] = field(default_factory=dict)
    onward: dict[Directed, set[Directed]] = field(default_factory=lambda: defaultdict(set))

    def open(self, road: str, *, against: bool) -> bool:
        """Tell whether cars may drive there."""
        return self.lanes[road] == NONE or self.lanes[road][0 if against else 1] != ""

    def length_m(self, road: str) -> float:
        """Return the length of a road."""
        return math.dist(*self.ends[road])

    def at(self, leg: Directed, *, front: bool) -> tuple[float, float]:
        """Return where a leg ends, or where it begins."""
        return self.ends[leg[0]][front != leg[1]]


def random_network(dice: random.Random) -> Truth:
    """Return roads between a few places; where they meet there are junctions, or just links."""
    truth, made = Truth(), Map()
    places = [(1000.0 * i, 700.0 * (i * i % 5)) for i in range(dice.randint(2, 5))]
    at: dict[int, list[tuple[str, bool]]] = defaultdict(list)  # place -> road, is it its end
    for number in range(dice.randint(2, 8)):
        name = f"r{number}"
        pair = dice.choices(range(len(places)), k=2)
        points = []
        for is_end, k in enumerate(pair):  # every end has a point of its own around the place
            turn = 2.1 * len(at[k])
            x, y = places[k]
            points.append((x + 40.0 * math.cos(turn) + is_end, y + 40.0 * math.sin(turn)))
            at[k].append((name, bool(is_end)))
        truth.ends[name] = (points[0], points[1])
        truth.lanes[name] = dice.choice([RIGHT, LEFT, BOTH, BOTH, NONE])
    links: dict[tuple[str, bool], str] = {}
    for k, met in at.items():
        if len(met) == 2 and met[0][0] != met[1][0] and dice.random() < 0.4:
            _link(truth, links, met, dice)
        elif dice.random() < 0.9:
            _junction(truth, made, links, f"J{k}", met, dice)
    for name in [road for road in truth.ends if road.startswith("r")]:
        rear, front = links.get((name, False), ""), links.get((name, True), "")
        ends = truth.ends[name]
        made.road(name, *ends, rear=rear, front=front, lanes=truth.lanes[name])
    truth.text = made.text
    return truth


def _end(is_end: bool) -> str:
    return "end" if is_end else "start"


def _link(
    truth: Truth,
    links: dict[tuple[str, bool], str],
    met: list[tuple[str, bool]],
    dice: random.Random,
) -> None:
    """Link two ends to each other; they need not say at which end."""
    (one, one_end), (other, other_end) = met
    points = list(truth.ends[other])
    points[other_end] = truth.ends[one][one_end]
    truth.ends[other] = (points[0], points[1])
    for here, there in (met, met[::-1]):
        links[here] = f"{there[0]} {_end(there[1]) if dice.random() < 0.8 else ''}"
        truth.onward[here[0], not here[1]].add((there[0], there[1]))


def _junction(
    truth: Truth,
    made: Map,
    links: dict[tuple[str, bool], str],
    junction: str,
    met: list[tuple[str, bool]],
    dice: random.Random,
) -> None:
    """Lay connecting roads between some pairs of ends, drawn either way, said well or badly."""
    made.connections.setdefault(junction, [])
    for end in met:
        links[end] = f"junction {junction}"
    for here in met:
        for there in met:
            if here == there or dice.random() < 0.4:
                continue
            name = f"{junction}{here[0]}{_end(here[1])}{there[0]}{_end(there[1])}"
            drawn = [here, there] if dice.random() < 0.7 else [there, here]
            first, last = (truth.ends[road][is_end] for road, is_end in drawn)
            truth.ends[name] = (first, last)
            truth.lanes[name] = lanes = dice.choice([RIGHT, RIGHT, LEFT, BOTH, NONE])
            rear, front = (
                f"{road} {_end(is_end) if dice.random() < 0.7 else ''}" for road, is_end in drawn
            )
            made.road(
                name, first, last, rear=rear, front=front, lanes=lanes, junction=junction
            )  # fmt: skip
            for incoming, other, against in ((drawn[0], drawn[1], False), (*drawn[::-1], True)):
                truth.onward[name, against].add((other[0], other[1]))
                if dice.random() < 0.7:
                    right = _end(against)
                    stated = dice.choice([right, right, right, "", _end(not against)])
                    made.connect(junction, incoming[0], name, stated)
                    _may_leave(truth, incoming, (name, against), wrong=stated not in (right, ""))
                    both = (incoming[0], not incoming[1]) == other
                    if both:  # whose connection names the road, not its end: it holds for both
                        other_way = _end(not against)
                        wrong = stated not in (other_way, "")
                        _may_leave(truth, other, (name, not against), wrong=wrong)


def _may_leave(truth: Truth, end: tuple[str, bool], way: Directed, *, wrong: bool) -> None:
    """Note that ``way`` begins at an end of a road, if a lane leaves along it.

    Where the junction says that it begins with its other end, only a lane shows that it does not.
    """
    lanes = truth.lanes[way[0]]
    if truth.open(way[0], against=way[1]) and not (wrong and lanes == NONE):
        truth.onward[end[0], not end[1]].add(way)


def shortest_m(truth: Truth, start: Directed, named: list[str]) -> float:
    """Return the length of the shortest way by relaxing all steps until nothing changes."""
    first = (int(named[:1] == [start[0]]), start)
    best = {first: truth.length_m(start[0])}
    changed = True
    while changed:
        changed = False
        for (passed, leg), length_m in list(best.items()):
            for onward in truth.onward[leg] if passed < len(named) else ():
                state = (passed + (onward[0] == named[passed]), onward)
                longer_m = length_m + truth.length_m(onward[0])
                if longer_m < best.get(state, math.inf) - 1e-9:
                    best[state] = longer_m
                    changed = True
    return min((m for (passed, _), m in best.items() if passed == len(named)), default=math.inf)


def _way(truth: Truth, options: RoadOptions) -> list[Directed]:
    root = parse_xml([truth.text.encode()], "OpenDRIVE", _PATH, [])
    notes: list[Finding] = []
    legs: list[Leg] = find_way(Network(root, Place(_PATH)), options, notes)
    way = [leg.key for leg in legs]
    for before, behind in pairwise(way):
        assert behind in truth.onward[before], (before, behind)
        assert truth.at(before, front=True) == truth.at(behind, front=False)
    return way


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_way_passes_what_is_named_and_is_the_shortest(seed: int) -> None:
    dice = random.Random(seed)
    truth = random_network(dice)
    start = (f"r{dice.randrange(2)}", dice.random() < 0.5)
    if not truth.open(start[0], against=start[1]):
        start = (start[0], not start[1])
    named = dice.choices(sorted(truth.ends), k=dice.randint(1, 3))
    wanted_m = shortest_m(truth, start, named)
    options = RoadOptions(start[0], tuple(named[:-1]), named[-1], start[1])
    if len(named) > 1 and named[-1] == named[-2]:
        return  # the last of the roads to pass is where it ends
    if wanted_m == math.inf:
        with pytest.raises(ModelError, match="no way from road"):
            _way(truth, options)
        return
    way = _way(truth, options)
    assert way[0] == start
    assert way[-1][0] == named[-1]
    driven = iter([road for road, _ in way])
    assert all(road in driven for road in named)
    assert sum(truth.length_m(road) for road, _ in way) == pytest.approx(wanted_m)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_way_without_names_goes_on_while_there_is_one_road(seed: int) -> None:
    dice = random.Random(seed)
    truth = random_network(dice)
    start = (f"r{dice.randrange(2)}", dice.random() < 0.5)
    if not truth.open(start[0], against=start[1]):
        start = (start[0], not start[1])
    try:
        way = _way(truth, RoadOptions(start[0], reverse=start[1]))
    except OptionNeededError as refused:
        suggested = refused.suggested
        assert suggested.via[0] in [road for road, _ in _way(truth, suggested)]
        return
    driven = [road for road, _ in way]
    assert len(set(driven)) == len(driven)
    onward = truth.onward[way[-1]]
    targets = {next(iter(truth.onward[leg])) if leg[0][0] == "J" else leg for leg in onward}
    assert len(targets) <= 1
    assert not onward or any(leg[0] in driven for leg in onward)
