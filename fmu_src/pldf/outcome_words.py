"""What became of each intervention, in people's words.

They are printf formats: the native FMUs print the same lines with them
(``build/runtime/outcome.c``). They tell speeds in km/h.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import floor
from typing import Final

from .kernel.codes import (
    BOUND_ACCEL,
    BOUND_DECEL,
    BOUND_JERK,
    BOUND_LATERAL_ACCEL,
    BOUND_LEGAL_LIMIT,
    BOUND_NONE,
    EVIDENCE_BY,
    EVIDENCE_CHANGE,
    EVIDENCE_GAINED,
    EVIDENCE_LOST,
    OUTCOME_FOLLOWING,
    OUTCOME_FORGOTTEN,
    OUTCOME_HOLE,
    OUTCOME_LEARNED,
    OUTCOME_NOT_ELIGIBLE,
    OUTCOME_PENDING,
    OUTCOME_STOP,
    OUTCOME_TAKEN_BACK,
    OUTCOME_UNDONE,
)
from .kernel.units import KMH_PER_MPS
from .outcomes import Hold, Outcomes, PedalOutcome, Place, SetSpeedOutcome
from .roads import Mark
from .roads.marks import ROAD, ROADS, road_words

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
    "PEDAL": "pedal intervention %d, %d to %d m%s: ",
    "TRUNCATED": "(not over when the drive ended) ",
    "NOT_MOVED": NOT_LEARNED + "the car did not move",
    "LEARNED": "learned from %d to %d m, on average %s km/h, at most %s km/h",
    "BARRED": ", but for %d m where learning was not allowed",
    "HOLE": NOT_LEARNED + "a hole of %s s in the recording costs %d m",
    "STOP": NOT_LEARNED + "the car was slower than %d km/h, a situation, not a wish",
    "NOT_ELIGIBLE": NOT_LEARNED + "learning was not allowed there",
    "FORGOTTEN": NOT_LEARNED + "it began before the place was forgotten",
    "UNDONE": NOT_LEARNED + "the driver took it back",
    "FOLLOWING": NOT_LEARNED + "it happened behind a car that set the speed",
    "PENDING": NOT_LEARNED + "it waits until it happens again, evidence %s of %s",
    "SET_SPEED": "set speed, %d to %d m%s: ",
    "SET_LEARNED": "%s km/h learned",
    "SET_CUT": "%s km/h learned of the %s km/h set, held by legal limit + tolerance",
    "SET_SHARE": ", the profile goes %d percent of the way",
    "SET_NOT_ELIGIBLE": "%s km/h not learned: learning was not allowed there",
    "SET_FORGOTTEN": "%s km/h not learned: set before the place was forgotten",
    "SET_UNDONE": "%s km/h not learned: the driver took it back",
    "SET_PENDING": "%s km/h not learned: it waits until it is set again, evidence %s of %s",
    "SET_TAKEN_BACK": NOT_LEARNED + "taken back at once",
    "PLAN": "plan with the set speed: ",
    "SEPARATOR": "; ",
    "HELD": "held at %d km/h from %d to %d m by %s",
    "HELD_BETWEEN": "held at %d to %d km/h from %d to %d m by %s",
    "MORE": "held at %d more places",
    "FASTER_BY_PEDALS": "faster by pedal, %d to %d m%s: ",
    "SLOWER_BY_PEDALS": "slower by pedal, %d to %d m%s: ",
    "FASTER_BY_LEVER": "faster by lever, %d to %d m%s: ",
    "SLOWER_BY_LEVER": "slower by lever, %d to %d m%s: ",
    "EVIDENCE_GAINED": "evidence grew to %s of %s",
    "EVIDENCE_LOST": "evidence fell to %s of %s",
    "EVIDENCE_DROPPED": "evidence fell to 0, what was waiting there is dropped",
    "EVIDENCE_ACCEPTED": "the wish is accepted",
    "EVIDENCE_PUT_BACK": "what was accepted is put back",
    "ROAD": ROAD,
    "ROADS": ROADS,
}

_WHY_NOT: Final = {
    OUTCOME_NOT_ELIGIBLE: "NOT_ELIGIBLE",
    OUTCOME_FORGOTTEN: "FORGOTTEN",
    OUTCOME_UNDONE: "UNDONE",
    OUTCOME_FOLLOWING: "FOLLOWING",
}

# How the lines begin.
LINES: Final = (
    "PEDAL",
    "SET_SPEED",
    "PLAN",
    "FASTER_BY_PEDALS",
    "SLOWER_BY_PEDALS",
    "FASTER_BY_LEVER",
    "SLOWER_BY_LEVER",
)
# Of one intervention, so that its line stays readable.
HOLDS_TOLD: Final = 10
# Transitions shorter than this are left out of the words: the bounds trim an edge here and there,
# and no two pedal presses begin at the same metre.
TRANSITION_MIN_M: Final = 10


def lines_of(outcomes: Outcomes, marks: Sequence[Mark] = ()) -> Iterator[str]:
    """Yield one line for people per intervention; ``marks`` of the route name its roads."""
    for pedal in outcomes.pedals:
        place = _place(marks, pedal.start_m, pedal.end_m)
        yield TEXTS["PEDAL"] % (pedal.number, *place) + pedal_words(outcomes, pedal)
    for series in outcomes.set_speeds:
        place = _place(marks, series.from_m, series.to_m)
        yield TEXTS["SET_SPEED"] % place + set_speed_words(outcomes, series)
    told = _first(told_holds(outcomes.plan_holds))
    if told:
        yield TEXTS["PLAN"] + TEXTS["SEPARATOR"].join(told)
    for changed in outcomes.places:
        if changed.to_m - changed.from_m >= TRANSITION_MIN_M:
            place = _place(marks, changed.from_m, changed.to_m)
            yield TEXTS[_test_of(changed)] % place + place_words(outcomes, changed)


def _test_of(place: Place) -> str:
    """Return the name of the text that says whose evidence it is."""
    return f"{'FASTER' if place.sign > 0 else 'SLOWER'}_BY_{EVIDENCE_BY.items[place.by]}"


def place_words(outcomes: Outcomes, place: Place) -> str:
    """Return what became of the evidence of a place."""
    told = TEXTS[f"EVIDENCE_{EVIDENCE_CHANGE.items[place.change]}"]
    if place.change in (EVIDENCE_GAINED, EVIDENCE_LOST):
        return told % (tenths(place.evidence), tenths(outcomes.accept))
    return told


def _place(marks: Sequence[Mark], from_m: float, to_m: float) -> tuple[int, int, str]:
    return whole(from_m), whole(to_m), road_words(marks, from_m, to_m)


def pedal_words(outcomes: Outcomes, pedal: PedalOutcome) -> str:
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
        return told + TEXTS["STOP"] % whole(KMH_PER_MPS * outcomes.slowest_mps)
    if pedal.outcome == OUTCOME_PENDING:
        return told + TEXTS["PENDING"] % (tenths(pedal.proof), tenths(outcomes.accept))
    return told + TEXTS[_WHY_NOT.get(pedal.outcome, "NOT_MOVED")]


def set_speed_words(outcomes: Outcomes, series: SetSpeedOutcome) -> str:
    """Return what became of a series of presses, without its place."""
    offset = signed(KMH_PER_MPS * series.offset_mps)
    wish = signed(KMH_PER_MPS * series.wish_mps)
    if series.outcome == OUTCOME_TAKEN_BACK:
        return TEXTS["SET_TAKEN_BACK"]
    if series.outcome in _WHY_NOT:
        return TEXTS["SET_" + _WHY_NOT[series.outcome]] % wish
    if series.outcome == OUTCOME_PENDING:
        return TEXTS["SET_PENDING"] % (wish, tenths(series.proof), tenths(outcomes.accept))
    told = TEXTS["SET_CUT"] % (offset, wish) if series.is_cut else TEXTS["SET_LEARNED"] % offset
    if outcomes.set_speed_gain < 1.0:
        told += TEXTS["SET_SHARE"] % whole(100.0 * outcomes.set_speed_gain)
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
    starts = (TEXTS[name].partition("%")[0] for name in LINES)
    return text.startswith(tuple(starts))


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
