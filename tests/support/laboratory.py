"""What tests share: roads, a function on them, recordings, a point mass, files of a folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pldf.function import DrivingFunction
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE, STANDBY
from pldf.kernel.replay import Samples, replay
from pldf.kernel.signals import signals_of
from pldf.profiles.stored_profile import Iteration, StoredProfile
from pldf.roads import Route, fingerprint

KMH = 1.0 / 3.6
STEP_S = 0.01
BASE = 100.0 * KMH  # profile of a road without signs and curves

Array = NDArray[np.float64]
Span = tuple[float, float]


def files(folder: Path) -> dict[str, bytes]:
    """All files below a folder, by their place in it."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def road(
    length_m: float,
    limits: Sequence[Span] = ((0.0, 100.0 * KMH),),
    curves: Iterable[tuple[float, float, float]] = (),
) -> Route:
    """A level road along x: ``limits`` are (from m, m/s), ``curves`` (from m, to m, 1/m)."""
    bends = [knot for a, b, k in curves for knot in ((a, 0.0), (a, k), (b, k), (b, 0.0))]
    signs = [at for at, _ in limits if all(at != s for s, _ in bends)]
    knots = [(0.0, 0.0)] if not any(s == 0.0 for s, _ in bends) and 0.0 not in signs else []
    knots += bends
    for at in (*signs, length_m):
        inside = [k for a, b, k in curves if a < at < b]
        if all(at != s for s, _ in knots):
            knots.append((at, inside[0] if inside else 0.0))
    knots.sort(key=lambda knot: knot[0])
    s_m = np.array([s for s, _ in knots])
    at = np.array([s for s, _ in limits])
    limit = np.array([v for _, v in limits])[np.searchsorted(at, s_m, side="right") - 1]
    curvature = np.array([k for _, k in knots])
    return Route("test road", s_m, curvature, limit, 0.0 * s_m, s_m, 0.0 * s_m)


def function(route: Route, stored: StoredProfile | None = None, **settings: Any) -> DrivingFunction:
    """A driving function at the start of a drive, on its base profile or on ``stored``."""
    made = DrivingFunction()
    for name, value in settings.items():
        assert hasattr(made.record, name)
        setattr(made.record, name, value)
    made.prepare(route)
    made.follow(stored or StoredProfile(0, fingerprint(route), np.array(made.profile.base_mps)))
    made.refresh()
    return made


def plain(made: DrivingFunction) -> DrivingFunction:
    """Switch off what follows the mean of eq. (3): no smoothing, no cross-fade, no jerk bound."""
    made.record.learning_smoothing_window_m = 1
    made.record.learning_fade_m = 0
    made.record.learning_jerk_max_mps3 = 0.0
    return made


def after(made: DrivingFunction, iteration: Iteration) -> StoredProfile:
    """What is stored when ``iteration`` has been added to what ``made`` started from."""
    assert made.stored is not None
    return replace(made.stored, iterations=(*made.stored.iterations, iteration))


def outcomes(made: DrivingFunction) -> Array:
    """What the last lesson made of each pedal intervention."""
    return np.array(made.following.outcome)[: made.record.drive_interventions]


def within(s_m: Array, spans: Iterable[Span]) -> NDArray[np.bool_]:
    """True where a position lies in one of the half-open spans."""
    inside = np.zeros(len(s_m), dtype=bool)
    for a, b in spans:
        inside |= (a <= s_m) & (s_m < b)
    return inside


def travel_times(s_m: Array, speed_mps: Array) -> Array:
    """Times of constant acceleration from position to position."""
    steps = 2.0 * np.diff(s_m) / (speed_mps[1:] + speed_mps[:-1])
    return np.concatenate(([0.0], np.cumsum(steps)))


def play(made: DrivingFunction, s_m: Array, speed_mps: Array, **columns: Any) -> None:
    """Feed a recording to the function: scalars or arrays; ``time_s`` follows from the speed."""
    s_m = np.asarray(s_m, dtype=np.float64)
    speed_mps = np.broadcast_to(np.asarray(speed_mps, dtype=np.float64), s_m.shape)
    table = {name: 0.0 for name in Samples._fields}
    table |= {"mode": float(ACTIVE), "eligible": 1.0, "s_m": s_m, "speed_mps": speed_mps}
    if "time_s" not in columns:
        table["time_s"] = travel_times(s_m, speed_mps)
    assert columns.keys() <= table.keys()
    filled = [np.zeros(len(s_m)) + {**table, **columns}[name] for name in Samples._fields]
    replay(made.record, made.route, made.trace, Samples(*map(memoryview, filled)))  # type: ignore[arg-type]


def play_override(
    made: DrivingFunction,
    speed_at: Callable[[Array], Array] | float,
    gas: Iterable[Span] = (),
    brake: Iterable[Span] = (),
    **columns: Any,
) -> None:
    """Drive the whole road, one sample per half metre, with pedal interventions between places."""
    s_m = np.arange(0.0, len(made.route.limit_mps) - 0.75, 0.5)
    speed = speed_at(s_m) if callable(speed_at) else np.full(len(s_m), speed_at)
    braked = within(s_m, brake)
    mode = np.where(within(s_m, gas), GAS_OVERRIDE, np.where(braked, STANDBY, ACTIVE))
    play(made, s_m, speed, mode=mode, brake_pedal=0.3 * braked, **columns)


def bent(*points: Span) -> Callable[[Array], Array]:
    """Speed over position: straight lines between (m, m/s)."""
    places, speeds = zip(*points, strict=True)
    return lambda s_m: np.interp(s_m, places, speeds)


def changed(made: DrivingFunction, learned: Array) -> Array:
    return np.flatnonzero(learned != np.array(made.profile.learned_mps))


def override(speed_mps: float, first: float, last: float, **settings_: float) -> DrivingFunction:
    """2 km at 100 km/h, with gas from ``first`` to ``last`` at another speed."""
    made = function(road(2000.0), **settings_)
    speed = bent((0, BASE), (first, BASE), (first + 1, speed_mps), (last, speed_mps),
                 (last + 1, BASE), (2000, BASE))  # fmt: skip
    play_override(made, speed, gas=[(first, last)])
    return made


class PointMass:
    """A car that accelerates as requested, after a first-order lag; brake wins over gas."""

    def __init__(self, made: DrivingFunction, speed_mps: float = 20.0, lag_s: float = 0.0) -> None:
        self.made, self.lag_s = made, lag_s
        self.s_m, self.speed_mps, self.acceleration_mps2 = 0.0, speed_mps, 0.0

    def step(self, step_s: float = STEP_S, **inputs: float) -> None:
        """One communication step: the function first, then the car; ``inputs`` hold on."""
        st = self.made.record
        st.vehicle_s_m, st.vehicle_speed_mps = self.s_m, self.speed_mps
        st.vehicle_acceleration_mps2 = self.acceleration_mps2
        for name, value in inputs.items():
            assert hasattr(st, name)
            setattr(st, name, value)
        self.made.step(step_s)
        wanted = st.acceleration_request_mps2 if st.function_active else 0.0
        wanted += 3.0 * min(max(0.0, st.driver_gas_pedal), 1.0)  # a broken pedal is no pedal
        if st.driver_brake_pedal > st.control_pedal_threshold:
            wanted = -8.0 * min(st.driver_brake_pedal, 1.0)
        share = 1.0 if self.lag_s == 0.0 else min(step_s / self.lag_s, 1.0)
        self.acceleration_mps2 += share * (wanted - self.acceleration_mps2)
        before = self.speed_mps
        self.speed_mps = max(before + self.acceleration_mps2 * step_s, 0.0)
        if self.speed_mps == 0.0:
            self.acceleration_mps2 = 0.0
        self.s_m += 0.5 * (before + self.speed_mps) * step_s

    def run(self, seconds: float, step_s: float = STEP_S, **inputs: float) -> None:
        """Many steps with the same inputs."""
        for _ in range(round(seconds / step_s)):
            self.step(step_s, **inputs)

    def tip(self, lever: str) -> None:
        """Close one lever contact for 100 ms, then leave it alone for 100 ms."""
        self.run(0.1, **{lever: 1})
        self.run(0.1, **{lever: 0})


def driving(route: Route, speed_mps: float = 20.0, **settings: Any) -> PointMass:
    """A point mass with the function active on ``route``."""
    car = PointMass(function(route, **settings), speed_mps)
    car.tip("lever_resume")
    assert car.made.record.mode == ACTIVE
    return car


def assert_sound(made: DrivingFunction) -> None:
    """Every output and every recorded or stored number is finite."""
    for signal in signals_of(made.record):
        if signal.causality == "output":
            assert isfinite(getattr(made.record, signal.field)), signal.name
    for array in made.arrays:
        assert np.all(np.isfinite(array))
