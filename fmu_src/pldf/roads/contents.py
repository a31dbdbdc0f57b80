"""What one OpenDRIVE road says of its line and its height, over its own arc length.

Decisions: a geometry holds until the next one starts, which closes gaps and overlaps of up to
``S_GAP_MAX_M``; larger ones are refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from ..errors import ModelError
from .geometry import Cubic, Geometry, LinearCurvature, Pose, param_poly3, poly3
from .leg import Leg
from .route import LENGTH_MAX_M
from .xml_tree import Element, Place

S_GAP_MAX_M: Final = 0.5
MERGE_M: Final = 1e-6


@dataclass(frozen=True)
class Contents:
    """One road's line and height; starts are sorted and begin with 0."""

    leg: Leg
    place: Place
    length_m: float
    geometries: list[tuple[float, Geometry, Element]]
    grades: list[tuple[float, Cubic]]


def read_contents(leg: Leg, place: Place) -> Contents:
    """Return line and height of the road of ``leg``.

    Raises:
        ModelError: with file, line, road and way out.
    """
    road = leg.road
    length = place.number(road, "length")
    if length <= 0.0:
        raise place.error(road, f"length {length:g} m; a road must be longer than 0")
    if length > LENGTH_MAX_M:
        raise place.error(road, f"length {length:g} m is beyond 10 000 km; is the unit right?")
    return Contents(leg, place, length, _geometries(road, place, length), _grades(road, place))


def _geometries(
    road: Element, place: Place, length: float
) -> list[tuple[float, Geometry, Element]]:
    elements = [(place.number(e, "s"), e) for e in road.all("planView", "geometry")]
    if not elements:
        raise place.error(road, "no planView/geometry; a route needs its line")
    elements.sort(key=lambda pair: pair[0])
    end = 0.0
    for start, element in elements:
        _check_gap(start - end, end, element, place)
        end = start + place.number(element, "length")
    _check_gap(length - end, end, elements[-1][1], place)
    kept = [(s, e) for s, e in elements if place.number(e, "length") > MERGE_M]
    if not kept:
        raise place.error(road, "every geometry has length 0")
    return [(s, _geometry(e, place), e) for s, e in kept]


def _check_gap(gap_m: float, at_m: float, element: Element, place: Place) -> None:
    if abs(gap_m) > S_GAP_MAX_M:
        kind = "gap" if gap_m > 0.0 else "overlap"
        raise place.error(
            element, f"{kind} of {abs(gap_m):.6g} m in planView at s = {at_m:.6g} m; close it"
        )


def _geometry(element: Element, place: Place) -> Geometry:
    pose = Pose(*(place.number(element, name) for name in ("x", "y", "hdg")))
    length = place.number(element, "length")
    for shape in element.children:
        try:
            geometry = _shape(shape, place, pose, length)
        except ModelError:
            raise
        except ValueError as error:
            raise place.error(shape, str(error)) from None
        if geometry is not None:
            return geometry
    raise place.error(element, "no line, arc, spiral, poly3 or paramPoly3 in this geometry")


def _shape(shape: Element, place: Place, pose: Pose, length: float) -> Geometry | None:
    def cubic(names: str) -> Cubic:
        a, b, c, d = (place.number(shape, name) for name in names.split())
        return a, b, c, d

    match shape.tag:
        case "line":
            return LinearCurvature(pose, length, 0.0, 0.0)
        case "arc":
            curvature = place.number(shape, "curvature")
            return LinearCurvature(pose, length, curvature, curvature)
        case "spiral":
            ends = (place.number(shape, name) for name in ("curvStart", "curvEnd"))
            return LinearCurvature(pose, length, *ends)
        case "poly3":
            return poly3(pose, length, cubic("a b c d"))
        case "paramPoly3":
            normalized = shape.attributes.get("pRange", "normalized").lower() != "arclength"
            u, v = cubic("aU bU cU dU"), cubic("aV bV cV dV")
            return param_poly3(pose, length, u, v, normalized=normalized)
    return None


def _grades(road: Element, place: Place) -> list[tuple[float, Cubic]]:
    records: list[tuple[float, Cubic]] = [(0.0, (0.0, 0.0, 0.0, 0.0))]
    for element in road.all("elevationProfile", "elevation"):
        a, b, c, d = (place.number(element, name, 0.0) for name in ("a", "b", "c", "d"))
        records.append((place.number(element, "s"), (a, b, c, d)))
    return sorted(records, key=lambda record: record[0])
