"""Routes from files and from the package."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Final

from ..errors import ModelError
from .csv_file import parse_route_csv
from .opendrive_file import parse_opendrive
from .options import AS_WRITTEN, LimitUnit, OptionNeededError, RoadOptions, arguments, keywords
from .route import Route
from .ways.listing import RoadRow, csv_row, opendrive_rows

DATA: Final = Path(__file__).parent / "data"
# Index = route_id. Only ever append: studies refer to routes by this number.
PACKED: Final = ("study_road.xodr",)
STUDY_ROAD_ID: Final = 0
_BLOCK: Final = 1 << 22  # bytes that are read at a time


def read_route(path: Path | str, options: RoadOptions = AS_WRITTEN) -> Route:
    """Read an OpenDRIVE or route CSV file, told apart by content.

    Args:
        path: the file.
        options: how it is to be read.

    Raises:
        ModelError: when the file cannot be read or used; names file, line and way out.
    """
    path = Path(path)
    with _content(path) as (blocks, is_opendrive):
        if is_opendrive:
            return parse_opendrive(blocks, path, options)
        return parse_route_csv(b"".join(blocks), path, options.smoothing_m)


@contextmanager
def _content(path: Path) -> Iterator[tuple[Iterable[bytes], bool]]:
    """Open a file: yield its bytes, block by block, and whether they are OpenDRIVE.

    A city's file is larger than what is read of it.
    """
    try:
        with path.open("rb") as file:
            head = file.read(_BLOCK)
            by_name = path.suffix.lower() in (".xodr", ".xml")
            if b"<OpenDRIVE" not in head and not (by_name and head.strip()):
                head += file.read()
            if not head.strip():
                raise ModelError(f"{path}: the file is empty")
            rest = iter(lambda: file.read(_BLOCK), b"")
            yield chain([head], rest), by_name or b"<OpenDRIVE" in head
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({error.strerror}); check the path") from None


@dataclass(frozen=True, eq=False)
class Road:
    """A route and where it came from, so that others can find it again.

    Attributes:
        route: the route.
        route_id: its number among the packed routes; None: it comes from ``file``.
        file: the file, as the person named it; a packed one's own file.
        as_it_is: number or file alone give this route, without options.
    """

    route: Route
    route_id: int | None
    file: Path
    as_it_is: bool


def open_road(name: str, options: RoadOptions = AS_WRITTEN) -> Road:
    """Return the road that a person named: a file, else ``study`` or the number of a packed route.

    Args:
        name: as above.
        options: how its file is to be read.

    Raises:
        ModelError: as ``read_route``, or there is no packed route with this number.
    """
    route_id, file = _found(name)
    return Road(read_route(file, options), route_id, file, options == AS_WRITTEN)


def roads_of(name: str, options: RoadOptions = AS_WRITTEN) -> list[RoadRow]:
    """Return the roads of the file that a person named, those of junctions last.

    Args:
        name: as for ``open_road``.
        options: how limits are to be read; what is said of a way does not matter.

    Raises:
        ModelError: the file cannot be read.
    """
    _, path = _found(name)
    with _content(path) as (blocks, is_opendrive):
        if is_opendrive:
            return opendrive_rows(blocks, path, options)
        return [csv_row(parse_route_csv(b"".join(blocks), path, options.smoothing_m))]


def open_route(  # noqa: PLR0913 - all by keyword, as a person says them
    name: str,
    *,
    start_road: str | None = None,
    via: Iterable[str] = (),
    to: str | None = None,
    reverse: bool = False,
    default_limit_mps: float | None = None,
    limit_unit: LimitUnit | None = None,
    signs: bool = True,
    smoothing_m: float | None = None,
) -> Route:
    """Return the route that a person named.

    Args:
        name: a file, ``study`` for the shipped road, or the number of a packed route.
        start_road: id of the OpenDRIVE road to start with; None: the only possible one.
        via: ids of the roads to pass, in this order; also as a text, ``"12,45"``.
        to: id of the road that the way ends with.
        reverse: the start road is driven against the direction in which it is drawn.
        default_limit_mps: limit where the file states none and no neighbour does.
        limit_unit: unit of limits that the file states without one.
        signs: speed signs count where no speed is stated.
        smoothing_m: the curvature is its mean over so many metres; None: only noise is smoothed.

    Raises:
        ModelError: as ``open_road``.
    """
    named = (via,) if isinstance(via, str) else tuple(via)
    options = RoadOptions(
        start_road, named, to, reverse, default_limit_mps, limit_unit, signs, smoothing_m
    )
    try:
        return open_road(name, options).route
    except OptionNeededError as error:
        raise ModelError(error.told(keywords)) from None


def packed_route(route_id: int) -> Route:
    """Return the route with this index among those shipped with the package, 0 = the study road.

    Raises:
        ModelError: for an unknown index; lists the known ones.
    """
    return read_route(_packed_file(route_id))


def _found(name: str) -> tuple[int | None, Path]:
    """Return the number of the packed route that a person named, None for a file, and the file."""
    path = Path(name)
    # A folder hides no packed route: it is none itself.
    route_id = None if path.exists() and not path.is_dir() else _packed_id(name)
    return route_id, path if route_id is None else _packed_file(route_id)


def _packed_id(name: str) -> int | None:
    if name == "study":
        return STUDY_ROAD_ID
    return int(name) if name.isdecimal() and name.isascii() else None


def _packed_file(route_id: int) -> Path:
    if not 0 <= route_id < len(PACKED):
        known = ", ".join(f"{i} = {Path(name).stem}" for i, name in enumerate(PACKED))
        raise ModelError(f"route_id {route_id} is unknown; packed routes: {known}")
    return DATA / PACKED[route_id]


def chosen_route(route_id: int, route_file: str) -> Route:
    """Return the route that a model's parameters name: the file if there is one, else the packed.

    Raises:
        ModelError: as ``read_route`` and ``packed_route``.
    """
    if not route_file:
        return packed_route(route_id)
    try:
        return read_route(route_file)
    except OptionNeededError as error:  # a model has no such options: its route_file must say all
        route = f"pldf route {shlex.quote(route_file)}"
        told = error.told(lambda options: f"{route} {arguments(options)} --export my.csv")
        raise ModelError(told) from None
