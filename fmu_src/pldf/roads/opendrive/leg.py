"""One road of a way, and what its lanes say about driving along it or against it.

Decisions: cars drive on the lanes of ``DRIVEN``; those for buses, taxis, bicycles, trams and people
on foot are none, and neither are shoulders and parking lanes. Lanes on the right go along the
direction in which a road is drawn, those on the left against it; in left-hand traffic
(``rule="LHT"``) it is the other way round. A lane with ``direction="reversed"`` goes the other way,
one with ``direction="both"`` or of type ``bidirectional`` goes both ways.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from .xml_tree import Element, as_number

DRIVEN: Final = frozenset(
    (
        *("driving", "entry", "exit", "onramp", "offramp", "connectingramp", "sliplane"),
        *("bidirectional", "hov", "mwyentry", "mwyexit"),
    )
)
_BOTH: Final = (False, True)


@dataclass(frozen=True, eq=False)
class Leg:
    """One road, driven along its direction or against it."""

    road: Element
    against: bool

    def __eq__(self, other: object) -> bool:
        """Tell whether it is the same road in the same direction."""
        return isinstance(other, Leg) and self.key == other.key

    def __hash__(self) -> int:
        """Return the hash of road and direction."""
        return hash(self.key)

    @property
    def id(self) -> str:
        """The road's id."""
        return self.road.attributes.get("id", "")

    @property
    def key(self) -> tuple[str, bool]:
        """Road and direction."""
        return self.id, self.against

    @property
    def front(self) -> str:
        """The end of the road that the leg leads to: start or end."""
        return "start" if self.against else "end"

    @property
    def rear(self) -> str:
        """The end of the road that the leg comes from: start or end."""
        return "end" if self.against else "start"

    @property
    def turned(self) -> Leg:
        """The same road in the other direction."""
        return Leg(self.road, not self.against)


def driven_lanes(section: Element, road: Element, *, against: bool) -> Iterator[Element]:
    """Yield the lanes of one laneSection of ``road`` on which cars drive in this direction."""
    left_hand_traffic = road.attributes.get("rule", "RHT").strip().upper() == "LHT"
    for side in ("left", "right"):
        goes_against = (side == "left") != left_hand_traffic
        for lane in section.all(side, "lane"):
            if against in _directions(lane, goes_against=goes_against):
                yield lane


def _directions(lane: Element, *, goes_against: bool) -> tuple[bool, ...]:
    kind = lane.attributes.get("type", "").strip().lower()
    direction = lane.attributes.get("direction", "standard").strip().lower()
    if kind not in DRIVEN:
        return ()
    if kind == "bidirectional" or direction == "both":
        return _BOTH
    return (goes_against != (direction == "reversed"),)


def lane_counts(road: Element) -> tuple[int, int] | None:
    """Return the most lanes for cars, along the road and against it; None if it has no lanes."""
    sections = list(road.all("lanes", "laneSection"))
    if not any(s.find(side) is not None for s in sections for side in ("left", "right")):
        return None
    along, against = (
        max(sum(1 for _ in driven_lanes(s, road, against=way)) for s in sections) for way in _BOTH
    )
    return along, against


def road_length_m(leg: Leg) -> float:
    """Return the length that the road states; 0 if it states none: that is told when it is read."""
    length_m = as_number(leg.road.attributes.get("length"))
    return length_m if math.isfinite(length_m) and length_m > 0.0 else 0.0
