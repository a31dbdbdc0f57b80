"""What is kept about one driver on one route, as values; how it gets into a file is elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from ..errors import ModelError
from ..kernel.arrays import FloatArray

# What made an iteration: a drive, a recording learned from, or the driver's word (section 7).
KINDS: Final = ("drive", "learn", "forget", "undo", "rollback")


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


@dataclass(frozen=True, eq=False, slots=True)
class Iteration:
    """What was known after one drive; float64 arrays of n nodes, read-only when they were read.

    Evidence and pending demonstrations (section 6) are kept per sign: the driver wishes to go
    faster or slower. A demonstration is pending until the evidence accepts it.

    Attributes:
        number: 1 for the first, then counting up by one.
        kind: one of ``KINDS``; of iteration 0, which is in no file, ``base``.
        note: up to 80 printable ASCII characters for people.
        interventions: number of pedal interventions in the drive.
        base_mps: per node, planned from the legal limits alone in that drive.
        learned_mps: per node, the speed that the next drive follows.
        offset_mps: per cell, learned offset of the set speed from the legal limit.
        drive: per node, number of the iteration that changed it last, 0 = never.
        intervention: per node, number of the intervention in that drive, 0 = set speed.
        lessons: per node, how many drives shaped it.
        bound: per node, which bound cut it last (``BOUND`` of ``kernel.codes``).
        evidence_faster, evidence_slower: per node, 0 .. 2.2, for the pedals.
        pending_faster, pending_slower: per node, number of pending demonstrations.
        pending_faster_mps, pending_slower_mps: per node, their mean speed.
        offset_evidence_faster, offset_evidence_slower: per cell, 0 .. 2.2, for the lever.
        offset_pending_faster, offset_pending_slower: per cell, number of pending offsets.
        offset_pending_faster_mps, offset_pending_slower_mps: per cell, their mean.
    """

    number: int
    kind: str
    note: str
    interventions: int
    base_mps: FloatArray
    learned_mps: FloatArray
    offset_mps: FloatArray
    drive: FloatArray
    intervention: FloatArray
    lessons: FloatArray
    bound: FloatArray
    evidence_faster: FloatArray
    evidence_slower: FloatArray
    pending_faster: FloatArray
    pending_slower: FloatArray
    pending_faster_mps: FloatArray
    pending_slower_mps: FloatArray
    offset_evidence_faster: FloatArray
    offset_evidence_slower: FloatArray
    offset_pending_faster: FloatArray
    offset_pending_slower: FloatArray
    offset_pending_faster_mps: FloatArray
    offset_pending_slower_mps: FloatArray


# Of the arrays of an iteration, in their order in a file.
COLUMN_NAMES: Final = tuple(f.name for f in fields(Iteration) if f.type == "FloatArray")


@dataclass(frozen=True, eq=False)
class StoredProfile:
    """Everything that is kept about one driver on one route.

    Attributes:
        driver_id: 0 .. 999999999.
        route: fingerprint of the route, 16 hexadecimal digits.
        base_mps: per node, the base profile before the first iteration, float64 array of n nodes;
            each iteration has that of its drive, which other parameters may have planned.
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
        columns = dict.fromkeys(COLUMN_NAMES, np.zeros(self.nodes))
        columns |= {"base_mps": self.base_mps, "learned_mps": self.base_mps}
        return Iteration(0, "base", "", 0, **columns)

    def next_iteration(
        self,
        kind: str,
        note: str,
        interventions: int,
        changed: Mapping[str, FloatArray],
        after: int | None = None,
    ) -> Iteration:
        """Return what follows on iteration ``after`` (None: the newest), numbered as the next one.

        Args:
            kind: one of ``KINDS``.
            note: for people.
            interventions: number of pedal interventions in the drive.
            changed: arrays by name; all others are as in iteration ``after``, to the bit.
            after: number of that iteration.

        Raises:
            ModelError: there is no iteration ``after``.
        """
        return replace(
            self.iteration(after),
            number=len(self.iterations) + 1,
            kind=kind,
            note=note,
            interventions=interventions,
            **dict(changed),
        )

    def with_iteration(self, iteration: Iteration) -> StoredProfile:
        """Return this profile with ``iteration`` added as the newest."""
        return replace(self, iterations=(*self.iterations, iteration))

    def rolled_back(self, to: int) -> StoredProfile:
        """Return this profile with a copy of iteration ``to`` added as the newest.

        0 is the base profile with nothing learned: that of the newest iteration, since the
        parameters of the first drive may be long gone.

        Raises:
            ModelError: there is no iteration ``to``.
        """
        base = self.iteration().base_mps
        changed = {} if to else {"base_mps": base, "learned_mps": base}
        copy = self.next_iteration("rollback", f"rollback of {to}", 0, changed, after=to)
        return self.with_iteration(copy)
