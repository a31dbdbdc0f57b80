"""Cars ahead that brake, stop, cut in and vanish: is contact ever made that was promised away?

The judge knows the sentence of section 8 and nothing of the kernel: a state is promised if a
request that falls at 2.5 m/s3 to -3.5 m/s2, with the vehicle's lag, stops behind a car that brakes
with 3.5 m/s2. That is tried step by step, not derived.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pldf.compiled import Namespace, compile_modules, pack
from pldf.instance import zeros
from pldf.kernel.arrays import FloatArray, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.codes import ACTIVE, STANDBY
from pldf.kernel.state import PldfState
from pldf.roads import Route, route_arrays
from pldf.study.simulation import car_code

from faults import watched_drive, watched_follow
from faults.experiment import Counts, Experiment, Progress
from faults.hard_roads import hard_road
from faults.watched_follow import Cars, Watched
from vehicle_models.vehicle_state import VehicleState

KMH: Final = 1.0 / 3.6
STEP_S: Final = 0.05
STEPS: Final = 800
TOGETHER: Final = 100  # drives per road; their cars are simulated together
ROADS: Final = 24
STRAIGHT_KMH: Final = (50.0, 80.0, 100.0, 130.0)  # of the first roads; the others are hard
PROMISED_M: Final = 0.5  # spare room from which a state is promised without doubt
LOST_M: Final = -0.25  # and from which it is without doubt not
CAUTION_S: Final = 0.2  # the function may take the car for as much later than it is
CAUTION_M: Final = 1.0  # and for as much longer
LEAD_BRAKES_MPS2: Final = -3.5
REQUEST: Final = (-3.5, 2.0)
JERK_MPS3: Final = 2.5


class Road(NamedTuple):
    """A road for the kernel and the base profile on it."""

    arrays: RouteArrays
    base: ProfileArrays


@cache
def machine_code() -> Namespace:
    """Return the compiled functions of the function, the vehicle, the drive and the judge."""
    called = car_code()
    return {**called, **compile_modules((watched_drive, watched_follow), called, inline=True)}


@cache
def blank_records() -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return a vehicle and a function in standby, packed."""
    return pack(VehicleState()), pack(PldfState(mode=STANDBY))


@cache
def road(number: int) -> Road:
    """Return road ``number``: straight ones first, then those that are hard."""
    if number < len(STRAIGHT_KMH):
        level, s_m = np.zeros(2), np.array([0.0, 3000.0])
        limit = level + STRAIGHT_KMH[number] * KMH
        route = Route("straight", s_m, level, limit, level, s_m, level)
    else:
        route = hard_road(number)
    arrays = RouteArrays(*(np.array(column) for column in route_arrays(route)))
    nodes = len(arrays.limit_mps)
    base = zeros(ProfileArrays, nodes)
    machine_code()["plan_base"](pack(PldfState())[0], arrays, base, zeros(Work, nodes))
    return Road(arrays, base)


def simulated_cars(rng: np.random.Generator, number: int) -> FloatArray:
    """Return the speeds (m/s) of so many cars per step: each wants something else now and then.

    They brake with up to 6 m/s2, stop, stand, go on, and their acceleration changes by a jerk.
    """
    part = np.cumsum(rng.random((number, STEPS)) < STEP_S / rng.uniform(2.0, 15.0, (number, 1)), 1)
    part = np.minimum(part, 19)
    rows = np.arange(number)[:, None]
    wanted = np.maximum(rng.uniform(-12.0, 36.0, (number, 20)), 0.0)[rows, part]
    brakes = rng.choice([0.7, 1.5, 2.0, 3.0, 3.5, 3.5, 6.0], (number, 20))[rows, part]
    gathers = rng.uniform(0.5, 2.5, (number, 20))[rows, part]
    change = STEP_S * rng.uniform(3.0, 30.0, number)
    speed, acceleration = wanted[:, 0].copy(), np.zeros(number)
    speeds = np.zeros((number, STEPS))
    for k in range(STEPS):
        speeds[:, k] = speed
        aim = np.clip(2.0 * (wanted[:, k] - speed), -brakes[:, k], gathers[:, k])
        acceleration += np.clip(aim - acceleration, -change, change)
        slower = np.maximum(speed + acceleration * STEP_S, 0.0)
        acceleration = np.where(slower > 0.0, acceleration, 0.0)
        speed = slower
    return speeds


def drawn_cars(rng: np.random.Generator, speeds: FloatArray) -> Cars:
    """Return one car after the other ahead: rows of ``speeds`` that cut in, vanish, are lost."""
    cars = Cars(np.ones(STEPS), speeds[0].copy(), *np.zeros((3, STEPS)))
    cars.new_gap_m[0] = rng.uniform(3.0, 150.0)
    for other in speeds[1:]:
        at = int(rng.integers(20, STEPS))
        if rng.random() < 0.5:
            cars.speed_mps[at:] = other[at:]
            cars.new_gap_m[at] = rng.uniform(2.0, 90.0)
        else:
            gone = 10 if rng.random() < 0.5 else int(rng.integers(1, 200))
            cars.present[at : at + gone] = 0.0
    for _ in range(int(rng.integers(0, 3)) if rng.random() < 0.3 else 0):
        at, held = int(rng.integers(0, STEPS)), int(rng.integers(5, 60))
        cars.gas[at : at + held] = rng.uniform(0.1, 0.8)
    for at in rng.integers(0, STEPS, int(rng.integers(0, 6))):
        cars.tip[at : at + 3] = rng.integers(1, 4)
    return cars


def drive_behind(number: int, rng: np.random.Generator, cars: Cars) -> tuple[Watched, Any]:
    """Drive behind ``cars`` on road ``number``; return what was seen, and the vehicle."""
    code, where = machine_code(), road(number)
    base = where.base
    speed = float(np.asarray(base.base_mps)[0]) * rng.uniform(0.2, 1.0)
    vehicle, st = (record.copy() for record in blank_records())
    st["following_desired_time_gap_s"] = rng.uniform(0.8, 3.0)
    vehicle["start_speed_mps"], vehicle["start_s_m"] = speed, rng.uniform(0.0, 300.0)
    trace, watched = zeros(TraceArrays, len(base.base_mps)), zeros(Watched, STEPS)
    models = (vehicle[0], st[0])
    made = code["watch_follow"](models, where.arrays, (base, trace), cars, watched, STEP_S)
    return Watched(*(np.asarray(column)[:made] for column in watched)), vehicle[0]


def judge(cars: Cars, watched: Watched, lag_s: float) -> Counts:
    """Count what was promised and what was broken in one drive."""
    seen = Watched(*(np.asarray(column) for column in watched))
    steps = len(seen.s_m)
    lead = np.asarray(cars.speed_mps)[:steps]
    spare = np.zeros(steps)
    machine_code()["judge_gaps"](seen, lead, spare, (STEP_S, lag_s))
    behind = (np.asarray(cars.present)[:steps] > 0.0) & (seen.next_mode == ACTIVE)
    told = seen.take_over > 0.0
    change = np.abs(seen.next_request_mps2 - seen.request_mps2)
    contact = bool(steps and np.asarray(cars.present)[steps - 1] > 0.0 and seen.gap_m[-1] <= 0.0)
    active_contact = contact and bool(seen.next_mode[-1] == ACTIVE)
    return {
        "drives": 1,
        "steps_behind": float(np.sum(behind)),
        "steps_not_promised": float(np.sum(behind & (spare < LOST_M))),
        "steps_taken_over": float(np.sum(behind & told)),
        "contacts": float(contact),
        "contacts_promised_away": float(active_contact and was_promised(cars, seen, spare)),
        "not_told_to_take_over": events(behind & (spare < LOST_M) & ~told),
        "told_without_need": events(behind & told & _plenty(seen, lead, lag_s, behind & told)),
        "told_without_a_car": events(~(np.asarray(cars.present)[:steps] > 0.0) & told),
        "request_jumps": events(change > JERK_MPS3 * STEP_S * (1.0 + 1e-9)),
        "request_beyond": events(
            (seen.next_request_mps2 < REQUEST[0]) | (seen.next_request_mps2 > REQUEST[1])
        ),
    }


def was_promised(cars: Cars, seen: Watched, spare: FloatArray) -> bool:
    """Tell whether the contact at the end follows on a state from which none was promised.

    The promise ends when another car cuts in, the driver drives, or the car ahead brakes harder.
    """
    steps = len(spare)
    lead = np.asarray(cars.speed_mps)[:steps]
    brakes = np.concatenate((np.diff(lead) / STEP_S < LEAD_BRAKES_MPS2 - 0.05, [False]))
    over = brakes | (np.asarray(seen.next_mode) != ACTIVE)
    came = (np.asarray(cars.new_gap_m)[:steps] > 0.0) | (np.asarray(cars.present)[:steps] == 0.0)
    ends = np.flatnonzero(over)
    begin = max(int(ends[-1]) + 1 if len(ends) else 0, *np.flatnonzero(came)[-1:], 0)
    return bool(np.any(spare[begin:] > PROMISED_M))


def _plenty(
    seen: Watched, lead: FloatArray, lag_s: float, where: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Tell where even a cautious judge finds room: the driver was called for nothing."""
    spare = np.zeros(len(lead))
    at = np.flatnonzero(where)
    part = Watched(*(np.ascontiguousarray(np.asarray(column)[at]) for column in seen))
    found = np.zeros(len(at))
    machine_code()["judge_gaps"](part, lead[at], found, (STEP_S, lag_s + CAUTION_S))
    spare[at] = found
    return spare > CAUTION_M


def events(broken: NDArray[np.bool_]) -> float:
    """Return how often something began."""
    return float(np.sum(broken[1:] & ~broken[:-1]) + broken[0]) if len(broken) else 0.0


def follow_cars(rounds: int, seed: int, progress: Progress) -> Counts:
    """Drive ``rounds`` times ``TOGETHER`` drives behind cars of their own."""
    rng = np.random.default_rng(seed)
    total: Counts = {}
    for number in range(rounds):
        others = rng.integers(0, 5, TOGETHER)
        speeds = np.split(simulated_cars(rng, int(others.sum()) + TOGETHER), np.cumsum(others + 1))
        for own in speeds[:TOGETHER]:
            cars = drawn_cars(rng, own)
            watched, vehicle = drive_behind(int(rng.integers(ROADS)), rng, cars)
            for name, value in judge(cars, watched, float(vehicle["body_brake_lag_s"])).items():
                total[name] = total.get(name, 0.0) + value
        progress(number + 1)
    broken = ("contacts_promised_away", "not_told_to_take_over", "told_without_need",
              "told_without_a_car", "request_jumps", "request_beyond")  # fmt: skip
    total["violations"] = sum(total[name] for name in broken)
    return total


EXPERIMENTS = (
    Experiment(
        name="cars_ahead",
        promise="Behind cars that brake, stop, cut in and vanish there is no contact where none "
        "is promised, elsewhere the driver is told in the same step, and requests stay smooth.",
        run=follow_cars,
        count=1000,
        short=1,
    ),
)
