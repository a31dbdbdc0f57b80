"""How a road is named, the same in every command."""

from __future__ import annotations

import argparse
import math

from ...kernel.units import KMH_PER_MPS
from ...roads import Road, open_road
from .telling import tell

_LIMIT_MAX_KMH = 300.0


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
        "--default-limit", metavar="KMH", type=_limit, help="limit where the road states none"
    )


def chosen_road(options: argparse.Namespace) -> Road | None:
    """Return the road that the arguments name, None if they name none.

    Raises:
        ModelError: it cannot be used.
    """
    if options.road is None:
        return None
    road = open_road(
        options.road, start_road=options.start_road, default_limit_mps=default_limit_mps(options)
    )
    tell(road.route.notes)
    return road


def required_road(options: argparse.Namespace) -> Road:
    """Return the road where the arguments name one in any case; as ``chosen_road``."""
    road = chosen_road(options)
    assert road is not None
    return road


def default_limit_mps(options: argparse.Namespace) -> float | None:
    """Return ``--default-limit`` in m/s."""
    return None if options.default_limit is None else options.default_limit / KMH_PER_MPS


def _limit(text: str) -> float:
    try:
        limit = float(text)
    except ValueError:
        limit = math.nan
    if not 0.0 < limit <= _LIMIT_MAX_KMH:
        raise argparse.ArgumentTypeError(f"{text!r} is not a speed above 0 and up to 300 km/h")
    return limit
