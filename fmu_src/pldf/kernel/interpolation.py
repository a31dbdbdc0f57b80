"""Reading per-metre arrays at any position."""

from __future__ import annotations

from .arrays import Floats

# Where a position lies: node before it, node behind it, share of the way between them. At the ends
# of the route and beyond, both are the node at that end. Several arrays can be read at one place.
Place = tuple[int, int, float]


def place_at(n: int, s_m: float) -> Place:
    """Return the place of position ``s_m`` on a route of ``n`` nodes."""
    if s_m >= n - 1:  # first, because a machine integer does not hold every position
        return n - 1, n - 1, 0.0
    i = int(s_m)
    if s_m <= 0.0 or i < 0:  # the second says to the compiler that no index is negative
        return 0, 0, 0.0
    return i, i + 1, s_m - i


def cell_at(n: int, s_m: float) -> int:
    """Return the index of the cell that holds position ``s_m``, kept inside ``0 .. n - 1``."""
    return place_at(n, s_m)[0]


def value_of(values: Floats, place: Place) -> float:
    """Return ``values`` (one per node) at ``place``, linear between nodes."""
    before, behind, share = place
    return values[before] + share * (values[behind] - values[before])


def value_at(values: Floats, s_m: float) -> float:
    """Return ``values`` (one per node) at ``s_m``, linear between nodes, constant outside."""
    return value_of(values, place_at(len(values), s_m))


def position_of(rising: Floats, value: float, start: int, end: int) -> float:
    """Return where ``rising`` (not decreasing over nodes start..end) takes ``value``, in metres.

    Before the first value it is ``start``, behind the last ``end``.
    """
    if value <= rising[start]:
        return float(start)
    # From the end: where the car stood still (equal values) its last node counts; and callers look
    # a few seconds back from ``end``.
    for i in range(end, start, -1):
        if rising[i - 1] <= value:
            step = rising[i] - rising[i - 1]
            if value >= rising[i] or step <= 0.0:
                return float(i)
            return i - 1 + (value - rising[i - 1]) / step
    return float(start)
