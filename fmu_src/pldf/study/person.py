"""One simulated participant while driving, and what a drive's row says of the person's wish."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vehicle_models.driver import ScriptedDriver
from vehicle_models.script_kernel import ScriptArrays
from vehicle_models.wish_kernel import WishArrays

from ..compiled import pack
from ..kernel.arrays import ProfileArrays
from ..kernel.state import PldfState
from .drive_row import DriveRow
from .participants import Participant
from .phases import HANDS_OFF, PREFERENCE, SCRIPT, Phase, seed_of_drive


class Person(NamedTuple):
    """A participant with the driver model, and the lasting wish or a script to follow."""

    participant: Participant
    model: ScriptedDriver
    wish: WishArrays
    script: ScriptArrays

    def packed(self, phase: Phase, number: int) -> NDArray[np.void]:
        """Return the driver's record for the drive with this number, from 0."""
        st = pack(self.model.record)
        kind = SCRIPT if len(self.script.at) else PREFERENCE
        st["kind"] = kind if phase.intervenes else HANDS_OFF
        st["seed"] = self.seed_of(number)
        return st

    def seed_of(self, number: int) -> int:
        """Return the seed of the drive with this number, from 0."""
        return seed_of_drive(self.participant.seed, number)

    @property
    def is_always_the_same(self) -> bool:
        """Whether the wish of every drive is the lasting one."""
        record = self.model.record
        return not (record.wish_offset_occasion_sd_mps or record.wish_lateral_occasion_sigma)


class WishErrors(NamedTuple):
    """Root mean square over the route's metres of the profile followed minus a wish, in m/s."""

    lasting_mps: float
    drive_mps: float


def wish_errors(followed: ProfileArrays, lasting: WishArrays, drive: WishArrays) -> WishErrors:
    """Return how far the profile followed is from the lasting wish and from that of the drive."""
    return WishErrors(_missed_mps(followed, lasting), _missed_mps(followed, drive))


def _missed_mps(followed: ProfileArrays, wish: WishArrays) -> float:
    missed = np.asarray(followed.learned_mps) - np.asarray(wish.wish_mps)
    return float(np.sqrt(np.mean(missed * missed)))


def row_of_drive(
    person: Person,
    phase: Phase,
    number: int,
    duration_s: float,
    outputs: PldfState,
    errors: WishErrors,
) -> DriveRow:
    """Return the row of the drive with this number, from 0, with the function's last outputs."""
    return DriveRow(
        participant=person.participant.id,
        phase=phase.name,
        position=number + 1,
        duration_s=duration_s,
        pedal_rate=outputs.rate_pedal,
        set_speed_rate=outputs.rate_set_speed,
        combined_rate=outputs.rate_combined,
        interventions=outputs.drive_interventions,
        wish_error_mps=errors.lasting_mps,
        drive_wish_error_mps=errors.drive_mps,
    )
