"""The speed signs of one road that face who drives along it: ``signal`` and ``signalReference``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from ..findings import Finding
from .contents import Contents
from .options import LimitUnit
from .route import LIMIT_MAX_MPS
from .sign_types import SignType, sign_type
from .speed_records import Section
from .speed_values import Speed, SpeedReader, speed_of, unit_named
from .spots import Spot, counted, listed, told
from .xml_tree import Element

_ORIENTATIONS: Final = {False: "+", True: "-"}


class Sign(NamedTuple):
    """One sign that faces the traffic.

    Attributes:
        spot: where it stands, within the road.
        limit: what it begins; None: it ends a limit.
    """

    spot: Spot
    limit: Speed | None


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
        speeds: what reads positions, and knows the unit of those who state none.
    """

    signals: Mapping[str, Element]
    speeds: SpeedReader
    _told: dict[str, list[tuple[Spot, str]]] = field(default_factory=dict)

    def signs(self, road: Contents, sections: list[Section]) -> list[Sign]:
        """Return the signs in the order in which they are passed."""
        types = road.leg.road.all("type")
        country = next(filter(None, (e.attributes.get("country") for e in types)), "")
        facing = self._facing(road, sections)
        signs = [self._sign(road, element, signal, country) for element, signal in facing]
        return sorted(filter(None, signs), key=_passed(road.leg.against))

    def _facing(self, road: Contents, sections: list[Section]) -> Iterator[tuple[Element, Element]]:
        """Yield the elements on the road and the signals that they are or refer to."""
        ours = ("none", "", _ORIENTATIONS[road.leg.against])
        for holder in road.leg.road.all("signals"):
            for element in holder.children:
                if element.attributes.get("orientation", "").strip().lower() not in ours:
                    continue
                signal = element if element.tag == "signal" else None
                if element.tag == "signalReference":
                    signal = self.signals.get(element.attributes.get("id", ""))
                if signal is not None and self._for_us(road, element, sections):
                    yield element, signal

    def _for_us(self, road: Contents, element: Element, sections: list[Section]) -> bool:
        """Tell whether a driven lane is among those for which the sign is valid."""
        ranges = [
            sorted(self.speeds.number(road.place, e, name) for name in ("fromLane", "toLane"))
            for e in element.all("validity")
        ]
        if not ranges or not sections:
            return True
        s_m = self.speeds.number(road.place, element, "s")
        section = next((each for each in reversed(sections) if each.start_m <= s_m), sections[0])
        lanes = [self.speeds.number(road.place, lane, "id") for lane in section.lanes]
        return any(low <= lane <= high for low, high in ranges for lane in lanes)

    def _sign(self, road: Contents, element: Element, signal: Element, country: str) -> Sign | None:
        of = {name: signal.attributes.get(name, "").strip() for name in _ATTRIBUTES}
        kind = sign_type(of["country"] or country, of["type"], of["subtype"], of["value"])
        s_m = self.speeds.number(road.place, element, "s")
        spot = Spot(road.place, element.line, min(max(s_m, 0.0), road.length_m))
        if kind is None:
            unit = unit_named(of["unit"])
            if unit in ("km/h", "mph") and of["value"]:
                shown = (
                    f"type {of['type']} of {of['country'] or 'no country'}: {of['value']} {unit}"
                )
                self._tell("not read, with a speed but of an unknown type", spot, shown)
        elif of["dynamic"].lower() == "yes":
            self._tell("not read, because it changes (dynamic)", spot, of["type"])
        elif kind.meaning == "implied":
            self._tell("not read, which implies a limit without showing it", spot, of["type"])
        elif kind.meaning == "end":
            return Sign(spot, None)
        else:
            return self._limit(kind, of, spot)
        return None

    def _limit(self, kind: SignType, of: dict[str, str], spot: Spot) -> Sign | None:
        unit = unit_named(of["unit"]) if of["unit"] else self._unit(kind)
        if kind.number is None or unit is None:
            what = f"unit {of['unit'][:20]!r}" if unit is None else "no number"
            self._tell("not read, without a usable speed", spot, f"type {of['type']}, {what}")
            return None
        speed = speed_of(kind.number, unit)
        if kind.doubt:
            self._tell("read, but in doubt", spot, f"{speed.shown}, {kind.doubt}")
        if speed.mps > LIMIT_MAX_MPS:
            self._tell("not read, without a usable speed", spot, f"{kind.number:g} {unit}")
            return None
        return Sign(spot, speed)

    def _unit(self, kind: SignType) -> LimitUnit:
        chosen = self.speeds.options.limit_unit
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


_ATTRIBUTES: Final = ("country", "type", "subtype", "value", "unit", "dynamic")
