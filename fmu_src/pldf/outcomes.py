"""What became of each intervention of a drive, and why: one structure, one form in words.

The kernel finds the figures (``kernel/outcomes``). The words are printf formats: the native FMUs
print the same lines with them (``build/runtime/outcome.c``). They tell speeds in km/h; the
structure has m/s.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import floor
from typing import Final, NamedTuple

import numpy as np

from .kernel.arrays import FloatArray, NextArrays, TraceArrays
from .kernel.codes import (
    BOUND_ACCEL,
    BOUND_DECEL,
    BOUND_JERK,
    BOUND_LATERAL_ACCEL,
    BOUND_LEGAL_LIMIT,
    BOUND_NONE,
    OUTCOME_HOLE,
    OUTCOME_LEARNED,
    OUTCOME_NOT_ELIGIBLE,
    OUTCOME_STOP,
    OUTCOME_TAKEN_BACK,
)
from .kernel.state import PldfState
from .kernel.units import KMH_PER_MPS

BOUND_WORDS: Final = {
    BOUND_NONE: "no bound",
    BOUND_LATERAL_ACCEL: "lateral acceleration",
    BOUND_LEGAL_LIMIT: "legal limit + tolerance",
    BOUND_ACCEL: "acceleration",
    BOUND_DECEL: "deceleration",
    BOUND_JERK: "jerk",
}

NOT_LEARNED: Final = "not learned: "
# In people's words: %d takes a whole number of m or km/h, %s a name or a number with one decimal.
TEXTS: Final = {
    "PEDAL": "pedal intervention %d, %d to %d m: ",
    "TRUNCATED": "(not over when the drive ended) ",
    "NOT_MOVED": NOT_LEARNED + "the car did not move",
    "LEARNED": "learned from %d to %d m, on average %s km/h, at most %s km/h",
    "BARRED": ", but for %d m where learning was not allowed",
    "HOLE": NOT_LEARNED + "a hole of %s s in the recording costs %d m",
    "STOP": NOT_LEARNED + "the car was slower than %d km/h, a situation, not a wish",
    "NOT_ELIGIBLE": NOT_LEARNED + "learning was not allowed there",
    "SET_SPEED": "set speed, %d to %d m: ",
    "SET_LEARNED": "%s km/h learned",
    "SET_CUT": "%s km/h learned of the %s km/h set, held by legal limit + tolerance",
    "SET_NOT_ELIGIBLE": "%s km/h not learned: learning was not allowed there",
    "SET_TAKEN_BACK": NOT_LEARNED + "taken back at once",
    "PLAN": "plan with the set speed: ",
    "SEPARATOR": "; ",
    "HELD": "held at %d km/h from %d to %d m by %s",
    "HELD_BETWEEN": "held at %d to %d km/h from %d to %d m by %s",
    "MORE": "held at %d more places",
}

# Of one intervention, so that its line stays readable.
HOLDS_TOLD: Final = 10
# Transitions shorter than this are left out of the words: the bounds trim an edge here and there.
TRANSITION_MIN_M: Final = 10
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
    barred_m: float
    holds: tuple[Hold, ...]


class SetSpeedOutcome(NamedTuple):
    """What became of a series of presses of the lever.

    Attributes:
        from_m, to_m: where its offset holds, or would have held.
        wish_mps: offset from the legal limit that the driver set.
        offset_mps: what was adopted of it.
        outcome: OUTCOME in ``kernel.codes``.
        barred_m: how much of it lies where learning was not allowed, which takes no offset.
    """

    from_m: float
    to_m: float
    wish_mps: float
    offset_mps: float
    outcome: int
    barred_m: float

    @property
    def is_cut(self) -> bool:
        """Tell whether the tolerance above the legal limit allowed less than was set."""
        learned = self.outcome == OUTCOME_LEARNED
        return learned and self.offset_mps < self.wish_mps - SAME_OFFSET_MPS


class Outcomes(NamedTuple):
    """What became of all interventions of a drive.

    Attributes:
        pedals: in the order of the drive.
        set_speeds: in the order of the drive.
        plan_holds: bounds that cut the plan with the learned set speeds.
        slowest_mps: below this speed the car stops, which is no wish.
    """

    pedals: tuple[PedalOutcome, ...]
    set_speeds: tuple[SetSpeedOutcome, ...]
    plan_holds: tuple[Hold, ...]
    slowest_mps: float

    def lines(self) -> Iterator[str]:
        """Yield one line for people per intervention."""
        for pedal in self.pedals:
            place = whole(pedal.start_m), whole(pedal.end_m)
            yield TEXTS["PEDAL"] % (pedal.number, *place) + self.words(pedal)
        for series in self.set_speeds:
            place = whole(series.from_m), whole(series.to_m)
            yield TEXTS["SET_SPEED"] % place + set_speed_words(series)
        told = _first(told_holds(self.plan_holds))
        if told:
            yield TEXTS["PLAN"] + TEXTS["SEPARATOR"].join(told)

    def words(self, pedal: PedalOutcome) -> str:
        """Return what became of ``pedal``, without its number and place."""
        told = TEXTS["TRUNCATED"] if pedal.truncated else ""
        if pedal.outcome == OUTCOME_LEARNED:
            told += TEXTS["LEARNED"] % (
                whole(pedal.learned_from_m),
                whole(pedal.learned_to_m),
                signed(KMH_PER_MPS * pedal.mean_change_mps),
                signed(KMH_PER_MPS * pedal.largest_change_mps),
            )
            told += barred_words(pedal.barred_m)
            return TEXTS["SEPARATOR"].join([told, *_first(told_holds(pedal.holds))])
        if pedal.outcome == OUTCOME_HOLE:
            return told + TEXTS["HOLE"] % (tenths(pedal.hole_s), whole(pedal.hole_m))
        if pedal.outcome == OUTCOME_STOP:
            return told + TEXTS["STOP"] % whole(KMH_PER_MPS * self.slowest_mps)
        if pedal.outcome == OUTCOME_NOT_ELIGIBLE:
            return told + TEXTS["NOT_ELIGIBLE"]
        return told + TEXTS["NOT_MOVED"]


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
    return Outcomes(tuple(pedals), tuple(series), tuple(held.get(0, ())), st.learning_speed_min_mps)


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
        following.set_barred_m[k],
    )


def set_speed_words(series: SetSpeedOutcome) -> str:
    """Return what became of a series of presses, without its place."""
    offset = signed(KMH_PER_MPS * series.offset_mps)
    wish = signed(KMH_PER_MPS * series.wish_mps)
    if series.outcome == OUTCOME_TAKEN_BACK:
        return TEXTS["SET_TAKEN_BACK"]
    if series.outcome == OUTCOME_NOT_ELIGIBLE:
        return TEXTS["SET_NOT_ELIGIBLE"] % wish
    told = TEXTS["SET_CUT"] % (offset, wish) if series.is_cut else TEXTS["SET_LEARNED"] % offset
    return told + barred_words(series.barred_m)


def barred_words(metres: float) -> str:
    """Return what of a lesson was left out; empty if nothing was."""
    return TEXTS["BARRED"] % whole(metres) if metres > 0.0 else ""


def told_holds(holds: Iterable[Hold]) -> list[str]:
    """Return the holds in words, but for short transitions."""
    return [hold_words(hold) for hold in holds if _is_told(hold)]


def hold_words(hold: Hold) -> str:
    """Return where a bound holds the profile, and at which speed."""
    place = (whole(hold.from_m), whole(hold.to_m), BOUND_WORDS[hold.bound])
    low, high = whole(KMH_PER_MPS * hold.low_mps), whole(KMH_PER_MPS * hold.high_mps)
    if high == low:
        return TEXTS["HELD"] % (low, *place)
    return TEXTS["HELD_BETWEEN"] % (low, high, *place)


def is_outcome(text: str) -> bool:
    """Tell whether a message of an FMU is one of these lines."""
    starts = (TEXTS[name].partition("%")[0] for name in ("PEDAL", "SET_SPEED", "PLAN"))
    return text.startswith(tuple(starts))


def held_places(bound: FloatArray, speed_mps: FloatArray) -> list[Hold]:
    """Return the holds of a stored profile: which bound cut each node, and its speed, per node."""
    first = np.flatnonzero(np.diff(bound, prepend=np.nan) != 0.0)
    behind = np.append(first[1:], len(bound))
    return [
        Hold(int(bound[a]), a, b - 1.0, speed_mps[a:b].min(), speed_mps[a:b].max())
        for a, b in zip(first.tolist(), behind.tolist(), strict=True)
        if bound[a] > BOUND_NONE
    ]


def _is_told(hold: Hold) -> bool:
    transition = hold.bound not in (BOUND_LATERAL_ACCEL, BOUND_LEGAL_LIMIT)
    return not transition or hold.to_m - hold.from_m >= TRANSITION_MIN_M


def _first(told: list[str]) -> list[str]:
    """Return what fits into one line."""
    more = len(told) - HOLDS_TOLD
    return told if more <= 0 else [*told[:HOLDS_TOLD], TEXTS["MORE"] % more]


# The native FMUs round in the same way, and whatever the importer's locale: so not by printf.


def whole(value: float) -> int:
    """Return the nearest whole number."""
    return floor(value + 0.5)


def tenths(value: float) -> str:
    """Return the absolute value with one decimal."""
    count = whole(10.0 * abs(value))
    return f"{count // 10}.{count % 10}"


def signed(value: float) -> str:
    """Return the value with sign and one decimal."""
    return ("-" if whole(10.0 * value) < 0 else "+") + tenths(value)
