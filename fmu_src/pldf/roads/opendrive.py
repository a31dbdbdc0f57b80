"""A way through an OpenDRIVE file, read step by step to the knots of a route."""

from __future__ import annotations

from itertools import accumulate
from pathlib import Path

from ..errors import ModelError
from ..findings import Finding
from .contents import read_contents
from .joining import joined
from .leg import Leg
from .network import Network
from .options import RoadOptions
from .route import Mark, Route
from .sampling import sample
from .speeds import limits_along
from .ways import find_way
from .xml_tree import Place, parse_xml


def parse_opendrive(data: bytes, path: Path, options: RoadOptions) -> Route:
    """Return the route along the chain of roads in ``data``; ``path`` names it in errors.

    Raises:
        ModelError: with file, line, road and way out.
    """
    notes: list[Finding] = []
    root = parse_xml(data, "OpenDRIVE", path, notes)
    legs = find_way(Network(root, Place(path)), options, notes)
    roads = [read_contents(leg, Place(path, leg.id)) for leg in legs]
    limits = limits_along(roads, options, notes)
    starts_m = [0.0, *accumulate(road.length_m for road in roads)]
    stretches = [sample(*each) for each in zip(roads, limits, starts_m, strict=False)]
    (s_m, curvature, limit, grade, x_m, y_m), _ = joined(stretches)
    header = root.find("header")
    name = header.attributes.get("name", "").strip() if header is not None else ""
    marks = tuple(Mark(s, "road", _named(leg)) for s, leg in zip(starts_m, legs, strict=False))
    try:
        return Route(
            name or path.stem, s_m, curvature, limit, grade, x_m, y_m,
            notes=tuple(notes), marks=marks,
        )  # fmt: skip
    except ModelError as error:
        raise ModelError(f"{path}: {error}") from None


def _named(leg: Leg) -> str:
    """Return a road's id, and its name if it has another."""
    name = leg.road.attributes.get("name", "").strip()
    return f"{leg.id} {name}" if name not in ("", leg.id) else leg.id
