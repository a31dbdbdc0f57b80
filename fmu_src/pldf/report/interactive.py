"""The interactive figures of the report.

Zooming is along the distance; a double click shows everything again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import plotly.graph_objects as go  # type: ignore[import-untyped]
from plotly.subplots import make_subplots  # type: ignore[import-untyped]

from ..analysis.analysis import RATES, Analysis
from ..analysis.long_run import PANELS, Columns
from ..analysis.published import published_means
from ..kernel.arrays import FloatArray
from ..kernel.units import KMH_PER_MPS
from ..recordings.interventions import pedal_interventions, set_speed_interventions
from ..recordings.recording import Recording
from ..recordings.steps import Steps
from ..route_facts import RouteFacts
from .figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION
from .material import DriverShown, Material
from .page_tables import RATE_TITLES
from .traces import BASE, Look, driven_line, limit_line, line, short, styled

STEP_NAMES: Final = ("1 recorded", "2 stretched", "3 offset", "4 mean", "5 smoothed")
_KINDS: Final = {
    "gas": ("Gas", GREEN, 9, -0.14),
    "brake": ("Brake until reactivated", VERMILLION, 9, -0.14),
    "set_speed": ("Set speed changed", ORANGE, 5, 0.2),
}
_PEOPLE_MAX: Final = 200  # more lines than this are a grey area


def rates_figure(analysis: Analysis) -> Any:
    """Return all participants' rates over the drives with interventions, means and bands."""
    figure = make_subplots(
        1, 3, shared_yaxes=True, horizontal_spacing=0.03, subplot_titles=list(RATE_TITLES.values())
    )
    phases = list(analysis.needed)
    for column, measure in enumerate(RATES, start=1):
        once = {"showlegend": column == 1}
        place = {"row": 1, "col": column}
        figure.add_trace(_participants(analysis, phases, measure) | once, **place)
        intervals = [analysis.interval(phase, measure) for phase in phases]
        band = [100 * i.high for i in intervals] + [100 * i.low for i in intervals[::-1]]
        figure.add_trace(
            {
                "type": "scatter", "x": phases + phases[::-1], "y": band, "fill": "toself",
                "fillcolor": "rgba(0,114,178,0.28)", "line": {"width": 0}, "hoverinfo": "skip",
                "mode": "lines", "name": "95 % confidence band", "legendgroup": "band", **once,
            },
            **place,
        )  # fmt: skip
        figure.add_trace(
            {
                "type": "scatter", "x": phases, "y": [100 * i.value for i in intervals],
                "customdata": [[100 * i.low, 100 * i.high] for i in intervals],
                "mode": "lines+markers", "line": {"color": BLUE, "width": 3},
                "marker": {"size": 9}, "name": "Mean", "legendgroup": "mean", **once,
                "hovertemplate": "%{x}: mean %{y:.1f} %<br>95 %: %{customdata[0]:.1f} to "
                "%{customdata[1]:.1f} %<extra></extra>",
            },
            **place,
        )  # fmt: skip
        figure.add_trace(_paper(analysis, measure) | once, **place)
    figure.update_yaxes(title_text="Share of the driving time (%)", col=1, row=1)
    figure.update_yaxes(range=[-2, 102], fixedrange=True)
    figure.update_xaxes(fixedrange=True)
    return styled(figure, 470, distance=False)


def _participants(analysis: Analysis, phases: Sequence[str], measure: str) -> dict[str, Any]:
    """Return one trace with a line per participant; of a crowd, every n-th."""
    rates = np.array([analysis.rate(phase, measure) for phase in phases]).T
    step = -(-len(rates) // _PEOPLE_MAX)
    shown = range(0, len(rates), step)
    gap = len(phases) + 1
    x: list[str | None] = [*phases, None] * len(shown)
    y = np.full(gap * len(shown), np.nan)
    names = np.repeat(np.array(analysis.participants)[::step], gap)
    for at, number in enumerate(shown):
        y[gap * at : gap * at + len(phases)] = 100 * rates[number]
    every = "" if step == 1 else f", every {step}th"
    return {
        "type": "scatter", "x": x, "y": _plain(y), "text": names.tolist(),
        "mode": "lines+markers", "line": {"color": "rgba(70,70,70,0.4)", "width": 1},
        "marker": {"size": 4, "color": "rgba(70,70,70,0.55)"}, "connectgaps": False,
        "name": f"Participants{every}", "legendgroup": "participants",
        "hovertemplate": "%{text} %{x}: %{y:.1f} %<extra></extra>",
    }  # fmt: skip


def _paper(analysis: Analysis, measure: str) -> dict[str, Any]:
    x: list[str | None] = []
    y: list[float | None] = []
    for phases, mean in zip(analysis.compared.values(), published_means(measure), strict=True):
        x += [*phases, None]
        y += [100 * mean] * len(phases) + [None]
    return {
        "type": "scatter", "x": x, "y": y, "mode": "lines+markers",
        "line": {"color": BLACK, "width": 2, "dash": "dash"},
        "marker": {"symbol": "diamond-open", "size": 10, "color": BLACK},
        "name": "Paper, mean of both drives", "legendgroup": "paper",
        "hovertemplate": "paper, mean of both drives: %{y:.2f} %<extra></extra>",
    }  # fmt: skip


def route_figure(facts: RouteFacts) -> Any:
    """Return the base profile with legal limits and curve speeds, and the curvature below."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06, row_heights=[0.7, 0.3])
    s_m = np.arange(float(len(facts.base_mps)))
    limit = np.asarray(facts.arrays.limit_mps)
    top = 1.2 * float(np.max(limit))
    curve = np.where(facts.curve_speed_mps < top, facts.curve_speed_mps, np.nan)
    _add(figure, line(s_m, curve, Look("Curve speed", VERMILLION, 2, "dash")))
    _add(figure, limit_line(s_m, limit))
    _add(figure, line(s_m, facts.base_mps, Look("Base profile", BLUE, 3)))
    curvature = {
        "type": "scatter",
        "x": short(facts.route.s_m / 1000),
        "y": short(1e3 * facts.route.curvature_per_m),
        "fill": "tozeroy",
        "fillcolor": "rgba(213,94,0,0.22)",
        "line": {"color": VERMILLION, "width": 1.5},
        "showlegend": False,
        "hovertemplate": "%{y:.1f} per km<extra></extra>",
    }
    _add(figure, curvature, row=2)
    figure.update_yaxes(title_text="Speed (km/h)", range=[0, KMH_PER_MPS * top], row=1, col=1)
    figure.update_yaxes(title_text="Curvature (1/km)<br>left positive", row=2, col=1)
    return styled(figure, 570)


def development_figure(driver: DriverShown, facts: RouteFacts) -> Any:
    """Return the profile after each learned drive, and below what differs from the base."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.06, row_heights=[0.68, 0.32])
    s_m = np.arange(float(driver.profile.nodes))
    base = driver.profile.base_mps
    _add(figure, limit_line(s_m, np.asarray(facts.arrays.limit_mps)))
    _add(figure, line(s_m, base, BASE))
    styles = ((SKY, 1.5, "solid"), (GREEN, 2.0, "dashdot"), (BLACK, 2.6, "solid"))
    for iteration in driver.profile.iterations:
        style = styles[min(iteration.number, len(styles)) - 1]
        look = Look(f"Profile after {iteration.note}", *style)
        group = {"legendgroup": iteration.note}
        _add(figure, line(s_m, iteration.learned_mps, look, **group))
        change = iteration.learned_mps - base
        _add(figure, line(s_m, change, look, showlegend=False, **group), row=2)
    for number, phase in enumerate(driver.acting):
        recording = driver.recordings[phase]
        _add(figure, driven_line(number, phase, recording, visible="legendonly"))
    figure.update_yaxes(title_text="Speed (km/h)", row=1, col=1)
    figure.update_yaxes(title_text="Learned minus<br>base (km/h)", row=2, col=1)
    return styled(figure, 600)


def drives_figure(driver: DriverShown, facts: RouteFacts) -> Any:
    """Return what was driven in each drive, with a lane per drive of where the driver acted."""
    figure = make_subplots(2, 1, shared_xaxes=True, vertical_spacing=0.05, row_heights=[0.66, 0.34])
    s_m = np.arange(float(driver.profile.nodes))
    _add(figure, limit_line(s_m, np.asarray(facts.arrays.limit_mps)))
    for number, phase in enumerate(driver.acting):
        _add(figure, driven_line(number, phase, driver.recordings[phase]))
    lanes = driver.acting
    for kind, (name, colour, width, shift) in _KINDS.items():
        x, y, text = _lanes(driver.recordings, lanes, kind, shift)
        figure.add_trace(
            {
                "type": "scatter", "x": x, "y": y, "text": text, "mode": "lines",
                "line": {"color": colour, "width": width}, "name": name,
                "hovertemplate": "%{text}<extra></extra>",
            },
            row=2, col=1,
        )  # fmt: skip
    figure.update_yaxes(title_text="Speed (km/h)", row=1, col=1)
    figure.update_yaxes(
        title_text="Driver acts in", tickvals=list(range(len(lanes))), ticktext=lanes,
        range=[len(lanes) - 0.5, -0.5], row=2, col=1,
    )  # fmt: skip
    return styled(figure, 620)


def _lanes(
    recordings: Mapping[str, Recording], lanes: Sequence[str], kind: str, shift: float
) -> tuple[list[float | None], list[float | None], list[str]]:
    x: list[float | None] = []
    y: list[float | None] = []
    text: list[str] = []
    for lane, phase in enumerate(lanes):
        recording = recordings[phase]
        found = (
            set_speed_interventions(recording)
            if kind == "set_speed"
            else [i for i in pedal_interventions(recording) if i.kind == kind]
        )
        for interval in found:
            ends = recording["s_m"][[interval.first, interval.last]] / 1000
            times = recording["time_s"][[interval.first, interval.last]]
            x += [round(float(ends[0]), 4), round(float(ends[1]), 4), None]
            y += [lane + shift, lane + shift, None]
            text += [f"{phase}, {_KINDS[kind][0]}: {times[1] - times[0]:.1f} s"] * 3
    return x, y, text


def steps_figure(steps: Steps) -> Any:
    """Return one intervention in five steps; buttons show them one after the other."""
    figure = go.Figure()
    node = steps.node_m
    _add(figure, line(node, steps.driven_mps, Look("Speed driven", GREY, 1.5, "dot")), row=None)
    _add(figure, line(node, steps.followed_mps, BASE._replace(name="Profile followed")), row=None)
    names = iter(STEP_NAMES)
    for s_m, speed_mps, look in (
        (steps.piece_m, steps.recorded_mps, Look(next(names), BLACK, 4)),
        (steps.stretched_m, steps.recorded_mps, Look(next(names), ORANGE, 3, "dash")),
        (steps.stretched_m, steps.joined_mps, Look(next(names), VERMILLION, 3)),
        (node, steps.mean_mps, Look(next(names), GREEN, 2.5, "dash")),
        (node, steps.learned_mps, Look(next(names), PURPLE, 5)),
    ):
        # The mean lies over the smoothed profile, which hides it else.
        order = 2 if speed_mps is steps.mean_mps else 1
        _add(figure, line(s_m, speed_mps, look, zorder=order), row=None)
    count = len(STEP_NAMES)
    buttons = [
        {
            "label": name,
            "method": "restyle",
            "args": [{"visible": [True, True, *(at <= now for at in range(count))]}],
        }
        for now, name in enumerate(STEP_NAMES)
    ]
    figure.update_layout(
        updatemenus=[
            {
                "type": "buttons", "direction": "right", "buttons": buttons, "active": count - 1,
                "x": 0, "y": 1.02, "xanchor": "left", "yanchor": "bottom", "bgcolor": "#fff",
            }
        ]
    )  # fmt: skip
    figure.update_yaxes(title_text="Speed (km/h)")
    return styled(figure, 520)


def long_run_figure(runs: Mapping[float, Columns]) -> Any:
    """Return what becomes of rates, of content drivers and of the remaining error over drives."""
    figure = make_subplots(2, 2, shared_xaxes=True, vertical_spacing=0.08, horizontal_spacing=0.12)
    styles = ((VERMILLION, "solid"), (ORANGE, "dash"), (BLUE, "solid"), (GREEN, "dot"))
    marks = ("circle", "square", "triangle-up", "diamond")
    for at, (column, title) in enumerate(PANELS.items()):
        place = {"row": at // 2 + 1, "col": at % 2 + 1}
        for number, (factor, columns) in enumerate(runs.items()):
            colour, dash = styles[number % len(styles)]
            figure.add_trace(
                {
                    "type": "scatter", "x": columns["drive"], "y": columns[column],
                    "mode": "lines+markers", "line": {"color": colour, "dash": dash, "width": 2},
                    "marker": {"symbol": marks[number % len(marks)], "size": 6},
                    "name": f"Stretch factor {factor:g}", "legendgroup": f"{factor:g}",
                    "showlegend": at == 0,
                    "hovertemplate": f"{factor:g}: %{{y:.1f}}<extra></extra>",
                },
                **place,
            )  # fmt: skip
        figure.update_yaxes(title_text=title, rangemode="tozero", **place)
    styled(figure, 570, distance=False)
    figure.update_xaxes(title_text="Drive", row=2)
    figure.update_layout(hovermode="x unified")
    return figure


def figures_of(material: Material) -> dict[str, Any]:
    """Return the figures that the material allows, by name."""
    figures = {"rates": rates_figure(material.analysis)}
    if material.driver:
        figures["drives"] = drives_figure(material.driver, material.route)
        if material.driver.profile.iterations:
            figures["development"] = development_figure(material.driver, material.route)
        if material.driver.steps:
            figures["steps"] = steps_figure(material.driver.steps)
    if material.long_run:
        figures["long"] = long_run_figure(material.long_run)
    figures["base"] = route_figure(material.route)
    return figures


def _add(figure: Any, trace: dict[str, Any], row: int | None = 1) -> None:
    figure.add_trace(trace, row=row, col=None if row is None else 1)


def _plain(values: FloatArray) -> list[float | None]:
    return [None if np.isnan(value) else round(value, 3) for value in values.tolist()]
