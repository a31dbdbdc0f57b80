"""What slips of the foot teach, learned faithfully and only where consistent.

    python studies/consistent_learning.py --out out/consistent

The paper study's simulated people drive again and again and learn after every drive, once with
``learn`` = FAITHFUL, once with CONSISTENT. Besides what they wish, they press a pedal by accident:
per pass, in a share of the places. An accident is put into the recorded drive before it is learned
from: it changes what is taught, and through that the next drives. Writes ``consistent.csv`` (per
drive) and ``consistent.png``.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from pldf.files.tables import write_table
from pldf.kernel.codes import LEARN, LEARN_CONSISTENT, LEARN_FAITHFUL
from pldf.kernel.units import MPS_PER_KMH
from pldf.profiles.store import Iteration, StoredProfile
from pldf.recordings.interventions import Rates
from pldf.report import palette, paper
from pldf.report.scene import Axis, Line, Panel, Scene, Stroke
from pldf.roads import open_road
from pldf.study.loop import ModelArrays
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES
from pldf.study.population import read_distribution, sample_participants
from pldf.study.simulation import Packed, Simulation

SHARES: Final = (0.0, 0.02, 0.05)
# Places of the road, each long enough for one press with its stretched piece and its fades.
PLACE_M: Final = 250
PRESSED_M: Final = 110.0  # where in its place the press begins
HELD_S: Final = 2.5
# By gas as hard as the function itself accelerates at most, by brake as it plans: slips, no panic.
ACCELERATION_MPS2: Final = {1: 2.0, -1: -1.0}
RETURN_MPS2: Final = 1.0
TAUGHT_MPS: Final = 1.0 * MPS_PER_KMH  # a place that changed by less was not taught

COLOURS: Final = {"FAITHFUL": palette.VERMILLION, "CONSISTENT": palette.BLUE}
DASHES: Final = ("solid", "dash", "dot")  # per share

Row = dict[str, float | str]


@dataclass
class Run:
    """What one person taught in all drives, per drive and place.

    Attributes:
        rates: by pedal, by set speed and by either, per drive.
        accident: places pressed by accident, with the sign.
        wrong: places whose profile an accident changed.
        wished: places in which the driver intervened.
        taught: places that the driver's own interventions changed.
        known: places that a lesson or a pending demonstration reaches, stretched as it is.
    """

    rates: list[Rates] = field(default_factory=list)
    accident: list[NDArray[np.int64]] = field(default_factory=list)
    wrong: list[NDArray[np.bool_]] = field(default_factory=list)
    wished: list[NDArray[np.bool_]] = field(default_factory=list)
    taught: list[NDArray[np.bool_]] = field(default_factory=list)
    known: list[NDArray[np.bool_]] = field(default_factory=list)


class Slipping(Simulation):
    """A simulation whose drivers press pedals by accident, in a share of the places per pass."""

    share = 0.0
    chance = np.random.default_rng(0)
    run = Run()

    def _learn(self, st: Packed, arrays: ModelArrays, stored: StoredProfile) -> Iteration:
        """Put the accidents into the trace, learn, and note what became of each place."""
        own = pieces(st, arrays)
        places = self.nodes // PLACE_M
        slips = np.where(self.chance.random(places) < self.share, 1, 0)
        slips *= self.chance.choice((1, -1), places)
        pressed = [slip_at(arrays, k, int(sign)) for k, sign in enumerate(slips) if sign]
        free = [slip for slip in pressed if not _touches(slip, own)]
        for slip in free:
            press(arrays, *slip)
        everything = sorted([(*piece, False) for piece in own] + [(*s[:2], True) for s in free])
        trace = arrays.trace
        barred = np.asarray(trace.barred)
        kept = {start: barred[k] for k, (start, _) in enumerate(own)}
        for k, (start_m, end_m, _) in enumerate(everything):
            trace.start_m[k], trace.end_m[k] = start_m, end_m
            barred[k] = kept.get(start_m, 0.0)
        st["drive_interventions"] = len(everything)
        iteration = super()._learn(st, arrays, stored)
        self._note(arrays, iteration, everything, slips)
        return iteration

    def _note(
        self,
        arrays: ModelArrays,
        iteration: Iteration,
        pressed: Sequence[tuple[float, float, bool]],
        slips: NDArray[np.int64],
    ) -> None:
        change = np.abs(iteration.learned_mps - np.asarray(arrays.profile.learned_mps))
        mine = (iteration.drive == iteration.number) & (change > TAUGHT_MPS)
        by_slip = np.array([False, *(slip for *_, slip in pressed)])[
            np.where(mine, iteration.intervention, 0).astype(int)
        ]
        by_pedal = mine & (iteration.intervention > 0)
        wished = np.zeros(self.nodes, dtype=bool)
        for start_m, end_m, slip in pressed:
            wished[int(start_m) : int(end_m) + 1] |= not slip
        run = self.run
        run.accident.append(slips)
        run.wrong.append(_in_places(by_slip, 0.1))
        run.wished.append(_in_places(wished, 0.2))
        waiting = iteration.pending_faster + iteration.pending_slower
        run.known.append(_in_places(iteration.lessons + waiting > 0.0, 1.0 / PLACE_M))
        run.taught.append(_in_places(by_pedal & ~by_slip, 0.2))


def _in_places(nodes: NDArray[np.bool_], share: float) -> NDArray[np.bool_]:
    """Tell in which places at least this share of the metres is true."""
    places = len(nodes) // PLACE_M
    whole: NDArray[np.bool_] = nodes[: places * PLACE_M].reshape(places, PLACE_M).mean(1) >= share
    return whole


def pieces(st: Packed, arrays: ModelArrays) -> list[tuple[float, float]]:
    """Return where the driver intervened by pedal."""
    trace = arrays.trace
    count = int(st["drive_interventions"][0])
    return [(float(trace.start_m[k]), float(trace.end_m[k])) for k in range(count)]


def slip_at(arrays: ModelArrays, place: int, sign: int) -> tuple[float, float, int]:
    """Return where an accidental press in this place begins and ends, and its sign."""
    start_m = place * PLACE_M + PRESSED_M
    speed = float(np.asarray(arrays.trace.speed_mps)[int(start_m)])
    return start_m, start_m + (speed + 0.5 * ACCELERATION_MPS2[sign] * HELD_S) * HELD_S, sign


def _touches(slip: tuple[float, float, int], own: list[tuple[float, float]]) -> bool:
    """Tell whether the driver's feet were at work there anyway."""
    return any(slip[0] - PLACE_M / 2 < end and start < slip[1] + PLACE_M / 2 for start, end in own)


def press(arrays: ModelArrays, start_m: float, end_m: float, sign: int) -> None:
    """Put an accidental press into the recorded speed, and the way back to what was driven."""
    speed = np.asarray(arrays.trace.speed_mps)
    first, last = int(start_m) + 1, int(end_m)
    at_first = speed[first]
    strength = ACCELERATION_MPS2[sign]
    pressed = np.sqrt(at_first**2 + 2.0 * strength * np.arange(last - first + 1.0))
    np.asarray(arrays.trace.active)[first : last + 1] = 0.0
    off = pressed[-1] - speed[last]
    speed[first : last + 1] = pressed
    for i in range(last + 1, len(speed)):
        off -= sign * RETURN_MPS2 / max(speed[i], 1.0)
        if sign * off <= 0.0:
            return
        speed[i] += off


def drive_all(simulation: Slipping, person: Participant, drives: int, share: float) -> Run:
    """Let one person drive again and again; every drive is learned from."""
    simulation.share, simulation.run = share, Run()
    simulation.chance = np.random.default_rng([person.seed, round(1000 * share)])
    stored = simulation.stored_for(person)
    driver = simulation.person(person)
    for number in range(drives):
        result = simulation.drive_once(driver, PHASES["B1"], number, stored)
        simulation.run.rates.append(result.row.rates)
        assert result.iteration is not None  # B1 is learned from
        stored = stored.with_iteration(result.iteration)
    return simulation.run


def summaries(runs: Sequence[Run], twins: Sequence[Run], learn: int, share: float) -> Iterator[Row]:
    """Yield one row per drive: what had been taught until then, and the rates.

    ``twins`` are the same people without accidents: where nothing that these do by pedal reaches,
    they are content, and an accident is all that can be learned there.
    """
    passes = [wait for run in runs for wait in waits(run)]
    content = np.array([~np.any(twin.known, axis=0) for twin in twins])
    for drive in range(len(runs[0].rates)):
        wrong = np.array([np.any(run.wrong[: drive + 1], axis=0) for run in runs])
        pressed = np.array([np.any(run.accident[: drive + 1], axis=0) for run in runs])
        pedal, set_speed, combined = 100.0 * np.mean([run.rates[drive] for run in runs], axis=0)
        yield {
            "learn": LEARN.items[learn],
            "accidents_percent": 100.0 * share,
            "drive": drive + 1,
            "people": len(runs),
            "pressed_percent": 100.0 * float(pressed.mean()),
            "wrong_percent": 100.0 * float(wrong.mean()),
            "content_percent": 100.0 * float(content.mean()),
            "wrong_content_percent": 100.0 * float(wrong[content].mean()),
            "passes_to_learn": float(np.mean(passes)),
            "pedal_percent": float(pedal),
            "set_speed_percent": float(set_speed),
            "combined_percent": float(combined),
        }


def waits(run: Run) -> Iterator[int]:
    """Yield, per place that was learned, the passes from the first own intervention to that."""
    wished, taught = np.array(run.wished), np.array(run.taught)
    for place in range(wished.shape[1]):
        if wished[:, place].any() and taught[:, place].any():
            first = int(np.argmax(wished[:, place]))
            learned = np.flatnonzero(taught[first:, place])
            if len(learned):
                yield int(learned[0]) + 1


def one_way(task: tuple[int, Sequence[Participant], int]) -> list[Row]:
    """Drive all people with one way of learning and each share of accidents, none first."""
    learn, people, drives = task
    settings = StudySettings(road=open_road("study"), phases=(), function={"learn": learn})
    simulation = Slipping(settings)
    rows: list[Row] = []
    twins: list[Run] = []
    for share in SHARES:
        runs = [drive_all(simulation, person, drives, share) for person in people]
        twins = twins or runs
        rows += summaries(runs, twins, learn, share)
    return rows


def figure(rows: Sequence[Row]) -> Scene:
    """Return wrongly learned places and rates over drives."""
    measures = {
        "wrong_content_percent": Axis("Places taught", note="by accident (%)", low=0.0),
        "combined_percent": Axis("Pedals or set speed", note="(% of the time)", low=0.0),
        "pedal_percent": Axis("Pedals", note="(% of the time)", low=0.0),
        "set_speed_percent": Axis("Set speed", note="(% of the time)", low=0.0),
    }
    panels = [
        Panel(tuple(_lines(rows, name)), Axis("Drive"), axis, 2.2)
        for name, axis in measures.items()
    ]
    return Scene(tuple(panels), columns=2, width_in=9.0)


def _lines(rows: Sequence[Row], name: str) -> Iterator[Line]:
    for learn, share in product(COLOURS, SHARES):
        mine = [r for r in rows if r["learn"] == learn and r["accidents_percent"] == 100.0 * share]
        yield Line(
            np.array([float(row["drive"]) for row in mine]),
            np.array([float(row[name]) for row in mine]),
            Stroke(COLOURS[learn], 1.8, DASHES[SHARES.index(share)]),
            f"{learn}, {100.0 * share:g} % accidents",
        )


def main() -> int:
    """Drive, print, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    fitted = Path(__file__).with_name("population_constant_wish.toml")
    parser.add_argument("--out", type=Path, default=Path("out/consistent"))
    parser.add_argument("--people", type=int, default=43)
    parser.add_argument("--drives", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1, help="draws the people; 1 as in the studies")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    options = parser.parse_args()
    distribution = read_distribution(tomllib.loads(fitted.read_text())["distribution"])
    people = sample_participants(options.people, options.seed, distribution)
    tasks = [(learn, people, options.drives) for learn in (LEARN_FAITHFUL, LEARN_CONSISTENT)]
    rows: list[Row] = []
    with ProcessPoolExecutor(options.jobs) as pool:
        for done in pool.map(one_way, tasks):
            rows += done
            for row in done[options.drives - 1 :: options.drives]:
                print(", ".join(f"{name} {_shown(v)}" for name, v in row.items()), flush=True)
    options.out.mkdir(parents=True, exist_ok=True)
    table = {name: [_shown(row[name]) for row in rows] for name in rows[0]}
    write_table(options.out / "consistent.csv", table)
    paper.save(options.out / "consistent.png", figure(rows))
    return 0


def _shown(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


if __name__ == "__main__":
    sys.exit(main())
