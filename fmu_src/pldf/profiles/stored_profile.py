"""What is kept about one driver on one route, as values; how it gets into a file is elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..errors import ModelError
from ..kernel.arrays import FloatArray


class ProfileRefused(ModelError):  # noqa: N818 - it says what was done, to a person
    """A profile that is not used: the text gives file, line or byte, reason and what happens next.

    Attributes:
        file: name of the file as shown to the user.
        where: ``line 4`` (header), ``byte 8192`` or empty.
        reason: what is wrong there.
    """

    def __init__(self, file: str, where: str, reason: str, outcome: str = "") -> None:
        place = f"{file}, {where}" if where else file
        super().__init__(f"{place}: {reason}" + (f"; {outcome}" if outcome else ""))
        self.file = file
        self.where = where
        self.reason = reason

    def followed_by(self, outcome: str) -> ProfileRefused:
        """Return the same refusal, with ``outcome`` told at the end of the text."""
        return ProfileRefused(self.file, self.where, self.reason, outcome)


@dataclass(frozen=True, eq=False)
class Iteration:
    """What was known after one drive; float64 arrays of n nodes, read-only when they were read.

    Attributes:
        number: 1 for the first drive that was learned, then counting up by one.
        note: up to 80 printable ASCII characters for people.
        interventions: number of pedal interventions in the drive.
        learned_mps: per node, the speed that the next drive follows.
        offset_mps: per cell, learned offset of the set speed from the legal limit.
        drive: per node, number of the drive that changed it last, 0 = never.
        intervention: per node, number of the intervention in that drive, 0 = set speed.
    """

    number: int
    note: str
    interventions: int
    learned_mps: FloatArray
    offset_mps: FloatArray
    drive: FloatArray
    intervention: FloatArray


@dataclass(frozen=True, eq=False)
class StoredProfile:
    """Everything that is kept about one driver on one route.

    Attributes:
        driver_id: 0 .. 999999999.
        route: fingerprint of the route, 16 hexadecimal digits.
        base_mps: per node, planned from the legal limits alone, float64 array of n nodes.
        iterations: numbered from 1; empty before the first learned drive.
    """

    driver_id: int
    route: str
    base_mps: FloatArray
    iterations: tuple[Iteration, ...] = ()

    @property
    def nodes(self) -> int:
        """Number of nodes, one per metre."""
        return len(self.base_mps)

    def iteration(self, number: int | None = None) -> Iteration:
        """Return iteration ``number``; None: the newest, 0: the base profile before any learning.

        Raises:
            ModelError: there is no such iteration.
        """
        if number is None:
            number = len(self.iterations)
        if not 0 <= number <= len(self.iterations):
            raise ModelError(
                f"there is no iteration {number}; this profile has 0 (base) to "
                f"{len(self.iterations)}"
            )
        if number > 0:
            return self.iterations[number - 1]
        zeros = np.zeros(self.nodes)
        return Iteration(0, "base", 0, self.base_mps, zeros, zeros, zeros)

    def with_iteration(self, iteration: Iteration) -> StoredProfile:
        """Return this profile with ``iteration`` added as the newest."""
        return replace(self, iterations=(*self.iterations, iteration))
