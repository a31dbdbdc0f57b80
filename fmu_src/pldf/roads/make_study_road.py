"""Build the shipped study road: ``python -m pldf.roads.make_study_road [FOLDER]``.

4.5 km of curvy rural road as in the paper: mostly 80 and 100 km/h, a bridge at 60 and a village at
50 km/h. Seven curves lie far enough below their legal limit to be felt. Every limit starts on a
straight that is long enough to settle at the new speed, because a driver touches the set-speed
lever only in steady cruise. Curves begin and end in clothoids, as real ones do; without them each
curve would be a jump in curvature. All lengths are whole metres, so the knots of the CSV, too, are
exact. The same code gives the same bytes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from .csv_file import write_route_csv
from .load import DATA, read_route
from .opendrive.geometry import Geometries

NAME: Final = "Study road"
LENGTH_M: Final = 4500

# From this position on (m): limit (km/h) and OpenDRIVE road type.
LIMITS: Final = (
    (0, 100, "rural"),
    (1000, 80, "rural"),
    (1700, 60, "rural"),  # bridge
    (1960, 80, "rural"),
    (2710, 50, "town"),
    (3040, 100, "rural"),
)
BRIDGE_M: Final = (1720, 220)  # start and length

# Lengths of the straights (m) and the curves between them: radius (m, positive to the left),
# length of the arc and of each of its two clothoids (m).
STRAIGHTS_M: Final = (360, 60, 470, 130, 800, 190, 720, 80, 380)
CURVES_M: Final = (
    (200, 70, 50),
    (-180, 80, 50),
    (140, 70, 40),
    (-150, 60, 40),
    (-140, 80, 50),
    (200, 60, 40),  # in the village, does not bind
    (-220, 80, 50),
    (170, 70, 50),
)

# Position (m), height (m) and grade there; cubic in between.
HEIGHTS: Final = (
    (0, 412.0, 0.0),
    (600, 420.0, 0.02),
    (1200, 426.0, -0.01),
    (1700, 412.0, -0.02),
    (1960, 409.5, 0.0),
    (2710, 421.0, 0.01),
    (3040, 422.0, 0.0),
    (3900, 409.0, -0.015),
    (4500, 404.0, 0.0),
)


def stretches() -> Iterator[tuple[int, float, float]]:
    """Yield length (m), first and last curvature (1/m) of every line, spiral and arc."""
    for straight, (radius, arc, clothoid) in zip(STRAIGHTS_M, CURVES_M, strict=False):
        curvature = 1.0 / radius
        yield straight, 0.0, 0.0
        yield clothoid, 0.0, curvature
        yield arc, curvature, curvature
        yield clothoid, curvature, 0.0
    yield STRAIGHTS_M[-1], 0.0, 0.0


def study_road_xodr() -> str:
    """Return the road as OpenDRIVE 1.7."""
    bridge = f's="{BRIDGE_M[0]}" length="{BRIDGE_M[1]}"'
    return "\n".join(
        (
            '<?xml version="1.0" encoding="UTF-8"?>',
            "<!-- Written by python -m pldf.roads.make_study_road; do not edit. -->",
            "<OpenDRIVE>",
            f'  <header revMajor="1" revMinor="7" name="{NAME}" version="1.00"/>',
            f'  <road name="{NAME}" length="{LENGTH_M}" id="1" junction="-1" rule="RHT">',
            "    <link/>",
            *_types(),
            "    <planView>",
            *_plan_view(),
            "    </planView>",
            "    <elevationProfile>",
            *_elevation(),
            "    </elevationProfile>",
            "    <lateralProfile/>",
            "    <lanes>",
            '      <laneSection s="0">',
            *_lane("left", 1),
            '        <center><lane id="0" type="none" level="false"/></center>',
            *_lane("right", -1),
            "      </laneSection>",
            "    </lanes>",
            f'    <objects><bridge {bridge} id="1" name="Bridge" type="concrete"/></objects>',
            "  </road>",
            "</OpenDRIVE>",
            "",
        )
    )


def write_study_road(folder: Path = DATA) -> None:
    """Write ``study_road.xodr`` and ``study_road.csv`` into ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    xodr = folder / "study_road.xodr"
    xodr.write_text(study_road_xodr(), encoding="utf-8", newline="\n")
    route = read_route(xodr)
    # Sines differ in the last bit between machines; tenths of a millimetre do not.
    route = replace(route, x_m=np.round(route.x_m, 4), y_m=np.round(route.y_m, 4))
    write_route_csv(route, folder / "study_road.csv")


def _types() -> Iterator[str]:
    for start, limit, kind in LIMITS:
        yield f'    <type s="{start}" type="{kind}"><speed max="{limit}" unit="km/h"/></type>'


def _plan_view() -> Iterator[str]:
    s_m, (x_m, y_m, heading_rad) = 0, (0.0, 0.0, 0.0)
    for length, first, last in stretches():
        where = f'x="{x_m:.6f}" y="{y_m:.6f}" hdg="{heading_rad:.9f}"'
        head = f'<geometry s="{s_m}" {where} length="{length}">'
        yield f"      {head}{_shape(first, last)}</geometry>"
        piece = Geometries.linear(x_m, y_m, heading_rad, length, first, last)
        end = piece.points(np.zeros(1, dtype=np.intp), np.array([float(length)]))
        x_m, y_m, heading_rad = (float(v[0]) for v in (end.x_m, end.y_m, end.heading_rad))
        s_m += length


def _shape(first: float, last: float) -> str:
    if first != last:
        return f'<spiral curvStart="{first!r}" curvEnd="{last!r}"/>'
    return f'<arc curvature="{first!r}"/>' if first else "<line/>"


def _elevation() -> Iterator[str]:
    for (s, height, grade), (s_next, height_next, grade_next) in pairwise(HEIGHTS):
        span = s_next - s
        mean = (height_next - height) / span
        c = round((3.0 * mean - 2.0 * grade - grade_next) / span, 9) + 0.0
        d = round((grade + grade_next - 2.0 * mean) / (span * span), 12) + 0.0
        yield f'      <elevation s="{s}" a="{height!r}" b="{grade!r}" c="{c!r}" d="{d!r}"/>'


def _lane(side: str, lane_id: int) -> Iterator[str]:
    width = '<width sOffset="0" a="3.5" b="0" c="0" d="0"/>'
    yield f"        <{side}>"
    yield f'          <lane id="{lane_id}" type="driving" level="false">{width}</lane>'
    yield f"        </{side}>"


if __name__ == "__main__":
    write_study_road(*(Path(folder) for folder in sys.argv[1:2]))
