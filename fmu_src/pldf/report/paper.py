"""Scenes for print: drawn by matplotlib as PNG, PDF or SVG, the same scene as the same bytes."""

from __future__ import annotations

from math import ceil
from pathlib import Path
from typing import Any, Final, Literal

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from ..errors import ModelError
from .palette import GRID
from .scene import Axis, Band, Boxes, Fill, Line, Note, Panel, Scene, Stroke

DOTS_PER_INCH: Final = 150
_AROUND_IN: Final = 1.2  # title, axis and legend
_CHARACTERS_PER_IN: Final = 13.0  # of the legend's letters
_HANDLE_CHARACTERS: Final = 7  # room that an entry takes beside its text
_AREAS, _LINES, _RAISED = 1.0, 2.0, 3.0
_DASHES: Final[dict[str, Any]] = {
    "solid": "-", "dash": (0, (4, 2)), "dot": (0, (1, 1.2)), "dashdot": (0, (5, 1.5, 1, 1.5)),
}  # fmt: skip
_MARKS: Final = {"": "", "circle": "o", "square": "s", "triangle": "^", "diamond": "D"}
_ALIGNED: Final = {"above": "bottom", "middle": "center", "below": "top"}
_SHIFTS_PT: Final = {"above": 4, "middle": 0, "below": -4}
# What matplotlib would write of version and time of day.
_PINNED: Final[dict[str, dict[str, str | None]]] = {
    ".png": {"Software": "pldf"},
    ".pdf": {"CreationDate": None},
    ".svg": {"Date": None},
}


def save(path: Path, *scenes: Scene) -> None:
    """Draw ``scenes`` below each other into ``path`` (PNG, PDF or SVG): same scenes, same bytes.

    Raises:
        ModelError: the ending is unknown or the file cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with rc_context({"svg.hashsalt": "pldf"}):
            metadata = _PINNED.get(path.suffix.lower())
            drawn(*scenes).savefig(path, dpi=DOTS_PER_INCH, metadata=metadata)
    except (OSError, ValueError) as error:
        raise ModelError(f"{path}: cannot be drawn ({error}); use .png, .pdf or .svg") from error


def drawn(*scenes: Scene) -> Figure:
    """Return ``scenes``, one below the other, as a figure of matplotlib."""
    heights = [_AROUND_IN + sum(scene.heights_in) for scene in scenes]
    width = max(scene.width_in for scene in scenes)
    figure = Figure(figsize=(width, sum(heights)), layout="constrained")
    if len(scenes) == 1:
        _draw(figure, scenes[0])
    else:
        parts = figure.subfigures(len(scenes), squeeze=False, height_ratios=heights)
        for part, scene in zip(parts[:, 0], scenes, strict=True):
            _draw(part, scene)
    if any(scene.to_scale for scene in scenes):
        figure.draw_without_rendering()  # the layout needs to have seen a map in its shape
    return figure


def _draw(figure: FigureBase, scene: Scene) -> None:
    heights = scene.heights_in
    axes = figure.subplots(
        len(heights), scene.columns, sharex=True, squeeze=False, height_ratios=heights
    )
    for number, (axes_here, panel) in enumerate(zip(axes.flat, scene.panels, strict=True)):
        _draw_panel(axes_here, panel)
        if scene.to_scale:
            axes_here.set_aspect("equal", anchor="S")
        if scene.at_foot(number):
            axes_here.set_xlabel(panel.x.title)
        if scene.repeats_y(number):
            axes_here.tick_params(labelleft=False)
        else:
            axes_here.set_ylabel(panel.y.title)
    if scene.columns == 1:
        figure.align_ylabels(axes[:, 0])
    _add_legend(figure, scene)
    if scene.title:
        figure.suptitle(scene.title, x=0.01, ha="left", fontsize=13)


def _draw_panel(axes: Axes, panel: Panel) -> None:
    for element in panel.elements:
        match element:
            case Line() if not element.optional:
                _draw_line(axes, element)
            case Band():
                axes.fill_between(
                    element.x, element.low, element.high, zorder=_AREAS, **_area(element.fill)
                )
            case Boxes():
                for box in element.boxes:
                    at, size = (box.start, box.low), (box.end - box.start, box.high - box.low)
                    axes.add_patch(Rectangle(at, *size, zorder=_AREAS, **_area(element.fill)))
            case Note():
                _draw_note(axes, element)
    axes.set_title(panel.title, loc="left", fontsize=10)
    axes.margins(y=0.08)
    _set_axis(axes, "x", panel.x)
    _set_axis(axes, "y", panel.y)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _draw_line(axes: Axes, line: Line) -> None:
    axes.plot(
        line.x, line.y, drawstyle="steps-post" if line.stepped else "default",
        zorder=_RAISED if line.raised else _LINES, **_stroke(line.stroke),
    )  # fmt: skip


def _draw_note(axes: Axes, note: Note) -> None:
    box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0}
    axes.annotate(
        note.text, (note.x, note.y), xytext=(0, _SHIFTS_PT[note.place]),
        textcoords="offset points", ha="center", va=_ALIGNED[note.place], fontsize=8,
        bbox=box if note.boxed else None,
    )  # fmt: skip


def _set_axis(axes: Axes, which: Literal["x", "y"], axis: Axis) -> None:
    drawn_axis = axes.xaxis if which == "x" else axes.yaxis
    if axis.ticks:
        drawn_axis.set_ticks([tick.at for tick in axis.ticks], [tick.text for tick in axis.ticks])
        for text, tick in zip(drawn_axis.get_ticklabels(), axis.ticks, strict=True):
            text.set_color(tick.colour or "black")
    axes.set(**{f"{which}lim": (axis.low, axis.high)})
    if axis.grid:
        axes.grid(axis=which, color=GRID, linewidth=0.6)


def _stroke(stroke: Stroke) -> dict[str, Any]:
    return {
        "color": stroke.colour, "linewidth": stroke.width_pt, "linestyle": _DASHES[stroke.dash],
        "alpha": stroke.opacity, "marker": _MARKS[stroke.mark], "markersize": stroke.mark_pt,
        "markerfacecolor": "white" if stroke.hollow else stroke.colour,
    }  # fmt: skip


def _area(fill: Fill) -> dict[str, Any]:
    style: dict[str, Any] = {"facecolor": fill.colour, "alpha": fill.opacity, "linewidth": 0}
    if fill.hatched:
        style |= {"hatch": "////", "edgecolor": "white" if fill.opacity > 0.5 else fill.colour}
    return style


def _add_legend(figure: FigureBase, scene: Scene) -> None:
    """Put one legend for all panels below them."""
    handles: dict[str, Line2D | Patch] = {}
    for panel in scene.panels:
        for element in panel.elements:
            match element:
                case Line() if element.listed and not element.optional:
                    handles.setdefault(element.label, Line2D([], [], **_stroke(element.stroke)))
                case Band() | Boxes() if element.listed:
                    handles.setdefault(element.label, Patch(**_area(element.fill)))
                case _:
                    pass
    labels = [label for label in scene.legend if label in handles]
    if not labels:
        return
    fitting = _CHARACTERS_PER_IN * scene.width_in
    rows = ceil(sum(len(label) + _HANDLE_CHARACTERS for label in labels) / fitting)
    figure.legend(
        [handles[label] for label in labels], labels, loc="outside lower center",
        ncols=ceil(len(labels) / rows), frameon=False, fontsize=9,
        columnspacing=1.6, handlelength=2.2,
    )  # fmt: skip
