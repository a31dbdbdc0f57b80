"""Times of the models: whole nanoseconds. In the numba subset (see ``pldf.kernel``)."""

from __future__ import annotations

from math import floor

NS_PER_S = 1e9


def to_ns(seconds: float) -> int:
    """Seconds as whole nanoseconds."""
    return floor(seconds * NS_PER_S + 0.5)
