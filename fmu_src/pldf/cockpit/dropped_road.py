"""A road that somebody dropped on the page: read as the commands read it."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any, Final

from ..errors import ModelError
from ..roads import RoadOptions, open_road
from ..roads.options import OptionNeededError
from ..route_facts import route_facts
from .page_json import plain
from .road_view import road_view
from .storage import Refused

# An OpenDRIVE file of a city.
ROAD_MAX: Final = 200_000_000
_SUFFIXES: Final = (".xodr", ".xml", ".csv")


def dropped_road(name: str, data: bytes, options: Mapping[str, str]) -> dict[str, Any]:
    """Return the road in the form of the page, with where it ends and how fast it begins.

    Args:
        name: of the file, as the person has it.
        data: its content.
        options: ``start_road``, ``via`` (ids with commas), ``to``, ``reverse`` ("true"),
            ``default_limit_mps``.

    Raises:
        OptionNeededError: the file leaves something open.
        ModelError: the road cannot be used; names file and line.
        Refused: it is no road by its name.
    """
    given = PurePosixPath(name.replace("\\", "/")).name
    suffix = Path(given).suffix.lower()
    if suffix not in _SUFFIXES:
        raise Refused(HTTPStatus.BAD_REQUEST, f"{given}: roads are {', '.join(_SUFFIXES)} files")
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"road{suffix}"
        file.write_bytes(data)
        try:
            road = open_road(str(file), _options(options))
            view = road_view(road)
        except OptionNeededError as problem:
            matter = problem.matter.replace(str(file), given)
            raise OptionNeededError(matter, problem.suggested) from None
        except ModelError as problem:
            raise ModelError(str(problem).replace(str(file), given)) from None
    return {
        "road": plain({**view, "name": given}),
        "end_m": road.route.nodes - 1.0,
        "start_speed_mps": float(route_facts(road.route).base_mps[0]),
    }


def _options(given: Mapping[str, str]) -> RoadOptions:
    limit = given.get("default_limit_mps", "")
    try:
        limit_mps = float(limit) if limit else None
    except ValueError:
        raise ModelError(f"default_limit_mps = {limit!r} must be a number, in m/s") from None
    return RoadOptions(
        start_road=given.get("start_road") or None,
        via=tuple(filter(None, given.get("via", "").split(","))),
        to=given.get("to") or None,
        reverse=given.get("reverse", "") == "true",
        default_limit_mps=limit_mps,
    )
