"""What one road states of its legal limits: ``type/speed``, overridden by the lanes' ``speed``.

Decisions: of several driving lanes in this direction the lowest stated limit counts, of ramps and
carpool lanes only where there is no other; a record that begins up to ``LATE_MAX_M`` behind the
start of its road or lane section counts from that start, because exports round.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from typing import Final, NamedTuple

from ..opendrive.contents import Contents
from ..opendrive.leg import Leg, driven_lanes
from ..opendrive.xml_tree import Element
from .speed_values import Speed, SpeedReader
from .spots import Spot

LATE_MAX_M: Final = 0.5

_THROUGH: Final = ("driving", "bidirectional")


class Record(NamedTuple):
    """A limit (None: nothing stated) from ``start_m`` on."""

    start_m: float
    limit: Speed | None


class Section(NamedTuple):
    """One lane section: where it begins and ends, and the lanes that go this way."""

    start_m: float
    end_m: float
    lanes: list[Element]


class Late(NamedTuple):
    """A record that begins ``by_m`` behind the start from which it counts."""

    spot: Spot
    by_m: float


class Stated(NamedTuple):
    """What a road states, without gaps from 0 on; where it is driven; which records began late."""

    records: list[Record]
    sections: list[Section]
    late: list[Late]


def stated_limits(road: Contents, reader: SpeedReader) -> Stated:
    """Return what ``road`` states for the direction in which it is driven, in order of s from 0."""
    late: list[Late] = []
    types = _types(road, reader, late)
    sections = _sections(road, reader)
    lanes = [list(_lanes(road, section, reader, late)) for section in sections]
    speeds = [record for of_section in lanes for lane in of_section for record in lane]
    starts = {0.0} | {record.start_m for record in (*types, *speeds)}
    records: list[Record] = []
    for start in sorted(s for s in starts if 0.0 <= s < road.length_m):
        here = bisect_right(sections, start, key=lambda section: section.start_m) - 1
        in_force = [_in_force(lane, start) for lane in lanes[here]] if here >= 0 else []
        stated = [limit for limit in in_force if limit is not None]
        limit = min(stated) if stated else _in_force(types, start)
        if not records or records[-1].limit != limit:
            records.append(Record(start, limit))
    return Stated(records, sections, late)


def _sections(road: Contents, reader: SpeedReader) -> list[Section]:
    place = road.place
    found = [(reader.number(place, e, "s"), e) for e in road.leg.road.all("lanes", "laneSection")]
    found.sort(key=lambda pair: pair[0])
    if found and 0.0 < found[0][0] <= LATE_MAX_M:
        found[0] = (0.0, found[0][1])
    ends = [*(start for start, _ in found[1:]), road.length_m][: len(found)]
    return [
        Section(start, end, _driven(section, road.leg))
        for (start, section), end in zip(found, ends, strict=True)
    ]


def _driven(section: Element, leg: Leg) -> list[Element]:
    lanes = list(driven_lanes(section, leg.road, against=leg.against))
    through = [e for e in lanes if e.attributes.get("type", "").strip().lower() in _THROUGH]
    return through or lanes


def _types(road: Contents, reader: SpeedReader, late: list[Late]) -> list[Record]:
    records = []
    for element in road.leg.road.all("type"):
        start = reader.number(road.place, element, "s")
        speed = element.find("speed")
        limit = None if speed is None else reader.speed(speed, road.place, start)
        records.append((Record(start, limit), element))
    return _in_order(records, 0.0, road, late)


def _lanes(
    road: Contents, section: Section, reader: SpeedReader, late: list[Late]
) -> Iterator[list[Record]]:
    """Yield the records of every driven lane, each closed at the section's end."""
    start, end, lanes = section
    for lane in lanes:
        records = []
        for element in lane.all("speed"):
            at = start + reader.number(road.place, element, "sOffset", 0.0)
            records.append((Record(at, reader.speed(element, road.place, at)), element))
        ordered = _in_order(records, start, road, late)
        yield [r for r in ordered if r.start_m < end] + [Record(end, None)]


def _in_order(
    found: list[tuple[Record, Element]], start_m: float, road: Contents, late: list[Late]
) -> list[Record]:
    """Return the records in order of s; the first counts from ``start_m`` on if it is just late."""
    found.sort(key=lambda pair: pair[0].start_m)
    records = [record for record, _ in found]
    if records and start_m < records[0].start_m <= start_m + LATE_MAX_M:
        at_m = records[0].start_m
        late.append(Late(Spot(road.place, found[0][1].line, at_m), at_m - start_m))
        records[0] = records[0]._replace(start_m=start_m)
    return records


def _in_force(records: list[Record], at_m: float) -> Speed | None:
    index = bisect_right(records, at_m, key=lambda r: r.start_m)
    return records[index - 1].limit if index else None
