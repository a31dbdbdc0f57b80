"""One road, sampled to the knots of a route.

Knots lie at every whole metre of the route, at every change of geometry, limit or elevation record
and, on polynomials, every half metre. Lines, arcs and spirals are linear in curvature, so their
knots are exact; what a polynomial does between its knots is looked after in ``turning.py``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...findings import Finding, short
from ...kernel.arrays import FloatArray
from ..curves.joints import Joints
from ..limits.speeds import Limits
from ..opendrive.contents import Contents
from ..opendrive.ragged import Indices
from ..opendrive.xml_tree import Place
from .knots import Knots, Pieces, knots_of, pieces_of
from .turning import Turns, as_turned, told

LINE_GAP_MAX_M: Final = 1.0
# Differences at a border up to which there is no jump: rounding in the file, not the road.
_SAME_CURVATURE_PER_M: Final = 1e-9
_SAME_GRADE: Final = 1e-5


@dataclass(frozen=True)
class Stretch:
    """The knots of one road, in the direction in which it is driven."""

    contents: Contents
    columns: FloatArray  # [6, knots]: s, curvature, limit, grade, x, y
    start_heading_rad: float
    end_heading_rad: float
    joints: Joints
    notes: tuple[Finding, ...] = ()

    @property
    def place(self) -> Place:
        """File and road."""
        return self.contents.place


class _Borders(NamedTuple):
    """Where geometries meet, one value each."""

    s_m: FloatArray  # on the route
    turn_rad: FloatArray
    gap_m: FloatArray
    behind: Indices  # geometry


def sample(road: Contents, limits: Limits, offset_m: float) -> Stretch:
    """Return the knots of ``road`` under ``limits``, from ``offset_m`` of the route on.

    Raises:
        ModelError: the line jumps inside the road, or a polynomial is none; names all places.
    """
    pieces = pieces_of(road, limits, offset_m)
    # A polynomial's knots may be two each; memory that is not written to takes none.
    columns = np.empty((6, int(np.sum(pieces.counts * np.where(pieces.polynomial, 2, 1)))))
    used, headings = 0, []
    turns: list[Turns] = []
    borders: list[_Borders] = []
    for knots in _overlapping(knots_of(road, pieces, offset_m), pieces, turns):
        kept, met = _kept(knots, pieces)
        columns[:, used : used + len(kept)] = knots.columns[:, kept]
        used += len(kept)
        borders.append(met)
        headings += knots.heading_rad[[0, -1]].tolist()
    columns[:, used] = knots.columns[:, -1]
    met = _Borders(*(np.concatenate(values) for values in zip(*borders, strict=True)))
    line = road.geometries.line[met.behind]
    _refuse_jumps(road.place, met, line)
    drawn = np.pi if road.leg.against else 0.0
    return Stretch(
        road, columns[:, : used + 1], headings[0] + drawn, headings[-1] + drawn,
        Joints(met.s_m, met.turn_rad, line.astype(np.float64)), told(turns, road, offset_m),
    )  # fmt: skip


def jumps(end: FloatArray, start: FloatArray) -> NDArray[np.bool_]:
    """Tell whether curvature or grade jump between last knots and next ones, [6] or [6, n]."""
    _, curvature_jump, _, grade_jump, _, _ = np.abs(start - end)
    found: NDArray[np.bool_] = (curvature_jump > _SAME_CURVATURE_PER_M) | (grade_jump > _SAME_GRADE)
    return found


def wrapped(angle_rad: FloatArray | float) -> FloatArray:
    """Return the same angles from -pi to pi."""
    same: FloatArray = np.remainder(angle_rad + np.pi, 2.0 * np.pi) - np.pi
    return same


def _overlapping(some: Iterator[Knots], pieces: Pieces, turns: list[Turns]) -> Iterator[Knots]:
    """Yield knots that turn as the road does, behind the last one that was yielded before."""
    last: Knots | None = None
    for each in some:
        knots, turned = as_turned(each, pieces)
        turns.append(turned)
        yield knots if last is None else last.followed_by(knots)
        last = knots.take(slice(-1, None))


def _kept(knots: Knots, pieces: Pieces) -> tuple[Indices, _Borders]:
    """Return which knots but the last are needed, and where geometries meet among all.

    Where a piece ends there is one knot, that of the next; two only where there is a jump.
    """
    ends = np.flatnonzero(np.diff(knots.piece))
    end, start = knots.columns[:, ends], knots.columns[:, ends + 1]
    needed = np.ones(len(knots.piece), dtype=bool)
    needed[ends] = jumps(end, start)
    needed[-1] = False
    geometry = pieces.geometry[knots.piece]
    meet = np.flatnonzero(geometry[ends] != geometry[ends + 1])
    turn = wrapped(knots.heading_rad[ends + 1] - knots.heading_rad[ends])[meet]
    gap = np.hypot(*(start - end)[4:])[meet]
    met = _Borders(start[0, meet], turn, gap, geometry[ends[meet] + 1])
    return np.flatnonzero(needed), met


def _refuse_jumps(place: Place, met: _Borders, line: NDArray[np.intc]) -> None:
    far = np.flatnonzero(met.gap_m > LINE_GAP_MAX_M)
    if len(far):
        raise place.errors(
            (
                int(line[at]),
                f"the line jumps by {short(met.gap_m[at])} m at {met.s_m[at]:.6g} m of the route;"
                " correct x and y",
            )
            for at in far
        )
