"""Roads that are hard on a driving function: hairpins, short and low limits, ups and downs."""

from __future__ import annotations

from typing import Final

import numpy as np
from pldf.kernel.arrays import FloatArray
from pldf.roads import Route

KMH: Final = 1.0 / 3.6
LENGTH_M: Final = 2000.0
LIMITS_KMH: Final = (20, 20, 30, 50, 50, 60, 70, 80, 100, 130)
# From hairpins to bends that are hardly felt, as radius.
RADII_M: Final = ((9.0, 16.0), (16.0, 60.0), (60.0, 200.0), (200.0, 600.0))
GRADE_MAX: Final = 0.1


def hard_road(seed: int) -> Route:
    """Return the road of this seed, about 2 km long, always the same one."""
    rng = np.random.default_rng(seed)
    curves = _curves(rng)
    signs = _signs(rng)
    hills_m = np.arange(0.0, LENGTH_M + 1.0, 100.0)
    hills = np.clip(np.cumsum(rng.normal(0.0, 0.04, len(hills_m))), -GRADE_MAX, GRADE_MAX)
    s_m = np.unique(np.concatenate((curves[:, 0], signs[:, 0], hills_m, [LENGTH_M])))
    limit = signs[np.searchsorted(signs[:, 0], s_m, side="right") - 1, 1]
    return Route(
        name=f"hard road {seed}",
        s_m=s_m,
        curvature_per_m=np.interp(s_m, curves[:, 0], curves[:, 1]),
        speed_limit_mps=limit,
        grade=np.interp(s_m, hills_m, hills),
        x_m=s_m,
        y_m=np.zeros_like(s_m),
        has_line=False,
    )


def _curves(rng: np.random.Generator) -> FloatArray:
    """Return rows (m, 1/m): straights, curves, curves that follow each other without a straight."""
    knots = [(0.0, 0.0)]
    at = rng.uniform(60.0, 150.0)
    while at < LENGTH_M - 150.0:
        curvature = rng.choice([-1.0, 1.0]) / rng.uniform(*RADII_M[rng.integers(len(RADII_M))])
        # Many maps have no clothoids: there the curvature jumps.
        entry_m, exit_m = rng.choice([1.0, 8.0, 25.0], 2)
        arc_m = min(rng.uniform(0.3, 1.6) / abs(curvature), 150.0)
        lengths_m = (0.0, entry_m, arc_m, exit_m)
        for length_m, value in zip(lengths_m, (0.0, curvature, curvature, 0.0), strict=True):
            at += length_m
            knots.append((at, value))
        at += 1.0 if rng.random() < 0.3 else rng.uniform(10.0, 250.0)
    return np.array(knots)


def _signs(rng: np.random.Generator) -> FloatArray:
    """Return rows (m, m/s): where a limit begins; a third of the limits are short."""
    at, signs = 0.0, []
    while at < LENGTH_M - 50.0:
        signs.append((np.floor(10.0 * at) / 10.0, rng.choice(LIMITS_KMH) * KMH))
        at += rng.uniform(15.0, 80.0) if rng.random() < 0.33 else rng.uniform(100.0, 500.0)
    return np.array(signs)
