"""Learning against the paper's formulas, written down a second time with NumPy and SciPy.

Nothing of the project's kernel is used: eq. (1) to (3), the limits of the stretching, holes, stops,
runs and smoothing come from section 3 alone. Bounds and jerk are opened wide, they have tests of
their own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as hs
from laboratory import KMH, Array, bent, function, play, road, travel_times, within
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE
from scipy.ndimage import maximum_filter1d, minimum_filter1d
from scipy.signal import savgol_filter

LENGTH_M = 1500
CURVES = [(350.0, 420.0, 0.008), (900.0, 960.0, 0.01)]
ROAD = road(float(LENGTH_M), curves=CURVES)
OPEN = {
    "learning_jerk_max_mps3": 0.0,
    "planner_jerk_max_mps3": 0.0,
    "planner_lateral_accel_max_mps2": 10.0,
    "learning_lateral_accel_max_mps2": 10.0,
    "learning_over_limit_max_mps": 50.0,
    "learning_accel_max_mps2": 10.0,
    "learning_accel_min_mps2": -10.0,
    "planner_accel_max_mps2": 5.0,
    "planner_accel_min_mps2": -5.0,
}
LOST, OUTSIDE = -1, 0
Pieces = list[tuple[float, float]]


def alphas(pieces: Pieces, t: Array, v: Array, curvature: Array) -> list[float]:
    """Eq. (1): the stretch factor of each piece after its three limits."""
    found, s = [], np.arange(len(v))
    for k, (d_0, d_n) in enumerate(pieces):
        earlier = np.interp(np.interp(d_0, s, t) - 3.0, t, s)
        alpha = min(0.5, (d_0 - earlier) / (d_n - d_0))
        first = d_0 - alpha * (d_n - d_0)
        kmax = curvature[int(first) : int(d_n) + 1].max()
        alpha *= np.clip((0.016 - kmax) / 0.012, 0.0, 1.0)
        before = pieces[k - 1][1] if k else 0.0
        found.append(min(alpha, (d_0 - before) / (d_n - d_0)))
    return found


class Driven(NamedTuple):
    """What was recorded, one value per metre."""

    t: Array
    v: Array
    gap: Array
    eligible: Array


def learned(pieces: Pieces, drive: Driven, profile: Array, curvature: Array) -> Array:
    """Section 3.2 to 3.6 on the nodes of a route that was driven as a whole."""
    t, v, gap, eligible = drive
    s = np.arange(float(len(v)))
    prepro, owner = v.copy(), np.where(gap | ~eligible, LOST, OUTSIDE)
    stopped = set()
    for k, (d_0, d_n) in enumerate(pieces):
        alpha = alphas(pieces, t, v, curvature)[k]
        first = d_0 - alpha * (d_n - d_0)
        inside = (s >= first) & (s <= d_n)
        d = (s[inside] + alpha * d_n) / (1.0 + alpha)  # where it was recorded
        lift = np.interp(first, s, v) - np.interp(d_0, s, v)
        joined = np.interp(d, s, v) + (d_n - d) / (d_n - d_0) * lift  # eq. (2)
        prepro[inside] = np.maximum(joined, 10.0 * KMH)
        lost = gap[int(first) : int(d_n) + 1].any() or ~eligible[d.astype(int)]
        owner[inside] = np.where(lost | (owner[inside] == LOST), LOST, k + 1)
        if v[int(first) : int(d_n) + 1].min() < 10.0 * KMH:
            stopped.add(k + 1)
    wish = (owner > 0) | ((owner == OUTSIDE) & (np.abs(prepro - profile) > 1.0 * KMH))
    result = profile.copy()
    for run in runs(wish, owner, t):
        owners = set(owner[run]) - {OUTSIDE}
        if owners and not owners & stopped and v[run].min() >= 10.0 * KMH:
            result[run] = smoothed(prepro, profile, run)[run]
    return result


def runs(wish: Array, owner: Array, t: Array) -> list[slice]:
    """Maximal runs of wishes; gaps below 1 s merge, but not over what is lost."""
    found: list[slice] = []
    for i in np.flatnonzero(wish):
        last = found[-1].stop - 1 if found else -9
        near = found and (i == last + 1 or t[i] - t[last] < 1.0)
        if near and not (owner[last : i + 1] == LOST).any():
            found[-1] = slice(found[-1].start, i + 1)
        else:
            found.append(slice(i, i + 1))
    return found


def smoothed(prepro: Array, profile: Array, run: slice) -> Array:
    """Eq. (3), Savitzky-Golay over 51 m within the local range, cross-faded over 10 m."""
    mean = profile.copy()
    mean[run] = 0.5 * (profile[run] + prepro[run])
    fit = savgol_filter(np.pad(mean, 25, mode="edge"), 51, 2)[25:-25]
    low, high = (f(mean, 51, mode="nearest") for f in (minimum_filter1d, maximum_filter1d))
    s, n = np.arange(len(mean)), len(mean)
    left = s - run.start + 1 if run.start > 0 else np.full(n, 11)
    right = run.stop - s if run.stop < n else np.full(n, 11)
    share = np.clip(np.minimum(left, right) / 11.0, 0.0, 1.0)
    return profile + share * (np.clip(fit, low, high) - profile)


speeds = hs.lists(
    hs.tuples(hs.floats(0.0, float(LENGTH_M)), hs.floats(-3.0, 2.5)), min_size=1, max_size=8
)
spans = hs.lists(hs.tuples(hs.integers(0, 1400), hs.integers(4, 200)), max_size=5)


@settings(deadline=None, max_examples=40)
@given(
    speeds, spans, hs.integers(30, 1400), hs.integers(0, 80), hs.integers(0, 1400), hs.booleans()
)
def test_the_kernel_learns_what_the_formulas_say(
    wishes: list[tuple[float, float]],
    pressed: list[tuple[int, int]],
    hole_m: int,
    hole_length_m: int,
    closed_m: int,
    stops: bool,
) -> None:
    made = function(ROAD, **OPEN)
    profile = np.array(made.profile.learned_mps)
    s_m = np.arange(0.0, LENGTH_M + 0.25, 0.5)
    deviation = bent(*sorted(wishes))(s_m) * np.clip((690.0 - np.abs(s_m - 700.0)) / 50.0, 0.0, 1.0)
    speed = np.interp(s_m, np.arange(len(profile)), profile) + deviation
    if stops:
        speed *= np.clip(np.abs(s_m - 1100.0) / 60.0, 0.05, 1.0)
    # Apart by more than pedal bounce, which the recorder would merge.
    pieces: Pieces = []
    for first, length in sorted(pressed):
        if (not pieces or first > pieces[-1][1] + 40) and first + length < LENGTH_M - 10:
            pieces.append((float(max(first, 1)), float(first + length)))
    kept = (s_m <= hole_m) | (s_m >= hole_m + hole_length_m)
    eligible = np.abs(s_m - closed_m) > 30.0
    time = travel_times(s_m, speed)
    mode = np.where(within(s_m, pieces), GAS_OVERRIDE, ACTIVE)
    columns = {"time_s": time, "mode": mode, "eligible": eligible.astype(float)}
    play(made, s_m[kept], speed[kept], **{name: c[kept] for name, c in columns.items()})
    seen = made.learn().learned_mps

    count = made.record.drive_interventions
    found = list(zip(made.trace.start_m[:count], made.trace.end_m[:count], strict=True))
    nodes = np.arange(float(LENGTH_M + 1))
    at_nodes = [np.interp(nodes, s_m[kept], c[kept]) for c in (time, speed)]
    hole = (nodes > hole_m) & (nodes <= hole_m + hole_length_m)
    hole &= np.ptp(time[~kept | (s_m == hole_m) | (s_m == hole_m + hole_length_m)]) > 1.5
    drive = Driven(*at_nodes, hole, np.asarray(made.trace.eligible) > 0.0)
    expected = learned(found, drive, profile, np.asarray(made.route.curvature_per_m))
    np.testing.assert_allclose(seen, expected, atol=1e-9)
