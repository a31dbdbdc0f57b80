"""Lessons and stored profiles that are as bad as a driver, or somebody who writes files, can make.

Harm is done where the hard caps fall: gas as long and as late as possible, let go right before or
behind the place; a brake before, so that the profile has to climb first; set speeds far off.
"""

from __future__ import annotations

import numpy as np
from pldf.kernel.arrays import FloatArray

FALL_MPS = 1.0  # the caps fall by at least this at a place that harm is done at
RAW_GAS_MPS = 60.0  # a wish never reached: full gas


def worst_places(caps_mps: FloatArray) -> FloatArray:
    """Return the nodes at which the hard caps (m/s, per node) have fallen within 10 m."""
    falls = caps_mps[:-10] - caps_mps[10:] > FALL_MPS
    begins = np.flatnonzero(falls[1:] & ~falls[:-1]) + 10.0
    return np.asarray(begins if len(begins) else [0.5 * len(caps_mps)])


def bad_lesson(rng: np.random.Generator, caps_mps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return wish (m/s, 0 = hands off) and tips of the lever, per cell, for one drive."""
    wish, tips = np.zeros(len(caps_mps)), np.zeros(len(caps_mps))
    for place in worst_places(caps_mps):
        if rng.random() < 0.7:
            _push(rng, wish, caps_mps, int(place))
    for begin in rng.integers(0, len(wish), int(rng.integers(0, 4))):  # a brake anywhere
        end = begin + int(rng.uniform(10.0, 60.0))
        wish[begin:end] = rng.uniform(0.3, 0.7) * caps_mps[begin]
    sign = rng.choice([-1.0, 1.0, 1.0])
    for begin in rng.integers(10, len(tips) - 200, int(rng.integers(0, 4))):
        for press in range(int(rng.integers(1, 7))):
            tips[begin + 8 * press : begin + 8 * press + 3] = sign
    return wish, tips


def _push(rng: np.random.Generator, wish: FloatArray, caps_mps: FloatArray, place: int) -> None:
    """Gas up to ``place`` or a little beyond; sometimes after a brake that makes it steeper."""
    begin = max(place - int(rng.uniform(15.0, 250.0)), 0)
    end = max(begin + 5, place + int(rng.uniform(-40.0, 30.0)))
    raw = rng.random() < 0.4
    wish[begin:end] = RAW_GAS_MPS if raw else rng.uniform(0.85, 1.3) * caps_mps[begin:end]
    if rng.random() < 0.3:
        slow = max(begin - 40, 0)
        wish[slow:begin] = rng.uniform(0.2, 0.6) * caps_mps[slow:begin]


def forged_profile(rng: np.random.Generator, caps_mps: FloatArray) -> FloatArray:
    """Return a profile (m/s, per node) that flips as often and as hard as the bounds let it."""
    nodes = np.arange(len(caps_mps))
    kind = rng.integers(3)
    if kind == 0:  # at the caps, everywhere
        return 2.0 * caps_mps
    if kind == 1:  # saw teeth below the caps
        teeth = nodes / rng.uniform(5.0, 120.0) % 1.0
        return np.asarray(caps_mps * (1.0 - rng.uniform(0.1, 0.6) * teeth))
    steps = rng.uniform(0.3, 1.3, len(caps_mps))
    return np.asarray(caps_mps * steps[nodes // int(rng.integers(3, 40))])
