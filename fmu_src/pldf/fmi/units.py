"""Unit names such as ``kg/m3`` expressed in SI base units, as FMI asks for."""

from __future__ import annotations

import re
from typing import Final, NamedTuple

_SYMBOLS: Final[dict[str, tuple[float, dict[str, int]]]] = {
    "m": (1.0, {"m": 1}),
    "s": (1.0, {"s": 1}),
    "kg": (1.0, {"kg": 1}),
    "A": (1.0, {"A": 1}),
    "K": (1.0, {"K": 1}),
    "rad": (1.0, {"rad": 1}),
    "N": (1.0, {"kg": 1, "m": 1, "s": -2}),
    "J": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "Hz": (1.0, {"s": -1}),
    "kW": (1e3, {"kg": 1, "m": 2, "s": -3}),
}
# What a person reads instead: display value = factor * value in the unit.
DISPLAY: Final[dict[str, tuple[str, float]]] = {"m/s": ("km/h", 3.6)}

PURE: Final = "1"  # the unit of shares, pedals and other ratios
# Name of the quantity, after Modelica.Units.SI, and the usual size of what is connected.
QUANTITIES: Final[dict[str, tuple[str, float]]] = {
    PURE: ("Ratio", 1.0),
    "m": ("Length", 100.0),
    "m/s": ("Velocity", 10.0),
    "m/s2": ("Acceleration", 1.0),
    "m/s3": ("Jerk", 1.0),
    "s": ("Time", 1.0),
    "1/m": ("Curvature", 0.01),
    "1/s": ("Rate", 1.0),
    "kg": ("Mass", 1000.0),
    "kg/m3": ("Density", 1.0),
    "m2": ("Area", 1.0),
    "N": ("Force", 1000.0),
    "W": ("Power", 1e4),
}

_FACTOR: Final = re.compile(r"([A-Za-z]+)(\d?)")


class BaseUnit(NamedTuple):
    """Exponents of the SI base units (those that are not 0) and the factor to them."""

    factor: float
    exponents: dict[str, int]


def base_unit(unit: str) -> BaseUnit:
    """Return the base units of ``unit``; ValueError if it is not a known unit.

    Grammar: ``numerator[/denominator]``, each a product of symbols with an optional exponent,
    joined by ``.``: ``m/s2``, ``1/s``, ``N.m``, ``kg/m3``.
    """
    upper, _, lower = unit.partition("/")
    factor = 1.0
    exponents: dict[str, int] = {}
    for part, sign in ((upper, 1), (lower, -1)):
        for symbol, power in _factors(part, unit):
            scale, powers = _SYMBOLS[symbol]
            factor *= scale ** (sign * power)
            for base, exponent in powers.items():
                exponents[base] = exponents.get(base, 0) + sign * power * exponent
    return BaseUnit(factor, {base: e for base, e in exponents.items() if e})


def _factors(part: str, unit: str) -> list[tuple[str, int]]:
    factors = []
    for piece in part.split(".") if part not in ("", "1") else ():
        match = _FACTOR.fullmatch(piece)
        if match is None or match[1] not in _SYMBOLS:
            raise ValueError(f"unit {unit!r}: {piece!r} is not a known unit symbol")
        factors.append((match[1], int(match[2] or 1)))
    return factors
