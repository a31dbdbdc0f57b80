"""OpenDRIVE roads, linked to one chain, sampled to the knots of a route.

Knots lie at every whole metre of the route, at every change of geometry, limit or elevation record
and, on polynomials, every half metre. Lines, arcs and spirals are linear in curvature, so their
knots are exact.

Decisions: a geometry holds until the next one starts, which closes gaps and overlaps of up to
``S_GAP_MAX_M``; larger ones are refused, and so are jumps of the line.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .chain import Leg, Network
from .geometry import Cubic, Geometry, LinearCurvature, Pose, param_poly3, poly3
from .route import LENGTH_MAX_M, Route
from .speeds import limits
from .xml_tree import Element, Place, parse_xml

S_GAP_MAX_M: Final = 0.5
LINE_GAP_MAX_M: Final = 1.0
# Between roads the reference line may move by lane widths while the lanes go straight on.
LINK_GAP_MAX_M: Final = 10.0
# Differences at a border up to which there is no jump: rounding in the file, not the road.
_SAME_CURVATURE_PER_M: Final = 1e-9
_SAME_GRADE: Final = 1e-5
_MERGE_M: Final = 1e-6

Record = TypeVar("Record", bound=tuple[Any, ...])


@dataclass(frozen=True)
class Piece:
    """Knots of one stretch with one geometry, one limit and one elevation record."""

    columns: FloatArray  # [6, knots]: s, curvature, limit, grade, x, y
    element: Element
    place: Place


@dataclass(frozen=True)
class Road:
    """One road's contents over its own arc length; starts are sorted and begin with 0."""

    length_m: float
    geometries: list[tuple[float, Geometry, Element]]
    grades: list[tuple[float, Cubic]]
    limits: list[tuple[float, float]]


def parse_opendrive(
    data: bytes, path: Path, *, start_road: str | None, default_limit_mps: float | None
) -> Route:
    """Return the route along the chain of roads in ``data``; ``path`` names it in errors.

    Raises:
        ModelError: with file, line, road and way out.
    """
    notes: list[Finding] = []
    root = parse_xml(data, "OpenDRIVE", path, notes)
    pieces: list[Piece] = []
    offset_m = 0.0
    for leg in Network(root, Place(path)).chain(start_road):
        place = Place(path, leg.id)
        road = _read_road(leg, place, default_limit_mps)
        pieces += _pieces(road, leg, place, offset_m)
        offset_m += road.length_m
    header = root.find("header")
    name = header.attributes.get("name", "").strip() if header is not None else ""
    s_m, curvature, limit, grade, x_m, y_m = _join(pieces)
    try:
        return Route(name or path.stem, s_m, curvature, limit, grade, x_m, y_m, notes=tuple(notes))
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None


def _read_road(leg: Leg, place: Place, default_limit_mps: float | None) -> Road:
    road = leg.road
    length = place.number(road, "length")
    if length <= 0.0:
        raise place.error(road, f"length {length:g} m; a road must be longer than 0")
    if length > LENGTH_MAX_M:
        raise place.error(road, f"length {length:g} m is beyond 10 000 km; is the unit right?")
    return Road(
        length,
        _geometries(road, place, length),
        _grades(road, place),
        limits(road, place, length, against=leg.against, default_mps=default_limit_mps),
    )


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
    kept = [(s, e) for s, e in elements if place.number(e, "length") > _MERGE_M]
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


def _pieces(road: Road, leg: Leg, place: Place, offset_m: float) -> list[Piece]:
    starts = [r[0] for records in (road.geometries, road.grades, road.limits) for r in records]
    inner = np.unique([s for s in starts if _MERGE_M < s < road.length_m - _MERGE_M])
    inner = inner[np.diff(inner, prepend=0.0) > _MERGE_M]
    borders = np.concatenate(([0.0], inner, [road.length_m]))
    pieces = [
        _piece(road, (float(a), float(b)), leg, place, offset_m) for a, b in pairwise(borders)
    ]
    return pieces[::-1] if leg.against else pieces


def _piece(road: Road, span: tuple[float, float], leg: Leg, place: Place, offset_m: float) -> Piece:
    middle = 0.5 * (span[0] + span[1])
    start, geometry, element = _latest(road.geometries, middle)
    grade_start, (_, b, c, d) = _latest(road.grades, middle)
    _, limit = _latest(road.limits, middle)
    ends = (road.length_m - span[1], road.length_m - span[0]) if leg.against else span
    step = 1.0 if isinstance(geometry, LinearCurvature) else 0.5
    route_s = _stations(offset_m + ends[0], offset_m + ends[1], step)
    s_m = road.length_m - (route_s - offset_m) if leg.against else route_s - offset_m
    ds = np.maximum(s_m - start, 0.0)
    dz = s_m - grade_start
    sign = -1.0 if leg.against else 1.0
    grade = sign * (b + dz * (2.0 * c + dz * (3.0 * d)))
    curvature = sign * geometry.curvature(ds)
    columns = [route_s, curvature, np.full_like(route_s, limit), grade, *geometry.line(ds)]
    return Piece(np.stack(columns), element, place)


def _latest(records: Sequence[Record], at_m: float) -> Record:
    return records[bisect_right(records, at_m, key=lambda record: record[0]) - 1]


def _stations(start: float, end: float, step: float) -> FloatArray:
    inner = np.arange(np.floor(start / step) + 1.0, np.ceil(end / step)) * step
    return np.concatenate(([start], inner, [end]))


def _join(pieces: list[Piece]) -> FloatArray:
    """Put the pieces behind each other; a border has two knots only where there is a jump."""
    parts = []
    for piece, following in pairwise(pieces):
        end, start = piece.columns[:, -1], following.columns[:, 0]
        gap = float(np.hypot(*(start - end)[4:]))
        allowed = LINE_GAP_MAX_M if piece.place == following.place else LINK_GAP_MAX_M
        if gap > allowed:
            raise following.place.error(
                following.element,
                f"the line jumps by {gap:.3g} m at {start[0]:.6g} m of the route; correct x and y",
            )
        _, curvature_jump, _, grade_jump, _, _ = np.abs(start - end)
        jump = curvature_jump > _SAME_CURVATURE_PER_M or grade_jump > _SAME_GRADE
        parts.append(piece.columns if jump else piece.columns[:, :-1])
    return np.concatenate([*parts, pieces[-1].columns], axis=1)
