"""Times of the kernel: base profile and learning by route length, and the driving step."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable
from time import perf_counter
from typing import Any, Final

import numpy as np
import step_loop
from numpy.typing import NDArray
from pldf.compiled import KERNEL_MODULES, compile_modules, kernel, pack
from pldf.function import DrivingFunction
from pldf.instance import zeros
from pldf.kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.state import PldfState
from pldf.roads import packed_route, route_arrays

STUDY_KM: Final = 4.5
REPEATS: Final = 5
STEPS: Final = 20_000


def median_s(call: Callable[[], object]) -> float:
    """Return the median wall time of ``call`` over REPEATS runs, after one that does not count."""
    call()
    times = []
    for _ in range(REPEATS):
        start = perf_counter()
        call()
        times.append(perf_counter() - start)
    return sorted(times)[REPEATS // 2]


def long_route(length_km: float) -> RouteArrays:
    """Return the study road, repeated to ``length_km``."""
    one = route_arrays(packed_route(0))
    nodes = int(1000 * length_km) + 1
    return RouteArrays(*(np.resize(np.asarray(column)[:-1], nodes) for column in one))


def driven(route: RouteArrays) -> tuple[Any, ...]:
    """Return state and arrays after a drive 2 m/s above the profile, with gas now and then."""
    nodes = len(route.limit_mps)
    st = pack(PldfState())
    profile, trace = zeros(ProfileArrays, nodes), zeros(TraceArrays, nodes)
    work, following = zeros(Work, nodes), zeros(NextArrays, nodes)
    kernel()["plan_base"](st[0], route, profile, work)
    trace.speed_mps[:] = np.asarray(profile.base_mps)
    trace.time_s[:] = np.concatenate(([0.0], np.cumsum(1.0 / np.asarray(profile.base_mps)[1:])))
    trace.eligible[:] = 1.0
    starts = np.arange(300.0, nodes - 100.0, 600.0)
    for number, start in enumerate(starts):
        trace.start_m[number], trace.end_m[number] = start, start + 60.0
        np.asarray(trace.speed_mps)[int(start) : int(start) + 60] += 2.0
    st[0]["nodes"], st[0]["drive_interventions"] = nodes, len(starts)
    return st, profile, trace, work, following


def plan_and_learn(length_km: float) -> dict[str, float]:
    """Return seconds for base profile and learning on a route of ``length_km``."""
    route = long_route(length_km)
    st, profile, trace, work, following = driven(route)
    functions = kernel()
    road = (route.limit_mps, np.zeros(len(route.limit_mps)), route.curvature_per_m)
    return {
        "length_km": length_km,
        "base_profile_s": median_s(lambda: functions["plan"](st[0], road, profile.base_mps, work)),
        "learning_s": median_s(
            lambda: functions["learn_drive"](st[0], route, profile, trace, work, following)
        ),
    }


def peak_memory_mb(length_km: float) -> float:
    """Return the peak memory of a process that plans and learns on ``length_km``, in MB."""
    command = [sys.executable, __file__, str(length_km)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def toppra_s() -> float:
    """Return the median time that toppra needs for the study road on the same 1 m grid."""
    import toppra  # noqa: PLC0415 - a benchmark's peer, slow to import
    from toppra import algorithm, constraint  # noqa: PLC0415

    toppra.setup_logging("ERROR")
    route = route_arrays(packed_route(0))
    nodes = len(route.limit_mps)
    caps = np.zeros(nodes)
    kernel()["speed_caps"](caps, route.limit_mps, np.zeros(nodes), route.curvature_per_m, 2.5)
    s_m = np.arange(float(nodes))
    path = toppra.SplineInterpolator(s_m, s_m[:, None])
    speed = constraint.JointVelocityConstraintVarying(
        lambda s: np.array([[-1.0, 1.0]]) * np.interp(s, s_m, caps)
    )
    acceleration = constraint.JointAccelerationConstraint(np.array([[-1.0, 1.2]]))

    def solve() -> None:
        planner = algorithm.TOPPRA([speed, acceleration], path, gridpoints=s_m)
        planner.compute_parameterization(caps[0], caps[-1])

    return median_s(solve)


def step_times() -> dict[str, float]:
    """Return seconds per step of the same closed loop in CPython and compiled by numba."""
    function = DrivingFunction()
    function.record.learn = 1

    def in_cpython() -> None:
        function.initialize()
        step_loop.run(function.record, function.route, function.profile, function.trace, STEPS)

    function.initialize()
    compiled = compile_modules((*KERNEL_MODULES, step_loop))
    st = pack(function.record)
    route = RouteArrays(*map(np.array, function.route))
    profile = ProfileArrays(*map(np.array, function.profile))
    trace = zeros(TraceArrays, len(function.arrays[0]))
    return {
        "cpython_s": median_s(in_cpython) / STEPS,
        "numba_s": median_s(lambda: compiled["run"](st[0], route, profile, trace, STEPS)) / STEPS,
    }


def _measure_memory(arguments: list[str]) -> NDArray[np.float64] | None:
    driven(long_route(float(arguments[0])))
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)
    return None


if __name__ == "__main__":
    _measure_memory(sys.argv[1:])
