"""The figure of a route: limits, curves, base profile, curvature and grade over distance."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from ...durations import minutes
from ...kernel.units import KMH_PER_MPS
from ...route_facts import BINDING_MPS, RouteFacts
from .. import palette
from ..scene import Axis, Band, Box, Boxes, Element, Fill, Line, Note, Panel, Scene, Stroke
from .speeds import KM, SPEED, distance_axis, limit_line, speed_line, zero_line

_CURVATURE: Final = Stroke(palette.VERMILLION, 1.2)
_CURVE_SPEED: Final = Stroke(palette.VERMILLION, 1.2, "dash")
_BASE: Final = Stroke(palette.BLUE, 2.0)  # the subject here, not the background
_GRADE: Final = Stroke(palette.GREEN, 1.4)
_LABELLED_CURVES_MAX: Final = 14
_HEADROOM: Final = 1.18  # over the highest limit


def route(facts: RouteFacts) -> Scene:
    """Return limits, curves, base profile, curvature and, unless it is flat, grade."""
    x = distance_axis(0.0, facts.route.length_m)
    top = _HEADROOM * KMH_PER_MPS * float(np.max(np.asarray(facts.arrays.limit_mps)))
    per_km = 1e3 * facts.route.curvature_per_m
    reach = 1.5 * float(np.max(np.abs(per_km), initial=1.0))
    curvature = Axis("Curvature (1/km)", note="left positive", low=-reach, high=reach)
    panels = [
        Panel(_speeds(facts, top), x, replace(SPEED, low=0.0, high=top), 3.3, _headline(facts)),
        Panel((*_curvature(facts), zero_line(x)), x, curvature, 1.25),
    ]
    if np.any(facts.route.grade):
        grade = Line(facts.route.s_m * KM, 100.0 * facts.route.grade, _GRADE, "Grade", listed=False)
        panels.append(Panel((zero_line(x), grade), x, Axis("Grade", "%"), 1.1))
    return Scene(tuple(panels))


def _headline(facts: RouteFacts) -> str:
    return (
        f"{facts.route.name}: {facts.route.length_m * KM:.2f} km, base profile "
        f"{minutes(facts.driving_time_s)} min, binding curves: {len(facts.curves)}"
    )


def _speeds(facts: RouteFacts, top: float) -> tuple[Element, ...]:
    s_m = np.arange(float(len(facts.base_mps)))
    elements: list[Element] = []
    # A curve's speed leaves the panel, but does not go on to infinity.
    shown = np.where(facts.curve_speed_mps * KMH_PER_MPS < 2.0 * top, facts.curve_speed_mps, np.nan)
    if np.any(np.isfinite(shown)):
        curvature = np.asarray(facts.arrays.curvature_per_m)
        lateral_mps2 = float(np.nanmax(shown**2 * curvature))
        label = f"Curve speed at {lateral_mps2:.3g} m/s²"
        elements.append(speed_line(s_m, shown, _CURVE_SPEED, label))
    elements.append(limit_line(s_m, np.asarray(facts.arrays.limit_mps)))
    elements.append(speed_line(s_m, facts.base_mps, _BASE, "Base profile"))
    if facts.curves:
        boxes = (Box(c.start_m * KM, c.end_m * KM, 0.0, top) for c in facts.curves)
        label = f"Curve binds (over {BINDING_MPS * KMH_PER_MPS:.0f} km/h below the limit)"
        elements.append(Boxes(tuple(boxes), palette.CURVE, label))
    return tuple(elements)


def _curvature(facts: RouteFacts) -> tuple[Element, ...]:
    s_km, per_km = facts.route.s_m * KM, 1e3 * facts.route.curvature_per_m
    fill, zero = Fill(palette.VERMILLION, 0.25), np.zeros(len(s_km))
    band = Band(s_km, zero, per_km, fill, "Curvature", listed=False)
    line = Line(s_km, per_km, _CURVATURE, "Curvature", listed=False)
    if len(facts.curves) > _LABELLED_CURVES_MAX:
        return band, line
    notes = []
    for curve in facts.curves:
        middle = 0.5 * (curve.start_m + curve.end_m) * KM
        to_left = float(np.interp(middle, s_km, per_km)) > 0.0
        peak = (1.0 if to_left else -1.0) * 1e3 / curve.radius_m
        notes.append(Note(middle, peak, f"{curve.radius_m:.0f} m", "above" if to_left else "below"))
    return band, line, *notes
