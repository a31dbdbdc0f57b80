"""From knots to values per metre: interpolation, and what is decisive in each cell of a metre.

Places in order are looked up in blocks, each among the knots beside it: for a road across a
continent everything else would wait for the memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray

_AT_ONCE: Final = 1 << 16


def along(
    s_m: FloatArray, rows: Iterable[FloatArray], at: FloatArray, *, behind: bool = True
) -> FloatArray:
    """Return the ``rows`` at places in order, float64 [rows, places]; behind jumps or before."""
    values = right_values if behind else left_values
    rows = list(rows)
    found = np.empty((len(rows), len(at)))
    for block, near in _blocks(s_m, at):
        found[:, block] = values(s_m[near], np.stack([row[near] for row in rows]), at[block])
    return found


def lowest_limit(s_m: FloatArray, limit: FloatArray, nodes: FloatArray) -> FloatArray:
    """Return the lowest limit in force anywhere in each cell between the nodes 0, 1, 2, ..."""
    lowest = np.empty(len(nodes) - 1)
    for block, near in _blocks(s_m, nodes[:-1]):
        lowest[block] = limit[near][np.searchsorted(s_m[near], nodes[block], side="right") - 1]
    # The first knot of a jump is in force over no length at all: it does not count.
    at = np.flatnonzero((s_m[:-1] < s_m[1:]) & (s_m[:-1] < nodes[-1]))
    np.minimum.at(lowest, s_m[at].astype(np.intp), limit[at])
    return lowest


def sharpest_curve(s_m: FloatArray, curvature: FloatArray, nodes: FloatArray) -> FloatArray:
    """Return the largest absolute curvature in each cell between the nodes 0, 1, 2, ..."""
    # |curvature| is convex between knots: its maximum lies at a knot or at an end of the cell.
    sharpest = np.empty(len(nodes) - 1)
    for cells, near in _blocks(s_m, nodes[:-1], nodes[1:]):
        knots = s_m[near], curvature[near]
        np.maximum(
            np.abs(right_values(*knots, nodes[:-1][cells])),
            np.abs(left_values(*knots, nodes[1:][cells])),
            out=sharpest[cells],
        )
    at = np.flatnonzero((np.floor(s_m) < s_m) & (s_m < nodes[-1]))
    np.maximum.at(sharpest, s_m[at].astype(np.intp), np.abs(curvature[at]))
    return sharpest


def right_values(s_m: FloatArray, values: FloatArray, at: FloatArray) -> FloatArray:
    """Return the linear interpolation of ``values``, float64 [..., knots]; behind jumps."""
    before = np.minimum(np.searchsorted(s_m, at, side="right") - 1, len(s_m) - 1)
    return _between(s_m, values, at, before)


def left_values(s_m: FloatArray, values: FloatArray, at: FloatArray) -> FloatArray:
    """The same, before jumps."""
    after = np.searchsorted(s_m, at, side="left")
    between = _between(s_m, values, at, np.maximum(after - 1, 0))
    return np.where(s_m[after] == at, values[..., after], between)


def _between(
    s_m: FloatArray, values: FloatArray, at: FloatArray, before: NDArray[np.intp]
) -> FloatArray:
    after = np.minimum(before + 1, len(s_m) - 1)
    span = s_m[after] - s_m[before]
    share = np.divide(at - s_m[before], span, out=np.zeros_like(at), where=span > 0.0)
    blend: FloatArray = values[..., before] * (1.0 - share) + values[..., after] * share
    return blend


def _blocks(
    s_m: FloatArray, starts: FloatArray, ends: FloatArray | None = None
) -> Iterator[tuple[slice, slice]]:
    """Yield blocks of places in order, or of cells, and the knots that count there."""
    ends = starts if ends is None else ends
    for first in range(0, len(starts), _AT_ONCE):
        block = slice(first, min(first + _AT_ONCE, len(starts)))
        before = int(np.searchsorted(s_m, starts[block.start], side="left")) - 1
        behind = int(np.searchsorted(s_m, ends[block.stop - 1], side="right")) + 1
        yield block, slice(max(before, 0), behind)
