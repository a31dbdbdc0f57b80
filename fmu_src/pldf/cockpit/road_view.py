"""What a driver sees of a road beside what the FMUs know: lanes, villages, bridges."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from ..cosim.prepared import prepared_route
from ..findings import Finding
from ..roads import Mark, Road, Route, fingerprint
from ..roads.marks import plain_name
from ..roads.opendrive.leg import Leg, driven_lanes
from ..roads.opendrive.xml_parser import parse_xml
from ..roads.opendrive.xml_tree import Element, as_number

# A rural road of usual width, for files that state none.
LANE_WIDTH_M: Final = 3.5
LANE_WIDTH_MIN_M: Final = 2.0
LANE_WIDTH_MAX_M: Final = 6.0
LANES_MAX: Final = 6
# Values of ``type`` of a road, of OpenDRIVE 1.4 to 1.8, between houses.
_TOWN: Final = frozenset(
    ("town", "lowspeed", "pedestrian", "towncollector", "townlocal", "townplaystreet",
     "townprivate", "townarterial", "townexpressway")
)  # fmt: skip
_STRAIGHT_PER_M: Final = 1e-6


class _Piece(NamedTuple):
    """A road of the file on the way: from where to where on the route."""

    leg: Leg
    from_m: float
    to_m: float

    def span(self, start_m: float, length_m: float) -> tuple[float, float] | None:
        """Return where a span of the road's own arc length lies on the route; None: outside."""
        own_m = self.to_m - self.from_m
        first, last = sorted((start_m, start_m + length_m))
        if self.leg.against:
            first, last = own_m - last, own_m - first
        first, last = max(first, 0.0), min(last, own_m)
        return (self.from_m + first, self.from_m + last) if last > first else None


def road_view(road: Road) -> dict[str, Any]:
    """Return a road as the page's type ``Road`` (page/types.js); ``prepared`` is bytes.

    Lanes, villages and bridges are those of the OpenDRIVE file; a CSV says nothing of them: it has
    a lane of 3.5 m in each direction.

    Raises:
        ModelError: the file cannot be read any more.
    """
    route = road.route
    pieces = _pieces(road)
    return {
        "name": plain_name(route.name),
        "key": fingerprint(route),
        "prepared": prepared_route(route),
        **_lanes(pieces),
        "stretches": sorted(
            (*_villages(pieces), *_bridges(pieces), *_bends(route)),
            key=lambda stretch: stretch["from_m"],
        ),
    }


def _pieces(road: Road) -> list[_Piece]:
    """Return the roads of the file that the route was made of; none for a CSV."""
    data = road.file.read_bytes()
    if b"<OpenDRIVE" not in data:
        return []
    root = _parsed([data], road.file)
    named = {}
    for element in root.all("road"):
        id_ = element.attributes.get("id", "")
        name = element.attributes.get("name", "").strip()
        named[plain_name(id_)] = named[plain_name(f"{id_} {name}")] = element
    marks = [mark for mark in road.route.marks if mark.kind == "road"]
    ends = [*(mark.s_m for mark in marks[1:]), road.route.length_m]
    return list(_found(marks, ends, named))


def _parsed(blocks: Iterable[bytes], path: Path) -> Element:
    notes: list[Finding] = []  # told when the route was read
    return parse_xml(blocks, "OpenDRIVE", path, notes, objects=True)


def _found(
    marks: Sequence[Mark], ends: Sequence[float], named: dict[str, Element]
) -> Iterator[_Piece]:
    for mark, end_m in zip(marks, ends, strict=True):
        element = named.get(plain_name(mark.name))
        if element is not None and end_m > mark.s_m:
            yield _Piece(Leg(element, mark.against), mark.s_m, end_m)


def _lanes(pieces: Sequence[_Piece]) -> dict[str, Any]:
    """Return lanes and their width where most of the way has them: the page draws one width."""
    metres: dict[tuple[int, int, float, str], float] = {}
    for piece in pieces:
        for section, length_m in _sections(piece):
            along, against = (
                list(driven_lanes(section, piece.leg.road, against=way != piece.leg.against))
                for way in (False, True)
            )
            if along:
                kind = (len(along), len(against), _width_m(along), _traffic(piece.leg))
                metres[kind] = metres.get(kind, 0.0) + length_m
    usual = max(metres, key=lambda kind: metres[kind], default=(1, 1, LANE_WIDTH_M, "RHT"))
    lanes_along, lanes_against, width_m, traffic = usual
    return {
        "lane_width_m": width_m,
        "lanes_right": min(lanes_along, LANES_MAX),
        "lanes_left": min(lanes_against, LANES_MAX),
        "traffic": traffic,
    }


def _sections(piece: _Piece) -> Iterator[tuple[Element, float]]:
    sections = list(piece.leg.road.all("lanes", "laneSection"))
    starts = [_number(section, "s") for section in sections]
    ends = [*starts[1:], piece.to_m - piece.from_m]
    for section, start_m, end_m in zip(sections, starts, ends, strict=True):
        yield section, max(end_m - start_m, 0.0)


def _width_m(lanes: Sequence[Element]) -> float:
    """Return the width of the widest lane at its start, as far as a car's lane can be so wide."""
    widths = [_number(width, "a") for lane in lanes for width in lane.all("width")]
    usable = [w for w in widths if LANE_WIDTH_MIN_M <= w <= LANE_WIDTH_MAX_M]
    return max(usable, default=LANE_WIDTH_M)


def _traffic(leg: Leg) -> str:
    return "LHT" if leg.road.attributes.get("rule", "").strip().upper() == "LHT" else "RHT"


def _villages(pieces: Sequence[_Piece]) -> Iterator[dict[str, Any]]:
    """Yield where the file says ``town``; pieces that touch are one village."""
    spans = (span for piece in pieces for span in _town_spans(piece))
    return _joined((_stretch("village", *span, "") for span in spans), gap_m=1.0)


def _town_spans(piece: _Piece) -> list[tuple[float, float]]:
    types = list(piece.leg.road.all("type"))
    starts = [_number(element, "s") for element in types]
    spans = []
    for element, start_m, end_m in zip(types, starts, [*starts[1:], math.inf], strict=True):
        kind = element.attributes.get("type", "").strip().lower()
        length_m = min(end_m, piece.to_m - piece.from_m) - start_m
        span = piece.span(start_m, length_m) if length_m > 0.0 else None
        if span is not None and kind in _TOWN:
            spans.append(span)
    return sorted(spans)


def _bridges(pieces: Sequence[_Piece]) -> Iterator[dict[str, Any]]:
    for piece in pieces:
        for bridge in piece.leg.road.all("objects", "bridge"):
            span = piece.span(_number(bridge, "s"), _number(bridge, "length"))
            if span is not None:
                yield _stretch("bridge", *span, bridge.attributes.get("name", "").strip())


def _bends(route: Route) -> Iterator[dict[str, Any]]:
    """Yield to which side a road without a line turns: prepared files have no signs there."""
    return _joined(() if route.has_line else _bent(route), gap_m=0.0)


def _bent(route: Route) -> Iterator[dict[str, Any]]:
    """Yield what lies between two knots and turns; one side after the other where it changes."""
    s_m, curvature = route.s_m, route.curvature_per_m
    bent = np.abs(curvature) > _STRAIGHT_PER_M
    for k in np.flatnonzero(bent[:-1] | bent[1:]):
        before, after = float(curvature[k]), float(curvature[k + 1])
        from_m, to_m = float(s_m[k]), float(s_m[k + 1])
        if before * after >= 0.0:
            yield _bend(before + after, from_m, to_m)
            continue
        middle_m = from_m + (to_m - from_m) * before / (before - after)
        yield _bend(before, from_m, middle_m)
        yield _bend(after, middle_m, to_m)


def _bend(curvature_per_m: float, from_m: float, to_m: float) -> dict[str, Any]:
    return _stretch("bend_left" if curvature_per_m > 0.0 else "bend_right", from_m, to_m, "")


def _joined(stretches: Iterable[dict[str, Any]], gap_m: float) -> Iterator[dict[str, Any]]:
    """Yield stretches with those of one kind joined that are at most ``gap_m`` apart."""
    last: dict[str, Any] | None = None
    for stretch in stretches:
        if last is None:
            last = stretch
        elif last["kind"] == stretch["kind"] and abs(stretch["from_m"] - last["to_m"]) <= gap_m:
            last["to_m"] = stretch["to_m"]
        else:
            yield last
            last = stretch
    if last is not None:
        yield last


def _stretch(kind: str, from_m: float, to_m: float, name: str) -> dict[str, Any]:
    return {
        "kind": kind,
        "from_m": float(from_m),
        "to_m": float(to_m),
        "name": plain_name(name) if name else "",
    }


def _number(element: Element, name: str) -> float:
    value = as_number(element.attributes.get(name))
    return value if math.isfinite(value) else 0.0
