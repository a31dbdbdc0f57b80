"""How much of the fall from A to B could the order of the drives make, which was the same for all?

    python studies/order.py --out out/order          # order.csv, order.png and a table

In the paper everybody drove A before B, which its authors name as a limitation. Here drivers get
used to the system: with each drive, whichever it is, the deviation that they bear (their threshold)
grows by a share. Each share is driven by the same people in three ways:

- fixed: A before B, as in the paper;
- counterbalanced: every second person drives B before A, but for A2, from which B learns;
- nothing learned: the fixed order, with the base function in the drives of B, too. What falls then
  is made by the order alone.

A share of 0 is nobody getting used to anything. Which shares real people have is not known: these
were chosen before anything was driven, to span none to a threshold of 1.6 times in six drives.
"""

from __future__ import annotations

import argparse
import os
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from pldf.analysis.statistics import MeanInterval, mean_interval
from pldf.files.tables import write_table
from pldf.kernel.arrays import FloatArray
from pldf.report import paper
from pldf.report.palette import BLUE, GREEN, VERMILLION
from pldf.report.scene import Axis, Band, Dash, Fill, Line, Panel, Scene, Stroke
from pldf.roads import open_road
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES, Phase
from pldf.study.population import read_distribution, sample_participants
from pldf.study.runner import in_processes, rows_in_order
from pldf.study.unit import Job

SHARES: Final = (0.0, 0.02, 0.05, 0.10)
MEASURES: Final = {"pedal": "Pedals", "set_speed": "Set speed", "combined": "Pedals or set speed"}
SYSTEMS: Final = {"A": ("A1", "A2"), "B": ("B1", "B2")}
PEOPLE: Final = 20 * 43
SEED: Final = 1
FIXED, COUNTERBALANCED, NOTHING = "fixed", "counterbalanced", "nothing learned"
DRAWN: Final[Mapping[str, tuple[str, Dash]]] = {
    FIXED: (BLUE, "solid"),
    COUNTERBALANCED: (GREEN, "dash"),
    NOTHING: (VERMILLION, "dot"),
}


class Effect(NamedTuple):
    """What one measure does from A to B: percent of the driving time, and its fall in points."""

    share: float
    way: str
    measure: str
    a: float
    b: float
    fall: MeanInterval


def settings_of(way: str, share: float) -> StudySettings:
    """Return how the study is driven in this way."""
    phases = tuple(PHASES.values())
    if way == NOTHING:
        phases = tuple(map(_with_base_function, phases))
    return StudySettings(
        road=open_road("study"),
        phases=phases,
        counterbalanced=way == COUNTERBALANCED,
        threshold_growth_per_drive=share,
    )


def _with_base_function(phase: Phase) -> Phase:
    return phase._replace(apply_learned=False, learn=False)


def drive(way: str, share: float, people: Sequence[Participant], jobs: int) -> FloatArray:
    """Return rates[person, system, measure] in percent, means of the drives with interventions."""
    results = in_processes(jobs)(Job(settings_of(way, share)), list(people))
    rates = []
    for rows in rows_in_order(results, people):
        by_phase = {row.phase: row.rates for row in rows}
        rates.append([np.mean([by_phase[n] for n in names], axis=0) for names in SYSTEMS.values()])
    return 100.0 * np.array(rates)


def effects(way: str, share: float, rates: FloatArray) -> Iterator[Effect]:
    """Yield what each measure does, with the 95 % confidence interval of the mean fall."""
    for k, measure in enumerate(MEASURES):
        a, b = rates[:, 0, k], rates[:, 1, k]
        yield Effect(share, way, measure, float(a.mean()), float(b.mean()), mean_interval(a - b))


def table(found: Sequence[Effect]) -> str:
    """Return the falls as Markdown, and which part of the paper's way the order makes."""
    by_key = {(e.share, e.way, e.measure): e for e in found}
    lines = [
        "| rate | growth of the threshold per drive | fall, A first | fall, counterbalanced "
        "| fall, nothing learned | of it by the order |",
        "|---|---|---|---|---|---|",
    ]
    for measure, name in MEASURES.items():
        for share in SHARES:
            falls = [by_key[share, way, measure].fall for way in DRAWN]
            part = 100.0 * falls[2].value / falls[0].value
            lines.append(
                f"| {name.lower()} | {100.0 * share:g} % | "
                + " | ".join(f"{f.value:.2f} [{f.low:.2f}, {f.high:.2f}]" for f in falls)
                + f" | {part:.1f} % |"
            )
    return "\n".join(lines)


def figure(found: Sequence[Effect]) -> Scene:
    """Return the falls over the growth of the threshold, a panel for each rate."""
    across = Axis("Growth of the threshold per drive", "%")
    return Scene(
        tuple(
            Panel(
                tuple(_drawn([e for e in found if e.measure == measure])),
                across,
                Axis(name, note="fall from A to B (points)"),
                2.2,
            )
            for measure, name in MEASURES.items()
        ),
        columns=3,
        width_in=10.0,
    )


def _drawn(found: Sequence[Effect]) -> Iterator[Line | Band]:
    for way, (colour, dash) in DRAWN.items():
        mine = [effect for effect in found if effect.way == way]
        shares = 100.0 * np.array([effect.share for effect in mine])
        low, fall, high = np.array([(e.fall.low, e.fall.value, e.fall.high) for e in mine]).T
        yield Band(shares, low, high, Fill(colour, 0.15), "95 % confidence", listed=way == FIXED)
        yield Line(shares, fall, Stroke(colour, 1.8, dash, "circle", 4.0), way.capitalize())


def write(found: Sequence[Effect], folder: Path) -> None:
    """Write ``order.csv`` and ``order.png``."""
    folder.mkdir(parents=True, exist_ok=True)
    write_table(
        folder / "order.csv",
        {
            "threshold_growth_per_drive": [f"{e.share:g}" for e in found],
            "way": [e.way for e in found],
            "measure": [e.measure for e in found],
            "a_percent": [f"{e.a:.6g}" for e in found],
            "b_percent": [f"{e.b:.6g}" for e in found],
            "fall": [f"{e.fall.value:.6g}" for e in found],
            "fall_low": [f"{e.fall.low:.6g}" for e in found],
            "fall_high": [f"{e.fall.high:.6g}" for e in found],
        },
    )
    paper.save(folder / "order.png", figure(found))


def main() -> int:
    """Drive, print, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    fitted = Path(__file__).with_name("population.toml")
    parser.add_argument("--out", type=Path, default=Path("out/order"))
    parser.add_argument("--people", type=int, default=PEOPLE, help="default: twenty studies' worth")
    parser.add_argument("--population", type=Path, default=fitted, help="TOML file")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    options = parser.parse_args()
    with options.population.open("rb") as file:
        distribution = read_distribution(tomllib.load(file)["distribution"])
    people = sample_participants(options.people, SEED, distribution)
    found: list[Effect] = []
    for share in SHARES:
        for way in DRAWN:
            found += effects(way, share, drive(way, share, people, options.jobs))
            print(f"driven: {way}, {100.0 * share:g} %", file=sys.stderr, flush=True)
    write(found, options.out)
    print(table(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
