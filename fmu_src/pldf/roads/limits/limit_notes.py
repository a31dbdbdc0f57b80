"""What is told of limits that a way does not state, and of its speed signs: once for each kind."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from typing import Final

from ...findings import Finding, Severity
from .limit_spans import Cut, Span, Unread
from .speed_signs import Sign
from .spots import Spot, counted, listed, told

# A gap up to here is rounding; a road without a limit from here on is told as a warning.
_ROUNDING_M: Final = 0.5
_LONG_M: Final = 100.0
# A sign stands within this of the place where the road states its limit, in maps that have both.
_BESIDE_M: Final = 25.0
_SAME_MPS: Final = 0.2

_DEFAULT_LIMIT: Final = "--default-limit counts only where nothing on the way states a limit"


def notes_on_gaps(spans: Sequence[Span], *, default_given: bool) -> Iterator[Finding]:
    """Yield what is told of stretches that have the limit of a neighbour."""
    gaps = [span for span in spans if span.source in ("before", "behind")]
    kinds: tuple[tuple[Severity, str, Callable[[Span], bool]], ...] = (
        ("note", "connecting road", _connecting),
        ("warning", "road", lambda s: _whole(s) and _long(s)),
        ("note", "road", _whole),
        ("note", "gap", lambda _: True),
    )
    for severity, kind, belongs in kinds:
        found = [span for span in gaps if belongs(span)]
        gaps = [span for span in gaps if not belongs(span)]
        if any(span.end_m - span.start_m > _ROUNDING_M for span in found):
            yield _gap_note(severity, kind, found, default_given)
    signed = [span for span in spans if span.source == "behind sign"]
    if signed:
        shown = signed[0].limit.shown if signed[0].limit else ""
        text = f"no limit is stated before the first sign; its {shown} counts from the start"
        way_out = "give the limit before it (--default-limit KMH)"
        yield told("warning", [_spot(span) for span in signed], text, way_out=way_out)


def _gap_note(severity: Severity, kind: str, found: list[Span], default_given: bool) -> Finding:
    metres = sum(span.end_m - span.start_m for span in found)
    first = [span for span in found if span.source == "behind"]
    shown = listed([f"{s.limit.shown if s.limit else ''} from {_spot(s)} on" for s in found])
    several = len(found) > 1
    subject, states = counted(len(found), kind), "state" if several else "states"
    text = f"{subject} {states} no limit ({metres:.4g} m{' in all' if several else ''}): {shown}"
    rule = "that of what follows" if len(first) == len(found) else "that of what is driven before"
    also = ", at the start that of what follows" if 0 < len(first) < len(found) else ""
    way_out = "to have another, add type/speed to the file" + (
        f"; {_DEFAULT_LIMIT}" if default_given else ""
    )
    return told(severity, [_spot(s) for s in found], text, f"{rule} counts there{also}", way_out)


def _whole(span: Span) -> bool:
    return span.start_m == 0.0 and span.end_m == span.road.length_m


def _long(span: Span) -> bool:
    return span.end_m - span.start_m > _LONG_M


def _connecting(span: Span) -> bool:
    return span.road.leg.road.attributes.get("junction", "-1") not in ("-1", "")


def _spot(span: Span) -> Spot:
    s_m = span.end_m if span.road.leg.against else span.start_m
    return Spot(span.road.place, span.road.leg.road.line, s_m)


def notes_on_signs(parts: Cut) -> Iterator[Finding]:
    """Yield what is told of signs that are read, and of those that are not."""
    read = [span.sign for span in parts.spans if span.sign is not None]
    if read:
        text = f"{counted(len(read), 'speed sign')} read where no speed is stated: {_shown(read)}"
        yield told("note", [s.spot for s in read], text, way_out="--no-signs leaves them out")
    doubtful = [sign for sign in read if sign.doubt]
    if doubtful:
        text = f"{counted(len(doubtful), 'speed sign')} read, but in doubt: {_shown(doubtful)}"
        doubts = listed(sorted({sign.doubt for sign in doubtful}))
        yield told("warning", [s.spot for s in doubtful], text, doubts)
    unlike = [unread for unread in parts.unread if _contradicts(unread, parts.spans)]
    if unlike:
        signs = [unread.sign for unread in unlike]
        stated = listed(sorted({unread.stated.shown for unread in unlike}))
        is_not = "is" if len(signs) == 1 else "are"
        text = f"{counted(len(signs), 'speed sign')} {is_not} not read ({_shown(signs)})"
        why = f"the road states {stated} there, and what is stated counts"
        yield told("note", [s.spot for s in signs], text, why)
    if parts.endless:
        ends = parts.endless
        text = f"{counted(len(ends), 'sign')} that ends a limit, and none is stated before it"
        told_of = (
            "the sign before goes on to count",
            "give the limit behind it (--default-limit KMH)",
        )
        yield told("warning", [s.spot for s in ends], text, *told_of)


def _shown(signs: Sequence[Sign]) -> str:
    return listed([f"{s.limit.shown if s.limit else 'end of limit'} at {s.spot}" for s in signs])


def _contradicts(unread: Unread, spans: Sequence[Span]) -> bool:
    """Tell whether the road states another limit all around a sign."""
    limit = unread.sign.limit
    if limit is None:
        return False
    first = bisect_right(spans, unread.at_m - _BESIDE_M, key=lambda span: span.at_m) - 1
    last = bisect_left(spans, unread.at_m + _BESIDE_M, key=lambda span: span.at_m)
    around = [span.limit for span in spans[max(first, 0) : last] if span.source == "stated"]
    return not any(at is not None and abs(at.mps - limit.mps) <= _SAME_MPS for at in around)
