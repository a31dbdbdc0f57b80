"""What there is to know about a route before anybody drives it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .instance import view, views, zeros
from .kernel.arrays import FloatArray, RouteArrays, Work
from .kernel.preparation import plan_legal
from .kernel.state import PldfState
from .kernel.units import KMH_PER_MPS
from .roads import Route, route_arrays

# A curve is felt when it asks for clearly less than the sign.
BINDING_MPS: Final = 5.0 / KMH_PER_MPS


@dataclass(frozen=True)
class Curve:
    """A stretch whose curve speed lies more than ``BINDING_MPS`` below the legal limit."""

    start_m: float
    end_m: float
    radius_m: float  # smallest
    speed_mps: float  # lowest curve speed


@dataclass(frozen=True)
class RouteFacts:
    """A route, its per-metre arrays and the base profile with default parameters."""

    route: Route
    arrays: RouteArrays
    curve_speed_mps: FloatArray  # cell: speed that the curve allows, inf on straights
    base_mps: FloatArray  # node
    curves: tuple[Curve, ...]
    limits: tuple[tuple[float, float], ...]  # position (m) and legal limit (m/s) from there on

    @property
    def driving_time_s(self) -> float:
        """Time of the base profile; acceleration is constant within each metre."""
        return float(np.sum(2.0 / (self.base_mps[1:] + self.base_mps[:-1])))


def route_facts(route: Route) -> RouteFacts:
    """Plan the base profile of ``route`` and find its binding curves."""
    arrays = route_arrays(route)
    defaults = PldfState()
    curvature = np.asarray(arrays.curvature_per_m)
    with np.errstate(divide="ignore"):
        curve_speed = np.sqrt(defaults.planner_lateral_accel_max_mps2 / curvature)
    return RouteFacts(
        route=route,
        arrays=arrays,
        curve_speed_mps=curve_speed,
        base_mps=_base_profile(arrays, defaults),
        curves=_curves(curve_speed, arrays),
        limits=_limits(route),
    )


def _base_profile(arrays: RouteArrays, settings: PldfState) -> FloatArray:
    speed = np.zeros(len(arrays.limit_mps))
    plan_legal(settings, views(arrays), view(speed), views(zeros(Work, len(speed))))
    return speed


def _curves(curve_speed: FloatArray, arrays: RouteArrays) -> tuple[Curve, ...]:
    binding = curve_speed < np.asarray(arrays.limit_mps) - BINDING_MPS
    edges = np.flatnonzero(np.diff(binding.astype(np.int8), prepend=0, append=0))
    curvature = np.asarray(arrays.curvature_per_m)
    return tuple(
        Curve(
            start_m=float(start),
            end_m=float(min(end, len(binding) - 1)),
            radius_m=float(1.0 / np.max(curvature[start:end])),
            speed_mps=float(np.min(curve_speed[start:end])),
        )
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    )


def _limits(route: Route) -> tuple[tuple[float, float], ...]:
    in_force = np.append(route.s_m[:-1] < route.s_m[1:], False)  # a jump's first knot is not
    s_m, limit = route.s_m[in_force], route.speed_limit_mps[in_force]
    changes = np.flatnonzero(np.diff(limit, prepend=-1.0))
    return tuple((float(s_m[i]), float(limit[i])) for i in changes)
