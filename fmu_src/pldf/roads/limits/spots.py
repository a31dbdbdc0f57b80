"""Where in a file something was found, for what is told of many places at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from ...findings import Finding, Severity
from ..opendrive.xml_tree import Place

_NAMED_MAX: Final = 3


class Spot(NamedTuple):
    """One place on a road of a file."""

    place: Place
    line: int
    s_m: float  # over the road's own arc length

    def __str__(self) -> str:
        """Return metre and road."""
        return f"{self.s_m:.6g} m of road {self.place.road}"


def told(
    severity: Severity, spots: Sequence[Spot], text: str, consequence: str = "", way_out: str = ""
) -> Finding:
    """Return what is told once of all ``spots``; it points at the first."""
    first = spots[0]
    where = f"road {first.place.road}, s = {first.s_m:.6g} m"
    return Finding(severity, str(first.place.path), first.line, where, text, consequence, way_out)


def listed(items: Sequence[str]) -> str:
    """Return the first items and how many there are more."""
    more = f" and {len(items) - _NAMED_MAX} more" if len(items) > _NAMED_MAX else ""
    return ", ".join(items[:_NAMED_MAX]) + more


def counted(count: int, thing: str) -> str:
    """Return the number with its noun."""
    return f"{count} {thing}" if count == 1 else f"{count} {thing}s"
