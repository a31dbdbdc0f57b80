"""The jerk that following a learned profile demands, bounded by lowering it (section 3.8).

As in the planner: with ``b = v * v``, jerk is the second difference of ``b`` times ``v / 2``, and
``v`` is taken from the profile before its jerk is bounded. Valleys first, then peaks; a second
difference is bounded if one of its three nodes is marked.
"""

from __future__ import annotations

from math import sqrt

from .arrays import Floats, Work
from .codes import BOUND_JERK
from .lowering import ROUNDING, UNMARKED, lower
from .planner import SLOWEST_CAP_MPS, round_peaks, steepest_rise

REACH_M = 64  # nodes beside a marked run that its peaks may take at first; doubled as needed


def lower_jerk(jerk_max_mps3: float, bound: Floats, work: Work, rise: float, fall: float) -> int:
    """Lower the squares ``work.c`` where marked nodes demand more jerk; return how often.

    ``work.b`` marks; ``rise`` and ``fall`` bound the slopes of the squares (m/s2, twice the
    acceleration). ``work.d`` to ``work.g`` are overwritten.
    """
    for i in range(len(work.c)):
        # A file may hold slower ones.
        work.d[i] = 2.0 * jerk_max_mps3 / max(sqrt(work.c[i]), SLOWEST_CAP_MPS)
    return _lower_valleys(bound, work, rise, fall) + _lower_peaks(bound, work)


def _lower_valleys(bound: Floats, work: Work, rise: float, fall: float) -> int:
    """Let the slope grow by at most the bend, away from the bottom (see ``round_valleys``)."""
    n = len(work.c)
    count = 0
    for i in range(n - 3, -1, -1):
        slope = work.c[i + 1] - work.c[i + 2]
        allowed = work.c[i + 1] + steepest_rise(slope, work.d[i + 1], fall)
        mark = max(work.b[i], work.b[i + 1], work.b[i + 2])
        count += lower(work, bound, i, allowed, mark, BOUND_JERK)
    for i in range(2, n):
        slope = work.c[i - 1] - work.c[i - 2]
        allowed = work.c[i - 1] + steepest_rise(slope, work.d[i - 1], rise)
        mark = max(work.b[i], work.b[i - 1], work.b[i - 2])
        count += lower(work, bound, i, allowed, mark, BOUND_JERK)
    return count


def _lower_peaks(bound: Floats, work: Work) -> int:
    """Round the peaks of each marked run, and of as much around it as that takes."""
    count = 0
    first = 0
    n = len(work.c)
    while first < n:
        if work.b[first] == UNMARKED:
            first += 1
            continue
        last = first
        while last < n - 1 and work.b[last + 1] != UNMARKED:
            last += 1
        count += _lower_peak(bound, work, first, last)
        while first < n and work.b[first] != UNMARKED:  # also what has just grown
            first += 1
    return count


def _lower_peak(bound: Floats, work: Work, first: int, last: int) -> int:
    """Round the peaks of the marked run first..last; return how many nodes that lowered."""
    n = len(work.c)
    reach = REACH_M
    left = max(first - reach, 0)
    right = min(last + reach, n - 1)
    _round_window(work, left, right)
    # Only a curve that leaves the ends of the window as they are is the one of the whole road.
    while (left > 0 and _falls(work, left + 1)) or (right < n - 1 and _falls(work, right - 1)):
        reach = 2 * reach
        left = max(first - reach, 0)
        right = min(last + reach, n - 1)
        _round_window(work, left, right)
    count = 0
    for i in range(left, right + 1):
        if _falls(work, i):
            mark = work.b[first] if i < first else work.b[last]
            count += lower(work, bound, i, work.g[i], mark, BOUND_JERK)
    return count


def _falls(work: Work, i: int) -> bool:
    return work.c[i] > work.g[i] * (1.0 + ROUNDING)


def _round_window(work: Work, left: int, right: int) -> None:
    """Fill ``work.g`` with the squares between two nodes, peaks rounded; the ends stay.

    Where no marked node is involved, what is there already may bend as it does.
    """
    for i in range(left, right + 1):
        work.g[i] = work.c[i]
        if left < i < right and max(work.b[i - 1], work.b[i], work.b[i + 1]) == UNMARKED:
            bends = 2.0 * work.c[i] - work.c[i - 1] - work.c[i + 1]
            work.h[i] = max(work.d[i], bends)
        else:
            work.h[i] = work.d[i]
    round_peaks(work.g, work.h, work.e, work.f, left, right)
