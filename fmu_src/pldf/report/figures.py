"""Figures of drives: speed over distance, interventions, pedals.

Colours are Okabe and Ito's, which keep apart for every kind of colour vision; what only colour
would tell apart is hatched or dashed as well, for print.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from ..instance import ModelError
from ..kernel.units import KMH_PER_MPS
from ..profiles.stored_profile import StoredProfile
from ..recordings.interventions import Interval, pedal_interventions, set_speed_interventions
from ..recordings.recording import Recording

KM: Final = 1e-3
BLACK, GREY, BLUE, SKY, GREEN, VERMILLION, ORANGE, PURPLE = (
    "#000000", "#666666", "#0072B2", "#56B4E9", "#009E73", "#D55E00", "#E69F00", "#CC79A7",
)  # fmt: skip
DRIVES: Final = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, BLACK)
STYLES: Final[dict[str, dict[str, Any]]] = {
    "gas": {"facecolor": GREEN, "alpha": 0.32, "linewidth": 0},
    "brake": {
        "facecolor": VERMILLION,
        "edgecolor": VERMILLION,
        "alpha": 0.32,
        "linewidth": 0,
        "hatch": "////",
    },
    "set_speed": {"facecolor": ORANGE, "alpha": 0.9, "linewidth": 0},
}
NAMES: Final = {
    "gas": "Gas pedal",
    "brake": "Brake until reactivated",
    "set_speed": "Set speed changed",
}
# What matplotlib would write of version and time of day.
_PINNED: Final[dict[str, dict[str, str | None]]] = {
    ".png": {"Software": "pldf"},
    ".pdf": {"CreationDate": None},
    ".svg": {"Date": None},
}
_STRIP: Final = 0.045  # height of the set-speed strip, share of the axes


def save(figure: Figure, path: Path) -> None:
    """Write ``figure`` to ``path`` (PNG, PDF or SVG by its ending): same figure, same bytes.

    Raises:
        ModelError: the ending is unknown or the file cannot be written.
    """
    metadata = _PINNED.get(path.suffix.lower())
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with rc_context({"svg.hashsalt": "pldf"}):
            figure.savefig(path, dpi=150, metadata=metadata)
    except (OSError, ValueError) as error:
        raise ModelError(f"{path}: cannot be drawn ({error}); use .png, .pdf or .svg") from error


def figure_of(
    recordings: Mapping[str, Recording], title: str, profile: StoredProfile | None = None
) -> Figure:
    """Return speed, interventions and pedals of one recording, or of several to compare.

    Args:
        recordings: complete recordings by name; limits and base profile are those of the first.
        title: of the whole figure.
        profile: draw the newest state of this profile too.
    """
    several = len(recordings) > 1
    heights = [3.4, 0.3 + 0.22 * len(recordings), 1.2] if several else [3.4, 1.2]
    figure = Figure(figsize=(11.0, 1.3 + 1.05 * sum(heights)), layout="constrained")
    axes = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    first = next(iter(recordings.values()))
    if several:
        _draw_several(axes[0], recordings)
        _draw_lanes(axes[1], recordings)
    else:
        draw_drive(axes[0], first)
    if profile is not None:
        newest = profile.iteration()
        axes[0].plot(
            np.arange(profile.nodes) * KM, newest.learned_mps * KMH_PER_MPS, color=PURPLE,
            linewidth=1.6, linestyle=(0, (1, 1)), label=f"Profile after drive {newest.number}",
        )  # fmt: skip
    axes[0].set_ylabel("Speed (km/h)")
    _draw_pedals(axes[-1], recordings)
    legend(figure, axes[0], recordings.values())
    finish(axes, first)
    figure.suptitle(title, x=0.01, ha="left", fontsize=13)
    return figure


def draw_drive(axis: Any, recording: Recording) -> None:
    """Draw limit, base profile, profile followed and speed, with the interventions shaded."""
    s_km = recording["s_m"] * KM
    draw_limit_and_base(axis, recording)
    if np.any(np.abs(recording["profile_mps"] - recording["base_mps"]) > 1e-6):
        base, followed = recording["base_mps"] * KMH_PER_MPS, recording["profile_mps"] * KMH_PER_MPS
        axis.fill_between(s_km, base, followed, color=SKY, alpha=0.35, linewidth=0)
        axis.plot(s_km, followed, color=BLUE, linewidth=1.6, label="Learned profile, followed")
    axis.plot(
        s_km, recording["speed_mps"] * KMH_PER_MPS, color=BLACK, linewidth=1.3, label="Speed driven"
    )
    for interval in pedal_interventions(recording):
        axis.axvspan(s_km[interval.first], s_km[interval.last], **STYLES[interval.kind])
    for interval in set_speed_interventions(recording):
        span = s_km[interval.first], s_km[interval.last]
        axis.axvspan(*span, ymin=0.0, ymax=_STRIP, **STYLES["set_speed"])
    fit_speeds(axis, [recording])


def fit_speeds(axis: Any, recordings: Sequence[Recording]) -> None:
    """Set the speed axis to what was driven and allowed, with room for the strip below."""
    names = ("limit_mps", "base_mps", "profile_mps", "speed_mps")
    low = min(float(np.min(r[name])) for r in recordings for name in names[1:]) * KMH_PER_MPS
    high = max(float(np.max(r[name])) for r in recordings for name in names) * KMH_PER_MPS
    axis.set_ylim(max(low - 0.25 * (high - low) - 2.0, 0.0), high + 0.08 * (high - low) + 2.0)


def draw_limit_and_base(axis: Any, recording: Recording) -> None:
    """Draw the legal limit and the base profile along a recording."""
    s_km = recording["s_m"] * KM
    axis.step(
        s_km, recording["limit_mps"] * KMH_PER_MPS, where="post", color=GREY, linewidth=1.6,
        label="Legal limit",
    )  # fmt: skip
    axis.plot(
        s_km, recording["base_mps"] * KMH_PER_MPS, color=BLUE, linewidth=1.1, linestyle=(0, (4, 2)),
        label="Base profile",
    )  # fmt: skip


def legend(figure: Figure, axis: Any, recordings: Iterable[Recording] = ()) -> None:
    """Put one legend below the figure: lines of ``axis``, then what is shaded in ``recordings``."""
    found = {
        interval.kind
        for recording in recordings
        for interval in (*pedal_interventions(recording), *set_speed_interventions(recording))
    }
    kinds = [kind for kind in NAMES if kind in found]
    lines, labels = axis.get_legend_handles_labels()
    patches = [Patch(**STYLES[kind]) for kind in kinds]
    figure.legend(
        [*lines, *patches], [*labels, *(NAMES[kind] for kind in kinds)],
        loc="outside lower center", ncols=min(len(lines) + len(patches), 7), frameon=False,
        fontsize=9, columnspacing=1.6, handlelength=1.8,
    )  # fmt: skip


def finish(axes: Any, recording: Recording) -> None:
    """Give all panels, one above the other, the same grid, range and distance axis."""
    for axis in axes:
        axis.grid(True, color="#DDDDDD", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
    axes[-1].set_xlabel("Distance (km)")
    axes[-1].set_xlim(recording["s_m"][0] * KM, recording["s_m"][-1] * KM)


def _draw_several(axis: Any, recordings: Mapping[str, Recording]) -> None:
    draw_limit_and_base(axis, next(iter(recordings.values())))
    for number, (name, recording) in enumerate(recordings.items()):
        axis.plot(
            recording["s_m"] * KM, recording["speed_mps"] * KMH_PER_MPS, linewidth=1.4,
            color=DRIVES[number % len(DRIVES)], label=name,
        )  # fmt: skip
    fit_speeds(axis, list(recordings.values()))


def _draw_lanes(axis: Any, recordings: Mapping[str, Recording]) -> None:
    """Draw one lane per recording with bars where the driver intervened; set speed below."""
    for lane, recording in enumerate(recordings.values()):
        for interval in set_speed_interventions(recording):
            axis.broken_barh([_span(recording, interval)], (lane, 0.3), **STYLES["set_speed"])
        for interval in pedal_interventions(recording):
            style = {**STYLES[interval.kind], "alpha": 0.7}
            axis.broken_barh([_span(recording, interval)], (lane - 0.35, 0.35), **style)
    axis.set_yticks(range(len(recordings)), recordings)
    for number, text in enumerate(axis.get_yticklabels()):
        text.set_color(DRIVES[number % len(DRIVES)])
    axis.set_ylim(len(recordings) - 0.5, -0.5)
    axis.set_ylabel("Interventions")


def _span(recording: Recording, interval: Interval) -> tuple[float, float]:
    start, end = recording["s_m"][[interval.first, interval.last]] * KM
    return float(start), float(end - start)


def _draw_pedals(axis: Any, recordings: Mapping[str, Recording]) -> None:
    """Draw gas upwards and brake downwards."""
    for number, recording in enumerate(recordings.values()):
        s_km = recording["s_m"] * KM
        gas, brake = recording["gas_pedal"], -recording["brake_pedal"]
        if len(recordings) == 1:
            axis.fill_between(s_km, gas, color=GREEN, alpha=0.8, linewidth=0)
            axis.fill_between(s_km, brake, color=VERMILLION, alpha=0.8, linewidth=0)
        else:
            colour = DRIVES[number % len(DRIVES)]
            axis.plot(s_km, gas, color=colour, linewidth=1.1)
            axis.plot(s_km, brake, color=colour, linewidth=1.1)
    gas_reach, brake_reach = (
        max(0.1, *(float(np.max(recording[pedal])) for recording in recordings.values()))
        for pedal in ("gas_pedal", "brake_pedal")
    )
    axis.set_ylim(-1.2 * brake_reach, 1.2 * gas_reach)
    axis.axhline(0.0, color=GREY, linewidth=0.8)
    axis.yaxis.set_major_formatter(FuncFormatter(lambda travel, _: f"{100 * abs(travel):.0f} %"))
    axis.set_ylabel("Pedals\nbrake | gas")
