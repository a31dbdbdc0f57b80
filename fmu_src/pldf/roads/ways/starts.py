"""Where a way begins when nobody says so, and in which direction its first road is driven."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import replace

from ...errors import ModelError
from ...findings import Finding
from ..opendrive.leg import Leg
from ..options import OptionNeededError, RoadOptions
from .network import Network
from .search import shortest, some

Follow = Callable[[Leg], list[Leg] | None]


def start_of(
    network: Network,
    options: RoadOptions,
    named: tuple[str, ...],
    follow: Follow,
    notes: list[Finding],
) -> Leg:
    """Return the first leg of the way.

    Without a start road it is the only road that nothing leads to; a closed loop starts at the
    first road of the file. Where several could be it, the first named road is. A way that is to be
    driven the other way round starts with its last road.

    Args:
        network: of the file.
        options: what a person said.
        named: the roads to pass.
        follow: returns the legs from one on, None where there is a choice.
        notes: gets what is told about it.

    Raises:
        ModelError: unknown or ambiguous start, no lane in the direction that is wanted.
    """
    if options.start_road is not None:
        return _as_wanted(network, options.start_road, options, notes)
    found = _only_start(network, follow)
    if isinstance(found, Leg) and options.reverse and not named:
        found = _from_the_other_end(network, found, follow)
    elif isinstance(found, Leg) and options.reverse:
        found = [found.id]
    if isinstance(found, Leg):
        if found.against:
            _tell_turned(network, found, notes)
        return found
    if options.via:
        return _first_named(network, named, options, notes)
    raise OptionNeededError(
        f"{network.place.path}: the route could start at road {some(found)}; name one",
        replace(options, start_road=found[0]),
        "; ".join(filter(None, (some(found[1:]), _list_command(network)))),
    )


def _from_the_other_end(network: Network, start: Leg, follow: Follow) -> Leg | list[str]:
    """Return the start of the same way driven the other way round, else the roads to name."""
    if start.against and network.has_lane(start.turned) is False:
        return start  # it is driven against its direction, and cannot be otherwise
    legs = follow(start)
    if legs is None:
        return [start.id]
    leg = legs[-1].turned
    if network.has_lane(leg) is False and network.has_lane(leg.turned):
        raise _no_lane(network, leg)
    return leg


def _no_lane(network: Network, leg: Leg) -> ModelError:
    way = "against" if leg.against else "along"
    text = f"no lane goes {way} the direction in which it is drawn; leave out reverse"
    return replace(network.place, road=leg.id).error(leg.road, text)


def _as_wanted(network: Network, road: str, options: RoadOptions, notes: list[Finding]) -> Leg:
    leg = network.leg(road, against=options.reverse)
    if network.has_lane(leg) is not False or not network.has_lane(leg.turned):
        return leg
    if options.reverse:
        raise _no_lane(network, leg)
    _tell_turned(network, leg.turned, notes)
    return leg.turned


def _tell_turned(network: Network, leg: Leg, notes: list[Finding]) -> None:
    if network.has_lane(leg.turned) is not False:
        return  # nothing leads to its other end, and that is why
    text = "all lanes go against the direction in which it is drawn"
    then = "it is driven from its end to its start"
    path = str(network.place.path)
    notes.append(Finding("note", path, leg.road.line, f"road {leg.id}", text, then))


def _only_start(network: Network, follow: Follow) -> Leg | list[str]:
    """Return the only leg that can be the first, else the roads that could be."""
    roads = network.roads.values()
    plain = [e for e in roads if e.attributes.get("junction", "-1") == "-1"] or list(roads)
    usual = [_usual(network, Leg(e, against=False)) for e in plain]
    free = [leg for leg in usual if network.nothing_behind(leg)]
    if not free:
        turned = [leg.turned for leg in usual if network.has_lane(leg.turned) is not False]
        free = [leg for leg in turned if network.nothing_behind(leg)] or usual
    if len(free) == 1:
        return free[0]
    # Several free ends are still one chain when some roads point against the others.
    legs = follow(free[0])
    if legs is not None and {id(e) for e in plain} <= {id(leg.road) for leg in legs}:
        return free[0]
    return [leg.id for leg in free]


def _usual(network: Network, leg: Leg) -> Leg:
    turn = network.has_lane(leg) is False and network.has_lane(leg.turned)
    return leg.turned if turn else leg


def _first_named(
    network: Network, named: tuple[str, ...], options: RoadOptions, notes: list[Finding]
) -> Leg:
    """Return the first named road, in the direction from which the others can be reached."""
    leg = _as_wanted(network, named[0], options, notes)
    both = not options.reverse and network.has_lane(leg.turned) is not False
    if (
        both
        and not shortest(network, leg, named).legs
        and shortest(network, leg.turned, named).legs
    ):
        leg = leg.turned
    way = "against the direction in which it is drawn" if leg.against else "as it is drawn"
    text = f"the way starts with road {leg.id}, the first that is named, {way}"
    path = str(network.place.path)
    notes.append(Finding("note", path, leg.road.line, f"road {leg.id}", text))
    return leg


def unknown_road(network: Network, road: str) -> ModelError:
    """Return the error for a road that the file does not have."""
    has = f"it has {some(network.roads)}; {_list_command(network)}"
    return ModelError(f"{network.place.path}: no road {road!r}; {has}")


def _list_command(network: Network) -> str:
    return f"pldf route {shlex.quote(str(network.place.path))} --list shows all"
