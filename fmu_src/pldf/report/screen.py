"""Scenes for the page: drawn by Plotly, to be zoomed along x, hovered over, hidden and shown."""

from __future__ import annotations

from html import escape
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from plotly.subplots import make_subplots  # type: ignore[import-untyped]

from ..kernel.arrays import FloatArray
from .palette import GRID
from .scene import Axis, Band, Boxes, Element, Line, Note, Panel, Scene

_PX_PER_PT: Final = 4.0 / 3.0
_PX_PER_IN: Final = 96.0
_TOP_PX, _BOTTOM_PX, _LEGEND_ROW_PX = 44, 66, 20
_GAP_PX: Final = 34  # between rows
_LEGEND_ENTRIES_PER_ROW: Final = 6  # about
_CONFIG: Final = {
    "displaylogo": False,
    "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}
_ANCHORS: Final = {"above": "bottom", "middle": "middle", "below": "top"}
_SHIFTS_PX: Final = {"above": 3, "middle": 0, "below": -3}
_NO_HOVER: Final = {"hoverinfo": "skip"}


def html_of(scene: Scene, name: str) -> str:
    """Return the HTML of ``scene``, a part of a page that has Plotly's script."""
    config = _CONFIG | {"toImageButtonOptions": {"format": "svg", "filename": name}}
    html: str = drawn(scene).to_html(
        full_html=False, include_plotlyjs=False, div_id=f"figure-{name}", config=config
    )
    return html


def drawn(scene: Scene) -> Any:
    """Return ``scene`` as a figure of Plotly."""
    heights, rows_px = scene.heights_in, _PX_PER_IN * sum(scene.heights_in)
    gaps_px = _GAP_PX * (len(heights) - 1)
    figure = make_subplots(
        len(heights), scene.columns, shared_xaxes=True, row_heights=list(heights),
        vertical_spacing=_GAP_PX / (rows_px + gaps_px) if len(heights) > 1 else 0.0,
        horizontal_spacing=_spacing(scene),
    )  # fmt: skip
    for number, panel in enumerate(scene.panels):
        place = {"row": number // scene.columns + 1, "col": number % scene.columns + 1}
        _draw_panel(figure, panel, place)
        suffix = f" {panel.x.unit}" if panel.x.unit else ""
        figure.update_xaxes(**_axis(panel.x), ticksuffix=suffix, **place)
        figure.update_yaxes(**_axis(panel.y), title_text=_text(panel.y.title), **place)
        if scene.repeats_y(number):
            figure.update_yaxes(showticklabels=False, title_text="", **place)
        if scene.at_foot(number) and (scene.to_scale or not suffix):  # else the unit tells enough
            figure.update_xaxes(title_text=_text(panel.x.title), **place)
    _style(figure, scene, rows_px + gaps_px)
    _list_once(figure, scene)
    if scene.stages:
        _add_stages(figure, scene)
    return figure


def _spacing(scene: Scene) -> float:
    """Return the space between columns, share of the width: little where axes are repeated."""
    if scene.columns == 1:
        return 0.0
    return 0.03 if scene.repeats_y(1) else 0.12


def _draw_panel(figure: Any, panel: Panel, place: dict[str, int]) -> None:
    for element in sorted(panel.elements, key=_level):
        if isinstance(element, Note):
            figure.add_annotation(**_note(element), **place)
        else:
            figure.add_trace(_trace(element, panel.y.unit), **place)
    if panel.title:
        figure.add_annotation(
            text=_text(panel.title), x=0, y=1, xref="x domain", yref="y domain", xanchor="left",
            yanchor="bottom", showarrow=False, **place,
        )  # fmt: skip


def _level(element: Element) -> int:
    """Return what lies over what: areas, lines, raised lines, notes."""
    match element:
        case Line():
            return 2 if element.raised else 1
        case Note():
            return 3
    return 0


def _trace(element: Line | Band | Boxes, unit: str) -> dict[str, Any]:
    match element:
        case Line():
            return _line(element, unit)
        case Band():
            x = np.concatenate((element.x, element.x[::-1]))
            y = np.concatenate((element.high, element.low[::-1]))
            return _area(x, y, element) | _NO_HOVER
    corners = [(b.start, b.end, b.end, b.start, b.start, np.nan) for b in element.boxes]
    heights = [(b.low, b.low, b.high, b.high, b.low, np.nan) for b in element.boxes]
    hover = [text for b in element.boxes for text in [_text(b.hover)] * 6]
    trace = _area(np.ravel(corners), np.ravel(heights), element) | {"hoveron": "points"}
    return trace | (_hover(hover) if any(hover) else _NO_HOVER)


def _line(line: Line, unit: str) -> dict[str, Any]:
    stroke = line.stroke
    name, unit = _text(line.name or line.label), f" {unit}" if unit else ""
    trace: dict[str, Any] = {
        "type": "scatter", "x": _short(line.x), "y": _short(line.y), "name": _text(line.label),
        "mode": "lines+markers" if stroke.mark else "lines", "showlegend": line.listed,
        "line": {
            "color": _rgba(stroke.colour, stroke.opacity), "width": _PX_PER_PT * stroke.width_pt,
            "dash": stroke.dash, "shape": "hv" if line.stepped else "linear",
        },
        "hovertemplate": f"{name}: %{{y:.1f}}{unit}<extra></extra>",
    }  # fmt: skip
    if stroke.mark:
        symbol = "triangle-up" if stroke.mark == "triangle" else stroke.mark
        edge = {"color": stroke.colour, "width": 1.5 if stroke.hollow else 0}
        trace["marker"] = {
            "symbol": symbol, "size": _PX_PER_PT * stroke.mark_pt, "line": edge,
            "color": "white" if stroke.hollow else _rgba(stroke.colour, stroke.opacity),
        }  # fmt: skip
    if line.optional:
        trace["visible"] = "legendonly"
    if line.hover:
        return trace | _hover([_text(text) for text in line.hover])
    return trace if line.label else trace | _NO_HOVER


def _hover(texts: list[str]) -> dict[str, Any]:
    return {"text": texts, "hovertemplate": "%{text}<extra></extra>"}


def _area(x: FloatArray, y: FloatArray, element: Band | Boxes) -> dict[str, Any]:
    fill = element.fill
    area = {
        "type": "scatter", "x": _short(x), "y": _short(y), "mode": "lines", "line": {"width": 0},
        "fill": "toself", "fillcolor": _rgba(fill.colour, fill.opacity),
        "name": _text(element.label), "showlegend": element.listed,
    }  # fmt: skip
    if fill.hatched:
        lines = "white" if fill.opacity > 0.5 else fill.colour
        area["fillpattern"] = {"shape": "/", "size": 7, "solidity": 0.2, "fgcolor": lines,
                               "bgcolor": _rgba(fill.colour, fill.opacity)}  # fmt: skip
    return area


def _note(note: Note) -> dict[str, Any]:
    return {
        "x": note.x, "y": note.y, "text": _text(note.text), "showarrow": False,
        "yanchor": _ANCHORS[note.place], "yshift": _SHIFTS_PX[note.place],
        "font": {"size": 11}, "bgcolor": "white" if note.boxed else "rgba(0,0,0,0)",
    }  # fmt: skip


def _axis(axis: Axis) -> dict[str, Any]:
    described: dict[str, Any] = {
        "gridcolor": GRID, "showgrid": axis.grid, "zeroline": False, "linecolor": "#888",
        "ticks": "outside",
    }  # fmt: skip
    if axis.low is not None or axis.high is not None:
        described["range"] = [axis.low, axis.high]
    if axis.ticks:
        described["tickvals"] = [tick.at for tick in axis.ticks]
        described["ticktext"] = [
            f'<span style="color:{tick.colour}">{_text(tick.text)}</span>'
            if tick.colour
            else _text(tick.text)
            for tick in axis.ticks
        ]
    return described


def _style(figure: Any, scene: Scene, panels_px: float) -> None:
    categories = bool(scene.panels[0].x.ticks)
    below = _BOTTOM_PX + _LEGEND_ROW_PX * (1 + len(scene.legend) // _LEGEND_ENTRIES_PER_ROW)
    figure.update_layout(
        template="none", height=round(_TOP_PX + panels_px + below), paper_bgcolor="#fff",
        plot_bgcolor="#fff",
        font={"family": "Helvetica, Arial, sans-serif", "size": 14, "color": "#222"},
        margin={"l": 74, "r": 16, "t": _TOP_PX, "b": below},
        hovermode="closest" if categories or scene.to_scale else "x unified",
        legend={"orientation": "h", "x": 0, "yref": "container", "y": 0, "yanchor": "bottom"},
        hoverlabel={"bgcolor": "#fff", "font": {"size": 13}},
    )  # fmt: skip
    figure.update_yaxes(fixedrange=not scene.to_scale)
    if scene.to_scale:
        figure.update_yaxes(scaleanchor="x", constrain="domain")
        figure.update_xaxes(constrain="domain")
        figure.update_traces(line_simplify=False)  # it would make corners of curves
    figure.update_xaxes(fixedrange=categories, hoverformat=".3f" if scene.panels[0].x.unit else "")


def _list_once(figure: Any, scene: Scene) -> None:
    """Give every label one entry, in the order of the scene, that hides and shows all of it."""
    order = {_text(label): rank for rank, label in enumerate(scene.legend, start=1)}
    for trace in figure.data:
        if trace.name:
            trace.legendgroup = trace.name
        if trace.showlegend:
            trace.showlegend = trace.name in order
            trace.legendrank = order.pop(trace.name, None)


def _add_stages(figure: Any, scene: Scene) -> None:
    """Add buttons that show one stage after the other."""
    stage = {_text(label): number for number, label in enumerate(scene.stages)}
    of_trace = [stage.get(trace.name, -1) for trace in figure.data]
    buttons = [
        {
            "label": label, "method": "restyle",
            "args": [{"visible": [number <= now for number in of_trace]}],
        }
        for now, label in enumerate(scene.stages)
    ]  # fmt: skip
    menu = {
        "type": "buttons", "direction": "right", "buttons": buttons, "active": len(buttons) - 1,
        "x": 0, "y": 1.02, "xanchor": "left", "yanchor": "bottom", "bgcolor": "#fff",
    }  # fmt: skip
    figure.update_layout(updatemenus=[menu])


def _short(values: FloatArray) -> NDArray[np.float32]:
    """Return four bytes a number: what is lost does not show."""
    return np.asarray(values, dtype=np.float32)


def _rgba(colour: str, opacity: float) -> str:
    red, green, blue = (int(colour[at : at + 2], 16) for at in (1, 3, 5))
    return f"rgba({red},{green},{blue},{opacity:g})"


def _text(text: str) -> str:
    """Return ``text`` for Plotly, which knows a few tags of HTML."""
    return escape(text, quote=False).replace("\n", "<br>")
