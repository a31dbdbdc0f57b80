"""One road, sampled to the knots of a route.

Knots lie at every whole metre of the route, at every change of geometry, limit or elevation record
and, on polynomials, every half metre. Lines, arcs and spirals are linear in curvature, so their
knots are exact.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

from ..kernel.arrays import FloatArray
from .contents import MERGE_M, Contents
from .geometry import LinearCurvature
from .speeds import Limits
from .xml_tree import Element, Place

LINE_GAP_MAX_M: Final = 1.0
# Differences at a border up to which there is no jump: rounding in the file, not the road.
_SAME_CURVATURE_PER_M: Final = 1e-9
_SAME_GRADE: Final = 1e-5

Record = TypeVar("Record", bound=tuple[Any, ...])


class Joints(NamedTuple):
    """Where a geometry ends and the next begins, one value per such place."""

    s_m: FloatArray  # on the route
    turn_rad: FloatArray  # jump of the heading, positive to the left
    line: FloatArray  # of the file, where the geometry behind it stands


NO_JOINTS: Final = Joints(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True)
class Stretch:
    """The knots of one road, in the direction in which it is driven."""

    contents: Contents
    columns: FloatArray  # [6, knots]: s, curvature, limit, grade, x, y
    start_heading_rad: float
    end_heading_rad: float
    joints: Joints

    @property
    def place(self) -> Place:
        """File and road."""
        return self.contents.place


class _Piece(NamedTuple):
    """Knots of what has one geometry, one limit and one elevation record."""

    columns: FloatArray  # [6, knots]
    headings_rad: tuple[float, float]  # at both ends, as driven
    element: Element


def sample(road: Contents, limits: Limits, offset_m: float) -> Stretch:
    """Return the knots of ``road`` under ``limits``, from ``offset_m`` of the route on.

    Raises:
        ModelError: the line jumps inside the road.
    """
    pieces = _pieces(road, limits, offset_m)
    joints: list[tuple[float, float, float]] = []
    parts = []
    for piece, following in pairwise(pieces):
        end, start = piece.columns[:, -1], following.columns[:, 0]
        gap = float(np.hypot(*(start - end)[4:]))
        if gap > LINE_GAP_MAX_M:
            raise road.place.error(
                following.element,
                f"the line jumps by {gap:.3g} m at {start[0]:.6g} m of the route; correct x and y",
            )
        if following.element is not piece.element:
            turn = wrapped(following.headings_rad[0] - piece.headings_rad[1])
            joints.append((float(start[0]), turn, float(following.element.line)))
        parts.append(piece.columns if jumps(end, start) else piece.columns[:, :-1])
    columns = np.concatenate([*parts, pieces[-1].columns], axis=1)
    return Stretch(
        road,
        columns,
        pieces[0].headings_rad[0],
        pieces[-1].headings_rad[1],
        Joints(*np.array(joints).reshape(-1, 3).T),
    )


def jumps(end: FloatArray, start: FloatArray) -> bool:
    """Tell whether curvature or grade jump between the last knot and the next one."""
    _, curvature_jump, _, grade_jump, _, _ = np.abs(start - end)
    return bool(curvature_jump > _SAME_CURVATURE_PER_M or grade_jump > _SAME_GRADE)


def wrapped(angle_rad: float) -> float:
    """Return the same angle from -pi to pi."""
    return float(np.remainder(angle_rad + np.pi, 2.0 * np.pi) - np.pi)


def _pieces(road: Contents, limits: Limits, offset_m: float) -> list[_Piece]:
    starts = [r[0] for records in (road.geometries, road.grades, limits) for r in records]
    inner = np.unique([s for s in starts if MERGE_M < s < road.length_m - MERGE_M])
    inner = inner[np.diff(inner, prepend=0.0) > MERGE_M]
    borders = np.concatenate(([0.0], inner, [road.length_m]))
    pieces = [_piece(road, limits, (float(a), float(b)), offset_m) for a, b in pairwise(borders)]
    return pieces[::-1] if road.leg.against else pieces


def _piece(road: Contents, limits: Limits, span: tuple[float, float], offset_m: float) -> _Piece:
    against = road.leg.against
    middle = 0.5 * (span[0] + span[1])
    start, geometry, element = _latest(road.geometries, middle)
    grade_start, (_, b, c, d) = _latest(road.grades, middle)
    _, limit = _latest(limits, middle)
    ends = (road.length_m - span[1], road.length_m - span[0]) if against else span
    step = 1.0 if isinstance(geometry, LinearCurvature) else 0.5
    route_s = _stations(offset_m + ends[0], offset_m + ends[1], step)
    s_m = road.length_m - (route_s - offset_m) if against else route_s - offset_m
    ds = np.maximum(s_m - start, 0.0)
    dz = s_m - grade_start
    sign = -1.0 if against else 1.0
    grade = sign * (b + dz * (2.0 * c + dz * (3.0 * d)))
    curvature = sign * geometry.curvature(ds)
    columns = [route_s, curvature, np.full_like(route_s, limit), grade, *geometry.line(ds)]
    first, last = (float(at) for at in geometry.heading(ds[[0, -1]]) + (np.pi if against else 0.0))
    return _Piece(np.stack(columns), (first, last), element)


def _latest(records: Sequence[Record], at_m: float) -> Record:
    return records[bisect_right(records, at_m, key=lambda record: record[0]) - 1]


def _stations(start: float, end: float, step: float) -> FloatArray:
    inner = np.arange(np.floor(start / step) + 1.0, np.ceil(end / step)) * step
    return np.concatenate(([start], inner, [end]))
