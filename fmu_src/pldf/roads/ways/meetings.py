"""At which ends roads of one file meet, when not all links say it or say the same.

Decisions: what a road's own link says counts more than what others say of the road; where it says
nothing, the lines decide.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from typing import Final, NamedTuple

from ..opendrive.leg import Leg
from ..opendrive.xml_tree import Element
from .ends import Ends

LINK: Final = {"start": "predecessor", "end": "successor"}
ENDS: Final = ("start", "end")


class Back(NamedTuple):
    """A road that is linked to another one, with its own end and the link there."""

    road: Element
    end: str
    link: Element


class Meetings:
    """The links of the roads of one file, and where the lines of those lie that say too little."""

    def __init__(
        self, roads: Mapping[str, Element], junctions: Collection[str], ends: Ends
    ) -> None:
        self._roads, self._junctions, self._ends = roads, junctions, ends

    @cached_property
    def _back(self) -> dict[tuple[str, str], list[Back]]:
        """The roads whose own links are to an end of a road, by that road and end."""
        back: dict[tuple[str, str], list[Back]] = defaultdict(list)
        for road in self._roads.values():
            for end in ENDS:
                link = link_at(road, end)
                if link is not None and not self.to_junction(link):
                    given = link.attributes
                    contact = given.get("contactPoint", "").strip().lower()
                    back[given.get("elementId", ""), contact].append(Back(road, end, link))
        return back

    def linked_to(self, leg: Leg) -> list[Back]:
        """Return the roads that are linked to the front of a leg, and do lie there."""
        return [
            each
            for each in self._back.get((leg.id, leg.front), [])
            if self._lies_at_front(leg, Leg(each.road, against=False), each.end)
        ]

    def to_junction(self, link: Element) -> bool:
        """Tell whether a link is to a junction, not to a road."""
        name = link.attributes.get("elementId", "")
        usual = "junction" if name in self._junctions and name not in self._roads else "road"
        return link.attributes.get("elementType", usual) == "junction"

    def names(self, entered: Leg, end: str, leg: Leg) -> bool:
        """Tell whether the link of a road at this end is to the front of ``leg``."""
        link = link_at(entered.road, end)
        return (
            link is not None
            and not self.to_junction(link)
            and link.attributes.get("elementId") == leg.id
            and link.attributes.get("contactPoint", leg.front).strip().lower() == leg.front
        )

    def nearest(self, entered: Leg, ends: Iterable[str], leg: Leg) -> str:
        """Return that of the ``ends`` of a road that lies nearest to the front of ``leg``."""
        return min(ends, key=lambda end: self._ends.distance_m(entered, end, leg, leg.front))

    def contact(self, leg: Leg, entered: Leg, stated: str, junction: str) -> tuple[str | None, str]:
        """Return the end of a connecting road that lies at the front of ``leg``, and doubts."""
        own = [end for end in ENDS if self._begins_at(leg, entered, end, junction)]
        if stated in own:
            return stated, ""
        if own:
            if stated not in ENDS:
                return self.nearest(entered, own, leg), ""
            text = f"junction {junction} says that road {entered.id} is met at its {stated}, "
            return own[0], text + f"the road's own link that it is met at its {own[0]}"
        silent = [end for end in ENDS if self._says_nothing(entered, end)]
        if stated in ENDS:
            silent = [end for end in silent if end == stated]
        ways = {end: Leg(entered.road, against=end == "end") for end in silent}
        near = [
            end
            for end, way in ways.items()
            if self._lies_at_front(leg, entered, end) and not self._ends.goes_back(leg, way)
        ]
        return (self.nearest(entered, near, leg) if near else None), ""

    def misnamed(self, entered: Leg, end: str, leg: Leg, junction: str) -> str:
        """Return what is wrong with the end that a connecting road's own link names, if it is."""
        link = link_at(entered.road, end)
        stated = "" if link is None else link.attributes.get("contactPoint", "").strip().lower()
        if link is None or self.to_junction(link) or stated == leg.front:
            return ""
        text = f"<{link.tag}> of road {entered.id} (line {link.line}) "
        if stated in ENDS:
            text += f"names the {stated} of road {leg.id}, which is met at its {leg.front}"
        elif self.is_at(leg, leg.rear, junction):
            text += f"does not say (contactPoint) which end of road {leg.id} it means, and both"
            text += f" are at junction {junction}: the {leg.front}, where the lines meet"
        else:
            return ""
        return text

    def _begins_at(self, leg: Leg, entered: Leg, end: str, junction: str) -> bool:
        link = link_at(entered.road, end)
        if link is None or self.to_junction(link) or link.attributes.get("elementId") != leg.id:
            return False
        stated = link.attributes.get("contactPoint", "").strip().lower()
        if stated == leg.front:
            return True
        both = self.is_at(leg, leg.rear, junction)
        if stated == leg.rear and both:
            return False
        # The end is not stated, or it is one that is not at this junction.
        return not (both or stated) or self._lies_at_front(leg, entered, end)

    def _says_nothing(self, entered: Leg, end: str) -> bool:
        link = link_at(entered.road, end)
        return link is None or self.to_junction(link)

    def _lies_at_front(self, leg: Leg, entered: Leg, end: str) -> bool:
        front, rear = (
            self._ends.distance_m(entered, end, leg, each) for each in (leg.front, leg.rear)
        )
        return front <= rear

    def is_at(self, leg: Leg, end: str, junction: str) -> bool:
        """Tell whether this end of a road is linked to the junction."""
        link = link_at(leg.road, end)
        return (
            link is not None
            and self.to_junction(link)
            and link.attributes.get("elementId") == junction
        )


def link_at(road: Element, end: str) -> Element | None:
    """Return the link of a road at its start or its end, None if there is none."""
    return next(road.all("link", LINK[end]), None)
