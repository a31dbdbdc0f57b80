"""The roads of a file, for a person who looks for a way."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding
from ...kernel.arrays import FloatArray
from ..limits.speed_signs import signals_of
from ..limits.speeds import limits_along
from ..opendrive.contents import read_contents
from ..opendrive.leg import Leg, road_length_m
from ..opendrive.xml_parser import parse_xml
from ..opendrive.xml_tree import Element, Place
from ..options import RoadOptions
from ..route import Route
from .choices import choices
from .network import Network

_POINT_M: Final = 2.0  # between points that are shown of a line
_POINTS: Final = (2, 200)  # at least and at most


@dataclass(frozen=True, eq=False)
class RoadRow:
    """One road of a file.

    Attributes:
        id: by which it is named; empty in a CSV file, which is one road.
        name: what people call it, if anything.
        junction: id of the junction that it leads through; empty: it is none of a junction's.
        length_m: as the file states it.
        lanes: for cars, along the direction in which it is drawn and against it; None: not stated.
        limits_mps: the lowest and the highest limit on it; None: it states none.
        ways_on: ids of the roads that it leads on to, driven along its direction and against it.
        line_m: x and y of points along its line, as it is drawn; None: it has none that is read.
    """

    id: str
    name: str
    junction: str
    length_m: float
    lanes: tuple[int, int] | None
    limits_mps: tuple[float, float] | None
    ways_on: tuple[tuple[str, ...], tuple[str, ...]]
    line_m: tuple[FloatArray, FloatArray] | None = None


def opendrive_rows(blocks: Iterable[bytes], path: Path, options: RoadOptions) -> list[RoadRow]:
    """Return the roads of an OpenDRIVE file in its order, those of junctions last.

    Args:
        blocks: the content of the file, as ``parse_xml`` takes it.
        path: names it in errors.
        options: how its limits are to be read.

    Raises:
        ModelError: it is no OpenDRIVE file, or ids are not unique.
    """
    notes: list[Finding] = []
    root = parse_xml(blocks, "OpenDRIVE", path, notes)
    network, signals = Network(root, Place(path)), signals_of(root)
    rows = [
        _row(network, Leg(road, against=False), signals, options) for road in network.roads.values()
    ]
    return sorted(rows, key=lambda row: row.junction != "")


def csv_row(route: Route) -> RoadRow:
    """Return the one road that a CSV file is."""
    limits = (float(route.speed_limit_mps.min()), float(route.speed_limit_mps.max()))
    line = (route.x_m, route.y_m) if route.has_line else None
    return RoadRow("", route.name, "", route.length_m, None, limits, ((), ()), line)


def _row(
    network: Network, leg: Leg, signals: Mapping[str, Element], options: RoadOptions
) -> RoadRow:
    given = leg.road.attributes
    junction = given.get("junction", "-1")
    legs = [each for each in (leg, leg.turned) if network.has_lane(each) is not False]
    along, against = (
        tuple(way.target.id for way in choices(network, each)) if each in legs else ()
        for each in (leg, leg.turned)
    )
    return RoadRow(
        leg.id,
        given.get("name", "").strip(),
        "" if junction == "-1" else junction,
        road_length_m(leg),
        network.lanes(leg.road),
        _limits_mps(network.place.path, legs or [leg], signals, options),
        (along, against),
        _line_m(network.place.path, leg),
    )


def _line_m(path: Path, leg: Leg) -> tuple[FloatArray, FloatArray] | None:
    try:
        contents = read_contents(leg, Place(path, leg.id))
        count = int(np.clip(contents.length_m / _POINT_M, *_POINTS))
        points = contents.points_at(np.linspace(0.0, contents.length_m, count))
    except ModelError:
        return None  # said when the road is driven
    return points.x_m, points.y_m


def _limits_mps(
    path: Path, legs: list[Leg], signals: Mapping[str, Element], options: RoadOptions
) -> tuple[float, float] | None:
    """Return the lowest and the highest limit in the directions in which cars drive."""
    stated = replace(options, default_limit_mps=None)
    limits: list[float] = []
    for leg in legs:
        try:
            contents = read_contents(leg, Place(path, leg.id))
            (steps,), _ = limits_along([contents], signals, stated, [])
        except ModelError:
            continue  # said when the road is driven
        limits += [limit for _, limit in steps]
    return (min(limits), max(limits)) if limits else None
