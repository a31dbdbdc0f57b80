"""Chance that is the same everywhere: a generator whose numbers float64 holds exactly.

In the numba subset (see ``pldf.kernel``).
"""

from __future__ import annotations

from math import floor
from typing import Protocol

MINSTD_FACTOR = 48271.0
MINSTD_MODULUS = 2147483647.0


class Chance(Protocol):
    """A record with a generator in it."""

    random: float


def sow(st: Chance, seed: int) -> None:
    """Begin the series of ``seed`` >= 0."""
    # Neighbouring seeds give neighbouring first numbers: the first draws are thrown away.
    st.random = seed + 1.0
    for _ in range(3):
        draw(st)


def draw(st: Chance) -> float:
    """Next pseudo-random number above 0 and below 1 (MINSTD: exact in float64)."""
    product = st.random * MINSTD_FACTOR
    st.random = product - MINSTD_MODULUS * floor(product / MINSTD_MODULUS)
    return st.random / MINSTD_MODULUS


def draw_between(st: Chance, low: float, high: float) -> float:
    """Next pseudo-random number between ``low`` and ``high``, all equally likely."""
    return low + (high - low) * draw(st)
