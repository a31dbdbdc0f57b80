"""Figures of learning: the profile after each drive, one intervention in steps, the long run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ...analysis.long_run import Columns
from ...profiles.stored_profile import StoredProfile
from ...recordings.recording import Recording
from ...recordings.steps import Steps
from .. import palette
from ..scene import Axis, Element, Line, Panel, Scene, Stroke
from .driving import driven_line
from .speeds import SPEED, base_line, distance_axis, limit_line, speed_line, zero_line

STEPS: Final = ("1 recorded", "2 stretched", "3 offset", "4 mean", "5 smoothed")
_LONG_RUN: Final = {
    "combined_percent": Axis("Pedals or set speed", note="(% of the time)", low=0.0),
    "content_percent": Axis("Drivers who", note="did nothing (%)", low=0.0),
    "pedal_percent": Axis("Pedals", note="(% of the time)", low=0.0),
    "set_speed_percent": Axis("Set speed", note="(% of the time)", low=0.0),
    "wish_error_kmh": Axis("Profile minus lasting", note="wish, RMS (km/h)", low=0.0),
    "drive_wish_error_kmh": Axis("Profile minus wish of", note="the drive, RMS (km/h)", low=0.0),
}


def development(
    profile: StoredProfile,
    names: Sequence[str],
    recordings: Mapping[str, Recording],
    title: str,
    with_speeds: bool = False,
) -> Scene:
    """Return the profile after each drive that was learned, and its difference from the base.

    Args:
        profile: with one iteration per name in ``names``.
        names: the drives learned from.
        recordings: by drive; the legal limits are those of the first.
        title: of the whole figure.
        with_speeds: offer what was driven in ``recordings``, to be switched on.
    """
    first = next(iter(recordings.values()))
    s_m = np.arange(float(profile.nodes))
    x = distance_axis(0.0, s_m[-1])
    speeds: list[Element] = [
        limit_line(first["s_m"], first["limit_mps"]), base_line(s_m, profile.base_mps),
    ]  # fmt: skip
    changes: list[Element] = [replace(zero_line(x), stroke=palette.BASE)]
    for number, name in enumerate(names, start=1):
        learned = profile.iteration(number).learned_mps
        stroke = palette.iteration(number, len(names))
        label = f"Profile after {name}"
        speeds.append(speed_line(s_m, learned, stroke, label))
        changes.append(speed_line(s_m, learned - profile.base_mps, stroke, label))
    if with_speeds:
        for number, (name, recording) in enumerate(recordings.items()):
            speeds.append(replace(driven_line(number, name, recording), optional=True))
    difference = Axis("Learned minus base", note="(km/h)")
    return Scene(
        (Panel(tuple(speeds), x, SPEED, 3.2), Panel(tuple(changes), x, difference, 1.9)), title
    )


def steps(steps: Steps) -> Scene:
    """Return one intervention: recorded, stretched, offset, mean, smoothed."""
    node = steps.node_m
    pieces = (
        (steps.piece_m, steps.recorded_mps, Stroke(palette.BLACK, 2.6)),
        (steps.stretched_m, steps.recorded_mps, Stroke(palette.ORANGE, 1.8, "dash")),
        (steps.stretched_m, steps.joined_mps, Stroke(palette.VERMILLION, 2.0)),
        (node, steps.mean_mps, Stroke(palette.GREEN, 1.6, "dash")),
        (node, steps.learned_mps, Stroke(palette.PURPLE, 3.4)),
    )
    lines = (
        speed_line(node, steps.driven_mps, Stroke(palette.GREY, 1.2, "dot"), "Speed driven"),
        speed_line(node, steps.followed_mps, palette.BASE, "Profile followed"),
        # The smoothed profile would hide the mean.
        *(
            replace(speed_line(s_m, speed_mps, stroke, name), raised=name == STEPS[3])
            for name, (s_m, speed_mps, stroke) in zip(STEPS, pieces, strict=True)
        ),
    )
    x = distance_axis(node[0], node[-1])
    return Scene((Panel(lines, x, SPEED, 3.6),), width_in=9.0, stages=STEPS)


def long_run(runs: Mapping[str, Columns]) -> Scene:
    """Return rates, content drivers and remaining errors over drives, per variant."""
    return Scene(
        tuple(
            Panel(_runs(runs, column), Axis("Drive"), axis, 2.2)
            for column, axis in _LONG_RUN.items()
        ),
        columns=2,
        width_in=9.0,
    )


def _runs(runs: Mapping[str, Columns], column: str) -> tuple[Element, ...]:
    return tuple(
        Line(
            np.asarray(columns["drive"], float), np.asarray(columns[column], float),
            palette.series(number), variant,
        )
        for number, (variant, columns) in enumerate(runs.items())
    )  # fmt: skip
