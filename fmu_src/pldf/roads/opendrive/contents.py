"""What one OpenDRIVE road says of its line and its height, over its own arc length.

Decisions: a geometry holds until the next one starts, which closes gaps and overlaps of up to
``S_GAP_MAX_M``; larger ones are refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from ...kernel.arrays import FloatArray
from ..route import LENGTH_MAX_M
from .geometry import STRAIGHT, Geometries, Points
from .leg import Leg
from .plan_view import ARC, NORMALIZED, POLY3, SPIRAL, GeometryTable, PlanView, Rows
from .polynomials import GeometryError, Polynomials
from .ragged import Indices
from .xml_tree import Element, Place

S_GAP_MAX_M: Final = 0.5
MERGE_M: Final = 1e-6


@dataclass(frozen=True)
class Contents:
    """One road's line and height."""

    leg: Leg
    place: Place
    length_m: float
    geometries: Geometries
    grades: FloatArray  # [n, 5], in order: start, then the cubic of the height; from 0 on

    def points(self, which: Indices, ds: FloatArray) -> Points:
        """Return the points ``ds`` metres behind the starts of the geometries ``which``.

        Raises:
            ModelError: names every polynomial of the road that is none.
        """
        try:
            return self.geometries.points(which, ds)
        except GeometryError:
            raise self.place.errors(self.geometries.polynomials.faults()) from None

    def points_at(self, s_m: FloatArray) -> Points:
        """Return the points at ``s_m``.

        Raises:
            ModelError: as ``points``.
        """
        starts = self.geometries.start_m
        which = np.maximum(np.searchsorted(starts, s_m, side="right") - 1, 0)
        return self.points(which, np.maximum(s_m - starts[which], 0.0))


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


def _geometries(road: Element, place: Place, length: float) -> Geometries:
    plans = [plan for plan in road.all("planView") if isinstance(plan, PlanView)]
    if not any(plan.stop > plan.first for plan in plans):
        raise place.error(road, "no planView/geometry; a route needs its line")
    table = plans[0].table
    rows = table.rows(plans)
    _refuse(place, table.faults(rows, ("s", "length")))
    if np.any(np.diff(rows.s_m) < 0.0):
        rows = rows.take(np.argsort(rows.s_m, kind="stable"))
    _check_gaps(rows, length, place)
    if not np.all(rows.length_m > MERGE_M):
        rows = rows.take(np.flatnonzero(rows.length_m > MERGE_M))
    if not len(rows.line):
        raise place.error(road, "every geometry has length 0")
    _refuse(place, table.faults(rows, ("x", "y", "hdg")) + table.shape_faults(rows))
    return _shaped(rows, table)


def _refuse(place: Place, faults: list[tuple[int, str]]) -> None:
    if faults:
        raise place.errors(faults)


def _check_gaps(rows: Rows, length: float, place: Place) -> None:
    ends = np.concatenate(([0.0], rows.s_m + rows.length_m))
    gaps = np.append(rows.s_m, length) - ends
    faults = []
    for at in np.flatnonzero(np.abs(gaps) > S_GAP_MAX_M):
        kind = "gap" if gaps[at] > 0.0 else "overlap"
        text = f"{kind} of {abs(gaps[at]):.6g} m in planView at s = {ends[at]:.6g} m; close it"
        faults.append((int(rows.line[min(int(at), len(rows.line) - 1)]), text))
    _refuse(place, faults)


def _shaped(rows: Rows, table: GeometryTable) -> Geometries:
    curvature = np.zeros((2, len(rows.kind)))
    for kind, count in ((ARC, 1), (SPIRAL, 2)):
        at = np.flatnonzero(rows.kind == kind)
        curvature[:, at] = table.numbers(rows.take(at), count).T
    at = np.flatnonzero(rows.kind >= POLY3)
    cubic = np.full(len(rows.kind), STRAIGHT)
    cubic[at] = np.arange(len(at))
    s_m, x_m, y_m, heading_rad, length_m = rows.pose.T
    return Geometries(
        s_m, x_m, y_m, heading_rad, length_m, curvature[0], curvature[1],
        cubic, _polynomials(rows.take(at), table), rows.line,
    )  # fmt: skip


def _polynomials(rows: Rows, table: GeometryTable) -> Polynomials:
    cubics = np.empty((len(rows.kind), 8))
    simple = rows.kind == POLY3
    cubics[simple, :4] = (0.0, 1.0, 0.0, 0.0)
    cubics[simple, 4:] = table.numbers(rows.take(np.flatnonzero(simple)), 4)
    cubics[~simple] = table.numbers(rows.take(np.flatnonzero(~simple)), 8)
    end = np.where(rows.kind == NORMALIZED, 1.0, rows.length_m)
    return Polynomials(cubics, end, rows.length_m, ~simple, rows.shape_line)


def _grades(road: Element, place: Place) -> FloatArray:
    records: list[tuple[float, ...]] = [(0.0, 0.0, 0.0, 0.0, 0.0)]
    for element in road.all("elevationProfile", "elevation"):
        cubic = (place.number(element, name, 0.0) for name in ("a", "b", "c", "d"))
        records.append((place.number(element, "s"), *cubic))
    return np.array(sorted(records, key=lambda record: record[0]))
