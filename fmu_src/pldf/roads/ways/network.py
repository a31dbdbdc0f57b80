"""The roads of an OpenDRIVE file and what leads on from each of them.

Decisions:

- A way out of the front of a road through a junction is a connecting road that really begins there:
  its own link at the end where they meet names the road, and its end where given. What the
  connecting road says of itself counts more than the junction's ``contactPoint``; where it says
  nothing, the lines decide. It must have a lane for cars in this direction.
- Where a road has no link but another one is linked to it, they are linked.
- Links to what is not in the file end the way: excerpts of larger maps are full of them.
- A link into the middle of a road (``elementS``, of virtual junctions) ends it too.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace

from ...findings import Finding, Severity
from ..opendrive.leg import Leg, lane_counts, road_length_m
from ..opendrive.xml_tree import Element, Place
from .ends import Ends
from .meetings import ENDS, LINK, Meetings, link_at


@dataclass(frozen=True)
class Step:
    """A leg that another leads to, and what is told when it is taken."""

    leg: Leg
    told: tuple[Finding, ...] = ()


@dataclass(frozen=True)
class Onward:
    """What a leg leads to.

    Attributes:
        steps: one for each leg that can be driven next.
        told: why there is none, where that is worth telling.
        link: the element that leads there; None: the road has no link at its front.
        junction: id of the junction; empty: a road, or nothing.
    """

    steps: tuple[Step, ...] = ()
    told: tuple[Finding, ...] = ()
    link: Element | None = None
    junction: str = ""


class Network:
    """The roads and junctions of one file."""

    def __init__(self, root: Element, place: Place) -> None:
        self.place = place
        self.roads = _by_id(root.all("road"), place)
        self.junctions = _by_id(root.all("junction"), place)
        self.ends = Ends(place)
        self._meetings = Meetings(self.roads, self.junctions, self.ends)
        self._onward: dict[Leg, Onward] = {}
        self._lanes: dict[str, tuple[int, int] | None] = {}
        self._connections: dict[str, dict[str, list[Element]]] = {}
        if not self.roads:
            raise place.error(root, "no <road> in this file")

    def leg(self, road: str, *, against: bool) -> Leg:
        """Return the road with this id, in this direction."""
        return Leg(self.roads[road], against)

    def lanes(self, road: Element) -> tuple[int, int] | None:
        """Return the lanes for cars along the road and against it; None: the file has none."""
        name = road.attributes.get("id", "")
        if name not in self._lanes:
            self._lanes[name] = lane_counts(road)
        return self._lanes[name]

    def has_lane(self, leg: Leg) -> bool | None:
        """Tell whether cars drive in this direction; None: the file does not say."""
        counts = self.lanes(leg.road)
        return None if counts is None else counts[leg.against] > 0

    def onward(self, leg: Leg) -> Onward:
        """Return what the leg leads to."""
        if leg not in self._onward:
            onward, doubts = self._read_onward(leg), self._other_links(leg)
            steps = tuple(replace(step, told=step.told + doubts) for step in onward.steps)
            told = onward.told if steps else onward.told + doubts
            self._onward[leg] = replace(onward, steps=steps, told=told)
        return self._onward[leg]

    def _other_links(self, leg: Leg) -> tuple[Finding, ...]:
        """Return what is told of an end with more than one link; the first counts."""
        links = list(leg.road.all("link", LINK[leg.front]))
        if all(link.attributes == links[0].attributes for link in links):
            return ()
        first = links[0]
        name = first.attributes.get("elementId", "")
        text = f"{len(links)} <{first.tag}>, which say different things"
        return (self.told("warning", leg, first, text, f"the first counts, to {name!r}"),)

    def nothing_behind(self, leg: Leg) -> bool:
        """Tell whether no road and no junction of the file is linked to the rear of the leg."""
        link = link_at(leg.road, leg.rear)
        if link is None:
            return not self._meetings.linked_to(leg.turned)
        name = link.attributes.get("elementId", "")
        return name not in (self.junctions if self._meetings.to_junction(link) else self.roads)

    def _read_onward(self, leg: Leg) -> Onward:
        link = link_at(leg.road, leg.front)
        if link is None:
            return self._linked_back(leg)
        if self._meetings.to_junction(link):
            return self._through_junction(leg, link, link.attributes.get("elementId", ""))
        name = link.attributes.get("elementId", "")
        if name not in self.roads:
            return self._nowhere(leg, link, f"<{link.tag}> road {name!r} is not in the file")
        if "elementS" in link.attributes:
            text = f"leads into the middle of road {name}, at {link.attributes['elementS']} m"
            return self._nowhere(leg, link, text)
        return Onward((self._linked(leg, link, self.roads[name]),), link=link)

    def _nowhere(self, leg: Leg, link: Element, text: str) -> Onward:
        told = self.told("note", leg, link, text, "the way ends here")
        return Onward(told=(told,), link=link)

    def told(
        self, severity: Severity, leg: Leg, at: Element, text: str, then: str = "", out: str = ""
    ) -> Finding:
        """Return what is told of the front of a leg; ``at`` is the element that says it."""
        s_m = 0.0 if leg.against else road_length_m(leg)
        place = f"road {leg.id}, s = {s_m:.6g} m"
        return Finding(severity, str(self.place.path), at.line, place, text, then, out)

    # A link from road to road.

    def _linked(self, leg: Leg, link: Element, road: Element) -> Step:
        stated = link.attributes.get("contactPoint", "").strip().lower()
        entered = Leg(road, against=False)
        junction = leg.road.attributes.get("junction", "-1")  # the road behind it is linked to that
        own = [
            end
            for end in ENDS
            if self._meetings.names(entered, end, leg)
            or self._meetings.is_at(entered, end, junction)
        ]
        if stated in ENDS and (stated in own or not own):
            return Step(Leg(road, against=stated == "end"))
        end = self._meetings.nearest(
            entered, own if len(own) == 1 and stated not in ENDS else ENDS, leg
        )
        if stated in ENDS:
            text = f"<{link.tag}> names the {stated} of road {entered.id}, which is linked to here "
            text += f"by its {own[0]}"
        else:
            text = f"<{link.tag}> does not say at which end road {entered.id} is met (contactPoint)"
        told = self.told(
            "note" if stated not in ENDS else "warning",
            leg, link, text, f"driven from its {end} on, where the lines meet",
        )  # fmt: skip
        return Step(Leg(road, against=end == "end"), (told,))

    def _linked_back(self, leg: Leg) -> Onward:
        """Return what a leg without a link leads to: what is linked to its front, if anything."""
        back = self._meetings.linked_to(leg)
        within = {each.road.attributes.get("junction", "-1") for each in back} - {"-1"}
        if len(back) != 1 and len(within) != 1:
            return Onward()
        road, end, link = back[0]
        name = road.attributes.get("id", "")
        text = f"no <{LINK[leg.front]}>, but the {end} of road {name} is linked to here"
        told = self.told("note", leg, link, text, "taken as linked")
        if within:
            onward = self._through_junction(leg, link, *within)
        else:
            onward = Onward((Step(Leg(road, against=end == "end")),), link=link)
        steps = tuple(replace(step, told=(*step.told, told)) for step in onward.steps)
        return replace(onward, steps=steps, told=())

    # Through a junction.

    def _through_junction(self, leg: Leg, link: Element, name: str) -> Onward:
        if name not in self.junctions:
            return self._nowhere(leg, link, f"junction {name!r} is not in the file")
        connections = self._connections_of(name).get(leg.id, [])
        steps: dict[Leg, Step] = {}
        for connection in connections:
            step = self._connected(leg, connection, name)
            if step is not None:
                steps.setdefault(step.leg, step)
        if steps:
            missing = self._missing(leg, connections, name)
            with_missing = (replace(step, told=step.told + missing) for step in steps.values())
            return Onward(tuple(with_missing), (), link, name)
        text = f"junction {name} has no connection that leaves from here on a lane for cars"
        told = self.told("note", leg, link, text, "the way ends here")
        return Onward((), (told,), link, name)

    def _missing(self, leg: Leg, connections: list[Element], name: str) -> tuple[Finding, ...]:
        """Return what is told of connections to roads that are not in the file."""
        named = {_leads_to(each): each for each in connections}
        return tuple(
            self.told("note", leg, each, f"junction {name}: road {road!r} is not in the file")
            for road, each in named.items()
            if road not in self.roads
        )

    def _connections_of(self, junction: str) -> dict[str, list[Element]]:
        """Return the connections of a junction by the road that they can be entered from."""
        if junction not in self._connections:
            by_road: dict[str, list[Element]] = defaultdict(list)
            for each in self.junctions[junction].all("connection"):
                by_road[each.attributes.get("incomingRoad", "")].append(each)
                linked = each.attributes.get("linkedRoad")
                if linked is not None:  # direct: there is no road between, and both lead on
                    by_road[linked].append(each)
            self._connections[junction] = by_road
        return self._connections[junction]

    def _connected(self, leg: Leg, connection: Element, junction: str) -> Step | None:
        name = _leads_to(connection)
        if "linkedRoad" in connection.attributes:
            return self._directly(leg, connection, name, junction)
        if name not in self.roads:
            return None
        entered = Leg(self.roads[name], against=False)
        stated = connection.attributes.get("contactPoint", "").strip().lower()
        end, doubt = self._meetings.contact(leg, entered, stated, junction)
        if end is None:
            return None
        way = Leg(entered.road, against=end == "end")
        has_lane = self.has_lane(way)
        if has_lane is False or (doubt and has_lane is None):
            return None
        doubts = filter(None, (doubt, self._meetings.misnamed(entered, end, leg, junction)))
        then = f"{entered.id} is driven from its {end} on"
        return Step(way, tuple(self.told("warning", leg, connection, d, then) for d in doubts))

    def _directly(self, leg: Leg, connection: Element, linked: str, junction: str) -> Step | None:
        """Return the step through a direct junction, whose roads touch each other."""
        forth = connection.attributes.get("incomingRoad") == leg.id
        name = linked if forth else connection.attributes.get("incomingRoad", "")
        stated = connection.attributes.get("contactPoint", "").strip().lower()
        if name not in self.roads or (not forth and stated in ENDS and stated != leg.front):
            return None
        entered = Leg(self.roads[name], against=False)
        ends = [end for end in ENDS if self._meetings.is_at(entered, end, junction)]
        if forth and stated in ENDS:
            ends = [stated]
        if not ends:
            return None
        way = Leg(entered.road, against=self._meetings.nearest(entered, ends, leg) == "end")
        return None if self.has_lane(way) is False else Step(way)


def _leads_to(connection: Element) -> str:
    given = connection.attributes
    return given.get("linkedRoad", given.get("connectingRoad", ""))


def _by_id(elements: Iterable[Element], place: Place) -> dict[str, Element]:
    by_id: dict[str, Element] = {}
    faults = []
    for element in elements:
        name = element.attributes.get("id", "")
        first = by_id.setdefault(name, element)
        if first is not element:
            text = f"<{element.tag}> id {name!r} is that of line {first.line} too; ids must differ"
            faults.append((element.line, text))
    if faults:
        raise place.errors(faults)
    return by_id
