"""A way cut into stretches of one legal limit each, and who says so: speeds, signs, neighbours."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal, NamedTuple

from ..opendrive.contents import Contents
from .speed_records import Record
from .speed_signs import Sign
from .speed_values import Speed

# stated: type/speed or a lane's speed; sign: a sign passed before; before, behind: that of the
# neighbour before or behind; default: the person's.
Source = Literal["stated", "sign", "before", "behind", "behind sign", "default"]


class Span(NamedTuple):
    """A stretch of one road with one limit.

    Attributes:
        leg: number of the road on the way; a road may be driven twice.
        road: on which it lies.
        start_m: over the road's own arc length.
        end_m: the same, larger.
        at_m: where on the route it begins.
        limit: None: not known yet.
        source: who says so.
        sign: the sign that stands where it begins.
    """

    leg: int
    road: Contents
    start_m: float
    end_m: float
    at_m: float
    limit: Speed | None
    source: Source
    sign: Sign | None = None


class Unread(NamedTuple):
    """A sign that does not count, because the road states ``stated`` there."""

    sign: Sign
    at_m: float
    stated: Speed


@dataclass
class Cut:
    """A way cut into spans.

    Attributes:
        spans: in the order in which they are driven.
        unread: signs where a speed is stated.
        endless: signs that end a limit where none was stated before.
    """

    spans: list[Span] = field(default_factory=list)
    unread: list[Unread] = field(default_factory=list)
    endless: list[Sign] = field(default_factory=list)


def cut(
    roads: Sequence[Contents],
    stated: Sequence[list[Record]],
    signs: Sequence[list[Sign]],
    default: Speed | None,
) -> Cut:
    """Return the way in spans; what is not stated has the limit of what was driven before.

    Args:
        roads: in the order in which they are driven.
        stated: what each states, in order of its own s.
        signs: of each, in the order in which they are passed.
        default: the limit to which a sign returns where none was stated before.
    """
    walk = _Walk(default)
    for road, records, passed in zip(roads, stated, signs, strict=True):
        walk.drive(road, records, passed)
    return walk.cut


@dataclass
class _Walk:
    back: Speed | None  # to which the end of a limit returns
    now: Speed | None = None
    by_sign: bool = False
    sign: Sign | None = None  # the one just passed
    leg: int = 0
    offset_m: float = 0.0
    cut: Cut = field(default_factory=Cut)

    def drive(self, road: Contents, records: list[Record], signs: list[Sign]) -> None:
        stretches = _stretches(road, records)
        ahead = deque(signs)
        for index, (start, end, limit) in enumerate(stretches, 1):
            last = index == len(stretches)
            here = []
            while ahead and (last or _within(ahead[0].spot.s_m, start, end, road.leg.against)):
                here.append(ahead.popleft())
            if limit is None:
                self._signed(road, start, end, here)
            else:
                self._stated(road, (start, end), limit, here)
        self.leg += 1
        self.offset_m += road.length_m

    def _stated(
        self, road: Contents, ends: tuple[float, float], limit: Speed, signs: list[Sign]
    ) -> None:
        self.sign, self.by_sign = None, False
        self.now = self.back = limit
        self._add(road, *ends, "stated")
        self.cut.unread += [Unread(s, self._route_m(road, s.spot.s_m), limit) for s in signs]

    def _signed(self, road: Contents, start_m: float, end_m: float, signs: list[Sign]) -> None:
        for sign in signs:
            at = min(max(sign.spot.s_m, start_m), end_m)
            if road.leg.against:
                self._add(road, at, end_m, "sign" if self.by_sign else "before")
                end_m = at
            else:
                self._add(road, start_m, at, "sign" if self.by_sign else "before")
                start_m = at
            self._pass(sign)
        self._add(road, start_m, end_m, "sign" if self.by_sign else "before")

    def _pass(self, sign: Sign) -> None:
        if sign.limit is None and self.back is None:
            self.cut.endless.append(sign)
            return
        self.now = sign.limit or self.back
        self.sign, self.by_sign = sign, True

    def _add(self, road: Contents, start_m: float, end_m: float, source: Source) -> None:
        if start_m < end_m:
            at = self._route_m(road, end_m if road.leg.against else start_m)
            span = Span(self.leg, road, start_m, end_m, at, self.now, source, self.sign)
            self.cut.spans.append(span)
            self.sign = None

    def _route_m(self, road: Contents, s_m: float) -> float:
        return self.offset_m + (road.length_m - s_m if road.leg.against else s_m)


def _stretches(road: Contents, records: list[Record]) -> list[tuple[float, float, Speed | None]]:
    """Return start, end and limit of each record, in the order in which they are driven."""
    ends = [*(record.start_m for record in records[1:]), road.length_m]
    ordered = [(r.start_m, end, r.limit) for r, end in zip(records, ends, strict=True)]
    return ordered[::-1] if road.leg.against else ordered


def _within(s_m: float, start_m: float, end_m: float, against: bool) -> bool:
    """Tell whether a sign stands on a stretch, whose far end belongs to the next one."""
    return start_m < s_m if against else s_m < end_m


def filled(spans: list[Span], default: Speed | None) -> list[Span] | None:
    """Return the spans with what is not known at the start of the way; None: nothing is known.

    That is the limit that follows. Before a sign it is the default, if there is one: a sign says
    that it was another before.
    """
    first = next((span for span in spans if span.limit is not None), None)
    if first is None and default is None:
        return None
    limit: Speed | None = default
    source: Source = "default"
    if first is not None and (first.source == "stated" or default is None):
        limit, source = first.limit, "behind sign" if first.source == "sign" else "behind"
    return [s if s.limit else s._replace(limit=limit, source=source) for s in spans]


def changes(spans: list[Span]) -> Iterator[Span]:
    """Yield the spans at whose start a sign stands or the limit changes, the first included."""
    yield from spans[:1]
    for before, span in pairwise(spans):
        if span.sign is not None or not same(before.limit, span.limit):
            yield span


def same(one: Speed | None, other: Speed | None) -> bool:
    """Tell whether two limits are the same speed, in whatever unit they are stated."""
    return (one and one.mps) == (other and other.mps)
