"""Curvature that is noise of a survey or of a fit, and what it is smoothed to.

Roads swing, too: from bend to bend. What gives noise away is that its swings move the line hardly
sideways. A swing of ``2 k`` in curvature over ``l`` metres moves it by about ``k (l / pi)²``: 4 cm
for 0.004/m between points 10 m apart, 2 m for an S-bend of 20 m radius. ``SWINGS_MIN`` swings among
``_AMONG`` that move it by less than ``SIDEWAYS_MAX_M``, from sample to sample, are noise.

It is smoothed by the mean over a window around each place. How long, is found by the intersection
of confidence intervals (A. Goldenshluger, A. Nemirovski, *On spatially adaptive estimation of
nonparametric regression*, 1997): the longest window whose mean fits those of all shorter ones,
given the noise, which is estimated from second differences. Of these the last but one is taken:
the longest already levels bends by what the noise allows. So straights are averaged over hundreds
of metres, and bends keep their shape. What the means leave is averaged over the longest window and
added: the road turns as it is drawn.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ...kernel.arrays import FloatArray
from .bending import CURVATURE, S, averaged, in_a_row, recurved, turned
from .kinks import LANE_PLAY_M

SWINGS_MIN: Final = 8
_AMONG: Final = 12
SWING_MAX_M: Final = 100.0
SIDEWAYS_MAX_M: Final = 0.5 * LANE_PLAY_M
# Noisy stretches less than this apart are one.
_APART_MAX_M: Final = 100.0
# Half widths of the windows, in samples; and how many standard deviations a mean may be off.
_WINDOWS: Final = (0, 1, 2, 3, 4, 6, 8, 11, 16, 22, 32)
_CONFIDENCE: Final = 1.25
_ROUNDS_MAX: Final = 4
# Of white noise the standard deviation is about as large as the swings.
_ROUGH: Final = 0.25


class Noise(NamedTuple):
    """A stretch whose curvature was noise."""

    start_m: float
    end_m: float
    sigma_per_m: float  # standard deviation of the noise
    spacing_m: float  # of the samples that were smoothed
    sharpest_per_m: tuple[float, float]  # before and after


def smoothed(
    knots: FloatArray, window_m: float | None, felt_per_m: float
) -> tuple[FloatArray, list[Noise]]:
    """Return the knots without noise, and where it was; the same array if there was none.

    Args:
        knots: float64 [6, n]: s, curvature, limit, grade, x, y.
        window_m: None: as above. 0: never. Else the curvature is the mean over so many metres,
            everywhere.
        felt_per_m: curvature below which nobody feels a curve.
    """
    if window_m == 0.0:
        return knots, []
    if window_m is not None:
        whole = (float(knots[S, 0]), float(knots[S, -1]))
        after = averaged(knots, np.array([whole]), window_m)
        sharpest = _sharpest(knots, whole), _sharpest(after, whole)
        return after, [Noise(*whole, 0.0, window_m, sharpest)]
    found: list[Noise] = []
    for _ in range(_ROUNDS_MAX):
        spans = noisy_spans(knots, felt_per_m)
        if not spans:
            break
        knots, noises = _denoised(knots, spans)
        found += noises
    return knots, _first_of_each(found)


def noisy_spans(knots: FloatArray, felt_per_m: float) -> list[tuple[float, float]]:
    """Return from where to where the curvature is noise, in m."""
    at_m, value = _turning_points(knots, felt_per_m)
    length, swing = np.diff(at_m), 0.5 * np.abs(np.diff(value))
    sideways = swing * (length / np.pi) ** 2
    noisy = sideways < SIDEWAYS_MAX_M
    # Noise is not all alike: a larger swing among smaller ones belongs to it.
    swings = (sideways < 6.0 * SIDEWAYS_MAX_M) & (length < SWING_MAX_M)
    spans: list[tuple[float, float]] = []
    for run in in_a_row(np.flatnonzero(swings)):
        dense = np.convolve(noisy[run], np.ones(_AMONG), mode="full")
        if np.max(dense) < SWINGS_MIN:
            continue
        start, end = float(at_m[run[0]]), float(at_m[run[-1] + 1])
        if not _rough(knots, (start, end), float(np.median(swing[run]))):
            continue
        if spans and start - spans[-1][1] < _APART_MAX_M:
            start = spans.pop()[0]
        spans.append((start, end))
    return spans


def _rough(knots: FloatArray, span_m: tuple[float, float], swing_per_m: float) -> bool:
    """Tell whether the curvature jumps about from sample to sample, rather than swing smoothly."""
    part = _part(knots, *span_m)
    _, samples = _samples(part, span_m, _spacing(part, span_m))
    return _sigma(samples) > _ROUGH * swing_per_m


def _turning_points(knots: FloatArray, felt_per_m: float) -> tuple[FloatArray, FloatArray]:
    """Return where the curvature turns by more than can be overlooked, and its values there."""
    s_m, value = knots[S], knots[CURVATURE]
    slope = np.sign(np.diff(value))
    moving = np.flatnonzero(slope != 0.0)
    if len(moving) == 0:
        return np.zeros(0), np.zeros(0)
    turns = moving[np.flatnonzero(np.diff(slope[moving]) != 0.0)] + 1
    index = np.concatenate(([0], turns, [len(s_m) - 1]))
    kept = _zigzag(value[index].tolist(), 0.5 * felt_per_m)
    # A plateau turns in its middle: where it is left matters as much as where it is reached.
    nexts = np.minimum(np.searchsorted(moving, index[kept]), len(moving) - 1)
    left = np.maximum(moving[nexts], index[kept])
    return 0.5 * (s_m[index[kept]] + s_m[left]), value[index[kept]]


def _zigzag(values: list[float], swing_min: float) -> list[int]:
    """Return the turning points of those that swing by at least ``swing_min`` to each side."""
    kept = [0]
    for i, value in enumerate(values[1:], 1):
        if (
            len(kept) > 1
            and (value - values[kept[-1]]) * (values[kept[-1]] - values[kept[-2]]) >= 0.0
        ):
            kept[-1] = i  # goes on as it went
        elif abs(value - values[kept[-1]]) >= swing_min:
            kept.append(i)
    return kept


def _denoised(
    knots: FloatArray, spans_m: list[tuple[float, float]]
) -> tuple[FloatArray, list[Noise]]:
    """Replace the curvature in the spans by its adaptive means."""
    found: list[Noise] = []
    middles: list[FloatArray] = []
    means: list[FloatArray] = []
    for span in spans_m:
        part = _part(knots, *span)
        spacing = _spacing(part, span)
        reach = _WINDOWS[-1] * spacing
        wide = (span[0] - reach, span[1] + reach)
        middle, samples = _samples(_part(knots, *wide), wide, spacing)
        inside = (middle >= span[0]) & (middle <= span[1])
        sigma = _sigma(samples[inside])
        smooth = _adaptive_means(samples, sigma)
        at_m = np.concatenate((span[:1], middle[inside], span[1:]))
        value = np.interp(at_m, middle, smooth)
        # From end to end the road turns as before.
        drawn = float(np.diff(turned(part, np.array(span)))[0])
        value += (drawn - float(np.trapezoid(value, at_m))) / (span[1] - span[0])
        middles.append(at_m)
        means.append(value)
        sharpest = (_sharpest(part, span), float(np.max(np.abs(value))))
        found.append(Noise(*span, sigma, spacing, sharpest))
    every_m, mean = np.concatenate(middles), np.concatenate(means)
    after = recurved(knots, np.array(spans_m), lambda s_m: np.interp(s_m, every_m, mean))
    return after, found


def _part(knots: FloatArray, start_m: float, end_m: float) -> FloatArray:
    """Return the knots from the last before the start to the first behind the end."""
    first = max(int(np.searchsorted(knots[S], start_m, side="left")) - 1, 0)
    return knots[:, first : int(np.searchsorted(knots[S], end_m, side="right")) + 1]


def _sharpest(knots: FloatArray, span_m: tuple[float, float]) -> float:
    inside = (knots[S] >= span_m[0]) & (knots[S] <= span_m[1])
    return float(np.max(np.abs(knots[CURVATURE, inside]), initial=0.0))


def _spacing(knots: FloatArray, span_m: tuple[float, float]) -> float:
    """Return how far apart the corners of the curvature are, typically; from 1 to 25 m."""
    s_m, value = knots[S], knots[CURVATURE]
    gap = np.diff(s_m)
    slope = np.diff(value) / np.where(gap > 0.0, gap, 1.0)
    bends = np.flatnonzero((np.abs(np.diff(slope)) > 1e-9) | (gap[1:] == 0.0)) + 1
    at_m = np.unique(s_m[bends])
    at_m = at_m[(at_m >= span_m[0]) & (at_m <= span_m[1])]
    return float(np.clip(np.median(np.diff(at_m)), 1.0, 25.0)) if len(at_m) > 1 else 1.0


def _samples(
    knots: FloatArray, span_m: tuple[float, float], spacing_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return the middles of equal pieces of what the route has of the span, and their means."""
    first, last = max(span_m[0], float(knots[S, 0])), min(span_m[1], float(knots[S, -1]))
    edges = np.linspace(first, last, max(round((last - first) / spacing_m), 1) + 1)
    means = np.diff(turned(knots, edges)) / np.diff(edges)
    return 0.5 * (edges[1:] + edges[:-1]), means


def _sigma(samples: FloatArray) -> float:
    """Return the standard deviation of white noise with these second differences, robustly.

    Samples are means over what lies between two corners or three: neighbours share one, those two
    apart do not. Of white noise at the corners such a mean keeps about 1 / 1.35.
    """
    if len(samples) < 5:
        return 0.0
    seconds = samples[:-4] - 2.0 * samples[2:-2] + samples[4:]
    return float(1.35 * 1.4826 * np.median(np.abs(seconds)) / np.sqrt(6.0))


def _adaptive_means(samples: FloatArray, sigma: float) -> FloatArray:
    """Return of each sample the mean over the last but one window that fits all shorter ones."""
    total = np.concatenate(([0.0], np.cumsum(samples)))
    index = np.arange(len(samples))
    low, high = np.full(len(samples), -np.inf), np.full(len(samples), np.inf)
    longest, taken = samples, samples
    fits = np.ones(len(samples), dtype=bool)
    for half in _WINDOWS:
        reach = np.minimum(half, np.minimum(index, len(samples) - 1 - index))
        count = 2 * reach + 1
        mean = (total[index + reach + 1] - total[index - reach]) / count
        margin = _CONFIDENCE * sigma / np.sqrt(count)
        low, high = np.maximum(low, mean - margin), np.minimum(high, mean + margin)
        fits &= low <= high
        taken = np.where(fits, longest, taken)
        longest = np.where(fits, mean, longest)
    # Over the longest window the road turns as it is drawn.
    left = samples - taken
    total = np.concatenate(([0.0], np.cumsum(left)))
    turning: FloatArray = taken + (total[index + reach + 1] - total[index - reach]) / count
    return turning


def _first_of_each(found: list[Noise]) -> list[Noise]:
    """Return one finding per stretch: that of the first round, with what the last has left."""
    stretches: list[Noise] = []
    for noise in sorted(found):
        known = stretches[-1] if stretches else None
        if known is not None and noise.start_m < known.end_m:
            left = (known.sharpest_per_m[0], noise.sharpest_per_m[1])
            end_m = max(known.end_m, noise.end_m)
            stretches[-1] = known._replace(end_m=end_m, sharpest_per_m=left)
        else:
            stretches.append(noise)
    return stretches
