"""What a sentence of the cluster claims, read from its words, against what is so.

Nothing of the code that chooses sentences is used: the judge knows English, the road, what the
driver did in every drive so far, and the outputs that say what the car does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np
from pldf.kernel.arrays import FloatArray

KMH: Final = 1.0 / 3.6
MPH: Final = 0.44704
ROUNDED: Final = 1.0  # half a number is rounded away, and half of one is driven meanwhile
SURE: Final = 0.4  # a number that is off by less is right whatever is rounded
NEAR_MPS: Final = 3.0 * KMH  # a speed is driven within this
STEADY_MPS2: Final = 0.35  # below this a car neither speeds up nor slows down
AT_PLACE_M: Final = 3.0  # half the way of a step, and metres that are cells


class Past(NamedTuple):
    """What the driver did in one drive.

    Attributes:
        number: of the drive, from 1.
        faster: per node, whether a pedal intervention was faster here than what was followed.
        slower: the same, slower.
        taught: per node, whether the drive changed the learned speed.
    """

    number: int
    faster: FloatArray
    slower: FloatArray
    taught: FloatArray


class Moment(NamedTuple):
    """What is so at the end of a step."""

    s_m: float
    speed_mps: float
    acceleration_mps2: float
    request_mps2: float
    mode: str
    target_mps: float
    targets: tuple[float, float]  # lowest and highest of the last second: a sentence holds so long
    bases: tuple[float, float]  # the same of the base profile
    base_mps: float
    manual_mps: float  # set speed of the lever, 0 = none
    lead_m: float  # gap to a car ahead, 0 = none
    lead_mps: float
    limits: bool  # following.limits
    take_over: bool
    temporary_mps: float  # limit.override, 0 = none
    temporary_lately: bool  # there was one in the last two seconds
    paused: bool
    steady_mps2: float = STEADY_MPS2  # negative: what is nearly untrue counts as such


class Road(NamedTuple):
    """What does not change in a drive; one value per node or cell."""

    limit_mps: FloatArray
    curvature_per_m: FloatArray
    base_mps: FloatArray
    learned_mps: FloatArray
    offset_mps: FloatArray
    past: tuple[Past, ...]

    def here(self, values: FloatArray, s_m: float) -> FloatArray:
        """Return the values within a few metres."""
        first = max(int(s_m - AT_PLACE_M), 0)
        return values[first : int(s_m + AT_PLACE_M) + 2]

    def ahead(self, values: FloatArray, s_m: float, far_m: float) -> FloatArray:
        """Return the values from here to ``far_m`` further on."""
        return values[max(int(s_m - AT_PLACE_M), 0) : int(s_m + far_m) + 2]

    def next_limit(self, s_m: float) -> tuple[float, float, float]:
        """Return limits before and behind the next sign, and how far it is; it may be passed."""
        rest = self.limit_mps[max(int(s_m - AT_PLACE_M), 0) :]
        changes = np.flatnonzero(rest != rest[0]) if len(rest) else np.zeros(0, dtype=int)
        if len(changes) == 0:
            return 0.0, 0.0, np.inf
        return float(rest[0]), float(rest[changes[0]]), float(changes[0])


Lies = Iterator[str]
Claim = Callable[[re.Match[str], Moment, Road, float], Lies]


def lies(text: str, now: Moment, road: Road, unit_mps: float) -> list[str]:
    """Return what is wrong with ``text`` now; an unknown sentence is wrong, too."""
    for pattern, claim in CLAIMS:
        if found := pattern.fullmatch(text):
            return list(claim(found, now, road, unit_mps))
    return [f"unknown sentence {text!r}"]


def _number(found: re.Match[str], name: str, unit_mps: float) -> float:
    return float(found[name]) * unit_mps


def _near(told: float, so: float, unit_mps: float) -> bool:
    return abs(told - so) <= ROUNDED * unit_mps


def _within(told: float, between: tuple[float, float], unit_mps: float) -> bool:
    return between[0] - ROUNDED * unit_mps <= told <= between[1] + ROUNDED * unit_mps


def _aims_at(told: float, now: Moment, unit_mps: float) -> Lies:
    if now.steady_mps2 < 0.0 and abs(told - now.target_mps) > SURE * unit_mps:
        yield "it nearly aims at another speed"
    if not _within(told, now.targets, unit_mps):
        yield "it aims at another speed"


def _way_m(now: Moment) -> float:
    """Return how far off something may be that the car slows down for now, gently."""
    return now.speed_mps * 6.0 + now.speed_mps**2 / 1.2 + 20.0


def _limit_here(told: float, now: Moment, road: Road, unit_mps: float) -> Lies:
    here = set(road.here(road.limit_mps, now.s_m))
    if not any(_near(told, at, unit_mps) for at in here):
        yield "the limit here is another"
    if now.steady_mps2 < 0.0 and len(here) > 1:
        yield "a sign is just being passed"


def _at_limit(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "limit", unit_mps)
    yield from _active(now)
    yield from _keeps(now)
    yield from _limit_here(told, now, road, unit_mps)
    yield from _doubtful_aim(told, now, unit_mps)
    if now.speed_mps > told + NEAR_MPS and now.request_mps2 < -now.steady_mps2:
        yield "the car is still slowing down to the limit"
    if now.speed_mps < told - 2.0 * NEAR_MPS:
        yield "the car is far below the limit"
    # A car that is slower than it aims at may brake for no reason that can be named.
    if now.request_mps2 < -2.0 * now.steady_mps2 and now.speed_mps > now.target_mps:
        yield "it brakes"


def _keeps(now: Moment) -> Lies:
    """Of a sentence that says the car keeps a speed: it has not begun to slow down."""
    if now.steady_mps2 < 0.0 and now.request_mps2 < now.steady_mps2:
        yield "it begins to slow down"


def _active(now: Moment) -> Lies:
    if now.mode != "ACTIVE":
        yield f"the mode is {now.mode}"


def _free(now: Moment) -> Lies:
    if now.limits:
        yield "the car ahead limits"


def _curve(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "speed", unit_mps)
    yield from _active(now)
    yield from _free(now)
    curvature = np.maximum(road.ahead(road.curvature_per_m, now.s_m, _way_m(now)), 1e-9)
    caps = np.sqrt(4.0 / curvature)  # of learned speeds; planned ones are lower
    offset = max(float(road.here(road.offset_mps, now.s_m).max()), 0.0)
    wanted = max(now.manual_mps, float(road.here(road.limit_mps, now.s_m).max()) + offset)
    if np.sqrt(2.5 / curvature).min() > wanted:
        yield "no curve is near that asks for less than the set speed"
    if told > caps.max() + ROUNDED * unit_mps:
        yield "no curve is near that asks for this"
    if now.request_mps2 > 2.0 * now.steady_mps2:
        yield "it speeds up"


def _limit_ahead(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "limit", unit_mps)
    yield from _active(now)
    yield from _free(now)
    before, following, way_m = road.next_limit(now.s_m)
    if not _near(told, following, unit_mps):
        yield "the next limit is another"
    if following >= before:
        yield "the next limit is not lower"
    if way_m > _way_m(now):
        yield "the sign is far away"
    if now.steady_mps2 < 0.0 and way_m < 3.0 * AT_PLACE_M:
        yield "the sign is passed"
    if now.request_mps2 > now.steady_mps2:
        yield "it speeds up"


def _learned(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told, base = _number(found, "speed", unit_mps), _number(found, "base", unit_mps)
    faster = found["word"] == "faster"
    yield from _active(now)
    yield from _free(now)
    if (told > base) != faster:
        yield "the numbers say something else than the words"
    if faster and now.target_mps < now.base_mps - 0.05:
        yield "the request is below the base profile's"
    # Slower than what was set by the lever may still be faster than the base profile.
    own = max(now.manual_mps, float((road.limit_mps + road.offset_mps)[int(now.s_m)]))
    if not faster and now.target_mps > max(now.base_mps, own) + 0.05:
        yield "the request is above the base profile's"
    yield from _aims_at(told, now, unit_mps)
    low, high = now.bases
    if not _within(base, (low, max(high, own)), unit_mps):
        yield "without the lesson it would be another"
    delta = road.here(road.learned_mps - road.base_mps, now.s_m)
    if not np.any(delta > 0.0 if faster else delta < 0.0):
        yield "nothing is learned here"
    drive = int(found["drive"] or 0)
    past = [one for one in road.past if one.number == drive]
    if not drive:
        return
    if not past:
        yield "there was no such drive"
    elif not road.here(past[0].taught, now.s_m).any():
        yield "that drive taught nothing here"


def _offset(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told, limit = _number(found, "speed", unit_mps), _number(found, "limit", unit_mps)
    yield from _active(now)
    yield from _free(now)
    yield from _limit_here(limit, now, road, unit_mps)
    offsets = road.here(road.offset_mps, now.s_m)
    if not offsets.any():
        yield "no offset is learned here"
    if not any(_near(told, limit + offset, 2.0 * unit_mps) for offset in offsets):
        yield "limit and offset give another speed"
    if abs(now.speed_mps - told) > 2.0 * NEAR_MPS:
        yield "the car drives another speed"


def _by_hand(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "speed", unit_mps)
    yield from _active(now)
    yield from _free(now)
    if now.manual_mps <= 0.0:
        yield "nothing is set by hand"
    elif not _near(told, now.manual_mps, unit_mps):
        yield "another speed was set"
    yield from _aims_at(told, now, unit_mps)


def _lateral(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "speed", unit_mps)
    yield from _active(now)
    yield from _keeps(now)
    yield from _free(now)
    curvature = np.maximum(road.ahead(road.curvature_per_m, now.s_m, 10.0), 1e-9)
    if not np.any(np.abs(np.sqrt(4.0 / curvature) - told) <= 2.0 * ROUNDED * unit_mps):
        yield "the lateral acceleration allows another speed"


def _legal(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told, limit = _number(found, "speed", unit_mps), _number(found, "limit", unit_mps)
    yield from _active(now)
    yield from _keeps(now)
    yield from _free(now)
    yield from _limit_here(limit, now, road, unit_mps)
    if not _near(told, limit + 20.0 * KMH, 2.0 * unit_mps):
        yield "limit and tolerance give another speed"


def _mode(mode: str) -> Claim:
    def claim(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
        if now.mode != mode:
            yield f"the mode is {now.mode}"

    return claim


def _following(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    yield from _active(now)
    if now.lead_m <= 0.0 and not now.limits:
        yield "there is no car ahead"
    if not now.limits:
        yield "the car ahead limits nothing"


def _waits(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    yield from _active(now)
    if now.speed_mps > 1.0:
        yield "the car drives"


def _held(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    yield from _active(now)
    if now.lead_m <= 0.0:
        yield "there is no car ahead"
    if now.speed_mps > 1.0:
        yield "the car drives"


def _doubtful_aim(told: float, now: Moment, unit_mps: float) -> Lies:
    """Of what is asked to stay, the number has to be that of now, not of a plateau ahead."""
    if now.steady_mps2 < 0.0 and not _near(told, now.target_mps, unit_mps):
        yield "it may aim at another speed by now"


def _slowing(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "speed", unit_mps)
    yield from _active(now)
    yield from _free(now)
    if now.request_mps2 > now.steady_mps2:
        yield "it speeds up"
    if now.speed_mps < told - (NEAR_MPS if now.steady_mps2 > 0.0 else 0.0):
        yield "the car is slower than that"
    yield from _doubtful_aim(told, now, unit_mps)


def _speeding(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "speed", unit_mps)
    yield from _active(now)
    yield from _free(now)
    if now.request_mps2 < -now.steady_mps2:
        yield "it slows down"
    if now.speed_mps > told + NEAR_MPS:
        yield "the car is faster than that"
    yield from _doubtful_aim(told, now, unit_mps)


def _temporary(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "limit", unit_mps)
    yield from _active(now)
    yield from _free(now)
    if not _near(told, now.temporary_mps, unit_mps):
        yield "the temporary limit is another"
    yield from _doubtful_aim(told, now, unit_mps)
    if now.speed_mps < told - 2.0 * NEAR_MPS and now.request_mps2 < now.steady_mps2:
        yield "something else is slower"


def _new_limit(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    told = _number(found, "limit", unit_mps)
    if _near(told, now.temporary_mps, unit_mps):
        return
    yield from _limit_here(told, now, road, unit_mps)
    behind = road.limit_mps[max(int(now.s_m - 2.3 * max(now.speed_mps, 10.0)), 0) :]
    same = np.all(behind[: int(2.5 * max(now.speed_mps, 10.0))] == behind[:1])
    if same and not now.temporary_lately:
        yield "no sign was passed"


def _forgotten(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    # Where a lever's offset is learned nearby, the plan itself is another than the base.
    offsets = road.offset_mps[max(int(now.s_m - 500.0), 0) : int(now.s_m + 500.0)]
    # The press was here, or up to two seconds ago.
    pressed = slice(max(int(now.s_m - 2.0 * now.speed_mps - AT_PLACE_M), 0), int(now.s_m) + 2)
    here = (road.learned_mps - road.base_mps)[pressed]
    if np.all(np.abs(here) > 1.5 * KMH) and not offsets.any():
        yield "something is learned here"


def _paused(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    if not now.paused:
        yield "there is no pause"


def _resumed(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    if now.paused:
        yield "there is a pause"


def _take_over(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    if not now.take_over:
        yield "nothing asks the driver to brake"


def _believed(found: re.Match[str], now: Moment, road: Road, unit_mps: float) -> Lies:
    return iter(())


_FORMS: Final[tuple[tuple[str, Claim], ...]] = (
    (r"", _believed),
    (r"Speed limit (?P<limit>\d+)", _at_limit),
    (r"(?P<speed>\d+) for the curve", _curve),
    (r"(?P<speed>\d+): limit (?P<limit>\d+) ahead", _limit_ahead),
    (
        r"(?P<speed>\d+) instead of (?P<base>\d+): "
        r"you drove (?P<word>faster|slower) here(?: in drive (?P<drive>\d+))?",
        _learned,
    ),
    (r"(?P<speed>\d+) at limit (?P<limit>\d+): your learned set speed", _offset),
    (r"(?P<speed>\d+): set by you", _by_hand),
    (r"You drive: gas pedal", _mode("GAS_OVERRIDE")),
    (r"(?P<speed>\d+) is the most in this curve", _lateral),
    (r"(?P<speed>\d+) is the most at limit (?P<limit>\d+)", _legal),
    (r"You drive; RESUME hands over", _mode("STANDBY")),
    (r"Switched off", _mode("OFF")),
    (r"Fault: please drive yourself", _mode("FAULT")),
    (r"Following the car ahead", _following),
    (r"Waiting behind the car ahead", _held),
    (r"RESUME or gas to drive on", _waits),
    (r"Slowing down to (?P<speed>\d+)", _slowing),
    (r"Speeding up to (?P<speed>\d+)", _speeding),
    (r"Temporary limit (?P<limit>\d+)", _temporary),
    (r"New speed limit: (?P<limit>\d+)", _new_limit),
    (r"Forgotten what was learned here|Nothing to forget here", _forgotten),
    (r"The last lesson is undone|Nothing to undo|Learned from this drive", _believed),
    (r"Paused: nothing is learned", _paused),
    (r"The pause is over", _resumed),
    (r"Brake now!", _take_over),
)
CLAIMS: Final = tuple((re.compile(form), claim) for form, claim in _FORMS)
