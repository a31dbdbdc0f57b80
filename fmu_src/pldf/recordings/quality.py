"""How good a recording is: rate, holes and the metres they cost, how much of the road it covers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray, RouteArrays
from ..kernel.state import PldfState
from .recording import Recording

# A longer gap between two samples is a hole, for learning and here (algorithm, section 3.1).
HOLE_S = PldfState().learning_recording_gap_s


class Hole(NamedTuple):
    """Two samples with more than ``HOLE_S`` between them."""

    time_s: float  # of the last sample before it
    duration_s: float
    from_m: float
    to_m: float

    @property
    def lost_m(self) -> float:
        """Metres of which nothing is known."""
        return max(self.to_m - self.from_m, 0.0)


class Quality(NamedTuple):
    """What a recording is worth, in numbers.

    Attributes:
        duration_s: from the first to the last sample.
        rate_hz: samples per second, from the median step.
        from_m: smallest position.
        to_m: largest position.
        coverage: share of the road's metres between the two, 0..1; NaN if the road is not known.
        holes: in order of time.
    """

    duration_s: float
    rate_hz: float
    from_m: float
    to_m: float
    coverage: float
    holes: tuple[Hole, ...]

    @property
    def lost_m(self) -> float:
        """Metres that all holes cost."""
        return sum(hole.lost_m for hole in self.holes)


def quality_of(recording: Recording, route: RouteArrays | None) -> Quality:
    """Return the quality of ``recording``, driven on ``route`` if that is known."""
    time, s = recording["time_s"], recording["s_m"]
    from_m, to_m = float(np.min(s)), float(np.max(s))
    step_s = float(np.median(np.diff(time)))
    return Quality(
        duration_s=float(time[-1] - time[0]),
        rate_hz=1.0 / step_s if step_s > 0.0 else float("nan"),
        from_m=from_m,
        to_m=to_m,
        coverage=_coverage(from_m, to_m, route),
        holes=holes(recording),
    )


def holes(recording: Recording) -> tuple[Hole, ...]:
    """Return the holes of ``recording``."""
    time, s = recording["time_s"], recording["s_m"]
    gap_s = np.diff(time)
    return tuple(
        Hole(float(time[i]), float(gap_s[i]), float(s[i]), float(s[i + 1]))
        for i in np.flatnonzero(gap_s > HOLE_S).tolist()
    )


def road_length_m(route: RouteArrays) -> float:
    """Return the position of the last node."""
    return float(len(route.limit_mps) - 1)


def cells_of(s_m: FloatArray, route: RouteArrays) -> NDArray[np.intp]:
    """Return the cell of each position, the first and the last one for what lies off the road."""
    return np.clip(np.floor(s_m), 0, len(route.limit_mps) - 1).astype(np.intp)


def _coverage(from_m: float, to_m: float, route: RouteArrays | None) -> float:
    if route is None:
        return float("nan")
    length = road_length_m(route)
    driven = min(to_m, length) - max(from_m, 0.0)
    return max(driven, 0.0) / length
