"""Units that laboratories write, and what they are in ours.

Factors are fractions of whole numbers: a number of km/h becomes the float64 that is nearest to it
in m/s but for two roundings, as if a person had calculated it.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Final, NamedTuple

import numpy as np

from ..kernel.arrays import FloatArray

_FOOT: Final = Fraction(3048, 10000)  # m; the international foot of 1959, and what follows from it
_MILE: Final = 5280 * _FOOT
_GRAVITY: Final = Fraction(980665, 100000)  # m/s2; standard gravity, ISO 80000-3

# Our unit -> a name as one writes it -> how many of ours it is.
UNITS: Final[dict[str, dict[str, Fraction]]] = {
    "s": {
        "s": Fraction(1),
        "ms": Fraction(1, 1000),
        "us": Fraction(1, 10**6),
        "ns": Fraction(1, 10**9),
        "min": Fraction(60),
        "h": Fraction(3600),
    },
    "m": {
        "m": Fraction(1),
        "km": Fraction(1000),
        "cm": Fraction(1, 100),
        "mm": Fraction(1, 1000),
        "ft": _FOOT,
        "mi": _MILE,
    },
    "m/s": {
        "m/s": Fraction(1),
        "km/h": Fraction(1000, 3600),
        "mph": _MILE / 3600,
        "kn": Fraction(1852, 3600),
        "ft/s": _FOOT,
    },
    "m/s2": {
        "m/s2": Fraction(1),
        "g": _GRAVITY,
        "km/h/s": Fraction(1000, 3600),
        "ft/s2": _FOOT,
    },
    "1": {"1": Fraction(1), "%": Fraction(1, 100)},
}

# Stamps that say what time it was; their seconds are counted from the first row.
EPOCHS: Final[dict[str, Fraction]] = {
    f"epoch {name}": UNITS["s"][name] for name in ("s", "ms", "us", "ns")
}
DATE_TIME: Final = "date"  # 2026-05-01T12:00:00.250, or 12:00:00.250
STAMPS: Final = (*EPOCHS, DATE_TIME)

_SPELT: Final = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s", "sekunden": "s",
    "msec": "ms", "millisecond": "ms", "milliseconds": "ms", "millis": "ms",
    "µs": "us", "μs": "us", "usec": "us", "microseconds": "us", "micros": "us",
    "nsec": "ns", "nanoseconds": "ns", "nanos": "ns",
    "minutes": "min", "hours": "h", "hour": "h",
    "meter": "m", "metre": "m", "meters": "m", "metres": "m", "kilometer": "km",
    "kilometre": "km", "kilometers": "km", "kilometres": "km", "feet": "ft", "foot": "ft",
    "mile": "mi", "miles": "mi",
    "mps": "m/s", "ms-1": "m/s", "m/sec": "m/s", "m*s-1": "m/s",
    "kmh": "km/h", "kph": "km/h", "kmph": "km/h", "km/hr": "km/h", "kmh-1": "km/h",
    "mi/h": "mph", "mile/h": "mph", "miles/h": "mph",
    "knot": "kn", "knots": "kn", "kt": "kn", "kts": "kn", "fps": "ft/s",
    "mps2": "m/s2", "m/s/s": "m/s2", "ms-2": "m/s2", "m/sec2": "m/s2", "m*s-2": "m/s2",
    "percent": "%", "pct": "%", "prozent": "%",
    "-": "1", "ratio": "1", "none": "1", "fraction": "1",
    "iso": DATE_TIME, "iso8601": DATE_TIME, "isotime": DATE_TIME, "iso 8601": DATE_TIME,
    "datetime": DATE_TIME, "date time": DATE_TIME, "unix": "epoch s", "unix s": "epoch s",
    "unix ms": "epoch ms", "unix us": "epoch us", "unix ns": "epoch ns",
}  # fmt: skip
_KNOWN: Final = frozenset([*STAMPS, *(name for names in UNITS.values() for name in names)])

# Speed [km/h], Speed (km/h), Speed in km/h, Speed / km/h, speed_kmh, speed.kmh
_IN_HEADER: Final = (
    re.compile(r"(?P<name>.*\S)\s*[\[(<{](?P<unit>[^\[\](){}<>]+)[\])>}]"),
    re.compile(r"(?P<name>.*\S)\s+in\s+(?P<unit>\S+)"),
    re.compile(r"(?P<name>.*\S)\s+/\s*(?P<unit>\S+)"),
    re.compile(r"(?P<name>.*[^\s_.-])[\s_.-]+(?P<unit>[^\s_.-]+)"),
)


class Header(NamedTuple):
    """A column's name as far as it is a name, and the unit that stands in it, empty if none."""

    name: str
    unit: str


def unit_named(text: str) -> str:
    """Return the unit that ``text`` means, as ``UNITS`` and ``STAMPS`` write it; empty if none."""
    plain = " ".join(text.lower().replace("²", "2").replace("⁻", "-").split())
    plain = plain.replace("^", "").replace("·", "*").replace("¹", "1")
    for spelt in (plain, plain.replace(" ", "")):
        found = _SPELT.get(spelt, spelt)
        if found in _KNOWN:
            return found
    return ""


def header_of(text: str) -> Header:
    """Return what the name of a column says; its unit is empty if it tells none that is known."""
    for form in _IN_HEADER:
        found = form.fullmatch(text.strip())
        if found and (unit := unit_named(found["unit"])):
            return Header(found["name"], unit)
    return Header(text.strip(), "")


def units_of(ours: str) -> tuple[str, ...]:
    """Return the units that a column may have whose unit is ``ours``: m/s, s, ..., or 1."""
    return (*UNITS.get(ours, ()), *(STAMPS if ours == "s" else ()))


def to_ours(values: FloatArray, unit: str, ours: str) -> FloatArray:
    """Return ``values`` in ``unit``, one of ``units_of(ours)`` but a date, in the unit ``ours``."""
    factor = EPOCHS.get(unit) or UNITS[ours][unit]
    return np.asarray(values * float(factor.numerator) / float(factor.denominator))
