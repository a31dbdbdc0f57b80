"""Routes from files and from the package."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from ..instance import ModelError
from .csv_file import parse_route_csv
from .opendrive import parse_opendrive
from .route import Route

DATA: Final = Path(__file__).parent / "data"
# Index = route_id. Only ever append: studies refer to routes by this number.
PACKED: Final = ("study_road.xodr",)
STUDY_ROAD_ID: Final = 0


def read_route(
    path: Path | str, *, start_road: str | None = None, default_limit_mps: float | None = None
) -> Route:
    """Read an OpenDRIVE or route CSV file, told apart by content.

    Args:
        path: the file.
        start_road: id of the OpenDRIVE road to start with; default: the only possible one.
        default_limit_mps: limit for OpenDRIVE roads that state none.

    Raises:
        ModelError: when the file cannot be read or used; names file, line and way out.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({error.strerror}); check the path") from None
    if not data.strip():
        raise ModelError(f"{path}: the file is empty")
    if b"<OpenDRIVE" in data or path.suffix.lower() in (".xodr", ".xml"):
        return parse_opendrive(
            data, path, start_road=start_road, default_limit_mps=default_limit_mps
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ModelError(f"{path}, line {line}: not UTF-8 text; save the file as UTF-8") from None
    return parse_route_csv(text, path)


def open_route(
    name: str, *, start_road: str | None = None, default_limit_mps: float | None = None
) -> Route:
    """Return the route that a person named.

    Args:
        name: a file, ``study`` for the shipped road, or the number of a packed route.
        start_road: as for ``read_route``.
        default_limit_mps: as for ``read_route``.

    Raises:
        ModelError: as ``read_route`` and ``packed_route``.
    """
    if not Path(name).exists() and (name == "study" or name.isdigit()):
        return packed_route(STUDY_ROAD_ID if name == "study" else int(name))
    return read_route(name, start_road=start_road, default_limit_mps=default_limit_mps)


def packed_route(route_id: int) -> Route:
    """Return the route with this index among those shipped with the package, 0 = the study road.

    Raises:
        ModelError: for an unknown index; lists the known ones.
    """
    if not 0 <= route_id < len(PACKED):
        known = ", ".join(f"{i} = {Path(name).stem}" for i, name in enumerate(PACKED))
        raise ModelError(f"route_id {route_id} is unknown; packed routes: {known}")
    return read_route(DATA / PACKED[route_id])


def chosen_route(route_id: int, route_file: str) -> Route:
    """Return the route that a model's parameters name: the file if there is one, else the packed.

    Raises:
        ModelError: as ``read_route`` and ``packed_route``.
    """
    return read_route(route_file) if route_file else packed_route(route_id)
