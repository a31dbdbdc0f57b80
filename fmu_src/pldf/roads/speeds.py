"""Legal limits along one OpenDRIVE road: ``type/speed``, overridden by the lanes' ``speed``.

Decisions: of several driving lanes on the travel side the lowest stated limit counts; ``no limit``
means the recommended 130 km/h of a derestricted motorway, because a profile needs a number;
``undefined`` and -1 mean that nothing is stated. Traffic signs (``signals``) are not read.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import Final

from ..findings import Finding
from ..kernel.units import KMH_PER_MPS, MPS_PER_KMH
from .contents import Contents
from .options import RoadOptions
from .xml_tree import Element, Place

NO_LIMIT_MPS: Final = 130.0 / KMH_PER_MPS
_UNITS: Final = {"m/s": 1.0, "km/h": MPS_PER_KMH, "mph": 0.44704}
_WAY_OUT: Final = "add type/speed to the file or give a default limit (--default-limit KMH)"


# Start in m over the road's own arc length and limit in m/s, in order of s from 0 on.
Limits = list[tuple[float, float]]


@dataclass(frozen=True)
class Record:
    """A limit in m/s (None: nothing stated) from ``start_m`` on."""

    start_m: float
    limit_mps: float | None


def limits_along(roads: list[Contents], options: RoadOptions, notes: list[Finding]) -> list[Limits]:
    """Return the limits of each road of a way, over the road's own arc length.

    Args:
        roads: in the order in which they are driven.
        options: what counts where the file states no limit, or no unit.
        notes: gets what is told about them.

    Raises:
        ModelError: where no limit is stated and there is no default; for unusable speeds.
    """
    return [_limits(road, options.default_limit_mps) for road in roads]


def _limits(contents: Contents, default_mps: float | None) -> Limits:
    road, place, length_m = contents.leg.road, contents.place, contents.length_m
    types = _records(road, place, "type", "s")
    lanes = _lane_sections(road, place, _side(road, contents.leg.against), length_m)
    starts = {0.0} | {r.start_m for r in types} | {r.start_m for lane in lanes for r in lane}
    steps: Limits = []
    for start in sorted(s for s in starts if 0.0 <= s < length_m):
        stated = [at for at in (_in_force(lane, start) for lane in lanes) if at is not None]
        limit = min(stated) if stated else _in_force(types, start)
        limit = default_mps if limit is None else limit
        if limit is None:
            raise place.error(road, f"no speed limit from s = {start:g} m on; {_WAY_OUT}")
        if not steps or steps[-1][1] != limit:
            steps.append((start, limit))
    return steps


def _side(road: Element, against: bool) -> str:
    left_hand_traffic = road.attributes.get("rule", "RHT").upper() == "LHT"
    return "left" if against != left_hand_traffic else "right"


def _lane_sections(road: Element, place: Place, side: str, length_m: float) -> list[list[Record]]:
    """Return the records of every driving lane on one side, each closed at its section's end."""
    sections = [(place.number(e, "s"), e) for e in road.all("lanes", "laneSection")]
    sections.sort(key=lambda pair: pair[0])
    ends = [*(start for start, _ in sections[1:]), length_m][: len(sections)]
    lanes = []
    for (start, section), end in zip(sections, ends, strict=True):
        for lane in section.all(side, "lane"):
            if lane.attributes.get("type", "").lower() == "driving":
                records = [
                    Record(start + place.number(e, "sOffset", 0.0), _speed(e, place))
                    for e in lane.all("speed")
                ]
                records = sorted(records, key=lambda r: r.start_m)
                lanes.append([r for r in records if r.start_m < end] + [Record(end, None)])
    return lanes


def _records(road: Element, place: Place, tag: str, position: str) -> list[Record]:
    records = []
    for element in road.all(tag):
        speed = element.find("speed")
        limit = None if speed is None else _speed(speed, place)
        records.append(Record(place.number(element, position), limit))
    return sorted(records, key=lambda r: r.start_m)


def _in_force(records: list[Record], at_m: float) -> float | None:
    index = bisect_right(records, at_m, key=lambda r: r.start_m)
    return records[index - 1].limit_mps if index else None


def _speed(element: Element, place: Place) -> float | None:
    text = element.attributes.get("max", "").strip().lower()
    if text == "no limit":
        return NO_LIMIT_MPS
    if text == "undefined":
        return None
    unit = element.attributes.get("unit", "m/s").strip()
    if unit.lower() not in _UNITS:
        raise place.error(element, f"speed unit {unit[:20]!r} is unknown; use {', '.join(_UNITS)}")
    value = place.number(element, "max")
    if value == -1.0:
        return None
    limit = value * _UNITS[unit.lower()]
    if not 0.0 < limit <= 300.0 / KMH_PER_MPS:
        shown = f"{text} {unit}" + ("" if "unit" in element.attributes else " (no unit given)")
        raise place.error(element, f"speed limit {shown} must lie above 0 and up to 300 km/h")
    return limit
