"""Roads: OpenDRIVE and CSV files to routes, and the shipped study road."""

from __future__ import annotations

from .csv_file import write_route_csv
from .load import Road, chosen_route, open_road, open_route, packed_route, read_route, roads_of
from .options import AS_WRITTEN, RoadOptions
from .route import Mark, Route, fingerprint, route_arrays
from .ways.listing import RoadRow

__all__ = [
    "AS_WRITTEN",
    "Mark",
    "Road",
    "RoadOptions",
    "RoadRow",
    "Route",
    "chosen_route",
    "fingerprint",
    "open_road",
    "open_route",
    "packed_route",
    "read_route",
    "roads_of",
    "route_arrays",
    "write_route_csv",
]
