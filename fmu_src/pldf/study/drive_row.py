"""The row of ``drives.csv``, the table that a study ends in and an analysis begins with."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import nan
from typing import Final

from ..files.tables import Column, Format
from ..recordings.interventions import Rates

PHASE: Final = Column(
    "phase",
    "text",
    pattern=r"[AB][1-9][0-9]*",
    wanted="A or B and the number of the drive, such as A1",
)
_SHARE: Final = "a number from 0 to 1, the share of the time"
DRIVES: Final = Format(
    "table of drives",
    "drive",
    (
        Column("participant", "text", wanted="the name of a participant"),
        PHASE,
        Column("system", "word", words=("A", "B"), needed=False),
        Column("position", "whole", low=0.0, needed=False, blank=True),
        Column("duration_s", unit="s", needed=False, blank=True),
        Column("pedal_rate", low=0.0, high=1.0, wanted=_SHARE),
        Column("set_speed_rate", low=0.0, high=1.0, wanted=_SHARE),
        Column("combined_rate", low=0.0, high=1.0, wanted=_SHARE),
        Column("interventions", "whole", low=0.0, needed=False, blank=True),
        Column("wish_error_mps", unit="m/s", needed=False, blank=True),
        Column("drive_wish_error_mps", unit="m/s", needed=False, blank=True),
    ),
    key=("participant", "phase"),
)
COLUMNS: Final = DRIVES.names


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
            driver's lasting hidden wish; simulated drivers only.
        drive_wish_error_mps: the same against the wish of this drive.
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
    drive_wish_error_mps: float = nan
    where: str = field(default="", compare=False)

    @property
    def system(self) -> str:
        """A (base function) or B (learned profile)."""
        return self.phase[0]

    @property
    def rates(self) -> Rates:
        """The three rates."""
        return Rates(self.pedal_rate, self.set_speed_rate, self.combined_rate)

    @property
    def cells(self) -> tuple[str | float, ...]:
        """The values in the order of ``COLUMNS``."""
        return tuple(getattr(self, name) for name in COLUMNS)
