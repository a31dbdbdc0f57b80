"""Where the two ends of a road lie, for links that do not say at which end roads meet."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from ...errors import ModelError
from ..opendrive.contents import read_contents
from ..opendrive.leg import Leg
from ..opendrive.xml_tree import Element, Place

# Over this length behind its beginning a road shows where it leads.
_SHOWN_M: Final = 50.0
# No car turns that much on the spot.
_BACK_RAD: Final = math.radians(120.0)


class Pose(NamedTuple):
    """A place and the direction of the reference line there, in which the road is drawn."""

    x_m: float
    y_m: float
    heading_rad: float


class Ends:
    """Poses along the roads of one file; each road is read once."""

    def __init__(self, place: Place) -> None:
        self._path = place.path
        self._poses: dict[str, dict[str, Pose] | None] = {}

    def distance_m(self, one: Leg, end: str, other: Leg, other_end: str) -> float:
        """Return how far two ends lie apart; 0 where a road's line cannot be read."""
        ends, others = self._of(one.road), self._of(other.road)
        if ends is None or others is None:
            return 0.0
        here, there = ends[end], others[other_end]
        return math.hypot(here.x_m - there.x_m, here.y_m - there.y_m)

    def goes_back(self, before: Leg, leg: Leg) -> bool:
        """Tell whether ``leg`` begins in about the direction that ``before`` comes from."""
        ends, others = self._of(before.road), self._of(leg.road)
        if ends is None or others is None:
            return False
        turns = (before.against != leg.against) * math.pi
        turn = others[leg.rear].heading_rad - ends[before.front].heading_rad + turns
        return abs(math.remainder(turn, 2.0 * math.pi)) > _BACK_RAD

    def turn_rad(self, before: Leg, leg: Leg) -> float | None:
        """Return by how much the direction changes along ``leg`` from the front of ``before`` on.

        To the left it is positive, from -pi to pi. None where a line cannot be read.
        """
        ends, others = self._of(before.road), self._of(leg.road)
        if ends is None or others is None:
            return None
        in_heading = ends[before.front].heading_rad + (math.pi if before.against else 0.0)
        shown = others["shown_" + leg.rear]
        out_heading = shown.heading_rad + (math.pi if leg.against else 0.0)
        return math.remainder(out_heading - in_heading, 2.0 * math.pi)

    def _of(self, road: Element) -> dict[str, Pose] | None:
        name = road.attributes.get("id", "")
        if name not in self._poses:
            self._poses[name] = self._read(road, name)
        return self._poses[name]

    def _read(self, road: Element, name: str) -> dict[str, Pose] | None:
        try:
            contents = read_contents(Leg(road, against=False), Place(self._path, name))
        except ModelError:
            return None  # told when it is driven
        length = contents.length_m
        at_m = {
            "start": 0.0,
            "end": length,
            "shown_start": min(_SHOWN_M, length),
            "shown_end": max(length - _SHOWN_M, 0.0),
        }
        try:
            points = contents.points_at(np.array(list(at_m.values())))
        except ModelError:
            return None
        poses = np.transpose((points.x_m, points.y_m, points.heading_rad)).tolist()
        return {end: Pose(*pose) for end, pose in zip(at_m, poses, strict=True)}
