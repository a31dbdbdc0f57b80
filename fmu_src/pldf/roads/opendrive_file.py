"""A way through an OpenDRIVE file, read step by step to the knots of a route."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from itertools import accumulate
from pathlib import Path

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..kernel.arrays import FloatArray
from .curves.bending import S
from .curves.judge import Locate, judged
from .knots.joining import joined
from .knots.sampling import Stretch, sample
from .limits.speed_signs import signals_of
from .limits.speeds import limits_along
from .opendrive.contents import read_contents
from .opendrive.leg import Leg
from .opendrive.xml_parser import parse_xml
from .opendrive.xml_tree import Place
from .options import RoadOptions
from .route import COLUMNS, Mark, Route, first_fault
from .ways.network import Network
from .ways.ways import find_way


def parse_opendrive(blocks: Iterable[bytes], path: Path, options: RoadOptions) -> Route:
    """Return the route along the chain of roads of a file.

    Args:
        blocks: the content of the file, as ``parse_xml`` takes it.
        path: of the file, for errors.
        options: how it is to be read.

    Raises:
        ModelError: with file, line, road and way out.
    """
    notes: list[Finding] = []
    root = parse_xml(blocks, "OpenDRIVE", path, notes)
    legs = find_way(Network(root, Place(path)), options, notes)
    roads = [read_contents(leg, Place(path, leg.id)) for leg in legs]
    limits, signs = limits_along(roads, signals_of(root), options, notes)
    starts_m = [0.0, *accumulate(road.length_m for road in roads)]
    stretches = [sample(*each) for each in zip(roads, limits, starts_m, strict=False)]
    notes += (note for stretch in stretches for note in stretch.notes)
    knots, joints = joined(stretches, notes)
    locate = _locator(stretches, starts_m)
    _check(knots, path, locate, sharp=False)
    knots, told = judged(knots, joints, options.smoothing_m, str(path), locate)
    _check(knots, path, locate)
    s_m, curvature, limit, grade, x_m, y_m = knots
    header = root.find("header")
    name = header.attributes.get("name", "").strip() if header is not None else ""
    begun = [
        Mark(s, "road", _named(leg), leg.against) for s, leg in zip(starts_m, legs, strict=False)
    ]
    return Route(
        name or path.stem,
        s_m,
        curvature,
        limit,
        grade,
        x_m,
        y_m,
        notes=(*notes, *told),
        marks=tuple(sorted([*begun, *signs], key=lambda mark: mark.s_m)),
    )


def _check(knots: FloatArray, path: Path, locate: Locate, *, sharp: bool = True) -> None:
    """Raise ModelError, with its place in the file, for the first knot that is of no use."""
    fault = first_fault(dict(zip(COLUMNS, knots, strict=True)), sharp=sharp)
    if fault is not None:
        index, text = fault
        line, place = locate(float(knots[S, index]))
        raise ModelError(f"{path}, line {line}, {place}: {text}")


def _locator(stretches: list[Stretch], starts_m: list[float]) -> Locate:
    """Return what says where in the file a place on the route is."""

    def locate(at_m: float) -> tuple[int, str]:
        k = min(max(bisect_right(starts_m, at_m) - 1, 0), len(stretches) - 1)
        stretch, ds = stretches[k], at_m - starts_m[k]
        leg = stretch.contents.leg
        behind = int(np.searchsorted(stretch.joints.s_m, at_m, side="right"))
        line = int(stretch.joints.line[behind - 1]) if behind else leg.road.line
        s_m = stretch.contents.length_m - ds if leg.against else ds
        place = f"road {leg.id}, s = {s_m:.1f} m"
        return line, place if abs(s_m - at_m) < 0.05 else f"{place} ({at_m:.1f} m of the route)"

    return locate


def _named(leg: Leg) -> str:
    """Return a road's id, and its name if it has another."""
    name = leg.road.attributes.get("name", "").strip()
    same = ("", leg.id, f"Road {leg.id}")  # some programs name every road so
    return leg.id if name in same else f"{leg.id} {name}"
