"""Ways that meet themselves, made of lines and arcs, and cars that drive along them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from laboratory import Array
from pldf.roads import Route

Piece = tuple[float, float]  # length in m, curvature in 1/m, positive to the left


def arc(radius_m: float, turns: float) -> Piece:
    """Part of a circle; the radius is negative to the right."""
    return 2.0 * pi * abs(radius_m) * turns, 1.0 / radius_m


@dataclass(frozen=True, eq=False)
class Way:
    """The exact line of pieces behind each other, from the origin along x."""

    pieces: Sequence[Piece]

    @property
    def length_m(self) -> float:
        """Arc length."""
        return sum(length for length, _ in self.pieces)

    def pose(self, s_m: Array) -> tuple[Array, Array, Array]:
        """Return x, y and heading at ``s_m``, each from its piece alone."""
        x, y, heading = np.zeros(len(s_m)), np.zeros(len(s_m)), np.zeros(len(s_m))
        at, x0, y0, h0 = 0.0, 0.0, 0.0, 0.0
        for number, (length, k) in enumerate(self.pieces):
            last = number == len(self.pieces) - 1
            inside = (s_m >= at) & ((s_m < at + length) | last)
            here = s_m[inside] - at
            x[inside], y[inside], heading[inside] = _on_piece(here, k, x0, y0, h0)
            (x0,), (y0,), (h0,) = _on_piece(np.array([length]), k, x0, y0, h0)
            at += length
        return x, y, heading

    def beside(self, s_m: Array, left_m: float) -> tuple[Array, Array]:
        """Return x and y of a car that drives ``left_m`` to the left of the line."""
        x, y, heading = self.pose(s_m)
        return x - left_m * np.sin(heading), y + left_m * np.cos(heading)

    def route(self, name: str = "way") -> Route:
        """Return the route with a knot every half metre."""
        s_m = np.append(np.arange(0.0, self.length_m, 0.5), self.length_m)
        x, y, _ = self.pose(s_m)
        limit = np.full(len(s_m), 50.0 / 3.6)
        return Route(name, s_m, np.zeros(len(s_m)), limit, np.zeros(len(s_m)), x, y)


def _on_piece(s_m: Array, k: float, x: float, y: float, h: float) -> tuple[Array, Array, Array]:
    heading = h + k * s_m
    if k == 0.0:
        return x + s_m * np.cos(h), y + s_m * np.sin(h), heading
    return x + (np.sin(heading) - np.sin(h)) / k, y - (np.cos(heading) - np.cos(h)) / k, heading


# Enters to the right, goes round to the left, leaves to the right.
ROUNDABOUT = Way([(120.0, 0.0), arc(-14.0, 0.12), arc(16.0, 0.74), arc(-14.0, 0.12), (120.0, 0.0)])
ROUND_TWICE = Way([(120.0, 0.0), arc(-14.0, 0.12), arc(16.0, 2.49), arc(-14.0, 0.12), (120.0, 0.0)])
MINI_ROUNDABOUT = Way([(60.0, 0.0), arc(3.0, 2.5), (60.0, 0.0)])
# Two loops, to the left and to the right: crosses itself at 100 m, and drives its first line again.
FIGURE_OF_EIGHT = Way([(150.0, 0.0), arc(50.0, 0.75), (100.0, 0.0), arc(-50.0, 0.75), (150.0, 0.0)])
ROUND_AND_ROUND = Way(
    [arc(60.0, 3.0)]
)  # each place three times, the start a fourth time at the end
OUT_AND_BACK = Way([(300.0, 0.0), arc(3.5, 0.5), (300.0, 0.0)])  # carriageways 7 m apart
WAYS = {
    "roundabout": ROUNDABOUT,
    "round twice": ROUND_TWICE,
    "mini roundabout": MINI_ROUNDABOUT,
    "figure of eight": FIGURE_OF_EIGHT,
    "round and round": ROUND_AND_ROUND,
    "out and back": OUT_AND_BACK,
}
