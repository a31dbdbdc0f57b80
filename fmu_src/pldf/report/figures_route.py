"""The picture of a route: limits, curves, base profile, curvature and grade over distance."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from ..kernel.units import KMH_PER_MPS
from ..route_facts import BINDING_MPS, RouteFacts

_KM: Final = 1e-3
# Okabe and Ito's colours keep apart for every kind of colour vision.
_LIMIT, _CURVE, _BASE, _SHADE = "#404040", "#D55E00", "#0072B2", "#E69F00"
_LABELLED_CURVES_MAX: Final = 14


def draw_route(facts: RouteFacts, path: Path) -> None:
    """Draw ``facts`` into ``path`` (PNG, PDF or SVG by its ending)."""
    route_figure(facts).savefig(path, dpi=150)


def route_figure(facts: RouteFacts) -> Figure:
    """Return limits, curves, base profile, curvature and grade over distance."""
    hilly = bool(np.any(facts.route.grade))
    heights = [3.2, 1.2, 1.0] if hilly else [3.2, 1.2]
    figure = Figure(figsize=(11.0, 6.6 if hilly else 5.6), layout="constrained")
    axes = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    _draw_speeds(axes[0], facts)
    _draw_curvature(axes[1], facts)
    if hilly:
        _draw_grade(axes[2], facts)
    axes[-1].set_xlabel("Distance (km)")
    axes[-1].set_xlim(0.0, facts.route.length_m * _KM)
    for axis in axes:
        axis.grid(True, color="#DDDDDD", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
    figure.align_ylabels(axes)
    return figure


def minutes(time_s: float) -> str:
    """Return ``3:05 min``."""
    whole = round(time_s)
    return f"{whole // 60}:{whole % 60:02d} min"


def _draw_speeds(axis: Any, facts: RouteFacts) -> None:
    limit, base = np.asarray(facts.arrays.limit_mps) * KMH_PER_MPS, facts.base_mps * KMH_PER_MPS
    s_km = np.arange(len(base)) * _KM
    top = 1.18 * float(np.max(limit))
    for index, curve in enumerate(facts.curves):
        label = f"Curve binds (over {BINDING_MPS * KMH_PER_MPS:.0f} km/h below the limit)"
        axis.axvspan(
            curve.start_m * _KM, curve.end_m * _KM, color=_SHADE, alpha=0.25, linewidth=0,
            label=label if index == 0 else None,
        )  # fmt: skip
    speed = np.minimum(
        facts.curve_speed_mps * KMH_PER_MPS, 2.0 * top
    )  # leaves the axes, not to infinity
    axis.plot(s_km, speed, color=_CURVE, linestyle=(0, (4, 2)), linewidth=1.2,
              label="Curve speed at 2.5 m/s²")  # fmt: skip
    axis.step(s_km, limit, where="post", color=_LIMIT, linewidth=1.8, label="Legal limit")
    axis.plot(s_km, base, color=_BASE, linewidth=2.0, label="Base profile")
    axis.set_ylim(0.0, top)
    axis.set_ylabel("Speed (km/h)")
    axis.set_title(
        f"{facts.route.name}: {facts.route.length_m * _KM:.2f} km, base profile "
        f"{minutes(facts.driving_time_s)}, binding curves: {len(facts.curves)}",
        loc="left",
    )
    axis.legend(loc="lower left", ncols=2, framealpha=0.9)


def _draw_curvature(axis: Any, facts: RouteFacts) -> None:
    route = facts.route
    per_km = route.curvature_per_m * 1e3
    axis.fill_between(route.s_m * _KM, per_km, color=_CURVE, alpha=0.25, linewidth=0)
    axis.plot(route.s_m * _KM, per_km, color=_CURVE, linewidth=1.2)
    axis.axhline(0.0, color="#888888", linewidth=0.8)
    reach = 1.5 * float(np.max(np.abs(per_km), initial=1.0))
    axis.set_ylim(-reach, reach)
    axis.set_ylabel("Curvature (1/km)\nleft positive")
    if len(facts.curves) > _LABELLED_CURVES_MAX:
        return
    for curve in facts.curves:
        middle = 0.5 * (curve.start_m + curve.end_m)
        to_left = float(np.interp(middle, route.s_m, per_km)) > 0.0
        axis.annotate(
            f"{curve.radius_m:.0f} m",
            (middle * _KM, (1.0 if to_left else -1.0) * 1e3 / curve.radius_m),
            xytext=(0, 3 if to_left else -3), textcoords="offset points",
            ha="center", va="bottom" if to_left else "top", fontsize=8,
        )  # fmt: skip


def _draw_grade(axis: Any, facts: RouteFacts) -> None:
    axis.plot(facts.route.s_m * _KM, facts.route.grade * 100.0, color="#009E73", linewidth=1.4)
    axis.axhline(0.0, color="#888888", linewidth=0.8)
    axis.margins(y=0.15)
    axis.set_ylabel("Grade (%)")
