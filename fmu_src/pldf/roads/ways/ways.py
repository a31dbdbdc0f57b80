"""Which roads of an OpenDRIVE file are driven, in which order and direction.

Decisions: between the roads that are named, the way is the shortest. Behind the last of them it
goes on while there is only one road to go on to, unless it is the road to end with; it ends where a
road would be driven again. Several connecting roads to one road are no choice: the shortest is
driven.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from ...errors import ModelError
from ...findings import Finding
from ..opendrive.leg import Leg
from ..options import RoadOptions
from .choices import Choice, choices, described, names_for, refusal
from .network import Network
from .search import Found, shortest, some
from .starts import start_of, unknown_road


def find_way(network: Network, options: RoadOptions, notes: list[Finding]) -> list[Leg]:
    """Return the legs of the way, from the first to the last.

    Args:
        network: of the file.
        options: where the way starts, what it passes and where it ends.
        notes: gets what is told about it.

    Raises:
        ModelError: unknown or ambiguous start, a choice that nobody made, a road out of reach.
    """
    options = _known(network, options)
    named = options.via
    if options.to is not None and named[-1:] != (options.to,):
        named = (*named, options.to)

    def follow(leg: Leg) -> list[Leg] | None:
        legs, ways = _followed(network, [leg])
        return None if ways else legs

    start = start_of(network, options, named, follow, notes)
    legs = [start]
    if named:
        found = shortest(network, start, named)
        if not found.legs:
            raise _out_of_reach(network, start, named, found)
        legs = list(found.legs)
    ways: list[Choice] = []
    if options.to is None:
        legs, ways = _followed(network, legs)
        if ways and not named:
            raise refusal(network, legs, ways, options)
    _tell(network, legs, notes)
    if options.to is None:
        _tell_end(network, legs, ways, notes)
    return legs


def _known(network: Network, options: RoadOptions) -> RoadOptions:
    """Return the options with ids as the file writes them.

    Raises:
        ModelError: there is no such road.
    """
    via = tuple(road for text in options.via for road in _ids(network, text))
    start, to = (
        None if text is None else _id(network, text) for text in (options.start_road, options.to)
    )
    return replace(options, start_road=start, via=via, to=to)


def _id(network: Network, text: str) -> str:
    for name in (text, text.strip()):
        if name in network.roads:
            return name
    raise unknown_road(network, text)


def _ids(network: Network, text: str) -> list[str]:
    """Return the ids in ``12,45,7``; an id may itself contain commas and blanks."""
    parts = text.split(",")
    ids: list[str] = []
    while parts:
        for end in range(len(parts), 0, -1):
            joint = ",".join(parts[:end])
            name = joint if joint in network.roads else joint.strip()
            if name in network.roads:
                break
        else:
            raise unknown_road(network, parts[0].strip())
        ids.append(name)
        parts = parts[end:]
    return ids


def _followed(network: Network, legs: Sequence[Leg]) -> tuple[list[Leg], list[Choice]]:
    """Return the way, gone on with while there is one road to go on to, and what is to choose."""
    way = list(legs)
    driven = {leg.id for leg in way}
    while True:
        ways = choices(network, way[-1])
        if len(ways) != 1:
            return way, ways
        leg = ways[0].steps[0].leg
        if leg.id in driven:
            return way, []
        way.append(leg)
        driven.add(leg.id)


def _tell(network: Network, legs: Sequence[Leg], notes: list[Finding]) -> None:
    """Tell doubts about the links of a way, lanes that are missing, and connecting roads."""
    for before, leg in pairwise(legs):
        notes += next(s.told for s in network.onward(before).steps if s.leg == leg)
        _tell_parallel(network, before, leg, notes)
    for leg in dict.fromkeys(legs):
        if network.has_lane(leg) is False:
            way = "against its direction" if leg.against else "along its direction"
            text = f"no lane for cars {way}, in which it is driven"
            path = str(network.place.path)
            notes.append(Finding("warning", path, leg.road.line, f"road {leg.id}", text))


def _tell_parallel(network: Network, before: Leg, leg: Leg, notes: list[Finding]) -> None:
    onward = network.onward(before)
    for way in choices(network, before):
        legs = [step.leg for step in way.steps]
        if len(legs) > 1 and leg in legs and onward.link is not None:
            ids = some(each.id for each in legs)
            text = f"junction {onward.junction} leads on to road {way.target.id} through road {ids}"
            then = f"{leg.id} is driven"
            notes.append(network.told("note", before, onward.link, text, then))


def _tell_end(
    network: Network, legs: Sequence[Leg], ways: Sequence[Choice], notes: list[Finding]
) -> None:
    """Tell why a way ends where nobody said it should."""
    last = legs[-1]
    onward = network.onward(last)
    notes += onward.told
    if onward.link is None:
        return
    if ways:
        text = f"the way ends here: {described(network, last, ways)}"
        out = f"to go on, name one more to pass: {some(names_for(legs, ways))}"
        notes.append(network.told("note", last, onward.link, text, out=out))
    elif onward.steps and onward.steps[0].leg != legs[0]:  # a ring that closes is no surprise
        text = f"road {onward.steps[0].leg.id} comes again"
        notes.append(network.told("note", last, onward.link, text, "the way ends before it"))


def _out_of_reach(network: Network, start: Leg, named: tuple[str, ...], found: Found) -> ModelError:
    last = named[found.passed - 1] if found.passed else start.id
    reach = [name for name in found.within_reach if name != last]
    can = f"from there the way leads to road {some(reach)}" if reach else "the way ends there"
    turned = start.turned
    if network.has_lane(turned) is not False and shortest(network, turned, named).legs:
        can += "; there is a way from it in the other direction "
        can += "(reverse)" if turned.against else "(without reverse)"
    way = f"{start.id}, driven {'against' if start.against else 'along'} its direction"
    goal = named[found.passed] + (f" behind road {last}" if last != start.id else "")
    return ModelError(f"{network.place.path}: no way from road {way}, to road {goal}; {can}")
