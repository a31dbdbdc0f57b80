"""Let simulated drivers drive the learning system again and again: where does it end?

    python studies/long_run.py --out out/long_run       # long_run.csv and long_run.png

Everybody begins with the base profile, intervenes in every drive, and after every drive the system
learns. Repeated with several stretch factors (learning.stretch_factor; 0: interventions are learned
where they happened).
"""

from __future__ import annotations

import argparse
import os
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from pldf.analysis.long_run import read_long_run
from pldf.analysis.statistics import mean_interval
from pldf.files.tables import write_table
from pldf.kernel.units import KMH_PER_MPS
from pldf.report import figures, paper
from pldf.roads import open_road
from pldf.study.drive_row import DriveRow
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES
from pldf.study.population import read_distribution, sample_participants
from pldf.study.runner import in_processes
from pldf.study.unit import Job

Summary = dict[str, float]

STRETCH: Final = (0.0, 0.25, 0.5, 1.0)


def long_run(
    people: Sequence[Participant], stretch: float, drives: int, jobs: int
) -> list[Summary]:
    """Return one summary per drive of all people."""
    phases = tuple(PHASES["B1"]._replace(name=f"B{k + 1}") for k in range(drives))
    settings = StudySettings(
        road=open_road("study"), phases=phases, function={"learning.stretch_factor": stretch}
    )
    done = sorted(
        in_processes(jobs)(Job(settings), list(people)), key=lambda unit: unit.participant
    )
    by_drive = zip(*(unit.rows for unit in done), strict=True)
    return [summary(stretch, k + 1, rows) for k, rows in enumerate(by_drive)]


def summary(stretch: float, drive: int, rows: Sequence[DriveRow]) -> Summary:
    """Return means over people; errors have 95 % confidence intervals of the mean."""
    combined = mean_interval([100.0 * row.combined_rate for row in rows])
    error = mean_interval([KMH_PER_MPS * row.wish_error_mps for row in rows])
    return {
        "stretch_factor": stretch,
        "drive": drive,
        "people": len(rows),
        "pedal_percent": 100.0 * float(np.mean([row.pedal_rate for row in rows])),
        "set_speed_percent": 100.0 * float(np.mean([row.set_speed_rate for row in rows])),
        "combined_percent": combined.value,
        "combined_low": combined.low,
        "combined_high": combined.high,
        "content_percent": 100.0 * float(np.mean([row.combined_rate == 0.0 for row in rows])),
        "wish_error_kmh": error.value,
        "wish_error_low": error.low,
        "wish_error_high": error.high,
    }


def main() -> int:
    """Drive, write, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    fitted = Path(__file__).with_name("population_constant_wish.toml")
    parser.add_argument("--out", type=Path, default=Path("out/long_run"))
    parser.add_argument("--people", type=int, default=43)
    parser.add_argument("--drives", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1, help="draws the people; 1 as in paper.toml")
    parser.add_argument("--population", type=Path, default=fitted, help="TOML file")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    options = parser.parse_args()
    with options.population.open("rb") as file:
        distribution = read_distribution(tomllib.load(file)["distribution"])
    people = sample_participants(options.people, options.seed, distribution)
    summaries = []
    for factor in STRETCH:
        summaries += long_run(people, factor, options.drives, options.jobs)
        last = ", ".join(f"{name} {value:.2f}" for name, value in summaries[-1].items())
        print(last, flush=True)
    write(summaries, options.out)
    return 0


def write(summaries: Sequence[Summary], folder: Path) -> None:
    """Write CSV and figure."""
    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "long_run.csv"
    columns = {name: [f"{row[name]:.6g}" for row in summaries] for name in summaries[0]}
    write_table(table, columns)
    paper.save(folder / "long_run.png", figures.long_run(read_long_run(table)))


if __name__ == "__main__":
    sys.exit(main())
