"""Figures of intervention rates: of one driver as bars, of a study as lines with means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from ...analysis.analysis import RATES, Analysis
from ...analysis.published import DRIVERS, PUBLISHED, published_means
from ...kernel.arrays import FloatArray
from ...recordings.interventions import Rates
from .. import palette
from ..scene import Axis, Band, Box, Boxes, Element, Fill, Line, Note, Panel, Scene, Stroke, Tick

SHARE: Final = Axis("Share of the driving time", "%")
RATE_TITLES: Final = {
    "pedal": "Pedals",
    "set_speed": "Set speed",
    "combined": "Pedals or set speed",
}
PAPER: Final = f"Mean of {DRIVERS} drivers in the paper"
_BARS: Final = {
    "pedal": Fill(palette.GREEN, 1.0),
    "set_speed": Fill(palette.ORANGE, 1.0, hatched=True),
    "combined": Fill(palette.BLUE, 1.0),
}
_BAR: Final = 0.27  # width of a bar and its gap, in drives
_PUBLISHED: Final = Stroke(palette.BLACK, 1.8, "dot")
_PERSON: Final = Stroke(palette.GREY, 0.7, mark="circle", mark_pt=2.4, opacity=0.5)
_MEAN: Final = Stroke(palette.BLUE, 2.0, mark="circle", mark_pt=6.0)
_PAPER: Final = Stroke(palette.BLACK, 1.5, "dash", "diamond", 6.0, hollow=True)
_PEOPLE_MAX: Final = 200  # more lines than this are a grey area


def rate_bars(drives: Mapping[str, Rates], title: str) -> Scene:
    """Return the intervention rates of each drive as bars, with the paper's means marked.

    Args:
        drives: rates by drive; over A1, A2, .. the published mean of A is marked, over B of B.
        title: of the whole figure.
    """
    bars: list[Element] = []
    marks: list[Element] = []
    places = np.arange(float(len(drives)))
    for number, (measure, fill) in enumerate(_BARS.items()):
        shares = [100.0 * getattr(rates, measure) for rates in drives.values()]
        at = places + (number - 1) * _BAR
        name = RATE_TITLES[measure]
        boxes = (
            Box(x - 0.46 * _BAR, x + 0.46 * _BAR, 0.0, share, f"{drive}, {name}: {share:.1f} %")
            for x, share, drive in zip(at.tolist(), shares, drives, strict=True)
        )
        bars.append(Boxes(tuple(boxes), fill, name))
        marks.append(_published_marks(drives, at, measure))
        marks += (Note(x, 0.0, f"{s:.0f}", boxed=True) for x, s in zip(at, shares, strict=True))
    x = Axis(
        "", low=-0.6, high=len(drives) - 0.4, grid=False,
        ticks=tuple(Tick(at, drive) for at, drive in enumerate(drives)),
    )  # fmt: skip
    highest = max(100.0 * max(rates) for rates in drives.values())
    y = Axis(SHARE.label, SHARE.unit, low=0.0, high=max(10.0, 1.15 * highest))
    return Scene((Panel((*bars, *marks), x, y, 3.9),), title, width_in=9.0)


def _published_marks(drives: Mapping[str, Rates], at: FloatArray, measure: str) -> Line:
    """Return a dash over each bar of a drive with interventions."""
    x: list[float] = []
    y: list[float] = []
    for place, (drive, rates) in zip(at.tolist(), drives.items(), strict=True):
        if drive[0] in PUBLISHED and any(rates):
            mean = 100.0 * getattr(PUBLISHED[drive[0]], measure)
            x += [place - 0.55 * _BAR, place + 0.55 * _BAR, np.nan]
            y += [mean, mean, np.nan]
    return Line(np.array(x), np.array(y), _PUBLISHED, PAPER, name="Paper")


def rates(analysis: Analysis) -> Scene:
    """Return all participants' rates over the drives with interventions, means and bands."""
    drives = analysis.needed
    x = Axis("", ticks=tuple(Tick(at, drive) for at, drive in enumerate(drives)))
    y = Axis(SHARE.label, SHARE.unit, low=-2.0, high=102.0)
    return Scene(
        tuple(
            Panel(_rates_of(analysis, measure), x, y, 3.1, RATE_TITLES[measure])
            for measure in RATES
        ),
        columns=len(RATES),
        width_in=9.0,
    )


def _rates_of(analysis: Analysis, measure: str) -> tuple[Element, ...]:
    drives = analysis.needed
    places = np.arange(float(len(drives)))
    intervals = [analysis.interval(drive, measure) for drive in drives]
    mean, low, high = (
        100.0 * np.array([getattr(interval, end) for interval in intervals])
        for end in ("value", "low", "high")
    )
    hover_texts = tuple(
        f"{drive}: mean {m:.1f} %\n95 %: {a:.1f} to {b:.1f} %"
        for drive, m, a, b in zip(drives, mean, low, high, strict=True)
    )
    return (
        _people(analysis, measure),
        Band(places, low, high, Fill(palette.BLUE, 0.28), "95 % confidence band"),
        Line(places, mean, _MEAN, "Mean", hover=hover_texts),
        _paper_means(analysis, measure),
    )


def _people(analysis: Analysis, measure: str) -> Line:
    """Return one line with a piece per participant; of a crowd, every n-th."""
    drives = analysis.needed
    people = 100.0 * np.array([analysis.rate(drive, measure) for drive in drives]).T
    every = -(-len(people) // _PEOPLE_MAX)
    shown = people[::every]
    gaps = np.full((len(shown), 1), np.nan)
    places = np.arange(float(len(drives)))
    x = np.hstack((np.tile(places, (len(shown), 1)), gaps)).ravel()
    hover = tuple(
        f"{person} {drive}: {share:.1f} %" if drive else ""
        for person, row in zip(analysis.participants[::every], shown, strict=True)
        for drive, share in zip((*drives, ""), (*row, np.nan), strict=True)
    )
    label = "Participants" if every == 1 else f"Participants, every {every}th"
    return Line(x, np.hstack((shown, gaps)).ravel(), _PERSON, label, hover=hover)


def _paper_means(analysis: Analysis, measure: str) -> Line:
    x: list[float] = []
    y: list[float] = []
    for drives, mean in zip(analysis.compared.values(), published_means(measure), strict=True):
        x += [*(float(analysis.needed.index(drive)) for drive in drives), np.nan]
        y += [100.0 * mean] * len(drives) + [np.nan]
    label = "Paper, mean of both drives"
    hover = tuple("" if np.isnan(share) else f"{label}: {share:.2f} %" for share in y)
    return Line(np.array(x), np.array(y), _PAPER, label, hover=hover)
