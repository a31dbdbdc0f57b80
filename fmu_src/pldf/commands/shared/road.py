"""How a road is named, the same in every command."""

from __future__ import annotations

import argparse
import math
from typing import get_args

from ...kernel.units import KMH_PER_MPS
from ...roads import Road, RoadOptions, open_road
from ...roads.options import LimitUnit
from .telling import tell

_LIMIT_MAX_KMH = 300.0
_SMOOTHING_MAX_M = 1000.0

Parser = argparse.ArgumentParser | argparse._ArgumentGroup


def add_road(
    parser: Parser,
    about: str = "road driven",
    *,
    default: str | None = None,
    required: bool = False,
    by_position: bool = False,
) -> None:
    """Add the arguments that name a road: ``--route``, or by position, and what goes with it.

    Args:
        parser: of the command.
        about: what the road is for, for the help.
        default: the road without the option; None: there is none.
        required: the option must be given.
        by_position: the road is the command's own argument, in place of ``--route``.
    """
    text = (
        f"{about}: .xodr or .csv file, 'study' (the shipped road), or the number of a packed route"
        f"{f' (default: {default})' if default else ''}"
    )
    if by_position:
        parser.add_argument("road", metavar="ROAD", help=text)
    else:
        parser.add_argument(
            "--route", dest="road", metavar="ROAD", default=default, required=required, help=text
        )
    parser.add_argument(
        "--start-road", metavar="ID", help="OpenDRIVE road that the route starts with"
    )
    parser.add_argument(
        "--via", metavar="ID,ID", type=_ids, default=(),
        help="roads that the way passes, in this order, such as 12,45,7",
    )  # fmt: skip
    parser.add_argument("--to", metavar="ID", help="road that the way ends with")
    parser.add_argument(
        "--reverse", action="store_true",
        help="drive the start road against the direction in which it is drawn",
    )  # fmt: skip
    parser.add_argument(
        "--default-limit", metavar="KMH", type=_limit,
        help="limit where neither the road nor a neighbour states one",
    )  # fmt: skip
    parser.add_argument(
        "--limit-unit", choices=get_args(LimitUnit),
        help="unit of limits that the file states without one (default: m/s, as OpenDRIVE says)",
    )  # fmt: skip
    parser.add_argument(
        "--no-signs", dest="signs", action="store_false",
        help="do not read speed signs where the road states no limit",
    )  # fmt: skip
    parser.add_argument(
        "--smoothing", dest="smoothing_m", metavar="M", type=_metres,
        help="take the mean curvature over M metres; 0: never (default: only noise is smoothed)",
    )  # fmt: skip


def chosen_road(options: argparse.Namespace) -> Road | None:
    """Return the road that the arguments name, None if they name none.

    Raises:
        ModelError: it cannot be used.
    """
    if options.road is None:
        return None
    road = open_road(options.road, road_options(options))
    tell(road.route.notes)
    return road


def required_road(options: argparse.Namespace) -> Road:
    """Return the road where the arguments name one in any case; as ``chosen_road``."""
    road = chosen_road(options)
    assert road is not None
    return road


def road_options(options: argparse.Namespace) -> RoadOptions:
    """Return how the arguments want the file of a road to be read."""
    return RoadOptions(
        options.start_road,
        options.via,
        options.to,
        options.reverse,
        None if options.default_limit is None else options.default_limit / KMH_PER_MPS,
        options.limit_unit,
        options.signs,
        options.smoothing_m,
    )


def _ids(text: str) -> tuple[str, ...]:
    return tuple(filter(None, (name.strip() for name in text.split(","))))


def _metres(text: str) -> float:
    try:
        length_m = float(text)
    except ValueError:
        length_m = math.nan
    if not 0.0 <= length_m <= _SMOOTHING_MAX_M:
        raise argparse.ArgumentTypeError(f"{text!r} is not a length from 0 to 1000 m")
    return length_m


def _limit(text: str) -> float:
    try:
        limit = float(text)
    except ValueError:
        limit = math.nan
    if not 0.0 < limit <= _LIMIT_MAX_KMH:
        raise argparse.ArgumentTypeError(f"{text!r} is not a speed above 0 and up to 300 km/h")
    return limit
