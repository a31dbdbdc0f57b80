"""Which roads of an OpenDRIVE file are driven, in which order and direction."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from ..errors import ModelError
from ..findings import Finding
from .options import RoadOptions
from .xml_tree import Element, Place

_FORWARD_END: Final = {False: "successor", True: "predecessor"}
_BACKWARD_END: Final = {False: "predecessor", True: "successor"}


@dataclass(frozen=True)
class Leg:
    """One road, driven along its direction or against it."""

    road: Element
    against: bool

    @property
    def id(self) -> str:
        """The road's id."""
        return self.road.attributes.get("id", "")


class Network:
    """The roads and junctions of one file."""

    def __init__(self, root: Element, place: Place) -> None:
        self.place = place
        self.roads = _by_id(root.all("road"), place)
        self.junctions = _by_id(root.all("junction"), place)
        if not self.roads:
            raise place.error(root, "no <road> in this file")

    def way(self, options: RoadOptions, notes: list[Finding]) -> list[Leg]:
        """Follow the links from the start until the road ends or repeats.

        The start road is driven along its direction. Without one the route starts at the only road
        that nothing leads to; a closed loop starts at the first road of the file.

        Args:
            options: where the way starts and goes.
            notes: gets what is told about it.

        Raises:
            ModelError: unknown or ambiguous start, a link to nowhere, a junction with a choice.
        """
        start_road = options.start_road
        if start_road is None:
            return self._only_chain()
        if start_road not in self.roads:
            raise ModelError(
                f"{self.place.path}: no road {start_road!r}; it has {_some(list(self.roads))}"
            )
        return self._follow(Leg(self.roads[start_road], against=False))

    def _only_chain(self) -> list[Leg]:
        plain = [e for e in self.roads.values() if e.attributes.get("junction", "-1") == "-1"]
        plain = plain or list(self.roads.values())
        for against in (False, True):
            free = [e for e in plain if _link(e, _BACKWARD_END[against]) is None]
            if free:
                return self._unique(free, plain, against)
        return self._unique(plain, plain, against=False)

    def _unique(self, starts: list[Element], plain: list[Element], against: bool) -> list[Leg]:
        if len(starts) == 1:
            return self._follow(Leg(starts[0], against))
        # Several free ends are still one chain when some roads point against the others.
        try:
            legs = self._follow(Leg(starts[0], against))
        except ModelError:
            legs = []
        if {id(e) for e in plain} <= {id(leg.road) for leg in legs}:
            return legs
        names = [e.attributes.get("id", "") for e in starts]
        raise ModelError(
            f"{self.place.path}: the route could start at road {_some(names)}; "
            "name one (--start-road ID)"
        )

    def _follow(self, leg: Leg) -> list[Leg]:
        legs: list[Leg] = []
        driven: set[str] = set()
        following: Leg | None = leg
        while following is not None and following.id not in driven:
            legs.append(following)
            driven.add(following.id)
            following = self._next(following)
        return legs

    def _next(self, leg: Leg) -> Leg | None:
        link = _link(leg.road, _FORWARD_END[leg.against])
        if link is None:
            return None
        place = Place(self.place.path, leg.id)
        if link.attributes.get("elementType", "road") == "junction":
            return self._through_junction(leg, link, place)
        return self._leg(link, link.attributes.get("elementId", ""), leg, place)

    def _through_junction(self, leg: Leg, link: Element, place: Place) -> Leg | None:
        name = link.attributes.get("elementId", "")
        if name not in self.junctions:
            raise place.error(link, f"junction {name!r} is not in the file")
        ways = {
            e.attributes.get("connectingRoad", e.attributes.get("linkedRoad", "")): e
            for e in self.junctions[name].all("connection")
            if e.attributes.get("incomingRoad") == leg.id
        }
        if len(ways) > 1:
            raise place.error(
                link,
                f"junction {name} leads on to road {_some(list(ways))}; keep one connection in "
                "the file or start behind it (--start-road ID)",
            )
        return next((self._leg(e, road, leg, place) for road, e in ways.items()), None)

    def _leg(self, link: Element, road_id: str, before: Leg, place: Place) -> Leg:
        if road_id not in self.roads:
            raise place.error(link, f"<{link.tag}> road {road_id!r} is not in the file")
        road = self.roads[road_id]
        contact = link.attributes.get("contactPoint", "")
        if contact not in ("start", "end"):
            back = _link(road, "successor")
            linked_at_end = back is not None and back.attributes.get("elementId") == before.id
            contact = "end" if linked_at_end else "start"
        return Leg(road, against=contact == "end")


def _by_id(elements: Iterable[Element], place: Place) -> dict[str, Element]:
    by_id: dict[str, Element] = {}
    for element in elements:
        name = element.attributes.get("id", "")
        if name in by_id:
            text = f"id {name!r} is that of line {by_id[name].line} too; ids must differ"
            raise place.error(element, f"<{element.tag}> {text}")
        by_id[name] = element
    return by_id


def _link(road: Element, end: str) -> Element | None:
    return next(road.all("link", end), None)


def _some(names: list[str]) -> str:
    return ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
