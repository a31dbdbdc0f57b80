"""Savitzky-Golay smoothing of order 2 on the 1 m grid (section 3.6).

The weights are the closed form of the least-squares parabola through ``2 m + 1`` equidistant
samples, evaluated in the middle (Savitzky and Golay, Anal. Chem. 36, 1964)::

    w(j) = 3 (3 m^2 + 3 m - 1 - 5 j^2) / ((2 m - 1) (2 m + 1) (2 m + 3)),   j = -m .. m
"""

from __future__ import annotations

from .arrays import Floats


def smoothed_at(values: Floats, i: int, half: int) -> float:
    """Return the smoothed value at node ``i``, kept within the range of the window (decision).

    Without that, steps overshoot by 8 %.
    """
    n = len(values)
    low = values[i]
    high = values[i]
    for j in range(max(i - half, 0), min(i + half, n - 1) + 1):
        low = min(low, values[j])
        high = max(high, values[j])
    return min(max(parabola_at(values, i, half), low), high)


def parabola_at(values: Floats, i: int, half: int) -> float:
    """Return the parabola through the ``2 half + 1`` nodes around ``i``, evaluated at ``i``.

    Beyond the ends of the array its end values count.
    """
    if half == 0:
        return values[i]
    n = len(values)
    scale = (2.0 * half - 1.0) * (2.0 * half + 1.0) * (2.0 * half + 3.0)
    total = 0.0
    for j in range(-half, half + 1):
        value = values[min(max(i + j, 0), n - 1)]
        total += 3.0 * (3.0 * half * half + 3.0 * half - 1.0 - 5.0 * j * j) * value
    return total / scale
