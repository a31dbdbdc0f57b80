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
from ..scene import Line, Note, Scene, Stroke
from .frame import Frame, frame_around
from .labels import Labels

_POINTS: Final = 2500  # along the route: more does not show
_CLASSES_KMH: Final = (30.0, 50.0, 70.0, 90.0, 110.0, 130.0)  # of many limits
_ARROWS: Final = 7
_AROUND_IN: Final = 0.07  # over which the direction is taken
_APART_IN: Final = 0.12  # of marks, at least
_TEXTS_MAX: Final = 60  # of a kind for which room is looked for

_CURVE: Final = Stroke(palette.ORANGE, 11.0, opacity=0.45)
_SIGN: Final = Stroke(palette.BLACK, 0.0, mark="diamond", mark_pt=4.5, hollow=True)
_ROAD: Final = Stroke(palette.GREY, 0.0, mark="square", mark_pt=4.0, hollow=True)
_START: Final = Stroke(palette.BLACK, 0.0, mark="circle", mark_pt=8.0, hollow=True)
_END: Final = Stroke(palette.BLACK, 0.0, mark="square", mark_pt=7.0)


@dataclass(frozen=True, eq=False)
class _Map:
    """The route's line at places along it, in the unit of the axes.

    Attributes:
        facts: of the route.
        frame: the axes around it.
        s_m: the places; limits and curves begin and end at such.
        x, y: where they are.
    """

    facts: RouteFacts
    frame: Frame
    s_m: FloatArray
    x: FloatArray
    y: FloatArray

    def at(self, s_m: float) -> tuple[float, float]:
        """Return where the place ``s_m`` is."""
        return float(np.interp(s_m, self.s_m, self.x)), float(np.interp(s_m, self.s_m, self.y))

    def heading(self, s_m: float) -> tuple[float, float]:
        """Return the direction of driving around there, as a unit vector."""
        around = np.hypot(self.x - self.at(s_m)[0], self.y - self.at(s_m)[1])
        here = int(np.searchsorted(self.s_m, s_m))
        far = around > _AROUND_IN * self.frame.per_in
        before = int(np.flatnonzero(far[:here])[-1]) if np.any(far[:here]) else 0
        after = here + int(np.argmax(far[here:])) if np.any(far[here:]) else len(self.s_m) - 1
        east, north = (float(v[after] - v[before]) for v in (self.x, self.y))
        length = float(np.hypot(east, north)) or 1.0
        return east / length, north / length


def plan(facts: RouteFacts) -> Scene | None:
    """Return the plan view, None for a route whose file has no x and y."""
    if not facts.route.has_line:
        return None
    shown = _map(facts)
    lines = (*_limits(shown), *_curves(shown), *_places(shown), _arrows(shown))
    return shown.frame.scene((*lines, *_texts(shown)), f"{facts.route.name}: plan view")


def _map(facts: RouteFacts) -> _Map:
    route = facts.route
    s_m = _places_along(facts)
    x_m, y_m = (np.interp(s_m, route.s_m, values) for values in (route.x_m, route.y_m))
    frame = frame_around(x_m, y_m)
    return _Map(facts, frame, s_m, frame.factor * x_m, frame.factor * y_m)


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
    of_piece, labels = limit_classes(limits_kmh)
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


def limit_classes(limits_kmh: FloatArray) -> tuple[NDArray[np.intp], list[str]]:
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
    signs |= {m.s_m: m.name for m in route.marks if m.kind == "sign" and m.s_m > 0.0}
    roads = {mark.s_m: f"road {mark.name}" for mark in _roads(route)[1:]}
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
        if not apart or dist(shown.at(apart[-1]), shown.at(s_m)) > _APART_IN * shown.frame.per_in:
            apart.append(s_m)
    return apart


def _arrows(shown: _Map) -> Line:
    """Return arrow heads in the direction of driving."""
    shares = (np.arange(_ARROWS) + 0.5) / _ARROWS
    places = (float(share) * shown.facts.route.length_m for share in shares)
    return shown.frame.arrow_heads((*shown.at(s), *shown.heading(s)) for s in places)


def _texts(shown: _Map) -> list[Note]:
    """Return as many texts as there is room for, the most needed first."""
    facts, labels = shown.facts, Labels(shown.x, shown.y, shown.frame.per_in, shown.frame.inside)
    if dist(shown.at(0.0), shown.at(facts.route.length_m)) < _APART_IN * shown.frame.per_in:
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
