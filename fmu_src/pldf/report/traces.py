"""Lines and looks that the interactive figures share.

Colours are Okabe and Ito's; what only colour would tell apart is dashed or has another mark too.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernel.arrays import FloatArray
from ..kernel.units import KMH_PER_MPS
from ..recordings.recording import Recording
from .figures import BLUE, GREY, ORANGE, PURPLE, SKY, VERMILLION

EVERY_M: Final = 2.0  # one point of a recording per so many metres is drawn
_ENTRIES_PER_ROW: Final = 6  # of a legend, about
_GRID: Final = "#e3e3e3"


class Look(NamedTuple):
    """Name in the legend, colour, width in px, dash."""

    name: str
    colour: str
    width: float
    dash: str = "solid"


LIMIT: Final = Look("Legal limit", GREY, 2)
BASE: Final = Look("Base profile", BLUE, 2, "dash")
_DRIVEN: Final = (
    (SKY, "dot"),
    (BLUE, "solid"),
    (ORANGE, "dot"),
    (VERMILLION, "solid"),
    (PURPLE, "dash"),
    (GREY, "dash"),
)


def line(s_m: FloatArray, speed_mps: FloatArray, look: Look, **more: Any) -> dict[str, Any]:
    """Return the trace of a speed (or difference of speeds) over distance."""
    return {
        "type": "scatter",
        "x": short(s_m / 1000),
        "y": short(KMH_PER_MPS * speed_mps),
        "mode": "lines",
        "name": look.name,
        "line": {"color": look.colour, "width": look.width, "dash": look.dash},
        "hovertemplate": f"{look.name}: %{{y:.1f}} km/h<extra></extra>",
        **more,
    }


def limit_line(s_m: FloatArray, limit_mps: FloatArray) -> dict[str, Any]:
    """Return the trace of the legal limit, given per metre; only its corners are kept."""
    ends = np.flatnonzero(np.diff(limit_mps, prepend=np.nan, append=np.nan))
    corners = np.unique(np.clip(np.concatenate((ends, ends - 1)), 0, len(s_m) - 1))
    trace = line(s_m[corners], limit_mps[corners], LIMIT)
    trace["line"]["shape"] = "hv"
    return trace


def driven_line(number: int, phase: str, recording: Recording, **more: Any) -> dict[str, Any]:
    """Return the trace of the speed driven in the drive with this number, from 0."""
    s_m = np.arange(recording["s_m"][0], recording["s_m"][-1], EVERY_M)
    speed = np.interp(s_m, np.maximum.accumulate(recording["s_m"]), recording["speed_mps"])
    colour, dash = _DRIVEN[number % len(_DRIVEN)]
    return line(s_m, speed, Look(f"Speed driven in {phase}", colour, 1.8, dash), **more)


def short(values: FloatArray) -> NDArray[np.float32]:
    """Return four bytes a number: what is lost does not show."""
    return np.asarray(values, dtype=np.float32)


def styled(figure: Any, height: int, distance: bool = True) -> Any:
    """Give a figure the common look; zooming is along the distance only."""
    entries = sum(trace.showlegend is not False for trace in figure.data)
    below = 84 + 20 * (entries // _ENTRIES_PER_ROW)
    figure.update_layout(
        template="none",
        height=height,
        paper_bgcolor="#fff",
        plot_bgcolor="#fff",
        font={"family": "Helvetica, Arial, sans-serif", "size": 14, "color": "#222"},
        margin={"l": 74, "r": 16, "t": 40, "b": below},
        hovermode="x unified" if distance else "closest",
        legend={"orientation": "h", "x": 0, "yref": "container", "y": 0, "yanchor": "bottom"},
        hoverlabel={"bgcolor": "#fff", "font": {"size": 13}},
    )
    axis = {"gridcolor": _GRID, "zeroline": False, "linecolor": "#888", "ticks": "outside"}
    figure.update_xaxes(**axis)
    figure.update_yaxes(**axis)
    if distance:
        figure.update_yaxes(fixedrange=True)
        figure.update_xaxes(hoverformat=".3f", ticksuffix=" km")
    return figure
