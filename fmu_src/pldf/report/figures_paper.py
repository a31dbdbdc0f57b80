"""Figures of a study for papers: what the report shows, as SVG, PDF or PNG."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from ..analysis.analysis import RATES, Analysis
from ..analysis.long_run import PANELS, Columns
from ..analysis.published import published_means
from ..kernel.units import KMH_PER_MPS
from ..recordings.recording import Recording
from ..recordings.steps import Steps
from ..study.phases import PHASES
from .figures import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    KM,
    ORANGE,
    PURPLE,
    VERMILLION,
    save,
)
from .figures_route import route_figure
from .figures_study import drives_figure, profile_figure
from .material import Material

_TITLES: Final = {"pedal": "Pedals", "set_speed": "Set speed", "combined": "Pedals or set speed"}
_ROW_S: Final = 0.1
_STYLES: Final = (
    (VERMILLION, "-", "o"),
    (ORANGE, "--", "s"),
    (BLUE, "-", "^"),
    (GREEN, ":", "D"),
)


def write_figures(material: Material, folder: Path, ending: str) -> list[Path]:
    """Write every figure that the material allows into ``folder``; ``ending``: svg, pdf, png."""
    figures = {"rates": rates_figure(material.analysis), "base": route_figure(material.route)}
    if material.driver:
        driver = material.driver
        acting = {name: _thinned(driver.recordings[name]) for name in driver.acting}
        titles = {name: PHASES[name].about if name in PHASES else "" for name in acting}
        figures["drives"] = drives_figure(acting, titles, f"The drives of {driver.participant}")
        if driver.profile.iterations:
            notes = [iteration.note for iteration in driver.profile.iterations]
            title = f"What the function learned from {driver.participant}"
            figures["development"] = profile_figure(
                next(iter(acting.values())), driver.profile, notes, title
            )
        if driver.steps:
            figures["steps"] = steps_figure(driver.steps)
    if material.long_run:
        figures["long_run"] = long_run_figure(material.long_run)
    paths = [folder / f"{name}.{ending}" for name in figures]
    for path, figure in zip(paths, figures.values(), strict=True):
        save(figure, path)
    return paths


def _thinned(recording: Recording) -> Recording:
    """Return a row every tenth of a second or so: more does not show, but makes files large."""
    every = max(1, round(_ROW_S / float(np.median(np.diff(recording["time_s"])))))
    return Recording({name: values[::every] for name, values in recording.columns.items()})


def rates_figure(analysis: Analysis) -> Figure:
    """Return all participants' rates over the drives with interventions, means and bands."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    axes = figure.subplots(1, 3, sharey=True)
    phases = list(analysis.needed)
    for axis, measure in zip(axes, RATES, strict=True):
        people = 100.0 * np.array([analysis.rate(phase, measure) for phase in phases])
        axis.plot(phases, people, color=GREY, alpha=0.4, linewidth=0.7)
        intervals = [analysis.interval(phase, measure) for phase in phases]
        low, high = ([100.0 * getattr(i, end) for i in intervals] for end in ("low", "high"))
        band = axis.fill_between(phases, low, high, color=BLUE, alpha=0.28, linewidth=0)
        mean = [100.0 * i.value for i in intervals]
        (line,) = axis.plot(phases, mean, "o-", color=BLUE, linewidth=2.0, markersize=5)
        for drives, value in zip(analysis.compared.values(), published_means(measure), strict=True):
            (paper,) = axis.plot(
                drives, [100.0 * value] * len(drives), "D--", color=BLACK, markerfacecolor="white"
            )
        axis.set_title(_TITLES[measure], loc="left", fontsize=10)
        _plain(axis)
    axes[0].set_ylabel("Share of the driving time (%)")
    axes[0].set_ylim(-2.0, 102.0)
    handles = [axes[0].lines[0], line, band, paper]
    names = ["Participants", "Mean", "95 % confidence band", "Paper, mean of both drives"]
    figure.legend(handles, names, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    return figure


def steps_figure(steps: Steps) -> Figure:
    """Return one intervention: recorded, stretched, offset, mean, smoothed."""
    figure = Figure(figsize=(9.0, 4.4), layout="constrained")
    axis = figure.subplots()
    node = steps.node_m
    drawn: tuple[tuple[str, Any, Any, dict[str, Any]], ...] = (
        ("Speed driven", node, steps.driven_mps, {"color": GREY, "ls": ":", "lw": 1.2}),
        ("Profile followed", node, steps.followed_mps, {"color": BLUE, "ls": "--", "lw": 1.4}),
        ("1 recorded", steps.piece_m, steps.recorded_mps, {"color": BLACK, "lw": 2.6}),
        ("2 stretched", steps.stretched_m, steps.recorded_mps, {"color": ORANGE, "ls": "--"}),
        ("3 offset", steps.stretched_m, steps.joined_mps, {"color": VERMILLION, "lw": 2.0}),
        ("5 smoothed", node, steps.learned_mps, {"color": PURPLE, "lw": 3.4}),
        ("4 mean", node, steps.mean_mps, {"color": GREEN, "ls": "--", "lw": 1.6}),
    )
    for name, s_m, speed_mps, style in drawn:
        axis.plot(s_m * KM, speed_mps * KMH_PER_MPS, label=name, **style)
    axis.set_xlabel("Distance (km)")
    axis.set_ylabel("Speed (km/h)")
    _plain(axis)
    handles, names = axis.get_legend_handles_labels()
    order = sorted(range(len(names)), key=lambda at: (names[at][0].isdigit(), names[at]))
    figure.legend(
        [handles[at] for at in order], [names[at] for at in order],
        loc="outside lower center", ncols=7, frameon=False, fontsize=9, columnspacing=1.2,
    )  # fmt: skip
    return figure


def long_run_figure(runs: Mapping[float, Columns]) -> Figure:
    """Return rates, content drivers and remaining error over drives per stretch factor."""
    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True)
    for axis, (column, title) in zip(axes.flat, PANELS.items(), strict=True):
        for number, (factor, columns) in enumerate(runs.items()):
            colour, dash, mark = _STYLES[number % len(_STYLES)]
            axis.plot(
                columns["drive"], columns[column], dash, color=colour, marker=mark, markersize=3,
                label=f"Stretch factor {factor:g}",
            )  # fmt: skip
        axis.set_ylabel(title.replace("<br>", "\n"))
        axis.set_ylim(bottom=0.0)
        _plain(axis)
    for axis in axes[-1]:
        axis.set_xlabel("Drive")
    handles, names = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False)
    return figure


def _plain(axis: Any) -> None:
    axis.grid(True, color="#DDDDDD", linewidth=0.6)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
