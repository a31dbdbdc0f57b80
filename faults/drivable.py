"""Learned profiles that can be driven: random lessons on random roads (algorithm, section 3.8)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from laboratory import KMH, Array, after, bent, function, play_override, road
from pldf.function import DrivingFunction
from pldf.kernel.arrays import FloatArray
from pldf.kernel.bounds import keep_bounds
from pldf.profiles.stored_profile import Iteration
from pldf.roads import Route

from faults.experiment import Counts, Experiment, Progress

JERK_MAX_MPS3: Final = 2.0
LATERAL_MAX_MPS2: Final = 4.0
OVER_LIMIT_MPS: Final = 20.0 * KMH
DRIVES: Final = 3
WINDOW_S: Final = 0.5

Speed = Callable[[Array], Array]


def random_road(rng: np.random.Generator) -> Route:
    """0.6 to 1.5 km with signs of 30 to 130 km/h and curves down to a radius of 30 m."""
    length = float(rng.integers(600, 1500))
    signs = np.sort(rng.choice(np.arange(100, int(length) - 50), rng.integers(0, 4), False))
    limits = [(float(at), float(rng.integers(3, 14)) * 10.0 * KMH) for at in (0, *signs)]
    curves, at = [], 50.0
    while rng.random() < 0.7 and at < length - 150.0:
        begin = at + float(rng.integers(1, 200))
        end = min(begin + float(rng.integers(10, 200)), length - 20.0)
        if begin < end - 5.0:
            curves.append((begin, end, float(10.0 ** rng.uniform(-3.0, -1.5))))
        at = end + 1.0
    taken = {0.0, *(edge for a, b, _ in curves for edge in (a, b))}
    return road(length, limits[:1] + [x for x in limits[1:] if x[0] not in taken], curves)


def random_drive(rng: np.random.Generator, made: DrivingFunction, offsets: bool) -> None:
    """Drive the profile, but for one to four places where the driver wants something else."""
    n = len(made.route.limit_mps)
    profile = np.array(made.profile.learned_mps)
    gas, brake = [], []
    speed = profile.copy()
    for _ in range(rng.integers(1, 5)):
        a = float(rng.integers(0, n - 30))
        b = min(a + float(rng.integers(5, 300)), n - 2.0)
        inside = np.arange(int(a), int(b) + 1)
        knots = np.sort(rng.uniform(a, b, 4))
        change = rng.uniform(-8.0, 8.0) + rng.uniform(-3.0, 3.0, 4)
        speed[inside] = np.maximum(profile[inside] + np.interp(inside, knots, change), 1.0)
        (gas if change.mean() > 0.0 else brake).append((a, b))
    columns = _set_speeds(rng, made) if offsets else {}
    play_override(made, bent(*enumerate(speed)), gas, brake, **columns)


def _set_speeds(rng: np.random.Generator, made: DrivingFunction) -> dict[str, Array]:
    """Return what the lever set, per half metre: a new set speed from one place to another."""
    n = len(made.route.limit_mps)
    s_m = np.arange(0.0, n - 0.75, 0.5)
    limit = np.array(made.route.limit_mps)[s_m.astype(int)]
    automatic = limit + np.array(made.profile.offset_mps)[s_m.astype(int)]
    a, b = np.sort(rng.uniform(0.0, n, 2))
    wish = np.maximum(limit + float(rng.integers(-3, 5)) * 5.0 * KMH, 20.0 * KMH)
    wish = np.where((s_m >= a) & (s_m < b), wish, automatic)
    return {"set_speed_mps": wish, "set_speed_offset_mps": wish - automatic}


def second_differences(speed: FloatArray) -> FloatArray:
    """Return that of the squares at the inner nodes, in m2/s2 per m2; at the ends 0."""
    return np.pad(np.diff(speed * speed, 2), 1)


def jerk(speed: FloatArray) -> FloatArray:
    """Return the jerk at each node of following ``speed`` exactly, in m/s3."""
    result: FloatArray = 0.5 * speed * np.abs(second_differences(speed))
    return result


def jerk_over_time(speed: FloatArray) -> FloatArray:
    """Return the change of acceleration over half a second, per second, along the profile."""
    acceleration = 0.5 * np.diff(speed * speed)
    begin_s = np.concatenate(([0.0], np.cumsum(2.0 / (speed[1:] + speed[:-1]))))
    at_s = np.arange(0.0, begin_s[-1], 0.02)
    steps = round(WINDOW_S / 0.02)
    # Between the middles of the cells, since one at 3 m/s takes 0.3 s.
    a = np.interp(at_s, 0.5 * (begin_s[1:] + begin_s[:-1]), acceleration)
    result: FloatArray = np.abs(a[steps:] - a[:-steps]) / WINDOW_S
    return result


def touched(taught: Any) -> Any:
    """Return for each node whether its second difference involves a node that is ``taught``."""
    wide = np.pad(taught, 1)
    return wide[:-2] | wide[1:-1] | wide[2:]


def over_caps(made: DrivingFunction, speed: FloatArray) -> bool:
    """Tell whether a cell is passed faster than its curve or its limit allows."""
    fastest = np.maximum(speed[1:], speed[:-1])
    curvature, limit = np.array(made.route.curvature_per_m), np.array(made.route.limit_mps)
    lateral = fastest * fastest * curvature[:-1] > LATERAL_MAX_MPS2 * (1.0 + 1e-9)
    return bool(np.any(lateral | (fastest > (limit[:-1] + OVER_LIMIT_MPS) * (1.0 + 1e-12))))


def bounded_again(made: DrivingFunction, learned: FloatArray, taught: Any) -> FloatArray:
    """Return ``learned`` after section 3.8 once more, on the same segments."""
    speed, bound = learned.copy(), np.zeros(len(learned))
    np.asarray(made.work.b)[:] = taught
    columns: Any = (memoryview(speed), memoryview(bound))
    keep_bounds(made.record, made.route, *columns, made.work)
    return speed


def judge(made: DrivingFunction, iteration: Iteration, following: DrivingFunction) -> Counts:
    """Return what is wrong with what ``made`` learned, 0 or 1 each, and the largest jerk."""
    learned, driven = iteration.learned_mps, np.array(made.profile.learned_mps)
    here = iteration.drive == float(iteration.number)
    demanded = float(jerk(learned)[touched(here)].max(initial=0.0))
    return {
        "largest_jerk_mps3": demanded,
        "too_much_jerk": demanded > JERK_MAX_MPS3 * (1.0 + 1e-3),
        "changed_elsewhere": bool(np.any(learned[~here] != driven[~here])),
        "over_caps": over_caps(made, learned),
        "not_followed_as_stored": not np.array_equal(following.profile.learned_mps, learned),
        "not_idempotent": not np.array_equal(bounded_again(made, learned, here), learned),
    }


def learn_randomly(rounds: int, seed: int, progress: Progress) -> Counts:
    """Three drives with random lessons on each of ``rounds`` random roads."""
    rng = np.random.default_rng(seed)
    counts: Counts = {"profiles": 0, "violations": 0}
    for i in range(rounds):
        route = random_road(rng)
        made = function(route)
        for _ in range(DRIVES):
            random_drive(rng, made, offsets=bool(rng.random() < 0.3))
            iteration = made.learn()
            following = function(route, after(made, iteration))
            _add(counts, judge(made, iteration, following))
            made = following
        progress(i + 1)
    return counts


def _add(counts: Counts, judged: Counts) -> None:
    counts["profiles"] += 1
    for name, value in judged.items():
        if name.startswith("largest"):
            counts[name] = max(counts.get(name, 0.0), round(float(value), 4))
        else:
            counts[name] = counts.get(name, 0) + int(value)
            counts["violations"] += int(value)


EXPERIMENTS = (
    Experiment(
        name="drivable_profiles",
        promise=(
            "Where a drive taught, following the learned profile demands at most 2.0 m/s3 and "
            "keeps its caps; elsewhere nothing changes; it is followed as stored, to the bit."
        ),
        run=learn_randomly,
        count=300,
        short=3,
    ),
)
