"""Following what was learned: adversarial lessons on hard roads, judged with numbers of its own.

Nothing here asks the kernel what it thinks is safe: caps come from the road's knots, and whether
full braking could have saved the car is found out by braking fully.
"""

from __future__ import annotations

from functools import cache
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pldf.compiled import Namespace, compile_modules, pack
from pldf.instance import zeros
from pldf.kernel.arrays import FloatArray, NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.codes import LEARN_FAITHFUL
from pldf.kernel.state import PldfState
from pldf.roads import Route, route_arrays
from pldf.study.simulation import car_code

from faults import watched_drive
from faults.bad_lessons import bad_lesson, forged_profile
from faults.experiment import Counts, Experiment, Progress
from faults.hard_roads import hard_road
from faults.watched_drive import Lesson, Seen
from vehicle_models.vehicle_state import VehicleState

ROADS: Final = 20
DRIVES: Final = 10  # with a lesson each; after each a drive without hands
STEPS_S: Final = (0.01, 0.02, 0.05, 0.1)  # communication steps, one after the other
TIME_MAX_S: Final = 600.0
LATERAL_MPS2: Final = 4.0
LATERAL_SHARE: Final = 1.02
OVER_LIMIT_MPS: Final = 20.0 / 3.6
OVER_CAP_MPS: Final = 0.5 / 3.6
QUIET_S: Final = 3.0  # after activation and the driver's last input
RETRY_S: Final = 0.1  # how often a state that cannot be saved is looked at again
BRAKING_MPS2: Final = -3.5
JERK_MPS3: Final = 2.5


class Road(NamedTuple):
    """A road for the kernel, and its caps as the judge sees them, every 10 cm."""

    arrays: RouteArrays
    curvature_per_m: FloatArray
    limit_mps: FloatArray

    def at(self, values: FloatArray, s_m: NDArray[np.floating]) -> FloatArray:
        """Return ``values`` of the 10 cm that hold each position."""
        return np.asarray(values[np.minimum((10.0 * s_m).astype(int), len(values) - 1)])


@cache
def machine_code() -> Namespace:
    """Return the compiled functions of the function, the vehicle and the drive."""
    called = car_code()
    return {**called, **compile_modules((watched_drive,), called, inline=True)}


@cache
def road(seed: int) -> Road:
    """Return the hard road of this seed."""
    return road_of(hard_road(seed))


def road_of(route: Route) -> Road:
    """Return a route with its caps."""
    s_m = np.arange(0.0, route.length_m, 0.1)
    curvature = np.abs(np.interp(s_m + 0.05, route.s_m, route.curvature_per_m))
    signs = np.searchsorted(route.s_m, s_m + 0.05, side="right") - 1
    arrays = RouteArrays(*(np.array(column) for column in route_arrays(route)))
    return Road(arrays, curvature, route.speed_limit_mps[signs])


def follow(rounds: int, seed: int, progress: Progress) -> Counts:
    """Do ``rounds`` runs, each with the shipped vehicle and with one that answers twice as late."""
    total: Counts = {}
    for number in range(rounds):
        for slowness in (1.0, 2.0):
            run = Run(seed + number, slowness)
            for counts in run.drive_all():
                _add(total, counts)
        progress(number + 1)
    broken = ("lateral_violations", "speed_violations", "drives_unfinished")
    total["violations"] = sum(total[name] for name in broken)
    return total


def _add(total: Counts, counts: Counts) -> None:
    """Sum what is counted; of what is called largest keep the largest."""
    for name, value in counts.items():
        before = total.get(name, 0.0)
        total[name] = max(before, value) if name.startswith("largest") else before + value


class Run:
    """One driver on one road: ten bad lessons, each followed by a drive without hands."""

    def __init__(self, seed: int, slowness: float) -> None:
        self.rng = np.random.default_rng(seed)
        self.road = road(seed % ROADS)
        self.slowness = slowness
        self.step_s = STEPS_S[seed // ROADS % len(STEPS_S)]
        self.nodes = len(self.road.arrays.limit_mps)
        self.work = zeros(Work, self.nodes)
        self.base = zeros(ProfileArrays, self.nodes)
        machine_code()["plan_base"](pack(PldfState())[0], self.road.arrays, self.base, self.work)
        places = np.arange(self.nodes) + 0.5
        curvature = np.maximum(self.road.at(self.road.curvature_per_m, places), 1e-6)
        limit = self.road.at(self.road.limit_mps, places)
        self.caps = np.minimum(np.sqrt(LATERAL_MPS2 / curvature), limit + OVER_LIMIT_MPS)

    def drive_all(self) -> list[Counts]:
        """Return what was counted in every drive."""
        learned = ProfileArrays(*(np.array(column) for column in self.base))
        if self.rng.random() < 0.3:
            np.asarray(learned.learned_mps)[:] = forged_profile(self.rng, self.caps)
        counts = []
        wish, tips = bad_lesson(self.rng, self.caps)
        repeats = self.rng.random() < 0.5  # the same lesson again and again is learned best
        for number in range(DRIVES):
            if not repeats:
                wish, tips = bad_lesson(self.rng, self.caps)
            counts.append(self._drive(learned, Lesson(wish, tips), number))
            hands_off = Lesson(0.0 * wish, 0.0 * tips)
            counts.append(self._drive(learned, hands_off, number, learns=False))
        return counts

    def _drive(
        self, learned: ProfileArrays, lesson: Lesson, number: int, *, learns: bool = True
    ) -> Counts:
        """Drive once with ``learned``, put there what was learned; return what was counted."""
        code, route = machine_code(), self.road.arrays
        st = pack(PldfState(mode=1, learn=LEARN_FAITHFUL, profile_iteration=number))[0]
        profile = ProfileArrays(*(np.array(column) for column in self.base))
        for name in set(NextArrays._fields) & set(ProfileArrays._fields):
            getattr(profile, name)[:] = getattr(learned, name)
        code["adopt_learned"](st, route, profile, self.work)
        vehicle = VehicleState(start_speed_mps=float(self.base.base_mps[0]))
        vehicle.body_drive_lag_s *= self.slowness
        vehicle.body_brake_lag_s *= self.slowness
        trace, seen = zeros(TraceArrays, self.nodes), zeros(Seen, round(TIME_MAX_S / self.step_s))
        models = (pack(vehicle)[0], st)
        steps = code["watch_drive"](models, route, (profile, trace), lesson, seen, self.step_s)
        if learns:
            following = zeros(NextArrays, self.nodes)
            code["learn_drive"](st, route, profile, trace, self.work, following)
            for name in set(NextArrays._fields) & set(ProfileArrays._fields):
                getattr(learned, name)[:] = getattr(following, name)
        rows = Seen(*(np.asarray(column)[:steps] for column in seen))
        return judge(self.road, rows, vehicle.body_brake_lag_s, self.step_s)


def judge(where: Road, seen: Seen, lag_s: float, step_s: float) -> Counts:
    """Count what was promised and what was broken in one drive."""
    s_m, speed = np.asarray(seen.s_m), np.asarray(seen.speed_mps)
    counted = counted_steps(where, seen, lag_s, step_s)
    lateral = speed * speed * where.at(where.curvature_per_m, s_m)
    over = speed - where.at(where.limit_mps, s_m) - OVER_LIMIT_MPS
    over = np.where(np.asarray(seen.manual) > 0.0, -np.inf, over)
    quiet = np.asarray(seen.driver) == 0.0
    return {
        "drives": 1,
        "drives_unfinished": float(len(s_m) == round(TIME_MAX_S / step_s)),
        "active_steps": float(np.sum(quiet)),
        "counted_steps": float(np.sum(counted)),
        "largest_lateral_mps2": float(np.max(lateral, where=counted, initial=0.0)),
        "largest_over_cap_mps": float(np.max(over, where=counted, initial=-1e3)),
        "lateral_violations": events(counted & (lateral > LATERAL_MPS2 * LATERAL_SHARE)),
        "speed_violations": events(counted & (over > OVER_CAP_MPS)),
    }


def events(broken: NDArray[np.bool_]) -> float:
    """Return how often something began."""
    return float(np.sum(broken[1:] & ~broken[:-1]) + broken[0]) if len(broken) else 0.0


def counted_steps(where: Road, seen: Seen, lag_s: float, step_s: float) -> NDArray[np.bool_]:
    """Return in which steps the promise holds: ACTIVE, hands off, from a state that can be saved.

    A run of such steps begins 3 s after the driver's last input, or as soon after that as full
    braking would keep all caps ahead; it ends with the driver's next input.
    """
    busy = np.flatnonzero(np.asarray(seen.driver) > 0.0)
    counted = np.zeros(len(seen.s_m), dtype=bool)
    for begin, end in zip(busy, [*busy[1:], len(counted)], strict=True):
        first = int(begin) + round(QUIET_S / step_s)
        while first < end and not can_be_saved(where, seen, first, lag_s):
            first += round(RETRY_S / step_s)
        counted[first:end] = True
    return counted


def can_be_saved(where: Road, seen: Seen, k: int, lag_s: float) -> bool:
    """Tell whether full braking from step ``k`` on keeps all caps: tried, not derived."""
    t = np.arange(0.0, 16.0, 0.02)
    request = np.maximum(seen.request_mps2[k] - JERK_MPS3 * t, BRAKING_MPS2)
    # First-order lag: what the acceleration lacks of the request fades out, new lack comes in.
    ramp_s = (seen.request_mps2[k] - BRAKING_MPS2) / JERK_MPS3
    behind = (1.0 - np.exp(-t / lag_s)) - np.where(
        t > ramp_s, 1.0 - np.exp(-(t - ramp_s) / lag_s), 0.0
    )
    start = (seen.acceleration_mps2[k] - seen.request_mps2[k]) * np.exp(-t / lag_s)
    acceleration = request + JERK_MPS3 * lag_s * behind + start
    speed = np.maximum(seen.speed_mps[k] + 0.02 * (np.cumsum(acceleration) - acceleration), 0.0)
    speed = np.where(np.minimum.accumulate(speed) > 0.0, speed, 0.0)
    s_m = seen.s_m[k] + 0.02 * (np.cumsum(speed) - speed)
    # A set speed set by hand lifts the limit up to the next sign.
    limit = where.at(where.limit_mps, s_m)
    here = where.at(where.limit_mps, np.maximum(s_m[:1] - 1.0, 0.0))  # the kernel's signs: by metre
    by_hand = bool(seen.manual[k]) & (np.cumsum(limit != here) == 0)
    slow = by_hand | (speed <= limit + OVER_LIMIT_MPS)
    lateral = speed * speed * where.at(where.curvature_per_m, s_m)
    return bool(np.all(slow & (lateral <= LATERAL_MPS2)))


EXPERIMENTS = (
    Experiment(
        name="following_bad_lessons",
        promise="In ACTIVE the car keeps 4.0 m/s2 lateral (+2 %) and its speed cap (+0.5 km/h) "
        "wherever full braking can, and it arrives, whatever was learned or stored.",
        run=follow,
        count=300,
        short=1,
    ),
)
