"""What a person says about how the file of a road is to be read: the same in every command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

LimitUnit = Literal["km/h", "mph", "m/s"]


@dataclass(frozen=True, slots=True)
class RoadOptions:
    """How to read a road; without any of it, the file says all. CSV roads need none.

    Attributes:
        start_road: id of the OpenDRIVE road to start with; None: the only possible one.
        via: ids of the roads to pass, in this order; the same may be named twice.
        to: id of the road that the way ends with; None: it goes on while there is one way.
        reverse: the start road is driven against the direction in which it is drawn.
        default_limit_mps: limit where the file states none and no neighbour does.
        limit_unit: unit of limits that the file states without one; None: m/s, as OpenDRIVE says.
        signs: speed signs count where no speed is stated.
        smoothing_m: wavelength in m below which noise of the curvature is smoothed away; None: it
            is found where there is noise, 0: never.
    """

    start_road: str | None = None
    via: tuple[str, ...] = ()
    to: str | None = None
    reverse: bool = False
    default_limit_mps: float | None = None
    limit_unit: LimitUnit | None = None
    signs: bool = True
    smoothing_m: float | None = None


AS_WRITTEN = RoadOptions()
