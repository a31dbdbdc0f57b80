"""How many drives does it take to get rid of a wrong lesson by pedals alone?

    python studies/undo.py --out out/undo.csv
    python studies/undo.py --sample 200          # mistakes and thresholds drawn by chance

A driver content with the base profile once teaches something by mistake: a slip on the gas, a
brake that was meant for somebody else, a stop. From then on this driver corrects, by pedals, what
deviates by more than a threshold, and learning goes on after every drive. Counted are the drives
until one needs no intervention. Averaging with what is driven halves an error per drive, so from a
deviation d it cannot take fewer than log2(d / threshold) corrections. The goal is at most
one more, in 90 % of a drawn sample. (By the button it is at once: section 7.)
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import ceil, log2
from pathlib import Path
from typing import Final

import numpy as np
from pldf.files.tables import write_table
from pldf.kernel.units import KMH_PER_MPS, MPS_PER_KMH
from pldf.profiles.store import StoredProfile
from pldf.roads import Road, Route
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES
from pldf.study.simulation import Simulation

from vehicle_models.driver_script import Event, script_arrays
from vehicle_models.script_kernel import AT_POSITION, AT_TIME, BRAKE, GAS, RESUME

LIMIT_MPS: Final = 80.0 * MPS_PER_KMH
LENGTH_M: Final = 3000.0
MISTAKE_M: Final = 1000.0
THRESHOLDS_KMH: Final = (1.5, 3.0, 5.0)
# Name, control, pedal travel, seconds.
MISTAKES: Final = (
    ("gas 2.5 s", GAS, 0.5, 2.5),
    ("gas 6 s", GAS, 0.5, 6.0),
    ("brake 2 s", BRAKE, 0.15, 2.0),
    ("brake 4 s", BRAKE, 0.15, 4.0),
    ("stop", BRAKE, 0.4, 12.0),
)
DRIVES_MAX: Final = 12
SEED: Final = 1


@dataclass(frozen=True)
class Undoing:
    """What one driver made of one mistake.

    Attributes:
        mistake: what the driver did by mistake.
        threshold_kmh: smallest deviation that the driver corrects.
        taught_kmh: largest deviation from the base profile that the mistake taught.
        drives: drives with interventions until one had none; -1: none of ``DRIVES_MAX`` had.
        left_kmh: largest deviation then.
    """

    mistake: str
    threshold_kmh: float
    taught_kmh: float
    drives: int
    left_kmh: float

    @property
    def halvings(self) -> int:
        """Corrections that halving alone would take."""
        if self.taught_kmh <= self.threshold_kmh:
            return 0
        return ceil(log2(self.taught_kmh / self.threshold_kmh))

    @property
    def is_fast(self) -> bool:
        """Tell whether it took at most one drive more than halving needs."""
        return 0 <= self.drives <= self.halvings + 1


def straight_road() -> Road:
    """Return a straight level road under one limit."""
    s_m = np.array([0.0, LENGTH_M])
    level = np.zeros(2)
    route = Route("straight", s_m, level, level + LIMIT_MPS, level, s_m, level)
    return Road(route, None, Path("straight"), as_it_is=False)


def driver_with(threshold_kmh: float) -> Participant:
    """Return a driver who wishes what the base profile does, and uses pedals only.

    The pedal is let go as soon as the wish is reached: an overshoot would undo more at once.
    """
    values = {
        "wish_offset_mps": 0.0,
        "wish_accel_max_mps2": 1.2,
        "wish_accel_min_mps2": -1.0,
        "wish_anticipation_s": 0.0,
        "driver_threshold_mps": threshold_kmh * MPS_PER_KMH,
        "driver_overshoot": 0.0,
        "driver_uses_lever": 0.0,
    }
    return Participant("P001", 1, values)


Mistake = tuple[str, int, float, float]


def drawn_mistakes(count: int) -> Iterator[tuple[Mistake, float]]:
    """Yield mistakes by gas or brake, in equal shares, with a driver's threshold in km/h."""
    random = np.random.default_rng(SEED)
    for _ in range(count):
        threshold_kmh = random.uniform(THRESHOLDS_KMH[0], THRESHOLDS_KMH[-1])
        if random.random() < 0.5:
            travel, held_s = random.uniform(0.2, 0.8), random.uniform(1.5, 8.0)
            yield (f"gas {travel:.2f}, {held_s:.1f} s", GAS, travel, held_s), threshold_kmh
        else:
            travel, held_s = random.uniform(0.08, 0.3), random.uniform(1.0, 5.0)
            yield (f"brake {travel:.2f}, {held_s:.1f} s", BRAKE, travel, held_s), threshold_kmh


def mistakes(
    simulation: Simulation, made: Iterable[Mistake] = MISTAKES
) -> Iterator[tuple[str, StoredProfile]]:
    """Yield each mistake's name and what is stored after the drive in which it happened."""
    nobody = driver_with(0.0)
    for name, control, travel, held_s in made:
        events = [Event(1.0, AT_TIME, RESUME, 1.0, 0.3)]
        events.append(Event(MISTAKE_M, AT_POSITION, control, travel, held_s))
        if control == BRAKE:
            # MISTAKE_M is reached after 45 s; while the brake is pressed, RESUME does nothing.
            events += [Event(46.0 + k, AT_TIME, RESUME, 1.0, 0.3) for k in range(0, 40, 2)]
        person = simulation.person(nobody)._replace(script=script_arrays(events))
        stored = simulation.stored_for(nobody)
        result = simulation.drive_once(person, PHASES["A2"], 0, stored)
        assert result.iteration is not None  # A2 is learned from
        yield name, stored.with_iteration(result.iteration)


def undo(simulation: Simulation, stored: StoredProfile, threshold_kmh: float, name: str) -> Undoing:
    """Let a driver with this threshold drive on until nothing has to be corrected."""
    participant = driver_with(threshold_kmh)
    person = simulation.person(participant)
    taught = deviation_kmh(stored)
    for drive in range(DRIVES_MAX + 1):
        result = simulation.drive_once(person, PHASES["B1"], drive + 1, stored)
        if result.row.interventions == 0:
            return Undoing(name, threshold_kmh, taught, drive, deviation_kmh(stored))
        assert result.iteration is not None  # B1 is learned from
        stored = stored.with_iteration(result.iteration)
    return Undoing(name, threshold_kmh, taught, -1, deviation_kmh(stored))


def deviation_kmh(stored: StoredProfile) -> float:
    """Return how far the newest profile deviates from the base profile, in km/h."""
    newest = stored.iteration()
    return float(KMH_PER_MPS * np.abs(newest.learned_mps - stored.base_mps).max())


def table(simulation: Simulation) -> Iterator[Undoing]:
    """Yield what each driver makes of each of the mistakes."""
    for name, stored in mistakes(simulation):
        for threshold_kmh in THRESHOLDS_KMH:
            yield undo(simulation, stored, threshold_kmh, name)


def sampled(simulation: Simulation, count: int) -> Iterator[Undoing]:
    """Yield what drawn drivers make of drawn mistakes, as far as these teach anything."""
    for mistake, threshold_kmh in drawn_mistakes(count):
        ((name, stored),) = mistakes(simulation, [mistake])
        if deviation_kmh(stored) > 0.0:
            yield undo(simulation, stored, threshold_kmh, name)


def main() -> int:
    """Drive, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/undo.csv"))
    parser.add_argument("--sample", type=int, metavar="N", help="N drawn mistakes instead")
    options = parser.parse_args()
    simulation = Simulation(StudySettings(road=straight_road(), phases=()))
    rows = []
    for row in sampled(simulation, options.sample) if options.sample else table(simulation):
        rows.append(row)
        ended = f"{row.drives:2d}" if row.drives >= 0 else f"more than {DRIVES_MAX}"
        print(
            f"{row.mistake:16s} taught {row.taught_kmh:5.1f} km/h, threshold "
            f"{row.threshold_kmh:.1f} km/h: {ended} drives (halving: {row.halvings}), "
            f"{row.left_kmh:.1f} km/h left{'' if row.is_fast else '  SLOW'}",
            flush=True,
        )
    print(f"{sum(row.is_fast for row in rows)} of {len(rows)} within one drive of halving")
    options.out.parent.mkdir(parents=True, exist_ok=True)
    columns = {name: [getattr(row, name) for row in rows] for name in Undoing.__annotations__}
    write_table(options.out, {**columns, "halvings": [row.halvings for row in rows]})
    return 0


if __name__ == "__main__":
    sys.exit(main())
