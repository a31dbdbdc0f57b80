"""Reading per-metre arrays at any position."""

from __future__ import annotations

from .arrays import Floats


def cell_at(n: int, s_m: float) -> int:
    """Return the index of the cell that holds position ``s_m``, kept inside ``0 .. n - 1``."""
    if s_m <= 0.0:
        return 0
    if s_m >= n - 1:
        return n - 1
    return int(s_m)


def value_at(values: Floats, s_m: float) -> float:
    """Return ``values`` (one per node) at ``s_m``, linear between nodes, constant outside."""
    if s_m <= 0.0:
        return values[0]
    i = int(s_m)
    if i >= len(values) - 1:
        return values[len(values) - 1]
    return values[i] + (s_m - i) * (values[i + 1] - values[i])


def position_of(rising: Floats, value: float, start: int, end: int) -> float:
    """Return where ``rising`` (not decreasing over nodes start..end) takes ``value``, in metres.

    Before the first value it is ``start``, behind the last ``end``.
    """
    if value <= rising[start]:
        return float(start)
    for i in range(end, start, -1):
        if rising[i - 1] <= value:
            step = rising[i] - rising[i - 1]
            if value >= rising[i] or step <= 0.0:
                return float(i)
            return i - 1 + (value - rising[i - 1]) / step
    return float(start)
