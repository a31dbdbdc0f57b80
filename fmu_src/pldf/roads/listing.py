"""The roads of a file, for a person who looks for a way."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import ModelError
from ..findings import Finding
from .choices import choices
from .contents import read_contents
from .leg import Leg, road_length_m
from .network import Network
from .options import RoadOptions
from .route import Route
from .speed_signs import signals_of
from .speeds import limits_along
from .xml_parser import parse_xml
from .xml_tree import Element, Place


@dataclass(frozen=True)
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
    """

    id: str
    name: str
    junction: str
    length_m: float
    lanes: tuple[int, int] | None
    limits_mps: tuple[float, float] | None
    ways_on: tuple[tuple[str, ...], tuple[str, ...]]


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
    return RoadRow("", route.name, "", route.length_m, None, limits, ((), ()))


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
    )


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
