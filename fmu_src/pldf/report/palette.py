"""Colours, strokes and fills of all figures, on paper and on the page.

Colours are Okabe and Ito's, which keep apart for every kind of colour vision; what only colour
would tell apart is dashed, marked or hatched as well, for print.
"""

from __future__ import annotations

from typing import Final

from .scene import Dash, Fill, Mark, Stroke

BLACK, GREY, BLUE, SKY, GREEN, VERMILLION, ORANGE, PURPLE = (
    "#000000", "#666666", "#0072B2", "#56B4E9", "#009E73", "#D55E00", "#E69F00", "#CC79A7",
)  # fmt: skip
GRID: Final = "#DDDDDD"

LIMIT: Final = Stroke(GREY, 1.6)
BASE: Final = Stroke(BLUE, 1.2, "dash")
FOLLOWED: Final = Stroke(BLUE, 1.6)
DRIVEN: Final = Stroke(BLACK, 1.3)
NEWEST: Final = Stroke(PURPLE, 1.6, "dot")
ZERO: Final = Stroke("#888888", 0.8)

# Recordings in one panel: every other one is dashed, so that it hides no solid one below.
COMPARED: Final = (
    Stroke(BLUE, 1.4),
    Stroke(VERMILLION, 1.4, "dash"),
    Stroke(GREEN, 1.4),
    Stroke(ORANGE, 1.4, "dash"),
    Stroke(PURPLE, 1.4),
    Stroke(SKY, 1.4, "dash"),
    Stroke(BLACK, 1.4, "dot"),
)

LEARNED: Final = Fill(SKY, 0.35)
CURVE: Final = Fill(ORANGE, 0.25)
# What a driver does: by kind of intervention its name and how it is shaded.
INTERVENTIONS: Final = {
    "gas": ("Gas pedal", Fill(GREEN, 0.32)),
    "brake": ("Brake until reactivated", Fill(VERMILLION, 0.32, hatched=True)),
    "set_speed": ("Set speed changed", Fill(ORANGE, 0.9)),
}
# Why the car drives at its speed: by name of the reason what it is called and how it is shaded. One
# colour for one kind of reason; a bound, or what only leads there, is hatched.
REASONS: Final = {
    "LIMIT": ("Speed limit", Fill(GREY, 0.45)),
    "COASTING_TO_LIMIT": ("Limit ahead", Fill(GREY, 0.75, hatched=True)),
    "CAP_LEGAL": ("At the bound over the limit", Fill(BLACK, 0.7, hatched=True)),
    "TEMPORARY_LIMIT": ("Temporary limit", Fill(GREY, 0.9)),
    "CURVE": ("Curve", Fill(ORANGE, 0.75)),
    "CAP_CURVE": ("At the bound for curves", Fill(ORANGE, 0.9, hatched=True)),
    "LEARNED_FASTER": ("Learned: faster", Fill(BLUE, 0.85)),
    "LEARNED_SLOWER": ("Learned: slower", Fill(SKY, 0.85)),
    "LEARNED_OFFSET": ("Learned: set speed", Fill(PURPLE, 0.8)),
    "MANUAL_SET": ("Set by the driver", Fill(PURPLE, 0.35, hatched=True)),
    "OVERRIDE": ("The driver, by gas", Fill(GREEN, 0.7)),
    "SLOWING_DOWN": ("Slowing down", Fill(BLACK, 0.12, hatched=True)),
    "SPEEDING_UP": ("Speeding up", Fill(BLACK, 0.12)),
    "FOLLOWING": ("Car ahead", Fill(VERMILLION, 0.75)),
    "HELD": ("Held behind a car", Fill(VERMILLION, 0.9, hatched=True)),
    "STANDBY": ("Standby", Fill(BLACK, 0.06)),
    "OFF": ("Off", Fill(BLACK, 0.06)),
    "FAULT": ("Fault", Fill(BLACK, 0.9)),
}


_SERIES: Final[tuple[tuple[str, Dash, Mark], ...]] = (
    (VERMILLION, "solid", "circle"),
    (ORANGE, "dash", "square"),
    (BLUE, "solid", "triangle"),
    (GREEN, "dot", "diamond"),
    (PURPLE, "dash", "circle"),
    (SKY, "solid", "square"),
    (BLACK, "dot", "triangle"),
    (GREY, "dashdot", "diamond"),
)


# Legal limits in order, light and wide for fast: a part of matplotlib's viridis, which keeps apart
# and in order for every kind of colour vision and in print.
_LIMITS: Final = (
    "#440154", "#472F7D", "#39568C", "#287C8E", "#1FA187", "#4AC16D", "#93D741",
)  # fmt: skip
LIMITS_MAX: Final = len(_LIMITS)


def limit(number: int, count: int) -> Stroke:
    """Return the stroke of limit ``number`` (from 0, the slowest) of ``count``."""
    share = number / (count - 1) if count > 1 else 0.5
    return Stroke(_LIMITS[round(share * (LIMITS_MAX - 1))], 2.2 + 2.6 * share)


def series(number: int) -> Stroke:
    """Return the stroke of the series with this number, from 0, its points marked."""
    colour, dash, mark = _SERIES[number % len(_SERIES)]
    return Stroke(colour, 1.5, dash, mark, 4.0)


def iteration(number: int, count: int) -> Stroke:
    """Return the stroke of learned state ``number`` (from 1) of ``count``.

    Later states are darker, thicker lines: earlier ones stay visible below.
    """
    few: tuple[tuple[str, Dash], ...] = ((SKY, "solid"), (GREEN, "dashdot"), (BLACK, "solid"))
    more: tuple[tuple[str, Dash], ...] = (*few[:2], (ORANGE, "solid"), (PURPLE, "dash"), few[2])
    colour, dash = (shades := few if count <= len(few) else more)[(number - 1) % len(shades)]
    return Stroke(colour, 1.0 + 0.3 * min(number, len(more)), dash)
