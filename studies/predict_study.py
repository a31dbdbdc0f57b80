"""Drive the paper's study many times with simulated drivers and compare with the paper.

    python studies/predict_study.py --studies 20        # Markdown tables on standard output

Each study is 43 new people of the fitted population. System A was fitted with other people
(studies/fit_population.py), system B is a prediction. Given is the mean over the studies and, in
brackets, the range that holds 95 % of them: what one study of 43 people may show by chance.
"""

from __future__ import annotations

import argparse
import os
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from pldf.analysis.published import DRIVERS, TESTS, published_means
from pldf.analysis.statistics import Comparison, compare
from pldf.kernel.arrays import FloatArray
from pldf.roads import open_road
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES
from pldf.study.population import Distribution, read_distribution, sample_participants
from pldf.study.runner import in_processes
from pldf.study.unit import Job

MEASURES: Final = {"pedal": "pedal", "set_speed": "set speed", "combined": "combined"}
COMPARED: Final = {"A": ("A1", "A2"), "B": ("B1", "B2")}


def drive_studies(distribution: Distribution, studies: int, jobs: int) -> FloatArray:
    """Return rates[study, person, drive, measure] in percent; drives are A1, A2, B1, B2."""
    settings = StudySettings(road=open_road("study"), phases=tuple(PHASES.values()))
    people = [person for seed in range(studies) for person in study_people(seed, distribution)]
    drives = [name for names in COMPARED.values() for name in names]
    rates_of: dict[str, list[list[float]]] = {}
    for count, done in enumerate(in_processes(jobs)(Job(settings), people), 1):
        by_phase = {row.phase: row for row in done.rows}
        rates_of[done.participant] = [
            [getattr(by_phase[name], f"{measure}_rate") for measure in MEASURES] for name in drives
        ]
        if count % DRIVERS == 0:
            print(f"{count} of {len(people)} drivers", file=sys.stderr)
    rates = 100.0 * np.array([rates_of[person.id] for person in people])
    return rates.reshape(studies, DRIVERS, len(drives), len(MEASURES))


def study_people(seed: int, distribution: Distribution) -> list[Participant]:
    """Return the people of study ``seed``, from 0, numbered on from study to study."""
    people = sample_participants(DRIVERS, seed + 1, distribution)
    return [replace(person, id=f"P{seed * DRIVERS + person.number:05d}") for person in people]


def tables(rates: FloatArray) -> str:
    """Return means, tests and drives as Markdown."""
    per_person = rates.reshape(*rates.shape[:2], 2, 2, -1).mean(axis=3)  # study, person, system
    lines = [
        "| rate % | A paper | A model | B paper | B model | fall A to B paper | model |",
        "|---|---|---|---|---|---|---|",
    ]
    for k, (measure, name) in enumerate(MEASURES.items()):
        a, b = (100.0 * mean for mean in published_means(measure))
        means = per_person[..., k].mean(axis=1)
        fall = means[:, 0] - means[:, 1]
        lines.append(
            f"| {name} | {a:.2f} | {_range(means[:, 0])} | {b:.2f} | {_range(means[:, 1])} "
            f"| {a - b:.2f} | {_range(fall)} |"
        )
    lines += ["", "| test | paper | model: median and 95 % of the studies |", "|---|---|---|"]
    for k, (measure, name) in enumerate(MEASURES.items()):
        compared = [compare(study[:, 0, k], study[:, 1, k]) for study in per_person]
        lines += _test_rows(measure, name, compared)
    lines += ["", "| rate % | A1 | A2 | B1 | B2 |", "|---|---|---|---|---|"]
    for k, name in enumerate(MEASURES.values()):
        lines.append(
            f"| {name} | " + " | ".join(_range(rates[..., d, k].mean(1)) for d in range(4)) + " |"
        )
    return "\n".join(lines)


def _test_rows(measure: str, name: str, compared: Sequence[Comparison]) -> list[str]:
    """Return rows with the paper's test of this measure, its p value, effect and who fell."""
    paper = TESTS[measure]
    if paper.kind == "t":
        statistic, p = [c.t.t for c in compared], [c.t.p for c in compared]
    else:
        statistic, p = [c.signed_rank.w for c in compared], [c.signed_rank.p for c in compared]
    zeros = [float(c.signed_rank.zeros) for c in compared]
    return [
        f"| {name} | {paper.text} | {_middle(statistic, '.2f')} |",
        f"| {name}, p | {paper.p:.3g} | {_middle(p, '.1e')} |",
        f"| {name}, Cohen's d_z | | {_middle([c.d_z for c in compared], '.2f')} |",
        f"| {name}, drivers who fell | | {_middle([float(c.fell) for c in compared], '.0f')} |",
        f"| {name}, drivers without difference | | {_middle(zeros, '.0f')} |",
    ]


def _range(values: FloatArray) -> str:
    low, high = np.quantile(values, [0.025, 0.975])
    return f"{values.mean():.2f} [{low:.2f}, {high:.2f}]"


def _middle(values: Sequence[float], form: str) -> str:
    low, middle, high = np.quantile(values, [0.025, 0.5, 0.975])
    return f"{middle:{form}} [{low:{form}}, {high:{form}}]"


def read_population(path: Path) -> Distribution:
    """Return the distribution of a TOML file's table [distribution]."""
    with path.open("rb") as file:
        return read_distribution(tomllib.load(file)["distribution"])


def main() -> int:
    """Drive and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    fitted = Path(__file__).with_name("population.toml")
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--population", type=Path, default=fitted, help="TOML file")
    parser.add_argument("--start", action="store_true", help="starting values, nothing fitted")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    options = parser.parse_args()
    distribution = Distribution() if options.start else read_population(options.population)
    print(tables(drive_studies(distribution, options.studies, options.jobs)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
