"""Legal limits along a way: what its roads state, signs where they state nothing, and gaps filled.

Decisions: a gap (most often a connecting road in a junction) has the limit of what was driven
before it until the next one is stated; at the start of the way, that of what follows. A default
limit counts only where the whole way states nothing, and before the first sign. A sign counts only
where no speed is stated, until the next sign or stated speed; the end of a limit returns to the one
that was stated last. ``no limit`` means the recommended 130 km/h of a derestricted motorway, since
a profile needs a number; ``undefined`` and -1 mean that nothing is stated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Final, NamedTuple

from ...findings import Finding
from ...kernel.units import KMH_PER_MPS
from ..opendrive.contents import Contents
from ..opendrive.xml_tree import Element
from ..options import OptionNeededError, RoadOptions
from ..route import Mark
from .limit_notes import notes_on_gaps, notes_on_signs
from .limit_spans import Span, changes, cut, filled
from .speed_records import Stated, stated_limits
from .speed_signs import Sign, SignReader
from .speed_values import Speed, SpeedReader
from .spots import counted, told

# What is proposed where a default is missing: the limit of a German country road.
_PROPOSED_MPS: Final = 100.0 / KMH_PER_MPS
# A record that begins later than this is told, although it counts from the start.
_LATE_TOLD_M: Final = 0.1

# Start in m over the road's own arc length and limit in m/s, in order of s from 0 on.
Limits = list[tuple[float, float]]


class WayLimits(NamedTuple):
    """The limits of a way.

    Attributes:
        limits: of each road, over its own arc length.
        marks: where a limit or a sign begins, in order of the route's arc length.
    """

    limits: list[Limits]
    marks: list[Mark]


def limits_along(
    roads: Sequence[Contents],
    signals: Mapping[str, Element],
    options: RoadOptions,
    notes: list[Finding],
) -> WayLimits:
    """Return the limits of a way, without gaps.

    Args:
        roads: in the order in which they are driven.
        signals: of the file, by id (``signals_of``).
        options: default limit, unit where the file states none, whether signs are read.
        notes: gets what is told of limits and signs.

    Raises:
        ModelError: unusable speeds, all of them; or nothing is stated and there is no default.
    """
    reader = SpeedReader(options)
    sign_reader = SignReader(signals, options)
    stated = [stated_limits(road, reader) for road in roads]
    signs = [
        sign_reader.signs(road, each.sections) for road, each in zip(roads, stated, strict=True)
    ]
    reader.refuse()
    default = _default(options)
    read = signs if options.signs else [[] for _ in roads]
    parts = cut(roads, [each.records for each in stated], read, default)
    spans = filled(parts.spans, default)
    if spans is None:
        raise _nothing_stated(roads[0], signs, options)
    notes += [*reader.notes(), *_late(stated)]
    notes += notes_on_gaps(spans, default_given=default is not None)
    if options.signs:
        notes += [*notes_on_signs(parts), *sign_reader.notes()]
    return WayLimits(_by_road(spans), [_mark(span) for span in changes(spans)])


def _default(options: RoadOptions) -> Speed | None:
    mps = options.default_limit_mps
    return None if mps is None else Speed(mps, f"{mps * KMH_PER_MPS:.4g} km/h")


def _nothing_stated(
    road: Contents, signs: Sequence[list[Sign]], options: RoadOptions
) -> OptionNeededError:
    unread = sum(sign.limit is not None for each in signs for sign in each)
    also = f" ({counted(unread, 'speed sign')} left out)" if unread else ""
    text = f"no speed limit from s = 0 m on{also}; add type/speed to the file or give a limit"
    matter = str(road.place.error(road.leg.road, text))
    return OptionNeededError(matter, replace(options, default_limit_mps=_PROPOSED_MPS))


def _late(stated: Sequence[Stated]) -> Iterator[Finding]:
    spots = [late.spot for each in stated for late in each.late if late.by_m > _LATE_TOLD_M]
    if spots:
        text = f"{counted(len(spots), 'limit')} beginning up to 0.5 m late"
        yield told("note", spots, text, "counts from the start of its road or lane section")


def _by_road(spans: Sequence[Span]) -> list[Limits]:
    """Return the steps of each road over its own arc length; equal neighbours are one."""
    roads = []
    for _, of_road in groupby(spans, key=lambda span: span.leg):
        steps: Limits = []
        for span in sorted(of_road, key=lambda span: span.start_m):
            assert span.limit is not None  # they are filled
            if not steps or steps[-1][1] != span.limit.mps:
                steps.append((span.start_m, span.limit.mps))
        roads.append(steps)
    return roads


def _mark(span: Span) -> Mark:
    shown = span.limit.shown if span.limit else ""
    if span.sign is not None:
        name = "end of limit sign" if span.sign.limit is None else f"{shown} sign"
    else:
        name = f"{'default' if span.source == 'default' else 'legal'} limit {shown}"
    return Mark(span.at_m, "sign", name)
