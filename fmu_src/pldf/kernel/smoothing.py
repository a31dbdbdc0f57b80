"""Savitzky-Golay smoothing of order 2 on the 1 m grid (section 3.6).

The weights are the closed form of the least-squares parabola through ``2 m + 1`` equidistant
samples, evaluated in the middle (Savitzky and Golay, Anal. Chem. 36, 1964)::

    w(j) = 3 (3 m^2 + 3 m - 1 - 5 j^2) / ((2 m - 1) (2 m + 1) (2 m + 3)),   j = -m .. m
"""

from __future__ import annotations

from .arrays import Floats


def smoothed_at(values: Floats, i: int, half: int) -> float:
    """Return the parabola through the ``2 half + 1`` nodes around ``i``, evaluated at ``i``.

    Steps overshoot by 8 %, so the result is kept within the range of the window (decision). Beyond
    the ends of the array its end values count.
    """
    n = len(values)
    scale = (2.0 * half - 1.0) * (2.0 * half + 1.0) * (2.0 * half + 3.0)
    total = 0.0
    low = values[i]
    high = values[i]
    for j in range(-half, half + 1):
        value = values[min(max(i + j, 0), n - 1)]
        total += 3.0 * (3.0 * half * half + 3.0 * half - 1.0 - 5.0 * j * j) * value
        low = min(low, value)
        high = max(high, value)
    if half == 0:
        return values[i]
    return min(max(total / scale, low), high)
