"""``pldf route``: read a road, say what is on it, draw it, export it."""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..cosim.prepared import SUFFIX, write_prepared_route
from ..durations import minutes
from ..errors import ModelError
from ..kernel.units import KMH_PER_MPS
from ..roads import fingerprint, open_road, roads_of, write_route_csv
from ..route_facts import BINDING_MPS, RouteFacts, route_facts
from .shared.road import add_road, road_options
from .shared.road_table import road_table
from .shared.telling import listed

if TYPE_CHECKING:
    from ..report.scene import Scene

EXAMPLE: Final = (
    "pldf route study --plot study.png\n"
    "  pldf route town.xodr --list --plot map.png\n"
    "      the roads of a town, the ways on from each, and a map with their ids\n"
    "  pldf route town.xodr --start-road 12 --via 45 --to 7 --export my_way.csv"
)

_LISTED_MAX: Final = 24
_OF_ONE_WAY: Final = {
    "start_road": "--start-road",
    "via": "--via",
    "to": "--to",
    "reverse": "--reverse",
    "export": "--export",
}
_PICTURES: Final = (".png", ".pdf", ".svg")


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_road(parser, "what to show", by_position=True)
    parser.add_argument(
        "--list", action="store_true",
        help="show the roads of the file and the ways on from each, instead of one way",
    )  # fmt: skip
    parser.add_argument(
        "--plot", metavar="PNG", type=_picture,
        help="draw a plan view, limits, curvature and base profile (.png, .pdf or .svg); with "
        "--list a map of all roads with their ids",
    )  # fmt: skip
    parser.add_argument(
        "--export",
        metavar="OUT.csv",
        type=Path,
        help="write the route as CSV; as OUT.prepared: for route_file of a native FMU",
    )
    parser.set_defaults(refuse=parser.error)


def run(options: argparse.Namespace) -> None:
    """Print the summary; draw and export if asked to; tell what was found at the end."""
    if options.list:
        _list(options)
        return
    route = open_road(options.road, road_options(options)).route
    facts = route_facts(route)
    print("\n".join(_summary(facts)))
    if options.export is not None:
        as_csv = options.export.suffix != SUFFIX
        (write_route_csv if as_csv else write_prepared_route)(route, options.export)
        print(f"written      {options.export}")
    if options.plot is not None:
        from ..report import figures  # noqa: PLC0415 (0.5 s that few calls need)

        plan = figures.plan(facts)
        without = "" if plan else " (without a plan view: the file has no x and y)"
        _draw(options.plot, *filter(None, (plan, figures.route(facts))), about=without)
    print("\n".join(listed(route.notes)))


def _list(options: argparse.Namespace) -> None:
    """Print the roads of the file, and draw them if asked to."""
    for name, option in _OF_ONE_WAY.items():
        if getattr(options, name):
            options.refuse(f"--list shows all roads of the file; {option} is for one way")
    rows = roads_of(options.road, road_options(options))
    print("\n".join(road_table(rows)))
    if options.plot is not None:
        from ..report import figures  # noqa: PLC0415 (0.5 s that few calls need)

        scene = figures.network(rows, Path(options.road).name)
        if scene is None:
            raise ModelError(f"{options.road}: no road has a line that can be drawn")
        _draw(options.plot, scene)


def _draw(path: Path, *scenes: Scene, about: str = "") -> None:
    from ..report import paper  # noqa: PLC0415 (0.5 s that few calls need)

    if not path.parent.is_dir():  # most likely a slip of the pen
        raise ModelError(f"{path}: there is no folder {path.parent}")
    paper.save(path, *scenes)
    print(f"drawn        {path}{about}")


def _summary(facts: RouteFacts) -> Iterator[str]:
    route, time_s = facts.route, facts.driving_time_s
    mean = (len(facts.base_mps) - 1) / time_s * KMH_PER_MPS
    yield f"route        {route.name}"
    yield f"length       {route.length_m:.1f} m" + ("" if route.has_line else ", no x and y")
    roads = [mark for mark in route.marks if mark.kind == "road"]
    if roads:
        yield from _listed("way", [f"{m.name} (against)" if m.against else m.name for m in roads])
    yield from _listed("limits", [f"{s:.0f} m: {_kmh(v)}" for s, v in facts.limits])
    yield f"curves       {len(facts.curves)} bind (over {_kmh(BINDING_MPS)} below the limit)"
    shown = [f"{c.start_m:.0f} m: {_kmh(c.speed_mps)}, R {c.radius_m:.0f} m" for c in facts.curves]
    if shown:
        yield from _listed("", shown)
    yield f"base profile {minutes(time_s, 1)} min, mean {mean:.1f} km/h"
    yield f"fingerprint  {fingerprint(route)}"


def _listed(title: str, items: list[str]) -> list[str]:
    hidden = len(items) - _LISTED_MAX
    text = "; ".join(items[:_LISTED_MAX]) + (f"; and {hidden} more" if hidden > 0 else "")
    # Items stay whole: their blanks become real ones only after wrapping.
    glued = text.replace("; ", ";\0").replace(" ", "\xa0").replace("\0", " ")
    lines = textwrap.wrap(
        glued, 96, initial_indent=f"{title:12} ", subsequent_indent=" " * 13, break_long_words=False
    )
    return [line.replace("\xa0", " ") for line in lines]


def _kmh(speed_mps: float) -> str:
    return f"{round(speed_mps * KMH_PER_MPS, 1):g} km/h"


def _picture(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() not in _PICTURES:
        raise argparse.ArgumentTypeError(f"{text!r} must end in {', '.join(_PICTURES)}")
    return path
