"""How the FMUs are told which road they drive."""

from __future__ import annotations

from pathlib import Path

from ..roads import Road, fingerprint, write_route_csv
from .values import Value


def road_values(road: Road, folder: Path) -> dict[str, Value]:
    """Return the parameters that make vehicle, driver and function drive on ``road``.

    FMUs know the numbers of the packed routes, and files; of start roads and default limits they
    know nothing. Where those were needed, the route is written as CSV into ``folder``.

    Raises:
        ModelError: the CSV cannot be written.
    """
    if road.as_it_is and road.route_id is not None:
        return {"route_id": road.route_id}
    if road.as_it_is:
        return {"route_file": str(road.file.resolve())}
    path = folder / f"road-{fingerprint(road.route)}.csv"
    if not path.exists():
        write_route_csv(road.route, path)
    return {"route_file": str(path.resolve())}
