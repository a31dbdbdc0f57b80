"""Write what the fit found into the packaged studies.

    python studies/adopt_population.py          # after studies/fit_population.py

The paper's study and the long runs get the distribution of studies/population.toml. The study of
one driver gets the typical participant of the paper's study (pldf/study/typical.py), who is also
recorded there: the example of README and report is chosen by a rule, not by hand.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Final

from pldf.files.disk import replace_file
from pldf.study.participants import DRIVER_SIGNALS, Participant
from pldf.study.study_file import ONE_DRIVER, PACKAGED, read_study
from pldf.toml_file import shown

POPULATION: Final = Path(__file__).with_name("population.toml")
LONG_RUNS: Final = tuple(
    Path(__file__).with_name(f"{name}.toml") for name in ("long_run", "stretch_factor")
)
# A table's lines up to the next empty one.
_DISTRIBUTION: Final = re.compile(r"(?<=^\[distribution\]\n)(.+\n)+", re.MULTILINE)
_DRIVER: Final = re.compile(r"(?<=^\[driver\]\n)(.+\n)+", re.MULTILINE)
_SEED: Final = re.compile(r"^seed = .*$", re.MULTILINE)


def adopt(population: Path, paper: Path, one_driver: Path) -> Participant:
    """Write the distribution into ``paper``, its typical person into ``one_driver``; return it."""
    take_over(population, paper)
    person = example(paper)
    _rewrite(one_driver, _SEED, f"seed = {person.seed}")
    _rewrite(one_driver, _DRIVER, _described(person))
    return person


def take_over(population: Path, study: Path) -> None:
    """Write the distribution into ``study``."""
    found = _DISTRIBUTION.search(population.read_text(encoding="utf-8"))
    if found is None:
        raise ValueError(f"{population}: no table [distribution]")
    _rewrite(study, _DISTRIBUTION, found[0])


def example(paper: Path) -> Participant:
    """Return who is recorded in the study file ``paper``, which names one person or "typical"."""
    study = read_study(paper)
    (recorded,) = study.settings.recorded
    return next(person for person in study.participants if person.id == recorded)


def _described(person: Participant) -> str:
    """Return the lines of the table [driver]; every number reads back to the same bits."""
    lines = []
    for field in person.values:
        signal, value = DRIVER_SIGNALS[field], person.value(field)
        lines.append(
            f'"{signal.name}" = {shown(bool(value) if signal.kind == "Boolean" else value)}\n'
        )
    return "".join(lines)


def _rewrite(path: Path, what: re.Pattern[str], new: str) -> None:
    text, count = what.subn(lambda _: new, path.read_text(encoding="utf-8"))
    if count != 1:
        raise ValueError(f"{path}: {what.pattern} is there {count} times, not once")
    replace_file(path, text.encode())


def main() -> int:
    """Write and say who the example is."""
    paper, one_driver = (PACKAGED / f"{name}.toml" for name in ("paper", ONE_DRIVER))
    for study in LONG_RUNS:
        take_over(POPULATION, study)
    person = adopt(POPULATION, paper, one_driver)
    print(f"{person.id} is the typical person, now in {one_driver}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
