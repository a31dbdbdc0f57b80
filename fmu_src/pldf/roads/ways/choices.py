"""Junctions that lead on to several roads, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

from ...findings import short
from ..opendrive.leg import Leg, road_length_m
from ..options import OptionNeededError, RoadOptions
from .network import Network, Onward, Step
from .search import some

_STRAIGHT_DEG: Final = 30.0
_BACK_DEG: Final = 150.0
_LISTED_MAX: Final = 6


class Choice(NamedTuple):
    """One road that a leg leads on to.

    Attributes:
        steps: that lead there, the shortest first: through a junction there may be several.
        target: the leg behind a connecting road; without one, and where nothing or more than one
            leg is behind it, the step's own.
    """

    steps: tuple[Step, ...]
    target: Leg


def choices(network: Network, leg: Leg) -> list[Choice]:
    """Return what can be chosen at the front of ``leg``: ways to one road are one choice."""
    onward = network.onward(leg)
    by_target: dict[Leg, list[Step]] = {}
    for step in onward.steps:
        by_target.setdefault(_target(network, onward, step), []).append(step)
    return [
        Choice(tuple(sorted(steps, key=lambda step: road_length_m(step.leg))), target)
        for target, steps in by_target.items()
    ]


def _target(network: Network, onward: Onward, step: Step) -> Leg:
    if not onward.junction or step.leg.road.attributes.get("junction") != onward.junction:
        return step.leg
    behind = network.onward(step.leg).steps
    return behind[0].leg if len(behind) == 1 else step.leg


def described(network: Network, leg: Leg, ways: Sequence[Choice]) -> str:
    """Return junction and ways in words: where they lead, how they turn, how long they are."""
    onward = network.onward(leg)
    told = [_described(network, leg, way) for way in ways[:_LISTED_MAX]]
    more = [f"{len(ways) - _LISTED_MAX} more"] if len(ways) > _LISTED_MAX else []
    return f"junction {onward.junction} leads on to {', '.join(told + more)}"


def _described(network: Network, leg: Leg, way: Choice) -> str:
    through = way.steps[0].leg
    about = [_turn(network.ends.turn_rad(leg, through))]
    if way.target != through:
        about.append(f"through road {through.id}")
    about.append(f"{short(road_length_m(through))} m")
    return f"road {way.target.id} ({', '.join(filter(None, about))})"


def _turn(turn_rad: float | None) -> str:
    if turn_rad is None:
        return ""
    turn_deg = math.degrees(turn_rad)
    if abs(turn_deg) < _STRAIGHT_DEG:
        return "straight on"
    if abs(turn_deg) > _BACK_DEG:
        return "back"
    return f"{'left' if turn_deg > 0.0 else 'right'} by {abs(turn_deg):.0f} degrees"


def names_for(legs: Sequence[Leg], ways: Sequence[Choice]) -> list[str]:
    """Return the road to name for each way: its target, else what leads there.

    A target that the way passed before, or that several ways lead to, says too little.
    """
    driven = {leg.id for leg in legs}
    targets = [way.target.id for way in ways]
    return [
        way.target.id
        if way.target.id not in driven and targets.count(way.target.id) == 1
        else way.steps[0].leg.id
        for way in ways
    ]


def refusal(
    network: Network, legs: Sequence[Leg], ways: Sequence[Choice], options: RoadOptions
) -> OptionNeededError:
    """Return the error for a choice that nobody made: the ways and what to say for each."""
    leg = legs[-1]
    link = network.onward(leg).link
    assert link is not None
    where = f"{network.place.path}, line {link.line}, road {leg.id}"
    first, *others = names_for(legs, ways)
    suggested = replace(options, via=(*options.via, first))
    matter = f"{where}: {described(network, leg, ways)}; say where to go"
    return OptionNeededError(matter, suggested, some(others), replace(options, to=leg.id))
