"""The shortest way through a network that passes roads in a given order."""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import count

from ..opendrive.leg import Leg, road_length_m
from .network import Network

# How many of the named roads were passed, and where one is.
State = tuple[int, Leg]


@dataclass(frozen=True)
class Found:
    """What a search found.

    Attributes:
        legs: the way, empty when there is none.
        passed: how many of the named roads were reached, in their order, at best.
        within_reach: ids of the roads that can be reached behind the last of those, in order of
            their distance.
    """

    legs: tuple[Leg, ...]
    passed: int
    within_reach: tuple[str, ...] = ()


def shortest(network: Network, start: Leg, named: tuple[str, ...]) -> Found:
    """Return the shortest way from ``start`` that passes ``named`` in order and ends with the last.

    The start counts as the first of the named roads if it is that one. Dijkstra's method over
    (roads passed, road, direction); the length of a way is that of its roads.
    """
    first: State = (int(bool(named) and named[0] == start.id), start)
    reached_from: dict[State, State | None] = {}
    order = count()  # where two are as far, the one found first
    queue: list[tuple[float, int, State, State | None]] = [(0.0, next(order), first, None)]
    while queue:
        distance_m, _, state, before = heapq.heappop(queue)
        if state in reached_from:
            continue
        reached_from[state] = before
        passed, leg = state
        if passed == len(named):
            return Found(_back(reached_from, state), passed)
        for step in network.onward(leg).steps:
            behind = passed + (step.leg.id == named[passed])
            length_m = distance_m + road_length_m(step.leg)
            heapq.heappush(queue, (length_m, next(order), (behind, step.leg), state))
    passed = max(state[0] for state in reached_from)
    reach = dict.fromkeys(leg.id for done, leg in reached_from if done == passed)
    return Found((), passed, tuple(reach))


def _back(reached_from: dict[State, State | None], state: State) -> tuple[Leg, ...]:
    legs = []
    at: State | None = state
    while at is not None:
        legs.append(at[1])
        at = reached_from[at]
    return tuple(reversed(legs))


def some(names: Iterable[str]) -> str:
    """Return the first names, as a person lists them."""
    listed = list(names)
    return ", ".join(listed[:6]) + (", ..." if len(listed) > 6 else "")
