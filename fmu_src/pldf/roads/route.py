"""The route as a list of knots, its per-metre arrays and its fingerprint."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelError
from ..findings import Finding
from ..kernel.arrays import FloatArray, RouteArrays
from ..kernel.units import KMH_PER_MPS
from .per_metre import along, lowest_limit, sharpest_curve

LENGTH_MIN_M: Final = 2.0
LENGTH_MAX_M: Final = 1e7  # ten times across a continent; a slip of a digit must not fill memory
# A limit above this is a km/h value in a m/s field, not a road.
LIMIT_MAX_MPS: Final = 300.0 / KMH_PER_MPS
# Curves tighter than 1 m do not exist on roads; broken polynomials and kinks of a line do.
CURVATURE_MAX_PER_M: Final = 1.0
GRADE_MAX: Final = 1.0  # steeper than any road; heights in another unit than metres are
# No car can be there: its inputs would count as invalid (kernel/drive.py).
PLACE_MAX_M: Final = 1e8
COLUMNS: Final = ("s_m", "curvature_per_m", "speed_limit_mps", "grade", "x_m", "y_m")


MarkKind = Literal["road", "sign"]  # a road of the file begins, a sign stands


class Mark(NamedTuple):
    """A place on a route that has a name, for messages and pictures."""

    s_m: float
    kind: MarkKind
    name: str
    against: bool = False  # a road that is driven against the direction in which it is drawn


@dataclass(frozen=True, eq=False)
class Route:
    """A road to drive along, given by knots; all arrays are float64 of one length.

    Raises:
        ModelError: when the knots are no usable route (``first_fault``).
    """

    name: str
    s_m: FloatArray  # from 0, not decreasing; two equal values are a jump
    curvature_per_m: FloatArray  # signed, positive to the left, linear between knots
    speed_limit_mps: FloatArray  # in force from this knot to the next
    grade: FloatArray  # rise over run, linear between knots
    x_m: FloatArray  # east, linear between knots; 0 when the source has no line
    y_m: FloatArray  # north
    has_line: bool = True
    notes: tuple[Finding, ...] = ()  # how its file was read
    marks: tuple[Mark, ...] = ()  # in order of s_m

    def __post_init__(self) -> None:
        fault = first_fault(self.knots)
        if fault is not None:
            raise ModelError(f"route {self.name}, knot {fault[0]}: {fault[1]}")

    @property
    def length_m(self) -> float:
        """Arc length of the whole route."""
        return float(self.s_m[-1])

    @property
    def nodes(self) -> int:
        """Number of nodes of the 1 m grid, floor(length) + 1."""
        return int(np.floor(self.length_m)) + 1

    @property
    def knots(self) -> dict[str, FloatArray]:
        """The arrays by the column names of the route file."""
        return {name: getattr(self, name) for name in COLUMNS}


def first_fault(knots: dict[str, FloatArray], *, sharp: bool = True) -> tuple[int, str] | None:
    """Return the index of the first unusable knot and what is wrong with it, None if all are good.

    Args:
        knots: maps the names in ``COLUMNS`` to arrays of equal length.
        sharp: that a curve is too tight for any car is a fault.
    """
    s_m = knots["s_m"]
    if len(s_m) == 0:
        return 0, "there are no knots: a route needs at least two"
    not_finite = [_first(~np.isfinite(values), _not_finite(name)) for name, values in knots.items()]
    faults = [fault for fault in not_finite if fault is not None] or _numeric_faults(knots, sharp)
    if faults:
        index, text = min(faults, key=lambda fault: fault[0])
        return index, text.format(**{name: float(values[index]) for name, values in knots.items()})
    if s_m[-1] < LENGTH_MIN_M:
        return len(s_m) - 1, f"the route is {s_m[-1]:g} m long; it must be at least 2 m long"
    return None


def _numeric_faults(knots: dict[str, FloatArray], sharp: bool) -> list[tuple[int, str]]:
    s_m, limit = knots["s_m"], knots["speed_limit_mps"]
    late = np.zeros(len(s_m), dtype=bool)
    late[0] = s_m[0] != 0.0
    thrice = np.zeros_like(late)
    thrice[2:] = s_m[2:] == s_m[:-2]
    back = np.zeros_like(late)
    back[1:] = s_m[1:] < s_m[:-1]
    faults = (
        _first(s_m > LENGTH_MAX_M, "s_m = {s_m:g} is beyond 10 000 km; is the unit right?"),
        _first(late, "s_m starts at {s_m:g}; it must start at 0 (subtract {s_m:g} everywhere)"),
        _first(back, "s_m = {s_m:g} lies before the previous one; sort the route by s_m"),
        _first(thrice, "s_m = {s_m:g} for the third time; two equal values make a jump"),
        _first(limit <= 0.0, "speed_limit_mps = {speed_limit_mps:g}; a limit must be above 0"),
        _first(
            limit > LIMIT_MAX_MPS,
            "speed_limit_mps = {speed_limit_mps:g} m/s is above 300 km/h; is the unit right?",
        ),
        _first(
            (np.abs(knots["curvature_per_m"]) > CURVATURE_MAX_PER_M) & sharp,
            "curvature_per_m = {curvature_per_m:g}: a curve tighter than 1 m; correct the line",
        ),
        _first(
            np.abs(knots["grade"]) > GRADE_MAX,
            "grade = {grade:.4g}, steeper than 45 degrees; are heights in metres?",
        ),
        *(
            _first(
                np.abs(knots[name]) > PLACE_MAX_M,
                f"{name} = {{{name}:g}} is beyond 100 000 km; subtract the same from all",
            )
            for name in ("x_m", "y_m")
        ),
    )
    return [fault for fault in faults if fault is not None]


def _not_finite(name: str) -> str:
    return f"{name} = {{{name}}}; every value must be a finite number"


def _first(bad: NDArray[np.bool_], text: str) -> tuple[int, str] | None:
    index = int(np.argmax(bad))
    return (index, text) if bad[index] else None


@lru_cache(maxsize=8)  # a start asks three times: fingerprint, driving function, vehicle or driver
def route_arrays(route: Route) -> RouteArrays:
    """Return what the kernel needs per metre: float64 arrays of ``route.nodes`` values.

    Who asks for the same route gets the same arrays; nobody writes to them.

    A cell's limit is the lowest in force anywhere in it, its curvature the largest absolute value
    in it. A sign or a jump exactly at node i + 1 belongs to cell i + 1 alone.
    """
    nodes = np.arange(route.nodes, dtype=np.float64)
    s_m = route.s_m
    limit_mps = _repeat_last(lowest_limit(s_m, route.speed_limit_mps, nodes))
    curvature_per_m = _repeat_last(sharpest_curve(s_m, route.curvature_per_m, nodes))
    grade, x_m, y_m = along(s_m, (route.grade, route.x_m, route.y_m), nodes)
    return RouteArrays(limit_mps, curvature_per_m, grade, x_m, y_m)


def fingerprint(route: Route) -> str:
    """Return 16 hex digits of SHA-256 over all that shapes a profile on this route.

    That is the length (rounded to 1 mm) and per metre the limit (1e-3 m/s) and the absolute
    curvature (1e-6 1/m), as little-endian 64-bit integers; neither the grade nor the line.
    """
    arrays = route_arrays(route)
    digest = hashlib.sha256(_rounded(np.array([route.length_m]), 1e3).data)
    digest.update(_rounded(np.asarray(arrays.limit_mps), 1e3).data)
    digest.update(_rounded(np.asarray(arrays.curvature_per_m), 1e6).data)
    return digest.hexdigest()[:16]


def _rounded(values: FloatArray, scale: float) -> NDArray[np.int64]:
    return np.rint(values * scale).astype("<i8")


def _repeat_last(cells: FloatArray) -> FloatArray:
    return np.append(cells, cells[-1])
