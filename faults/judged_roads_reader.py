"""A judge's own small reader of OpenDRIVE: roads, their links, lanes and limits.

It knows nothing of the project's reader. It says plainly what a file states of one road: its line
by the heading (integrated numerically), its limits, what its ends are linked to. Where a file does
not state that, or twice, it raises ``Unclear``: then a reader has to tell or to refuse.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final, NamedTuple
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from .judged_roads_line import Line, line_of, number, once, only
from .sheets import Unclear

_LENGTH_MAX_M: Final = 1e5
_MPS: Final = {"km/h": 1.0 / 3.6, "mph": 0.44704, "m/s": 1.0}
_MAIN: Final = frozenset(("driving", "bidirectional"))
_RAMPS: Final = frozenset(
    ("entry", "exit", "onramp", "offramp", "connectingramp", "sliplane", "hov")
) | {"mwyentry", "mwyexit"}


class Way(NamedTuple):
    """One road in one direction."""

    road: str
    against: bool


def parse(text: str) -> Town:
    """Return the roads of a file that was decoded before."""
    text = text[max(text.find("<OpenDRIVE"), 0) :]
    try:
        root = ElementTree.fromstring(re.sub(r"(?<=[\s</])\w*:(?=\w)", "", text))  # no prefixes
    except ElementTree.ParseError:
        raise Unclear("no XML") from None
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]  # of a namespace without a prefix
    if root.tag != "OpenDRIVE":
        raise Unclear("no OpenDRIVE")
    return Town(root)


class Town:
    """The roads and junctions of a file."""

    def __init__(self, root: Element) -> None:
        """Keep them by their ids; those of one id that stands twice are unclear."""
        self.roads = _by_id(root, "road")
        self.junctions = _by_id(root, "junction")
        self._lines: dict[str, Line] = {}

    def road(self, name: str) -> Element:
        """Return the only road of that name."""
        if len(self.roads.get(name, ())) != 1:
            raise Unclear(f"road {name} {len(self.roads.get(name, ()))} times")
        return self.roads[name][0]

    def length_m(self, name: str) -> float:
        """Return the length that the road states."""
        length = number(self.road(name), "length")
        if not 0.0 < length <= _LENGTH_MAX_M:
            raise Unclear(f"length {length}")
        return length

    def line(self, name: str) -> Line:
        """Return the line of a road."""
        if name not in self._lines:
            self._lines[name] = line_of(self.road(name), self.length_m(name))
        return self._lines[name]

    # Links.

    def onward(self, way: Way) -> list[Way]:
        """Return the ways on that links and junctions state plainly, with a lane for cars."""
        link = self._link(way.road, "predecessor" if way.against else "successor")
        if link is None:
            return []
        name = link.get("elementId", "")
        if link.get("elementType", "road") == "junction":
            found = list(self._through(way, name))
        else:
            found = self._entered(name, link.get("contactPoint"))
        return [each for each in dict.fromkeys(found) if self.has_lane(each)]

    def is_linked(self, way: Way) -> bool:
        """Tell whether the road says that something follows."""
        return self._link(way.road, "predecessor" if way.against else "successor") is not None

    def _link(self, road: str, tag: str) -> Element | None:
        return only(self.road(road).findall(f"link/{tag}"))

    def _entered(self, name: str, contact: str | None) -> list[Way]:
        if name not in self.roads or contact not in ("start", "end"):
            return []
        return [Way(name, contact == "end")]

    def _through(self, way: Way, junction: str) -> Iterator[Way]:
        for element in self.junctions.get(junction, ())[:1]:
            for each in element.findall("connection"):
                linked = each.get("linkedRoad")
                if linked is not None:
                    yield from self._directly(way, each, linked, junction)
                elif each.get("incomingRoad") == way.road:
                    yield from self._connecting(way, each)

    def _connecting(self, way: Way, connection: Element) -> list[Way]:
        name = connection.get("connectingRoad", "")
        if name not in self.roads:
            return []
        stated = connection.get("contactPoint", "")
        links = {"start": self._link(name, "predecessor"), "end": self._link(name, "successor")}
        ends = [end for end, link in links.items() if link is not None and _is_met(link, way)]
        if len(ends) == 2:  # a loop: only the junction can say
            ends = [end for end in ends if end == stated]
        link = links.get(stated)
        if not ends and stated in links and (link is None or _is_junction(link)):
            ends = [stated]  # the road says nothing of it
        return [Way(name, end == "end") for end in ends]

    def _directly(self, way: Way, connection: Element, linked: str, junction: str) -> list[Way]:
        contact = connection.get("contactPoint")
        if connection.get("incomingRoad") == way.road:
            return self._entered(linked, contact)
        if linked != way.road or contact != ("start" if way.against else "end"):
            return []
        name = connection.get("incomingRoad", "")
        if name not in self.roads:
            return []
        ends = [
            end == "successor"
            for end in ("predecessor", "successor")
            if (link := self._link(name, end)) is not None and link.get("elementId") == junction
        ]
        return [Way(name, ends[0])] if len(ends) == 1 else []

    # Lanes and limits.

    def has_lane(self, way: Way) -> bool:
        """Tell whether cars drive there; roads without any lane are for all."""
        sections = self.road(way.road).findall("lanes/laneSection")
        sided = [s for s in sections if s.find("left") is not None or s.find("right") is not None]
        return not sided or any(list(_driven(self.road(way.road), s, way.against)) for s in sided)

    def stated(self, way: Way, unit: str) -> list[tuple[float, float | None]]:
        """Return from which s on which limit is stated, in m/s and drawing direction.

        None: nothing is. ``unit`` is that of numbers without one.
        """
        road = self.road(way.road)
        records = once(road.findall("type"), "s")
        types = [(_late(number(t, "s")), _type_limit(t, unit)) for t in records]
        lanes = list(_lane_limits(road, way.against, unit))
        starts = sorted({0.0, *(s for s, _ in types), *(s for s, _ in lanes)})
        found: list[tuple[float, float | None]] = []
        for s in (each for each in starts if each >= 0.0):
            by_lane = [limit for at, limit in lanes if at <= s][-1:]
            by_type = [limit for at, limit in types if at <= s][-1:]
            found.append((s, next((v for v in (*by_lane, *by_type) if v is not None), None)))
        return found

    def has_signs(self) -> bool:
        """Tell whether any road has a signal."""
        return any(r.find("signals/*") is not None for rs in self.roads.values() for r in rs)


def _is_met(link: Element, way: Way) -> bool:
    """Tell whether a link says that a road meets the end to which this way leads."""
    is_road = link.get("elementId") == way.road and link.get("elementType", "road") == "road"
    return is_road and link.get("contactPoint") == ("start" if way.against else "end")


def _is_junction(link: Element) -> bool:
    return link.get("elementType") == "junction"


def _by_id(root: Element, tag: str) -> dict[str, list[Element]]:
    found: dict[str, list[Element]] = {}
    for element in root.findall(tag):
        found.setdefault(element.get("id", ""), []).append(element)
    return found


def _late(s_m: float) -> float:
    return 0.0 if s_m <= 0.5 else s_m


def _type_limit(element: Element, unit: str) -> float | None:
    speed = only(element.findall("speed"))
    return None if speed is None else _mps(speed, unit)


def _mps(speed: Element, unit: str) -> float | None:
    text = speed.get("max", "").strip()
    if text in ("undefined", "-1"):
        return None
    if text == "no limit":
        return 130.0 / 3.6
    unit = speed.get("unit", "") or unit
    if unit not in _MPS:
        raise Unclear(f"unit {unit}")
    mps = number(speed, "max") * _MPS[unit]
    if not 0.0 < mps <= 300.0 / 3.6:
        raise Unclear(f"limit {mps} m/s")
    return mps


def _driven(road: Element, section: Element, against: bool) -> Iterator[tuple[Element, bool]]:
    """Yield the lanes for cars in this direction, and whether each is a main lane."""
    left_hand = road.get("rule", "RHT") == "LHT"
    for side in ("left", "right"):
        for lane in section.findall(f"{side}/lane"):
            kind = lane.get("type", "").lower()
            goes_against = ((side == "left") != left_hand) != (lane.get("direction") == "reversed")
            both = kind == "bidirectional" or lane.get("direction") == "both"
            if kind in _MAIN | _RAMPS and (both or goes_against == against):
                yield lane, kind in _MAIN


def _lane_limits(road: Element, against: bool, unit: str) -> Iterator[tuple[float, float | None]]:
    """Yield the lowest limit of lanes from each s on where one begins."""
    for section in once(road.findall("lanes/laneSection"), "s"):
        start = number(section, "s")
        lanes = list(_driven(road, section, against))
        lanes = [each for each in lanes if each[1]] or lanes
        records = [
            [
                (_late(number(v, "sOffset", 0.0)), _mps(v, unit))
                for v in once(lane.findall("speed"), "sOffset", 0.0)
            ]
            for lane, _ in lanes
        ]
        for offset in sorted({0.0, *(s for of_lane in records for s, _ in of_lane)}):
            now = [[v for s, v in of_lane if s <= offset][-1:] for of_lane in records]
            known = [v[0] for v in now if v and v[0] is not None]
            yield start + offset, min(known) if known else None
