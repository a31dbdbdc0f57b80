"""Figures of a study: all drives below each other, the profile after each, the rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from ..kernel.units import KMH_PER_MPS
from ..profiles.stored_profile import StoredProfile
from ..recordings.interventions import Rates
from ..recordings.recording import Recording
from .figures import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    KM,
    ORANGE,
    SKY,
    draw_drive,
    draw_limit_and_base,
    finish,
    fit_speeds,
    legend,
)

_RATES: Final = (("Pedal", GREEN), ("Set speed", ORANGE), ("Either", BLUE))
_HATCHES: Final = ("", "////", "")
PAPER: Final = "Mean of 43 drivers in the paper"


def drives_figure(
    recordings: Mapping[str, Recording], titles: Mapping[str, str], title: str
) -> Figure:
    """Return one panel per drive: limit, profiles, speed, interventions shaded.

    Args:
        recordings: by drive, in order of driving.
        titles: what each drive was.
        title: of the whole figure.
    """
    figure = Figure(figsize=(11.0, 1.3 + 2.25 * len(recordings)), layout="constrained")
    axes = figure.subplots(len(recordings), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axis, (name, recording) in zip(axes, recordings.items(), strict=True):
        draw_drive(axis, recording)
        axis.set_title(f"{name}  {titles[name]}", loc="left", fontsize=10)
        axis.set_ylabel("km/h")
    fit_speeds(axes[0], list(recordings.values()))
    legend(figure, _richest(axes), recordings.values())
    finish(axes, next(iter(recordings.values())))
    figure.suptitle(title, x=0.01, ha="left", fontsize=13)
    return figure


def _richest(axes: Any) -> Any:
    """Return the panel with most labelled lines: only learned profiles have all of them."""
    return max(axes, key=lambda axis: len(axis.get_legend_handles_labels()[1]))


def profile_figure(
    recording: Recording, profile: StoredProfile, names: Sequence[str], title: str
) -> Figure:
    """Return the profile after each drive that was learned, and its difference from the base.

    Args:
        recording: of a drive with the base function, for the limits.
        profile: with one iteration per name in ``names``.
        names: the drives learned from.
        title: of the whole figure.
    """
    figure = Figure(figsize=(11.0, 6.4), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, height_ratios=[3.0, 1.8])
    draw_limit_and_base(axes[0], recording)
    s_km = np.arange(profile.nodes) * KM
    axes[1].axhline(0.0, color=BLUE, linewidth=1.1, linestyle=(0, (4, 2)))
    for number, name in enumerate(names, start=1):
        learned = profile.iteration(number).learned_mps
        style = _style(number, len(names))
        axes[0].plot(s_km, learned * KMH_PER_MPS, label=f"After {name}", **style)
        axes[1].plot(s_km, (learned - profile.base_mps) * KMH_PER_MPS, **style)
    axes[0].margins(y=0.08)
    axes[0].set_ylabel("Speed (km/h)")
    axes[1].set_ylabel("Learned minus base\n(km/h)")
    legend(figure, axes[0])
    finish(axes, recording)
    figure.suptitle(title, x=0.01, ha="left", fontsize=13)
    return figure


def rates_figure(rates: Mapping[str, Rates], published: Mapping[str, Rates], title: str) -> Figure:
    """Return the intervention rates of each drive as bars.

    Args:
        rates: by drive.
        published: means to mark over the drives whose name starts with the key.
        title: of the whole figure.
    """
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axis = figure.subplots()
    width = 0.27
    for number, (label, colour) in enumerate(_RATES):
        places = np.arange(len(rates)) + (number - 1) * width
        heights = [drive[number] for drive in rates.values()]
        axis.bar(
            places, heights, width * 0.92, color=colour, label=label, hatch=_HATCHES[number],
            edgecolor="white", linewidth=0.5,
        )  # fmt: skip
        _label_bars(axis, places, heights)
        _mark_published(axis, (rates, published), number, places)
    axis.set_xticks(range(len(rates)), rates)
    axis.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
    axis.set_ylabel("Share of the driving time")
    axis.set_ylim(0.0, max(0.1, 1.15 * max(max(drive) for drive in rates.values())))
    axis.grid(True, axis="y", color="#DDDDDD", linewidth=0.6)
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)
    lines, labels = axis.get_legend_handles_labels()
    order = sorted(range(len(labels)), key=lambda at: labels[at] == PAPER)
    axis.legend([lines[i] for i in order], [labels[i] for i in order], frameon=False, fontsize=9)
    axis.set_title(title, loc="left", fontsize=13)
    return figure


def _label_bars(axis: Any, places: Any, heights: Sequence[float]) -> None:
    """Write the value at the foot of each bar, where no mark can hide it."""
    for place, height in zip(places, heights, strict=True):
        axis.annotate(
            f"{100 * height:.0f}", (place, 0.0), xytext=(0, 4), textcoords="offset points",
            ha="center", va="bottom", fontsize=8,
            bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "linewidth": 0},
        )  # fmt: skip


def _mark_published(
    axis: Any, both: tuple[Mapping[str, Rates], Mapping[str, Rates]], number: int, places: Any
) -> None:
    rates, published = both
    labelled = number != len(_RATES) - 1  # one entry in the legend, after the bars
    for place, name in zip(places, rates, strict=True):
        for group, mean in published.items():
            if name.startswith(group) and any(rates[name]):
                label = None if labelled else PAPER
                labelled = True
                axis.hlines(
                    mean[number], place - 0.15, place + 0.15, color=BLACK, linewidth=1.8,
                    linestyle=(0, (1.2, 0.6)), label=label, zorder=3,
                )  # fmt: skip


def _style(number: int, count: int) -> dict[str, Any]:
    """Later states are darker, thicker lines: earlier ones stay visible below."""
    shades = (SKY, GREEN, BLACK) if count <= 3 else (SKY, GREEN, ORANGE, GREY, BLACK)
    return {"color": shades[(number - 1) % len(shades)], "linewidth": 1.0 + 0.3 * number}
