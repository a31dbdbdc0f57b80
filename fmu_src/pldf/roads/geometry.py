"""The five kinds of OpenDRIVE plan view geometry: curvature and line over arc length.

Line, arc and spiral have a curvature linear in arc length and share one class. poly3 and paramPoly3
are cubic polynomials; their curvature is analytic in the polynomial's parameter, and the parameter
belongs to an arc length by integration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray

Cubic = tuple[float, float, float, float]

# Gauss-Legendre nodes and weights on [0, 1]: exact far beyond 1e-9 m over 1 m of any road.
_GAUSS: Final = np.polynomial.legendre.leggauss(5)
_NODES: Final = 0.5 * (_GAUSS[0] + 1.0)
_WEIGHTS: Final = 0.5 * _GAUSS[1]
_TABLE_STEP_M: Final = 0.25
# A polynomial longer or shorter than its geometry by more than this share is a wrong pRange.
_LENGTH_TOLERANCE: Final = 0.05


class Geometry(Protocol):
    """One piece of the reference line; ``ds`` is arc length from its start, in metres."""

    def curvature(self, ds: FloatArray) -> FloatArray:
        """Return the signed curvature in 1/m."""
        ...

    def heading(self, ds: FloatArray) -> FloatArray:
        """Return the direction in rad, from the x axis to the left."""
        ...

    def line(self, ds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return x and y in metres."""
        ...


@dataclass(frozen=True)
class Pose:
    """Where a piece begins."""

    x_m: float
    y_m: float
    heading_rad: float

    def place(self, u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn and shift local coordinates into the map."""
        cos, sin = np.cos(self.heading_rad), np.sin(self.heading_rad)
        return self.x_m + u * cos - v * sin, self.y_m + u * sin + v * cos


@dataclass(frozen=True)
class LinearCurvature:
    """Line (0, 0), arc (k, k) or spiral (k0, k1): curvature linear in arc length."""

    pose: Pose
    length_m: float
    curvature_start_per_m: float
    curvature_end_per_m: float

    def curvature(self, ds: FloatArray) -> FloatArray:
        """Return the signed curvature in 1/m."""
        return self.curvature_start_per_m + self._rate() * ds

    def turn(self, ds: FloatArray) -> FloatArray:
        """Return the change of heading since the start, in rad."""
        return ds * (self.curvature_start_per_m + 0.5 * self._rate() * ds)

    def heading(self, ds: FloatArray) -> FloatArray:
        """Return the direction in rad, from the x axis to the left."""
        return self.pose.heading_rad + self.turn(ds)

    def line(self, ds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return x and y in metres; a spiral's Fresnel integral is summed metre by metre."""
        if self.curvature_start_per_m == self.curvature_end_per_m:
            half_turn = 0.5 * self.curvature_start_per_m * ds
            arc = ds * np.exp(1j * half_turn) * np.sinc(half_turn / np.pi)
            return self.pose.place(arc.real, arc.imag)
        whole = np.arange(int(np.floor(np.max(ds, initial=0.0))) + 1, dtype=np.float64)
        table = np.concatenate(([0j], np.cumsum(self._chord(whole, 1.0))))
        floor = np.floor(ds)
        local = table[floor.astype(np.intp)] + self._chord(floor, ds - floor)
        return self.pose.place(local.real, local.imag)

    def _chord(self, start: FloatArray, span: FloatArray | float) -> NDArray[np.complex128]:
        stations = start[:, None] + np.reshape(span, (-1, 1)) * _NODES
        chords: NDArray[np.complex128] = span * (np.exp(1j * self.turn(stations)) @ _WEIGHTS)
        return chords

    def _rate(self) -> float:
        return (self.curvature_end_per_m - self.curvature_start_per_m) / self.length_m


@dataclass(frozen=True)
class Polynomial:
    """The curve (u(p), v(p)) with ``parameter[i]`` belonging to the arc length ``arc_m[i]``."""

    pose: Pose
    u: Cubic
    v: Cubic
    parameter: FloatArray
    arc_m: FloatArray

    def curvature(self, ds: FloatArray) -> FloatArray:
        """Return the signed curvature in 1/m."""
        p = self._at(ds)
        u1, v1 = _slope(self.u, p), _slope(self.v, p)
        u2, v2 = _bend(self.u, p), _bend(self.v, p)
        bent: FloatArray = (u1 * v2 - v1 * u2) / np.hypot(u1, v1) ** 3
        return bent

    def heading(self, ds: FloatArray) -> FloatArray:
        """Return the direction in rad, from the x axis to the left."""
        p = self._at(ds)
        direction: FloatArray = np.arctan2(_slope(self.v, p), _slope(self.u, p))
        return self.pose.heading_rad + direction

    def line(self, ds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return x and y in metres."""
        p = self._at(ds)
        return self.pose.place(_value(self.u, p), _value(self.v, p))

    def _at(self, ds: FloatArray) -> FloatArray:
        return np.interp(ds, self.arc_m, self.parameter)


def poly3(pose: Pose, length_m: float, v: Cubic) -> Polynomial:
    """Return the piece v(u) from u = 0 up to the given arc length.

    Raises:
        ValueError: when the curve has no finite length.
    """
    u: Cubic = (0.0, 1.0, 0.0, 0.0)
    # ds >= du: the arc length is reached before u = length.
    parameter, arc_m = _arc_table(u, v, length_m, length_m)
    return Polynomial(pose, u, v, parameter, arc_m)


def param_poly3(pose: Pose, length_m: float, u: Cubic, v: Cubic, *, normalized: bool) -> Polynomial:
    """Return the piece (u(p), v(p)), p from 0 to 1 if normalized, else to the arc length.

    Real files keep p only nearly proportional to arc length, so the true arc length of the curve is
    used, scaled to ``length_m``.

    Raises:
        ValueError: when the curve's length does not fit ``length_m`` (mostly a wrong pRange).
    """
    parameter, arc_m = _arc_table(u, v, 1.0 if normalized else length_m, length_m)
    if not abs(arc_m[-1] - length_m) <= _LENGTH_TOLERANCE * length_m:
        raise ValueError(
            f"the polynomial is {arc_m[-1]:.6g} m long, its geometry {length_m:.6g} m; "
            "check length and pRange"
        )
    return Polynomial(pose, u, v, parameter, arc_m * (length_m / arc_m[-1]))


def _arc_table(
    u: Cubic, v: Cubic, parameter_end: float, length_m: float
) -> tuple[FloatArray, FloatArray]:
    cells = max(8, int(np.ceil(length_m / _TABLE_STEP_M)))
    parameter = np.linspace(0.0, parameter_end, cells + 1)
    step = parameter_end / cells
    stations = parameter[:-1, None] + step * _NODES
    pace = np.hypot(_slope(u, stations), _slope(v, stations))
    arc_m = np.concatenate(([0.0], np.cumsum(step * (pace @ _WEIGHTS))))
    if not np.all(np.diff(arc_m) > 0.0):
        raise ValueError("the polynomial stands still; check its coefficients")
    return parameter, arc_m


def _value(c: Cubic, p: FloatArray) -> FloatArray:
    return c[0] + p * (c[1] + p * (c[2] + p * c[3]))


def _slope(c: Cubic, p: FloatArray) -> FloatArray:
    return c[1] + p * (2.0 * c[2] + p * (3.0 * c[3]))


def _bend(c: Cubic, p: FloatArray) -> FloatArray:
    return 2.0 * c[2] + p * (6.0 * c[3])
