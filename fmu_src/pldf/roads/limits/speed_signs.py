"""The speed signs of one road that face who drives along it: ``signal`` and ``signalReference``."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from ...findings import Finding
from ..opendrive.contents import Contents
from ..opendrive.xml_tree import Element, as_number
from ..options import LimitUnit, RoadOptions
from ..route import LIMIT_MAX_MPS
from .sign_types import SignType, sign_type, supplementary
from .speed_records import Section
from .speed_values import Speed, speed_of, unit_named
from .spots import Spot, counted, listed, told

_TEXT_MAX: Final = 30  # characters that are told
_POST_M: Final = 0.5
_ORIENTATIONS: Final = {False: "+", True: "-"}


class Sign(NamedTuple):
    """One sign that faces the traffic.

    Attributes:
        spot: where it stands, within the road.
        limit: what it begins; None: it ends a limit.
        doubt: what contradicts or restricts it, empty: nothing.
    """

    spot: Spot
    limit: Speed | None
    doubt: str = ""


def signals_of(root: Element) -> dict[str, Element]:
    """Return the signals of a file by id, for those who refer to them."""
    signals: dict[str, Element] = {}
    for element in root.all("road", "signals", "signal"):
        signals.setdefault(element.attributes.get("id", ""), element)
    return signals


@dataclass
class SignReader:
    """Reads the speed signs of one way and keeps what is to be told of all of them together.

    Attributes:
        signals: of the file, by id.
        options: what a person says; of it, the unit of a sign that states none.
    """

    signals: Mapping[str, Element]
    options: RoadOptions
    _told: dict[str, list[tuple[Spot, str]]] = field(default_factory=dict)

    def signs(self, road: Contents, sections: list[Section]) -> list[Sign]:
        """Return the signs in the order in which they are passed."""
        types = road.leg.road.all("type")
        country = next(filter(None, (e.attributes.get("country") for e in types)), "")
        facing = [
            (element, _Shown.of(signal, country))
            for element, signal in self._facing(road)
            if _for_us(element, sections)
        ]
        plates = _plates(facing)
        signs = (self._sign(road, element, shown) for element, shown in facing)
        read = [_under_plates(sign, plates) for sign in signs if sign is not None]
        return sorted(read, key=_passed(road.leg.against))

    def _facing(self, road: Contents) -> Iterator[tuple[Element, Element]]:
        """Yield the elements on the road and the signals that they are or refer to."""
        ours = ("none", "", _ORIENTATIONS[road.leg.against])
        for holder in road.leg.road.all("signals"):
            for element in holder.children:
                signal = element if element.tag == "signal" else None
                if element.tag == "signalReference":
                    signal = self.signals.get(element.attributes.get("id", ""))
                faces = element.attributes.get("orientation", "").strip().lower() in ours
                if signal is not None and faces:
                    yield element, signal

    def _sign(self, road: Contents, element: Element, shown: _Shown) -> Sign | None:
        kind = sign_type(shown.country, shown.kind, shown.subtype, shown.value)
        unit = unit_named(shown.unit)
        if kind is None and not (shown.value and unit in ("km/h", "mph")):
            return None
        s_m = _number(element, "s")
        spot = Spot(road.place, element.line, min(max(s_m or 0.0, 0.0), road.length_m))
        if kind is None:
            told = f"type {shown.kind} of {shown.country or 'no country'}: {shown.value} {unit}"
            self._tell("not read, with a speed but of an unknown type", spot, told)
        elif s_m is None:
            self._tell("not read, because its s is no number", spot, shown.kind)
        elif shown.dynamic:
            self._tell("not read, because it changes (dynamic)", spot, shown.kind)
        elif kind.meaning == "implied":
            self._tell("not read, which implies a limit without showing it", spot, shown.kind)
        elif kind.meaning == "end":
            return Sign(spot, None)
        else:
            return self._limit(kind, shown, spot)
        return None

    def _limit(self, kind: SignType, shown: _Shown, spot: Spot) -> Sign | None:
        unit = unit_named(shown.unit) if shown.unit else self._unit(kind)
        if kind.number is None or unit is None:
            what = f"unit {shown.unit!r}" if unit is None else "no number"
            self._tell("not read, without a usable speed", spot, f"type {shown.kind}, {what}")
            return None
        speed = speed_of(kind.number, unit)
        if speed.mps > LIMIT_MAX_MPS:
            self._tell("not read, without a usable speed", spot, f"{kind.number:g} {unit}")
            return None
        return Sign(spot, speed, kind.doubt)

    def _unit(self, kind: SignType) -> LimitUnit:
        chosen = self.options.limit_unit
        return kind.unit if chosen is None or chosen == "m/s" else chosen

    def _tell(self, what: str, spot: Spot, shown: str) -> None:
        self._told.setdefault(what, []).append((spot, shown))

    def notes(self) -> Iterator[Finding]:
        """Yield what is told of signs that are not read as they stand."""
        for what, found in self._told.items():
            places = listed([f"{shown} at {spot}" for spot, shown in found])
            text = f"{counted(len(found), 'sign')} {what}: {places}"
            yield told("note", [spot for spot, _ in found], text)


def _passed(against: bool) -> Callable[[Sign], tuple[float, float]]:
    """Return the order in which signs are passed; what is passed last at one place counts.

    Of two at one place that is the lower one (each may be for a lane), after the end of another.
    """
    way = -1.0 if against else 1.0
    return lambda sign: (way * sign.spot.s_m, -sign.limit.mps if sign.limit else -math.inf)


class _Shown(NamedTuple):
    """What a signal says, as texts of bounded length."""

    country: str
    kind: str
    subtype: str
    value: str
    unit: str
    dynamic: bool

    @classmethod
    def of(cls, signal: Element, country: str) -> _Shown:
        """Return what ``signal`` says; ``country`` is that of its road."""

        def text(name: str) -> str:
            return signal.attributes.get(name, "").strip()[:_TEXT_MAX]

        return cls(
            text("country") or country.strip()[:_TEXT_MAX],
            text("type"),
            text("subtype"),
            text("value"),
            text("unit"),
            text("dynamic").lower() == "yes",
        )


def _plates(facing: list[tuple[Element, _Shown]]) -> list[tuple[float, str]]:
    """Return place and code of the supplementary signs, in order of s."""
    codes = [
        (_number(element, "s"), supplementary(shown.country, shown.kind, shown.subtype))
        for element, shown in facing
    ]
    return sorted((s_m, code) for s_m, code in codes if s_m is not None and code)


def _under_plates(sign: Sign, plates: list[tuple[float, str]]) -> Sign:
    """Return the sign in doubt if a supplementary sign hangs on its post."""
    first = bisect_left(plates, (sign.spot.s_m - _POST_M, ""))
    if sign.limit is None or first == len(plates) or plates[first][0] > sign.spot.s_m + _POST_M:
        return sign
    return sign._replace(doubt=f"the supplementary sign {plates[first][1]} restricts it")


def _for_us(element: Element, sections: list[Section]) -> bool:
    """Tell whether a driven lane is among those for which the sign is valid."""
    ranges = [(_number(e, "fromLane"), _number(e, "toLane")) for e in element.all("validity")]
    ends = [sorted((a, b)) for a, b in ranges if a is not None and b is not None]
    if not ends or not sections:
        return True
    here = bisect_right(sections, _number(element, "s") or 0.0, key=lambda each: each.start_m) - 1
    lanes = [_number(lane, "id") for lane in sections[max(here, 0)].lanes]
    return any(low <= lane <= high for low, high in ends for lane in lanes if lane is not None)


def _number(element: Element, name: str) -> float | None:
    """Return an attribute as a number, None if it is none: a sign is not worth a refusal."""
    value = as_number(element.attributes.get(name))
    return value if math.isfinite(value) else None
