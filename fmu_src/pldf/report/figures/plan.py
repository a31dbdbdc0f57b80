"""The plan view of a route: where it runs, to scale, with its limits in colours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import dist
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...kernel.arrays import FloatArray
from ...kernel.units import KMH_PER_MPS
from ...roads import Route
from ...roads.route import Mark
from ...route_facts import BINDING_MPS, RouteFacts
from .. import palette
from ..scene import Axis, Element, Line, Note, Panel, Scene, Stroke
from .labels import Labels, Rectangle

_WIDTH_IN: Final = 10.0  # of the map on paper, without its axis
_HEIGHTS_IN: Final = (2.0, 6.0)  # least and most, of the route alone
_MARGIN_IN: Final = 0.45  # around the route, for texts
_FOOT_IN: Final = 0.45  # below it, for scale and north
_POINTS: Final = 2500  # along the route: more does not show
_CLASSES_KMH: Final = (30.0, 50.0, 70.0, 90.0, 110.0, 130.0)  # of many limits
_ARROWS: Final = 7
_AROUND_IN: Final = 0.07  # over which the direction is taken
_APART_IN: Final = 0.12  # of marks, at least
_TEXTS_MAX: Final = 60  # of a kind for which room is looked for
_KM_FROM_M: Final = 20e3  # from this extent on the axes are in km

_CURVE: Final = Stroke(palette.ORANGE, 11.0, opacity=0.45)
_ARROW: Final = Stroke(palette.BLACK, 1.3)
_SCALE: Final = Stroke(palette.BLACK, 1.5)
_SIGN: Final = Stroke(palette.BLACK, 0.0, mark="diamond", mark_pt=4.5, hollow=True)
_ROAD: Final = Stroke(palette.GREY, 0.0, mark="square", mark_pt=3.0)
_START: Final = Stroke(palette.BLACK, 0.0, mark="circle", mark_pt=8.0, hollow=True)
_END: Final = Stroke(palette.BLACK, 0.0, mark="square", mark_pt=7.0)


@dataclass(frozen=True, eq=False)
class _Map:
    """The route's line at places along it, in the unit of the axes.

    Attributes:
        s_m: the places; limits and curves begin and end at such.
        x, y: where they are.
        unit: of the axes.
        per_in: length of an inch on paper.
    """

    facts: RouteFacts
    s_m: FloatArray
    x: FloatArray
    y: FloatArray
    unit: str
    per_in: float

    def at(self, s_m: float) -> tuple[float, float]:
        """Return where the place ``s_m`` is."""
        return float(np.interp(s_m, self.s_m, self.x)), float(np.interp(s_m, self.s_m, self.y))

    def heading(self, s_m: float) -> tuple[float, float]:
        """Return the direction of driving around there, as a unit vector."""
        around = np.hypot(self.x - self.at(s_m)[0], self.y - self.at(s_m)[1])
        here = int(np.searchsorted(self.s_m, s_m))
        far = around > _AROUND_IN * self.per_in
        before = int(np.flatnonzero(far[:here])[-1]) if np.any(far[:here]) else 0
        after = here + int(np.argmax(far[here:])) if np.any(far[here:]) else len(self.s_m) - 1
        east, north = (float(v[after] - v[before]) for v in (self.x, self.y))
        length = float(np.hypot(east, north)) or 1.0
        return east / length, north / length


def plan(facts: RouteFacts) -> Scene | None:
    """Return the plan view, None for a route whose file has no x and y."""
    if not facts.route.has_line:
        return None
    shown, x, y = _map(facts)
    lines = (*_limits(shown), *_curves(shown), *_places(shown), *_arrows(shown))
    inside = Rectangle(*x.ends, y.ends[0] + _FOOT_IN * shown.per_in, y.ends[1])
    elements = (*lines, *_scale_and_north(shown, x, y), *_texts(shown, inside))
    height_in = (y.ends[1] - y.ends[0]) / shown.per_in
    title = f"{facts.route.name}: plan view"
    return Scene((Panel(elements, x, y, height_in, title),), to_scale=True)


def _map(facts: RouteFacts) -> tuple[_Map, Axis, Axis]:
    """Return the line and the axes around it."""
    route = facts.route
    s_m = _places_along(facts)
    x, y = np.interp(s_m, route.s_m, route.x_m), np.interp(s_m, route.s_m, route.y_m)
    in_km = max(np.ptp(x), np.ptp(y)) >= _KM_FROM_M
    factor, unit = (1e-3, "km") if in_km else (1.0, "m")
    x, y = factor * x, factor * y
    across, up = float(np.ptp(x)), float(np.ptp(y))
    per_in = max(across / (_WIDTH_IN - 2 * _MARGIN_IN), up / _HEIGHTS_IN[1], 1e-2)
    height = max(up, _HEIGHTS_IN[0] * per_in) + 2 * _MARGIN_IN * per_in
    middle_x, middle_y = 0.5 * float(np.min(x) + np.max(x)), 0.5 * float(np.min(y) + np.max(y))
    half = 0.5 * _WIDTH_IN * per_in
    low = middle_y - 0.5 * height
    axes = (
        Axis("x, east", unit, low=middle_x - half, high=middle_x + half, grid=False),
        Axis("y, north", unit, low=low - _FOOT_IN * per_in, high=low + height, grid=False),
    )
    return _Map(facts, s_m, x, y, unit, per_in), *axes


def _places_along(facts: RouteFacts) -> FloatArray:
    """Return places at equal distances, and all where a limit or a curve begins or ends."""
    ends = [end for curve in facts.curves for end in (curve.start_m, curve.end_m)]
    even = np.linspace(0.0, facts.route.length_m, _POINTS)
    places: FloatArray = np.unique(np.concatenate((even, [s for s, _ in facts.limits], ends)))
    return places


def _limits(shown: _Map) -> Iterator[Line]:
    """Yield a line per limit, the slowest first; each ends where the next limit begins."""
    starts, limits = (np.array(values) for values in zip(*shown.facts.limits, strict=True))
    limits_kmh = np.round(limits * KMH_PER_MPS, 1)
    of_piece, labels = _classes(limits_kmh)
    piece = np.searchsorted(starts, shown.s_m, "right") - 1
    hover = _hover(shown, limits_kmh[piece])
    of_place = of_piece[piece]
    for number, label in enumerate(labels):
        inside = of_place == number
        inside[1:] |= inside[:-1].copy()  # up to where the next one begins
        stroke = palette.limit(number, len(labels))
        x, y = (np.where(inside, values, np.nan) for values in (shown.x, shown.y))
        kept = inside | np.append(inside[1:], False)  # a gap needs one point
        texts = tuple(np.array(hover)[kept])
        yield Line(x[kept], y[kept], stroke, label, hover=texts, raised=True)


def _classes(limits_kmh: FloatArray) -> tuple[NDArray[np.intp], list[str]]:
    """Return the class of each limit, and what the classes are called."""
    values = np.unique(limits_kmh)
    if len(values) <= palette.LIMITS_MAX:
        return np.searchsorted(values, limits_kmh), [f"{value:g} km/h" for value in values]
    number = np.searchsorted(_CLASSES_KMH, limits_kmh)
    names = [f"up to {_CLASSES_KMH[0]:g} km/h"]
    names += [f"up to {high:g}" for high in _CLASSES_KMH[1:]]
    names.append(f"over {_CLASSES_KMH[-1]:g}")
    there, of_limit = np.unique(number, return_inverse=True)
    return of_limit, [names[k] for k in there]


def _hover(shown: _Map, limits_kmh: FloatArray) -> list[str]:
    """Return what hovering says, place by place."""
    base_kmh = KMH_PER_MPS * np.interp(
        shown.s_m, np.arange(len(shown.facts.base_mps)), shown.facts.base_mps
    )
    return [
        f"{s:.0f} m: limit {limit:g} km/h, base profile {base:.0f} km/h"
        for s, limit, base in zip(shown.s_m, limits_kmh, base_kmh, strict=True)
    ]


def _curves(shown: _Map) -> Iterator[Line]:
    """Yield the stretches on which curves bind, below the limits."""
    curves = shown.facts.curves
    if not curves:
        return
    starts, ends = (np.array([getattr(c, name) for c in curves]) for name in ("start_m", "end_m"))
    number = np.searchsorted(starts, shown.s_m, "right") - 1
    inside = (number >= 0) & (shown.s_m <= ends[np.maximum(number, 0)])
    x, y = (np.where(inside, values, np.nan) for values in (shown.x, shown.y))
    label = f"Curve binds (over {BINDING_MPS * KMH_PER_MPS:.0f} km/h below the limit)"
    yield Line(x, y, _CURVE, label)


def _places(shown: _Map) -> Iterator[Line]:
    """Yield signs, beginnings of roads, start and end."""
    route = shown.facts.route
    signs = {s: f"{limit * KMH_PER_MPS:.3g} km/h" for s, limit in shown.facts.limits[1:]}
    signs |= {mark.s_m: mark.name for mark in route.marks if mark.kind == "sign"}
    roads = {mark.s_m: f"road {mark.name}" for mark in _roads(route)}
    for marks, stroke, label in ((roads, _ROAD, "Road begins"), (signs, _SIGN, "Sign")):
        apart = _apart(shown, sorted(marks))
        if apart:
            x, y = (np.array(values) for values in zip(*map(shown.at, apart), strict=True))
            hover = tuple(f"{s:.0f} m: {marks[s]}" for s in apart)
            yield Line(x, y, stroke, label, hover=hover, raised=True)
    for s_m, stroke, label in ((0.0, _START, "Start"), (route.length_m, _END, "End")):
        at_x, at_y = (np.array([value]) for value in shown.at(s_m))
        hover = (f"{label}, {s_m:.0f} m",)
        yield Line(at_x, at_y, stroke, label, listed=False, hover=hover, raised=True)


def _apart(shown: _Map, places_m: Iterable[float]) -> list[float]:
    """Return those places that can be told apart on the map."""
    apart: list[float] = []
    for s_m in places_m:
        if not apart or dist(shown.at(apart[-1]), shown.at(s_m)) > _APART_IN * shown.per_in:
            apart.append(s_m)
    return apart


def _arrows(shown: _Map) -> Iterator[Line]:
    """Yield arrow heads in the direction of driving."""
    reach = 0.11 * shown.per_in
    x, y = [], []
    for share in (np.arange(_ARROWS) + 0.5) / _ARROWS:
        s_m = share * shown.facts.route.length_m
        (tip_x, tip_y), (east, north) = shown.at(s_m), shown.heading(s_m)
        for side in (1.0, 0.0, -1.0):
            back = abs(side) * reach
            x.append(tip_x - back * east - 0.6 * side * reach * north)
            y.append(tip_y - back * north + 0.6 * side * reach * east)
        x.append(np.nan)
        y.append(np.nan)
    yield Line(np.array(x), np.array(y), _ARROW, raised=True)


def _scale_and_north(shown: _Map, x: Axis, y: Axis) -> Iterator[Element]:
    """Yield a bar of a round length and an arrow to the north, at the foot of the map."""
    inch, foot = shown.per_in, y.ends[0] + 0.15 * shown.per_in
    power = 10.0 ** np.floor(np.log10(1.6 * inch))
    length = float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= 1.6 * inch))
    left, tick = x.ends[0] + 0.2 * inch, 0.06 * inch
    right = left + length
    bar = np.array([left, left, left, right, right, right])
    ends = np.array([tick, -tick, 0.0, 0.0, tick, -tick])
    yield Line(bar, foot + ends, _SCALE)
    yield Note(0.5 * (left + right), foot, f"{length:g} {shown.unit}")
    at, tip, wing = x.ends[1] - 0.3 * inch, foot + 0.4 * inch, 0.08 * inch
    north_x = np.array([at, at, at - wing, at, at + wing])
    yield Line(north_x, np.array([foot, tip, tip - 2 * wing, tip, tip - 2 * wing]), _SCALE)
    yield Note(at, tip, "N")


def _texts(shown: _Map, inside: Rectangle) -> list[Note]:
    """Return as many texts as there is room for, the most needed first."""
    facts, labels = shown.facts, Labels(shown.x, shown.y, shown.per_in, inside)
    if dist(shown.at(0.0), shown.at(facts.route.length_m)) < _APART_IN * shown.per_in:
        labels.add(*shown.at(0.0), "start and end")
    else:
        labels.add(*shown.at(0.0), "start")
        labels.add(*shown.at(facts.route.length_m), "end")
    limits = dict(facts.limits)
    for s_m in _apart(shown, limits):
        labels.add(*shown.at(s_m), f"{limits[s_m] * KMH_PER_MPS:.3g}")
    for curve in sorted(facts.curves, key=lambda curve: curve.speed_mps)[:_TEXTS_MAX]:
        middle = 0.5 * (curve.start_m + curve.end_m)
        speed_kmh = curve.speed_mps * KMH_PER_MPS
        labels.add(*shown.at(middle), f"R {curve.radius_m:.0f} m, {speed_kmh:.0f} km/h")
    for s_m, name in _longest_roads(facts.route):
        labels.add(*shown.at(s_m), name)
    return labels.notes


def _roads(route: Route) -> list[Mark]:
    """Return where roads begin, if there are several."""
    roads = [mark for mark in route.marks if mark.kind == "road"]
    return roads if len(roads) > 1 else []


def _longest_roads(route: Route) -> list[tuple[float, str]]:
    """Return the middles and names of the roads, the longest first."""
    roads = _roads(route)
    if not roads:
        return []
    ends = [mark.s_m for mark in roads[1:]] + [route.length_m]
    spans = [(end - mark.s_m, mark) for mark, end in zip(roads, ends, strict=True)]
    longest = sorted(spans, key=lambda span: -span[0])[:_TEXTS_MAX]
    return [(mark.s_m + 0.5 * length, f"road {mark.name}") for length, mark in longest]
