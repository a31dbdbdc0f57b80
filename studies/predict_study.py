"""Drive the paper's study many times with simulated drivers and compare with the paper.

    python studies/predict_study.py --studies 20        # Markdown tables on standard output
    python studies/predict_study.py --tables            # once more, from what was driven

Each study is 43 new people of a population, drawn by seed: 1, 2, ... System A was fitted with other
people (studies/fit_population.py), system B is a prediction. The same people are driven with the
older model, whose wish never changes, with the one whose wish varies, and, to see what hangs on it,
with the latter's variance split in other ways. Those are not fitted anew.

Given is the mean over the studies, for tests the median, and in brackets the range that holds 95 %
of them: what one study of 43 people may show by chance. Every model's drives are kept in a folder
of --out that `pldf analyse` and studies/power.py read, the tables in its prediction.md.
"""

from __future__ import annotations

import argparse
import os
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path
from typing import Any, Final

import numpy as np
from pldf.analysis import implied
from pldf.analysis.drives_table import read_drives
from pldf.analysis.published import DRIVERS, TESTS, published_means
from pldf.analysis.statistics import Comparison, compare
from pldf.files.disk import replace_file
from pldf.files.tables import write_table
from pldf.kernel.arrays import FloatArray
from pldf.roads import open_road
from pldf.study.drive_row import COLUMNS, DriveRow
from pldf.study.own_files import DRIVES
from pldf.study.participants import Participant, StudySettings
from pldf.study.phases import PHASES
from pldf.study.population import Distribution, read_distribution, sample_participants
from pldf.study.runner import in_processes, rows_in_order
from pldf.study.unit import Job, ParticipantResult

Table = Mapping[str, Any]
# Name, the paper's value, form and which of a comparison.
Statistic = tuple[str, str, str, Callable[[Comparison], float]]

MEASURES: Final = {"pedal": "pedal", "set_speed": "set speed", "combined": "combined"}
COMPARED: Final = {"A": ("A1", "A2"), "B": ("B1", "B2")}
DRIVEN: Final = tuple(name for names in COMPARED.values() for name in names)
FOLDERS: Final = {"constant_wish": "one wish for ever", "varying_wish": "wish that varies"}
# Other shares of the variance, in percent: person, place, occasion. The rule's own are 49, 32, 19.
# Where one is left out or made more of, the others keep their ratio.
SPLITS: Final = {
    "person_and_occasion": (49.0, 0.0, 19.0),
    "person_and_place": (49.0, 32.0, 0.0),
    "twice_the_occasion": (49.0 * 62.0 / 81.0, 32.0 * 62.0 / 81.0, 38.0),
}
PARTS: Final = ("person", "place", "occasion")
KINDS: Final = ("wish.offset_{}_sd_mps", "wish.lateral_{}_sigma")


def split_otherwise(table: Table, shares: Sequence[float]) -> dict[str, Any]:
    """Return a table [distribution] with its variances in other shares and the same total."""
    changed = dict(table)
    for kind in KINDS:
        names = [kind.format(part) for part in PARTS]
        variance = sum(table[name] ** 2 for name in names)
        for name, share in zip(names, shares, strict=True):
            changed[name] = sqrt(variance * share / sum(shares))
    return changed


def models(constant: Table, varying: Table) -> dict[str, Table]:
    """Return the populations to drive, by the names of their folders."""
    splits = {name: split_otherwise(varying, shares) for name, shares in SPLITS.items()}
    return {**dict(zip(FOLDERS, (constant, varying), strict=True)), **splits}


def drive_studies(distribution: Distribution, studies: int, jobs: int) -> list[DriveRow]:
    """Return all drives of all studies, person by person."""
    settings = StudySettings(road=open_road("study"), phases=tuple(PHASES.values()))
    people = [person for seed in range(studies) for person in study_people(seed, distribution)]
    results = _counted(in_processes(jobs)(Job(settings), people), len(people))
    return [row for rows in rows_in_order(results, people) for row in rows]


def _counted(results: Iterable[ParticipantResult], people: int) -> Iterator[ParticipantResult]:
    """Pass results on and say how many there are."""
    for count, result in enumerate(results, 1):
        if count % DRIVERS == 0:
            print(f"  {count} of {people} drivers", file=sys.stderr)
        yield result


def study_people(seed: int, distribution: Distribution) -> list[Participant]:
    """Return the people of study ``seed``, from 0, numbered on from study to study."""
    people = sample_participants(DRIVERS, seed + 1, distribution)
    return [replace(person, id=f"P{seed * DRIVERS + person.number:05d}") for person in people]


def rates_of(rows: Sequence[DriveRow]) -> FloatArray:
    """Return rates[study, person, drive, measure] in percent; the drives are ``DRIVEN``."""
    by_drive = {(row.participant, row.phase): row for row in rows}
    rates = [
        by_drive[who, phase].rates
        for who in dict.fromkeys(row.participant for row in rows)
        for phase in DRIVEN
    ]
    return 100.0 * np.array(rates).reshape(-1, DRIVERS, len(DRIVEN), len(MEASURES))


@dataclass(frozen=True, eq=False)
class Predicted:
    """What one model does in all studies.

    Attributes:
        rates: rates[study, person, drive, measure] in percent.
    """

    rates: FloatArray

    @property
    def per_person(self) -> FloatArray:
        """Mean rates[study, person, system, measure]."""
        return self.rates.reshape(*self.rates.shape[:2], len(COMPARED), 2, -1).mean(axis=3)

    def mean(self, system: int, measure: int) -> FloatArray:
        """Return the mean rate of every study's people with this system."""
        return self.per_person[:, :, system, measure].mean(axis=1)

    def fall(self, measure: int) -> FloatArray:
        """Return by how much the mean rate falls from A to B."""
        return self.mean(0, measure) - self.mean(1, measure)

    def compared(self, measure: int) -> list[Comparison]:
        """Return the tests of every study."""
        values = self.per_person[..., measure]
        return [compare(study[:, 0], study[:, 1]) for study in values]

    def without_lever(self) -> list[float]:
        """Return how many of every study's people set no speed in any drive."""
        set_speed = self.rates[..., list(MEASURES).index("set_speed")]
        return [float(count) for count in (set_speed == 0.0).all(axis=2).sum(axis=1)]


def tables(predicted: Mapping[str, Predicted]) -> str:
    """Return all tables as Markdown; ``predicted`` by the names of ``models``."""
    shown = {title: predicted[name] for name, title in FOLDERS.items()}
    lines = [
        *_head("rate %", "paper", *shown), *_rate_rows(shown), "",
        *_head("test", "paper", *shown), *_test_rows(shown), "",
        *_head("rate %", "wish", *DRIVEN), *_drive_rows(shown), "",
        *_split_table(predicted),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _head(*cells: str) -> list[str]:
    return [_row(*cells), "|" + "---|" * len(cells)]


def _row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def _rate_rows(shown: Mapping[str, Predicted]) -> list[str]:
    """Return the mean rates of A and B and their difference."""
    lines = []
    for k, (measure, name) in enumerate(MEASURES.items()):
        paper = [100.0 * mean for mean in published_means(measure)]
        for at, system in enumerate(COMPARED):
            means = (_range(model.mean(at, k)) for model in shown.values())
            lines.append(_row(f"{name}, {system}", f"{paper[at]:.2f}", *means))
        falls = (_range(model.fall(k)) for model in shown.values())
        lines.append(_row(f"{name}, fall from A to B", f"{paper[0] - paper[1]:.2f}", *falls))
    return lines


def _test_rows(shown: Mapping[str, Predicted]) -> list[str]:
    """Return the paper's tests, what they imply of its drivers, and the models' ones."""
    lines = []
    for k, (measure, name) in enumerate(MEASURES.items()):
        compared = [model.compared(k) for model in shown.values()]
        for what, paper, form, of in _statistics(measure):
            cells = (_middle([of(study) for study in studies], form) for studies in compared)
            lines.append(_row(name + what, paper, *cells))
    never = (_middle(model.without_lever(), ".0f") for model in shown.values())
    return [*lines, _row("drivers who never use the lever", _implied("set_speed")[2], *never)]


def _statistics(measure: str) -> list[Statistic]:
    """Return what is told of one measure."""
    test, (effect, fell, same) = TESTS[measure], _implied(measure)
    p = f"{test.p:.3g}"
    tested: list[Statistic]
    if test.kind == "t":
        tested = [("", test.text, ".2f", lambda c: c.t.t), (", p", p, ".1e", lambda c: c.t.p)]
    else:
        tested = [
            ("", test.text, ".1f", lambda c: c.signed_rank.w),
            (", p", p, ".1e", lambda c: c.signed_rank.p),
        ]
    return [
        *tested,
        (", Cohen's d_z", effect, ".2f", lambda c: c.d_z),
        (", drivers who fell", fell, ".0f", lambda c: c.fell),
        (", drivers without difference", same, ".0f", lambda c: c.signed_rank.zeros),
    ]


def _implied(measure: str) -> tuple[str, str, str]:
    """Return the paper's d_z, who fell and who did not differ, as far as its tests tell."""
    test = TESTS[measure]
    if test.kind == "t":
        return f"{implied.d_z(test):.2f}", "", ""
    low, high = implied.fell(test)
    fell = f"{low}" if low == high else f"{low} to {high}"
    return "", fell, str(implied.without_difference(test))


def _drive_rows(shown: Mapping[str, Predicted]) -> list[str]:
    """Return the mean rates of every drive."""
    return [
        _row(name, title, *(_range(model.rates[..., d, k].mean(1)) for d in range(len(DRIVEN))))
        for k, name in enumerate(MEASURES.values())
        for title, model in shown.items()
    ]


def _split_table(predicted: Mapping[str, Predicted]) -> list[str]:
    """Return what hangs on how the variance is split: one row per split, the paper's first."""
    systems = [f"{name}, {system}" for name in MEASURES.values() for system in COMPARED]
    pedal, lever = _implied("pedal"), _implied("set_speed")
    paper = [f"{100.0 * mean:.2f}" for measure in MEASURES for mean in published_means(measure)]
    lines = _head("variance", *systems, "pedal, d_z", "set speed, fell", "never use the lever")
    lines.append(_row("paper", *paper, pedal[0], lever[1], lever[2]))
    for name, model in predicted.items():
        means = (
            _range(model.mean(at, k)) for k in range(len(MEASURES)) for at in range(len(COMPARED))
        )
        lines.append(
            _row(
                FOLDERS.get(name, name.replace("_", " ")), *means,
                _middle([c.d_z for c in model.compared(0)], ".2f"),
                _middle([float(c.fell) for c in model.compared(1)], ".0f"),
                _middle(model.without_lever(), ".0f"),
            )
        )  # fmt: skip
    return lines


def _range(values: FloatArray) -> str:
    low, high = np.quantile(values, [0.025, 0.975])
    return f"{values.mean():.2f} [{low:.2f}, {high:.2f}]"


def _middle(values: Sequence[float], form: str) -> str:
    low, middle, high = np.quantile(values, [0.025, 0.5, 0.975])
    return f"{middle:{form}} [{low:{form}}, {high:{form}}]"


def drive_all(populations: Mapping[str, Table], out: Path, studies: int, jobs: int) -> None:
    """Drive every model's studies and write its drives."""
    for name, table in populations.items():
        print(name, file=sys.stderr)
        rows = drive_studies(read_distribution(table), studies, jobs)
        columns = zip(*(row.cells for row in rows), strict=True)
        (out / name).mkdir(parents=True, exist_ok=True)
        write_table(out / name / DRIVES, dict(zip(COLUMNS, columns, strict=True)))


def main() -> int:
    """Drive and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    here = Path(__file__).parent
    constant, varying = here / "population_constant_wish.toml", here / "population.toml"
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--out", type=Path, default=Path("out/prediction"), help="folder")
    parser.add_argument("--tables", action="store_true", help="of what is in --out; drive nothing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    options = parser.parse_args()
    if not varying.exists():
        parser.error(f"{varying} is not there: python studies/fit_population.py makes it")
    populations = models(
        *(tomllib.loads(file.read_text())["distribution"] for file in (constant, varying))
    )
    if not options.tables:
        drive_all(populations, options.out, options.studies, options.jobs)
    predicted = {
        name: Predicted(rates_of(read_drives(options.out / name / DRIVES))) for name in populations
    }
    text = tables(predicted)
    replace_file(options.out / "prediction.md", text.encode())
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
