"""What became of each intervention of a drive, and why, in numbers.

The kernel finds them (``kernel/outcomes``); ``outcome_words`` has the words.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from .kernel.arrays import FloatArray, NextArrays, TraceArrays
from .kernel.codes import (
    BOUND_NONE,
    OUTCOME_LEARNED,
)
from .kernel.state import PldfState

SAME_OFFSET_MPS: Final = 1e-9


class Hold(NamedTuple):
    """A run of nodes whose learned speed the same bound cut last.

    Attributes:
        bound: which (BOUND in ``kernel.codes``).
        from_m, to_m: its first and last node.
        low_mps, high_mps: lowest and highest learned speed there.
    """

    bound: int
    from_m: float
    to_m: float
    low_mps: float
    high_mps: float


class PedalOutcome(NamedTuple):
    """What became of a pedal intervention.

    Attributes:
        number: 1, 2, ... in the order of the drive.
        start_m, end_m: where the driver intervened.
        truncated: it was not over when the drive ended.
        outcome: OUTCOME in ``kernel.codes``.
        learned_m: how many nodes of the profile it shaped last.
        learned_from_m, learned_to_m: the first and the last of them.
        mean_change_mps, largest_change_mps: of these nodes, against the profile driven.
        hole_s, hole_m: time and length of the holes that touch it.
        proof: evidence that it has got, while it waits for more.
        barred_m: how much of it, stretched, lies where learning was not allowed.
        holds: bounds that cut its lesson.
    """

    number: int
    start_m: float
    end_m: float
    truncated: bool
    outcome: int
    learned_m: int
    learned_from_m: float
    learned_to_m: float
    mean_change_mps: float
    largest_change_mps: float
    hole_s: float
    hole_m: float
    proof: float
    barred_m: float
    holds: tuple[Hold, ...]


class SetSpeedOutcome(NamedTuple):
    """What became of a series of presses of the lever.

    Attributes:
        from_m, to_m: where its offset holds, or would have held.
        wish_mps: offset from the legal limit that the driver set.
        offset_mps: what was adopted of it, or approached where ``set_speed_gain`` is below 1.
        outcome: OUTCOME in ``kernel.codes``.
        proof: evidence that it has got, while it waits for more.
        barred_m: how much of it lies where learning was not allowed, which takes no offset.
    """

    from_m: float
    to_m: float
    wish_mps: float
    offset_mps: float
    outcome: int
    proof: float
    barred_m: float

    @property
    def is_cut(self) -> bool:
        """Tell whether the tolerance above the legal limit allowed less than was set."""
        learned = self.outcome == OUTCOME_LEARNED
        return learned and self.offset_mps < self.wish_mps - SAME_OFFSET_MPS


class Place(NamedTuple):
    """A run of nodes, or cells, whose evidence changed in the same way (section 6).

    Attributes:
        by: EVIDENCE_BY in ``kernel.codes``.
        sign: 1 for going faster, -1 for slower.
        change: EVIDENCE_CHANGE in ``kernel.codes``.
        from_m, to_m: its first and last node.
        evidence: the highest there after the drive.
    """

    by: int
    sign: int
    change: int
    from_m: float
    to_m: float
    evidence: float


class Outcomes(NamedTuple):
    """What became of all interventions of a drive.

    Attributes:
        pedals: in the order of the drive.
        set_speeds: in the order of the drive.
        plan_holds: bounds that cut the plan with the learned set speeds.
        slowest_mps: below this speed the car stops, which is no wish.
        places: whose evidence changed, with learn = CONSISTENT.
        accept: evidence from which an intervention is learned.
        set_speed_gain: share of the way to an adopted offset that the profile goes.
    """

    pedals: tuple[PedalOutcome, ...]
    set_speeds: tuple[SetSpeedOutcome, ...]
    plan_holds: tuple[Hold, ...]
    slowest_mps: float
    places: tuple[Place, ...]
    accept: float
    set_speed_gain: float


def outcomes_of(st: PldfState, trace: TraceArrays, following: NextArrays) -> Outcomes:
    """Return what the kernel found out when it learned from a drive."""
    holds = [_hold(following, k) for k in range(st.holds)]
    owners = [int(following.hold_intervention[k]) for k in range(st.holds)]
    held: dict[int, list[Hold]] = {}
    for owner, hold in zip(owners, holds, strict=True):
        held.setdefault(owner, []).append(hold)
    pedals = (
        _pedal(st, trace, following, k, tuple(held.get(k + 1, ())))
        for k in range(st.drive_interventions)
    )
    series = (_set_speed(following, k) for k in range(st.set_series))
    return Outcomes(
        pedals=tuple(pedals),
        set_speeds=tuple(series),
        plan_holds=tuple(held.get(0, ())),
        slowest_mps=st.learning_speed_min_mps,
        places=tuple(_place(following, k) for k in range(st.evidence_places)),
        accept=st.learning_evidence_accept,
        set_speed_gain=st.learning_set_speed_gain,
    )


def _place(following: NextArrays, k: int) -> Place:
    return Place(
        int(following.place_by[k]),
        int(following.place_sign[k]),
        int(following.place_change[k]),
        following.place_from_m[k],
        following.place_to_m[k],
        following.place_evidence[k],
    )


def _hold(following: NextArrays, k: int) -> Hold:
    return Hold(
        int(following.hold_bound[k]),
        following.hold_from_m[k],
        following.hold_to_m[k],
        following.hold_low_mps[k],
        following.hold_high_mps[k],
    )


def _pedal(
    st: PldfState, trace: TraceArrays, following: NextArrays, k: int, holds: tuple[Hold, ...]
) -> PedalOutcome:
    return PedalOutcome(
        number=k + 1,
        start_m=trace.start_m[k],
        end_m=trace.end_m[k],
        truncated=bool(st.intervening) and k == st.drive_interventions - 1,
        outcome=int(following.outcome[k]),
        learned_m=int(following.taught_m[k]),
        learned_from_m=following.taught_from_m[k],
        learned_to_m=following.taught_to_m[k],
        mean_change_mps=following.mean_change_mps[k],
        largest_change_mps=following.largest_change_mps[k],
        hole_s=following.hole_s[k],
        hole_m=following.hole_m[k],
        proof=following.proof[k],
        barred_m=following.barred_m[k],
        holds=holds,
    )


def _set_speed(following: NextArrays, k: int) -> SetSpeedOutcome:
    return SetSpeedOutcome(
        following.set_from_m[k],
        following.set_to_m[k],
        following.set_wish_mps[k],
        following.set_offset_mps[k],
        int(following.set_outcome[k]),
        following.set_proof[k],
        following.set_barred_m[k],
    )


def held_places(bound: FloatArray, speed_mps: FloatArray) -> list[Hold]:
    """Return the holds of a stored profile: which bound cut each node, and its speed, per node."""
    return [
        Hold(int(code), a, b, speed_mps[a : b + 1].min(), speed_mps[a : b + 1].max())
        for a, b, code in equal_runs(bound)
        if code > BOUND_NONE
    ]


def equal_runs(values: FloatArray) -> list[tuple[int, int, float]]:
    """Return (first, last, value) of each run of equal values."""
    starts = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    ends = np.append(starts[1:] - 1, len(values) - 1)
    return [(int(a), int(b), float(values[a])) for a, b in zip(starts, ends, strict=True)]
