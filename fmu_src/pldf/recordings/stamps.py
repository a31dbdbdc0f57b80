"""Times of recordings: what date it was, and stamps that are coarser than the samples."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, time
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray

_DAY_S: Final = 86400.0
_HALF_DAY_S: Final = 43200.0
_HOLE: Final = 1.5  # a step of stamps this many times as long as usual is no rounding, but a hole
_COARSE: Final = 0.05  # share of samples with a stamp that is no new one, from which all are coarse


def seconds_of_dates(texts: Sequence[str]) -> FloatArray:
    """Return seconds since the first of ISO 8601 dates or times of day; NaN where a text is none.

    A time of day more than half a day before the one above it is of the next day. Dates without a
    time zone are taken as of one zone.
    """
    seconds = np.array([_seconds(text) for text in texts], dtype=np.float64)
    if all(":" in text[:3] for text in texts):
        days = np.diff(seconds, prepend=seconds[:1]) < -_HALF_DAY_S
        seconds = seconds + _DAY_S * np.cumsum(days)
    known = seconds[np.isfinite(seconds)]
    return seconds - known[0] if len(known) else seconds


def _seconds(text: str) -> float:
    text = text.strip().replace(",", ".")
    try:
        if ":" in text[:3]:
            at = time.fromisoformat(text)
            return 3600.0 * at.hour + 60.0 * at.minute + at.second + 1e-6 * at.microsecond
        moment = datetime.fromisoformat(text)
    except ValueError:
        return np.nan
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    return moment.timestamp()


class CoarseStamps:
    """Stamps that never go back, some of which several samples share.

    Attributes:
        runs: first sample of each stamp, and the count of samples behind the last.
        longest: most samples that share a stamp.
        usual: how many share one usually (median).
        step_s: usual difference between two stamps, s.
    """

    def __init__(self, stamps_s: FloatArray) -> None:
        self.stamps_s = stamps_s
        starts = np.flatnonzero(np.diff(stamps_s, prepend=-np.inf) > 0.0)
        self.runs: NDArray[np.intp] = np.append(starts, len(stamps_s))
        counts = np.diff(self.runs)
        self.longest, self.usual = int(counts.max()), float(np.median(counts))
        different = np.diff(stamps_s[starts])
        self.step_s = float(np.median(different)) if len(different) else 0.0

    @property
    def shared(self) -> int:
        """Number of samples that have the stamp of the one before."""
        return len(self.stamps_s) - len(self.runs) + 1

    @property
    def standing(self) -> list[int]:
        """Samples at which the clock begins to stand still, not merely to be coarse."""
        counts = np.diff(self.runs)
        allowed = 2.0 * self.usual + 1.0
        return [int(first) for first in self.runs[:-1][counts > allowed]]

    def times_s(self) -> FloatArray:
        """Return times that grow: evenly where stamps are coarse, else evenly per stamp."""
        per_stamp = self._per_stamp()
        if self.shared < _COARSE * len(per_stamp):
            return per_stamp
        starts = self.runs[:-1]
        holes = np.diff(self.stamps_s[starts]) > _HOLE * self.step_s
        parts = np.split(np.arange(len(per_stamp)), starts[1:][holes])
        times = np.concatenate([self._evenly(self.stamps_s[part]) for part in parts])
        return times if np.all(np.diff(times) > 0.0) else per_stamp

    def _evenly(self, stamps_s: FloatArray) -> FloatArray:
        """Return the straight line through stamps without a hole, if all are but rounded off it."""
        sample = np.arange(float(len(stamps_s)))
        if stamps_s[-1] == stamps_s[0]:
            return stamps_s
        slope, start = np.polyfit(sample, stamps_s, 1)
        line: FloatArray = start + slope * sample
        return line if np.max(np.abs(line - stamps_s)) <= self.step_s else stamps_s

    def _per_stamp(self) -> FloatArray:
        """Return the samples of each stamp evenly until the next one, at most one step long."""
        stamps, counts = self.stamps_s[self.runs[:-1]], np.diff(self.runs)
        width = np.minimum(np.diff(stamps, append=np.inf), self.step_s or 1.0)
        within = np.arange(len(self.stamps_s)) - np.repeat(self.runs[:-1], counts)
        return np.asarray(np.repeat(stamps, counts) + within * np.repeat(width / counts, counts))
