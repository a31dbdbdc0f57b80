"""Ten cars behind one another: does a disturbance grow from the first to the last?

Judged by the largest deviation of speed, for waves of 0.02 to 0.5 Hz and for single brakings. A car
only sees the one ahead, so they are driven one after the other: the speed of each is the next one's
car ahead.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import numpy as np
from pldf.compiled import pack
from pldf.instance import zeros
from pldf.kernel.arrays import FloatArray, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.state import PldfState
from pldf.roads import Route, route_arrays

from faults.car_ahead import machine_code
from faults.experiment import Counts, Experiment, Progress
from faults.watched_follow import Cars, Watched
from vehicle_models.vehicle_state import VehicleState

STEP_S: Final = 0.02
CARS: Final = 10
TIME_GAP_S: Final = 1.8
STANDSTILL_M: Final = 3.0
SETTLED_S: Final = 40.0
WATCHED_S: Final = 160.0
LIMIT_MPS: Final = 130.0 / 3.6
AMPLIFIED: Final = 1.01  # of the peak, and of its share that numbers are rounded to
ROUNDED_MPS: Final = 0.005


def disturbed(rng: np.random.Generator) -> tuple[FloatArray, float]:
    """Return the speed of the first car per step, and the speed it is disturbed around."""
    steps = round((SETTLED_S + WATCHED_S) / STEP_S)
    t = np.maximum(np.arange(steps) * STEP_S - SETTLED_S, 0.0)
    speed = rng.uniform(12.0, 28.0)
    if rng.random() < 0.7:
        frequency = 0.02 * 25.0 ** rng.random()
        # No car accelerates harder than 2 m/s2 or slows down more than following may.
        amplitude = min(rng.uniform(0.3, 3.0), 1.5 / (2.0 * np.pi * frequency))
        fade = np.clip(t * frequency, 0.0, 1.0)
        return speed + fade * amplitude * np.sin(2.0 * np.pi * frequency * t), speed
    drop, held = rng.uniform(1.0, 8.0), rng.uniform(1.0, 15.0)
    slow_s, fast_s = drop / rng.uniform(0.5, 2.5), drop / rng.uniform(0.5, 1.5)
    at = np.array([0.0, slow_s, slow_s + held, slow_s + held + fast_s])
    return speed - np.interp(t, at, [0.0, drop, drop, 0.0]), speed


def straight(length_m: float) -> tuple[RouteArrays, ProfileArrays]:
    """Return a long straight road and the base profile on it."""
    level, s_m = np.zeros(2), np.array([0.0, length_m])
    route = Route("straight", s_m, level, level + LIMIT_MPS, level, s_m, level)
    arrays = RouteArrays(*(np.array(column) for column in route_arrays(route)))
    base = zeros(ProfileArrays, len(arrays.limit_mps))
    nodes = len(arrays.limit_mps)
    machine_code()["plan_base"](pack(PldfState())[0], arrays, base, zeros(Work, nodes))
    return arrays, base


def follower(lead: FloatArray, road: tuple[RouteArrays, ProfileArrays]) -> tuple[FloatArray, float]:
    """Return the speed of a car behind ``lead`` per step, and the smallest gap (m)."""
    route, base = road
    blank = np.zeros(len(lead))
    cars = Cars(np.ones(len(lead)), lead, blank.copy(), blank, blank)
    cars.new_gap_m[0] = STANDSTILL_M + TIME_GAP_S * lead[0]
    record: Any = PldfState(mode=2, following_desired_time_gap_s=TIME_GAP_S)
    models = pack(VehicleState(start_speed_mps=float(lead[0])))[0], pack(record)[0]
    watched = zeros(Watched, len(lead))
    profile = ProfileArrays(*(np.array(column) for column in base))
    trace = zeros(TraceArrays, len(route.limit_mps))
    made = machine_code()["watch_follow"](models, route, (profile, trace), cars, watched, STEP_S)
    if made < len(lead):
        return np.asarray(watched.speed_mps)[:made], 0.0
    return np.asarray(watched.speed_mps), float(np.asarray(watched.gap_m).min())


def drive_platoon(
    rng: np.random.Generator, road: tuple[RouteArrays, ProfileArrays]
) -> tuple[list[float], float]:
    """Return the largest deviation of each car, the first one's first, and the smallest gap."""
    lead, steady = disturbed(rng)
    begin = round(SETTLED_S / STEP_S)
    peaks, least = [float(np.abs(lead[begin:] - steady).max())], np.inf
    for _ in range(CARS):
        lead, gap = follower(lead, road)
        if gap <= 0.0:
            return [*peaks, np.inf], 0.0
        least = min(least, gap)
        peaks.append(float(np.abs(lead[begin:] - steady).max()))
    return peaks, least


def drive_platoons(rounds: int, seed: int, progress: Progress) -> Counts:
    """Disturb ``rounds`` platoons."""
    rng = np.random.default_rng(seed)
    road = straight(7000.0)
    counts: Counts = {"platoons": 0, "largest_growth": 0.0, "violations": 0}
    for k in range(rounds):
        peaks, least = drive_platoon(rng, road)
        growth = max(after / peaks[0] for after in peaks[1:])
        counts["platoons"] += 1
        counts["largest_growth"] = max(counts["largest_growth"], round(growth, 4))
        grown = any(b > a * AMPLIFIED + ROUNDED_MPS for a, b in pairwise(peaks))
        counts["violations"] += int(grown or least <= 0.0)
        progress(k + 1)
    return counts


EXPERIMENTS = (
    Experiment(
        name="platoons",
        promise="At a time gap of 1.8 s no disturbance of 0.02 to 0.5 Hz grows from car to car in "
        "a platoon of ten.",
        run=drive_platoons,
        count=200,
        short=2,
    ),
)
