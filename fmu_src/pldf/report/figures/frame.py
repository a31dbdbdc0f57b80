"""What every map has: axes to scale around its lines, a bar of scale, north, arrow heads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...kernel.arrays import FloatArray
from .. import palette
from ..scene import Axis, Element, Line, Note, Panel, Scene, Stroke
from .labels import Rectangle

_WIDTH_IN: Final = 10.0  # of the map on paper, without its axis
_HEIGHTS_IN: Final = (2.0, 6.0)  # least and most, of the lines alone
_MARGIN_IN: Final = 0.45  # around them, for texts
_FOOT_IN: Final = 0.45  # below, for scale and north
_BAR_MAX_IN: Final = 1.6
_ARROW_IN: Final = 0.11
_KM_FROM_M: Final = 20e3  # from this extent on the axes are in km
_BLACK: Final = Stroke(palette.BLACK, 1.5)
_ARROW: Final = Stroke(palette.BLACK, 1.3)


@dataclass(frozen=True)
class Frame:
    """The axes of a map.

    Attributes:
        x, y: the axes, equally long per unit.
        factor: from metres to the unit of the axes.
        per_in: length of an inch on paper, in that unit.
    """

    x: Axis
    y: Axis
    factor: float
    per_in: float

    @property
    def inside(self) -> Rectangle:
        """Where lines and texts are."""
        return Rectangle(*self.x.ends, self.y.ends[0] + _FOOT_IN * self.per_in, self.y.ends[1])

    def scene(self, elements: Iterable[Element], title: str) -> Scene:
        """Return the map with these elements, a bar of scale and north."""
        height_in = (self.y.ends[1] - self.y.ends[0]) / self.per_in
        every = (*elements, *_scale_and_north(self))
        return Scene((Panel(every, self.x, self.y, height_in, title),), to_scale=True)

    def arrow_heads(self, tips: Iterable[tuple[float, float, float, float]]) -> Line:
        """Return arrow heads at tips, each with its direction as a unit vector."""
        reach = _ARROW_IN * self.per_in
        x, y = list[float](), list[float]()
        for tip_x, tip_y, east, north in tips:
            for side in (1.0, 0.0, -1.0):
                back = abs(side) * reach
                x.append(tip_x - back * east - 0.6 * side * reach * north)
                y.append(tip_y - back * north + 0.6 * side * reach * east)
            x.append(np.nan)
            y.append(np.nan)
        return Line(np.array(x), np.array(y), _ARROW, raised=True)


def frame_around(x_m: FloatArray, y_m: FloatArray) -> Frame:
    """Return the axes around all these points, which are at least one."""
    across_m, up_m = float(np.ptp(x_m)), float(np.ptp(y_m))
    factor, unit = (1e-3, "km") if max(across_m, up_m) >= _KM_FROM_M else (1.0, "m")
    across, up = factor * across_m, factor * up_m
    per_in = max(across / (_WIDTH_IN - 2 * _MARGIN_IN), up / _HEIGHTS_IN[1], 1e-2)
    height = max(up, _HEIGHTS_IN[0] * per_in) + 2 * _MARGIN_IN * per_in
    middle_x, middle_y = (0.5 * factor * float(np.min(v) + np.max(v)) for v in (x_m, y_m))
    half, low = 0.5 * _WIDTH_IN * per_in, middle_y - 0.5 * height
    return Frame(
        Axis("x, east", unit, low=middle_x - half, high=middle_x + half, grid=False),
        Axis("y, north", unit, low=low - _FOOT_IN * per_in, high=low + height, grid=False),
        factor,
        per_in,
    )


def _scale_and_north(frame: Frame) -> Iterator[Element]:
    """Yield a bar of a round length and an arrow to the north, at the foot of the map."""
    inch, foot = frame.per_in, frame.y.ends[0] + 0.15 * frame.per_in
    longest = _BAR_MAX_IN * inch
    power = 10.0 ** np.floor(np.log10(longest))
    length = float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= longest))
    left, tick = frame.x.ends[0] + 0.2 * inch, 0.06 * inch
    right = left + length
    bar = np.array([left, left, left, right, right, right])
    ends = np.array([tick, -tick, 0.0, 0.0, tick, -tick])
    yield Line(bar, foot + ends, _BLACK)
    yield Note(0.5 * (left + right), foot, f"{length:g} {frame.x.unit}")
    at, tip, wing = frame.x.ends[1] - 0.3 * inch, foot + 0.4 * inch, 0.08 * inch
    north_x = np.array([at, at, at - wing, at, at + wing])
    yield Line(north_x, np.array([foot, tip, tip - 2 * wing, tip, tip - 2 * wing]), _BLACK)
    yield Note(at, tip, "N")
