"""Cars ahead for tests: a lead with a speed of its own, and cars that follow one another."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from laboratory import Array, PointMass, function, road
from pldf.kernel.codes import ACTIVE
from pldf.roads import Route

STEP_S = 0.02
LAG_S = 0.2
STANDSTILL_M, TIME_GAP_S = 3.0, 1.8  # the desired gap: standstill + time gap * speed
LONG_ROAD = road(5000.0, ((0.0, 130.0 / 3.6),))


class Motion(NamedTuple):
    """What a car did, per sample."""

    time_s: Array
    gap_m: Array
    speed_mps: Array
    request_mps2: Array
    lead_mps: Array
    limits: Array
    take_over: Array


class Lead:
    """A car that accelerates as told, never backwards."""

    def __init__(self, s_m: float, speed_mps: float) -> None:
        self.s_m, self.speed_mps = s_m, speed_mps

    def step(self, acceleration_mps2: float, step_s: float = STEP_S) -> None:
        """Move on with this acceleration, down to a stop."""
        before = self.speed_mps
        self.speed_mps = max(before + acceleration_mps2 * step_s, 0.0)
        self.s_m += 0.5 * (before + self.speed_mps) * step_s


def desired_gap_m(speed_mps: float) -> float:
    return STANDSTILL_M + TIME_GAP_S * speed_mps


def follower(
    speed_mps: float, s_m: float = 0.0, route: Route = LONG_ROAD, **settings: float
) -> PointMass:
    """A car at ``s_m`` that drives steadily, with the function active."""
    car = PointMass(function(route, **settings), speed_mps, LAG_S)
    car.s_m = s_m
    car.step(0.001, lever_resume=1)
    car.made.record.lever_resume = 0
    assert car.made.record.mode == ACTIVE
    car.speed_mps, car.acceleration_mps2 = speed_mps, 0.0
    car.made.record.acceleration_request_mps2 = 0.0
    return car


def follow(
    car: PointMass,
    lead: Lead,
    seconds: float,
    acceleration_at: Callable[[float], float] = lambda _: 0.0,
    step_s: float = STEP_S,
    present: Callable[[float], bool] = lambda _: True,
    **inputs: float,
) -> Motion:
    """Let ``car`` follow ``lead``, whose acceleration is given over time; per step one row."""
    st = car.made.record
    rows = []
    for k in range(round(seconds / step_s)):
        t = k * step_s
        gap_m, lead_mps, speed_mps = lead.s_m - car.s_m, lead.speed_mps, car.speed_mps
        seen = {"lead_present": int(present(t)), "lead_gap_m": gap_m, "lead_speed_mps": lead_mps}
        car.step(step_s, **seen, **inputs)
        lead.step(acceleration_at(t), step_s)
        request = st.acceleration_request_mps2
        rows.append((t, gap_m, speed_mps, request, lead_mps, st.following_limits, st.hmi_take_over))
    return Motion(*np.array(rows).T)


def platoon(
    speed_at: Callable[[float], float],
    seconds: float,
    cars: int = 10,
    lags_s: tuple[float, ...] = (LAG_S,),
    step_s: float = STEP_S,
    **settings: float,
) -> Array:
    """Speeds of a lead and ``cars`` behind it, one row per sample; all begin at the desired gap."""
    start_mps = speed_at(0.0)
    places = [1000.0 - (k + 1) * desired_gap_m(start_mps) for k in range(cars)]
    tail = [follower(start_mps, s_m, **settings) for s_m in places]
    for k, car in enumerate(tail):
        car.lag_s = lags_s[k % len(lags_s)]
    lead = Lead(1000.0, start_mps)
    rows = []
    for k in range(round(seconds / step_s)):
        t = k * step_s
        rows.append([lead.speed_mps, *(car.speed_mps for car in tail)])
        ahead = [lead, *tail[:-1]]
        seen = [(a.s_m - car.s_m, a.speed_mps) for a, car in zip(ahead, tail, strict=True)]
        for car, (gap_m, lead_mps) in zip(tail, seen, strict=True):
            car.step(step_s, lead_present=1, lead_gap_m=gap_m, lead_speed_mps=lead_mps)
        lead.step((speed_at(t + step_s) - lead.speed_mps) / step_s, step_s)
    return np.array(rows)
