"""What a figure shows, whoever draws it: panels with axes, and in them lines, bands, boxes, notes.

A scene is plain data in the units of its axes. ``paper`` draws it with matplotlib for print,
``screen`` with Plotly for the page; neither adds or leaves out anything but what is said here.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import Literal, NamedTuple

from ..kernel.arrays import FloatArray

Dash = Literal["solid", "dash", "dot", "dashdot"]
Mark = Literal["", "circle", "square", "triangle", "diamond"]
Place = Literal["above", "middle", "below"]


@dataclass(frozen=True)
class Stroke:
    """How a line is drawn; hollow marks are white inside."""

    colour: str
    width_pt: float
    dash: Dash = "solid"
    mark: Mark = ""
    mark_pt: float = 0.0
    hollow: bool = False
    opacity: float = 1.0


@dataclass(frozen=True)
class Fill:
    """How an area is drawn."""

    colour: str
    opacity: float
    hatched: bool = False


@dataclass(frozen=True, eq=False)
class Line:
    """A line through points.

    Attributes:
        x, y: the points; NaN interrupts the line.
        stroke: how it is drawn.
        label: what it is, for the legend; elements with one label have one entry and are hidden
            and shown together. Empty: a line that only guides the eye.
        listed: False for a line whose label stays out of the legend.
        name: what hovering calls it; empty: its label.
        hover: what hovering says, point by point; empty: name and value.
        stepped: True if y holds until the next point.
        raised: drawn over the lines that follow it, too.
        optional: on the page in the legend, to be switched on; not on paper.
    """

    x: FloatArray
    y: FloatArray
    stroke: Stroke
    label: str = ""
    listed: bool = True
    name: str = ""
    hover: tuple[str, ...] = ()
    stepped: bool = False
    raised: bool = False
    optional: bool = False


@dataclass(frozen=True, eq=False)
class Band:
    """The area between ``low`` and ``high`` over ``x``, below all lines."""

    x: FloatArray
    low: FloatArray
    high: FloatArray
    fill: Fill
    label: str
    listed: bool = True


class Box(NamedTuple):
    """A rectangle, and what hovering over it says."""

    start: float
    end: float
    low: float
    high: float
    hover: str = ""


@dataclass(frozen=True)
class Boxes:
    """Rectangles of one kind, below all lines: shaded intervals, bars."""

    boxes: tuple[Box, ...]
    fill: Fill
    label: str
    listed: bool = True


@dataclass(frozen=True)
class Note:
    """A short text at a point; ``boxed``: on white, so that nothing hides it."""

    x: float
    y: float
    text: str
    place: Place = "above"
    boxed: bool = False


Element = Line | Band | Boxes | Note


class Tick(NamedTuple):
    """A place on an axis with its text; an empty colour is the usual one."""

    at: float
    text: str
    colour: str = ""


@dataclass(frozen=True)
class Axis:
    """What is along an axis.

    Attributes:
        label, unit: what is measured, and in what.
        note: a second line of the title.
        low, high: ends of the axis, ``low`` left or below; None: as the data ask for.
        ticks: places with texts in place of numbers.
        grid: whether its ticks have lines through the panel.
    """

    label: str
    unit: str = ""
    note: str = ""
    low: float | None = None
    high: float | None = None
    ticks: tuple[Tick, ...] = ()
    grid: bool = True

    @property
    def ends(self) -> tuple[float, float]:
        """Both ends; ValueError if the data choose one."""
        if self.low is None or self.high is None:
            raise ValueError(f"axis {self.label} has no fixed ends")
        return self.low, self.high

    @property
    def title(self) -> str:
        """Label with unit, and the note below it."""
        whole = f"{self.label} ({self.unit})" if self.unit else self.label
        return f"{whole}\n{self.note}" if self.note else whole


@dataclass(frozen=True, eq=False)
class Panel:
    """Elements over a pair of axes; ``height_in`` in inches on paper."""

    elements: tuple[Element, ...]
    x: Axis
    y: Axis
    height_in: float
    title: str = ""


@dataclass(frozen=True, eq=False)
class Scene:
    """A figure: panels row by row, all over one x axis.

    Attributes:
        panels: as many per row as ``columns``; those of one row are equally high.
        title: above all panels on paper; the page has headings of its own.
        columns: panels beside each other.
        width_in: on paper; the page gives all its width.
        stages: labels that the page can show one after the other, each with those before it.
        to_scale: a map: a unit of x is as long as one of y.
    """

    panels: tuple[Panel, ...]
    title: str = ""
    columns: int = 1
    width_in: float = 11.0
    stages: tuple[str, ...] = ()
    to_scale: bool = False

    @property
    def heights_in(self) -> tuple[float, ...]:
        """Height of each row."""
        return tuple(panel.height_in for panel in self.panels[:: self.columns])

    @property
    def legend(self) -> tuple[str, ...]:
        """Labels in the order of the legend: those of the panel with most, then what it lacks."""
        listed = [
            [e.label for e in panel.elements if not isinstance(e, Note) and e.label and e.listed]
            for panel in self.panels
        ]
        richest = max(listed, key=lambda labels: len(set(labels)))
        return tuple(dict.fromkeys(chain(richest, *listed)))

    def repeats_y(self, number: int) -> bool:
        """Return whether panel ``number`` has the y axis of its left neighbour."""
        return number % self.columns > 0 and self.panels[number].y == self.panels[number - 1].y

    def at_foot(self, number: int) -> bool:
        """Return whether panel ``number`` is in the last row."""
        return number >= len(self.panels) - self.columns
