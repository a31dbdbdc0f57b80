"""The row of ``drives.csv``, the table that a study ends in and an analysis begins with."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import nan
from typing import Final

COLUMNS: Final = (
    "participant", "phase", "system", "position", "duration_s",
    "pedal_rate", "set_speed_rate", "combined_rate", "interventions", "wish_error_mps",
)  # fmt: skip


@dataclass(frozen=True)
class DriveRow:
    """One drive of one participant, simulated or real; what is not known is NaN, or position 0.

    Attributes:
        participant: id.
        phase: the system and the number of the drive with it, such as A1.
        pedal_rate: share of the time with a pedal intervention, 0..1.
        set_speed_rate: share of the time with a set speed set by the driver in this drive.
        combined_rate: share of the time with either.
        position: place of the drive in this participant's order, from 1.
        duration_s: time from the first to the last sample.
        interventions: number of pedal interventions.
        wish_error_mps: root mean square over the route's metres of the profile followed minus the
            driver's hidden wish; simulated drivers only.
        where: file, and line if it has several drives, that the row was read from.
    """

    participant: str
    phase: str
    pedal_rate: float
    set_speed_rate: float
    combined_rate: float
    position: int = 0
    duration_s: float = nan
    interventions: float = nan
    wish_error_mps: float = nan
    where: str = field(default="", compare=False)

    @property
    def system(self) -> str:
        """A (base function) or B (learned profile)."""
        return self.phase[0]

    @property
    def cells(self) -> tuple[str | float, ...]:
        """The values in the order of ``COLUMNS``."""
        return tuple(getattr(self, name) for name in COLUMNS)
