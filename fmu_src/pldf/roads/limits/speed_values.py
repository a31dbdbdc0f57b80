"""Speeds as files write them: units, their spellings, and numbers whose unit is in doubt.

OpenDRIVE reads a speed without unit as m/s. No public road has 50 m/s = 180 km/h, and 30 m/s is
108 km/h, which no sign shows: such numbers are told, because they are most likely in km/h or mph.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

from ...errors import ModelError
from ...findings import Finding
from ...kernel.units import KMH_PER_MPS, MPS_PER_KMH
from ..opendrive.xml_tree import Element, Place
from ..options import LimitUnit, OptionNeededError, RoadOptions
from ..route import LIMIT_MAX_MPS
from .spots import Spot, counted, listed, told

UNITS: Final[dict[LimitUnit, float]] = {"m/s": 1.0, "km/h": MPS_PER_KMH, "mph": 0.44704}
NO_LIMIT_MPS: Final = 130.0 / KMH_PER_MPS

_SPELLINGS: Final[dict[str, LimitUnit]] = {
    **dict.fromkeys(("kmh", "kph", "kmph", "km/hr", "km/hour", "kmh-1"), "km/h"),
    **dict.fromkeys(("mps", "m/sec", "m/second", "ms-1"), "m/s"),
    **dict.fromkeys(("mi/h", "mi/hr", "mile/h", "miles/h", "miles/hour"), "mph"),
}
# The highest limit with a number in most countries; the highest anywhere (Abu Dhabi).
_USUAL_MAX_KMH: Final = 130.0
_HIGHEST_KMH: Final = 160.0
# From here on a whole number of fives is what signs show in km/h or mph, and none in m/s.
_SIGN_MIN: Final = 30.0
_FAULTS_TOLD: Final = 3


class Speed(NamedTuple):
    """A speed, and how a person reads it on a sign."""

    mps: float
    shown: str


def unit_named(text: str) -> LimitUnit | None:
    """Return the unit that ``text`` means, None if it is none."""
    bare = "".join(text.split()).lower()
    return next((unit for unit in UNITS if unit == bare), None) or _SPELLINGS.get(bare)


def speed_of(number: float, unit: LimitUnit) -> Speed:
    """Return ``number`` in ``unit`` as a speed; m/s is shown in km/h."""
    mps = number * UNITS[unit]
    return Speed(mps, f"{number:.4g} mph" if unit == "mph" else f"{mps * KMH_PER_MPS:.4g} km/h")


class _Seen(NamedTuple):
    spot: Spot
    number: float
    mps: float


@dataclass
class SpeedReader:
    """Reads the speeds of one way and keeps what is to be told of all of them together.

    Attributes:
        options: what a person says; of it, the unit where the file states none.
        faults: what cannot be used, each with file, line, road and way out.
    """

    options: RoadOptions
    faults: list[str] = field(default_factory=list)
    _unit_needed: bool = False
    _unitless: list[_Seen] = field(default_factory=list)
    _explicit: list[_Seen] = field(default_factory=list)
    _respelled: dict[str, list[Spot]] = field(default_factory=dict)

    def number(
        self, place: Place, element: Element, name: str, default: float | None = None
    ) -> float:
        """Return an attribute as a finite number; 0 and a fault if it is none."""
        try:
            return place.number(element, name, default)
        except ModelError as error:
            self.faults.append(str(error))
            return 0.0

    def speed(self, element: Element, place: Place, s_m: float) -> Speed | None:
        """Return the ``max`` of a ``speed`` element; None if nothing is stated, or a fault."""
        text = element.attributes.get("max", "").strip()
        if text.lower() == "no limit":
            return Speed(NO_LIMIT_MPS, "130 km/h (no limit)")
        if text.lower() == "undefined":
            return None
        spot = Spot(place, element.line, s_m)
        stated = element.attributes.get("unit", "").strip()
        unit = self._unit(stated, spot) if stated else self.options.limit_unit or "m/s"
        if unit is None:
            shown = f"speed unit {stated[:20]!r} is unknown"
            self._fault(place, element, f"{shown}; use {', '.join(UNITS)}")
            return None
        before = len(self.faults)
        number = self.number(place, element, "max")
        if len(self.faults) > before or number == -1.0:
            return None
        return self._checked(number, unit, _Stated(element, place, spot, bool(stated)))

    def _checked(self, number: float, unit: LimitUnit, stated: _Stated) -> Speed | None:
        speed = speed_of(number, unit)
        if not 0.0 < speed.mps <= LIMIT_MAX_MPS:
            shown = f"speed limit {number:g} {unit}" + (
                "" if stated.with_unit else " (no unit given)"
            )
            if stated.with_unit or number <= 0.0 or self.options.limit_unit is not None:
                text = f"{shown} must lie above 0 and up to 300 km/h"
            else:
                text = f"{shown} is {speed.mps * KMH_PER_MPS:.4g} km/h; say in which unit it is"
                self._unit_needed = True
            self._fault(stated.place, stated.element, text)
            return None
        seen = _Seen(stated.spot, number, speed.mps)
        (self._explicit if stated.with_unit else self._unitless).append(seen)
        return speed

    def _fault(self, place: Place, element: Element, text: str) -> None:
        self.faults.append(str(place.error(element, text)))

    def _unit(self, text: str, spot: Spot) -> LimitUnit | None:
        unit = unit_named(text)
        if unit is not None and text != unit:
            self._respelled.setdefault(f"{text[:20]!r} is read as {unit}", []).append(spot)
        return unit

    def refuse(self) -> None:
        """Raise all faults as one.

        Raises:
            ModelError: there are faults; names the first ones and how many there are.
        """
        if not self.faults:
            return
        shown = self.faults[:_FAULTS_TOLD]
        hidden = len(self.faults) - len(shown)
        more = f"\n  and {counted(hidden, 'more unusable number')}" if hidden else ""
        text = "\n  also ".join(shown) + more
        if self._unit_needed:
            raise OptionNeededError(text, replace(self.options, limit_unit="km/h"))
        raise ModelError(text)

    def notes(self) -> Iterator[Finding]:
        """Yield what is told of units."""
        for what, spots in self._respelled.items():
            yield told("note", spots, f"speed unit {what} ({counted(len(spots), 'place')})")
        chosen = self.options.limit_unit
        if chosen is None:
            yield from self._in_doubt()
        elif self._explicit and not self._unitless:
            spots = [seen.spot for seen in self._explicit]
            text = f"--limit-unit {chosen} changes nothing: every speed states its unit"
            yield told("note", spots, text)
        fast = [seen for seen in self._explicit if seen.mps * KMH_PER_MPS > _HIGHEST_KMH + 0.5]
        if fast:
            shown = f"{fast[0].mps * KMH_PER_MPS:.4g} km/h"
            text = f"{counted(len(fast), 'limit')} above {_HIGHEST_KMH:g} km/h, the first {shown}"
            question = "no public road has it; is the unit in the file right?"
            yield told("warning", [seen.spot for seen in fast], text, question)

    def _in_doubt(self) -> Iterator[Finding]:
        odd = [seen for seen in self._unitless if _doubtful(seen.number)]
        if not odd:
            return
        numbers = sorted({seen.number for seen in odd})
        readings = [f"{n:g} m/s = {n * KMH_PER_MPS:.4g} km/h" for n in numbers]
        count = counted(len(odd), "speed")
        text = f"{count} without a unit, read as m/s, as OpenDRIVE says: {listed(readings)}"
        doubt = "no sign shows that; is the unit right?"
        way_out = "--limit-unit km/h or mph reads them so; --limit-unit m/s says that it is right"
        yield told("warning", [seen.spot for seen in odd], text, doubt, way_out)


class _Stated(NamedTuple):
    element: Element
    place: Place
    spot: Spot
    with_unit: bool


def _doubtful(number: float) -> bool:
    as_on_a_sign = number >= _SIGN_MIN and number % 5.0 == 0.0
    return as_on_a_sign or number * KMH_PER_MPS > _USUAL_MAX_KMH + 0.5
