"""The analysis of a study, the same for real and for simulated participants.

Every participant counts with the mean over the drives with interventions per system (A1 and A2, B1
and B2), as in the paper. Drives without interventions (A3, B3) are reported but not tested.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..kernel.arrays import FloatArray
from ..recordings.interventions import Rates
from ..study.drive_row import DriveRow
from .drives_table import missing, repeated
from .exclusions import Exclusion
from .gathered import Gathered, Reading, gather
from .problems import StudyError, findings_of
from .questionnaires import Questionnaire, SurveyMap, read_questionnaire
from .rounding import as_written
from .statistics import Comparison, MeanInterval, compare, mean_interval
from .study_folder import SYSTEMS, StudyFolder

RATES: Final = Rates._fields
PARTICIPANTS_MIN: Final = 2


@dataclass(frozen=True, eq=False)
class Analysis:
    """What a study says.

    Attributes:
        drives: one row per drive.
        participants: in the order in which they appear.
        compared: system -> its drives with interventions.
        comparisons: measure (a rate, or a scale of the questionnaire) -> A against B.
        questionnaire: None if there is none.
        source: file or folder that the rates come from.
        notes: what one has to know to trust the numbers.
        exclusions: what was left out, and why.
    """

    drives: Sequence[DriveRow]
    participants: tuple[str, ...]
    compared: Mapping[str, tuple[str, ...]]
    comparisons: Mapping[str, Comparison]
    questionnaire: Questionnaire | None
    source: Path
    notes: tuple[Finding, ...] = ()
    exclusions: tuple[Exclusion, ...] = ()

    @property
    def needed(self) -> tuple[str, ...]:
        """The drives with interventions, A before B."""
        return tuple(phase for phases in self.compared.values() for phase in phases)

    @property
    def phases(self) -> list[str]:
        """Phases driven by somebody, in order of system and number."""
        return sorted({d.phase for d in self.drives}, key=lambda phase: (phase[0], int(phase[1:])))

    def rate(self, phase: str, measure: str) -> FloatArray:
        """Return one rate in ``phase`` by participant; NaN for those who did not drive it."""
        return mean_rates(self.drives, self.participants, measure, (phase,))

    def interval(self, phase: str, measure: str) -> MeanInterval:
        """Return the mean rate of a phase with its 95 % confidence interval, within 0 and 1."""
        rates = self.rate(phase, measure)
        rates = rates[np.isfinite(rates)]
        mean = float(np.mean(rates))
        if len(rates) < PARTICIPANTS_MIN:
            return MeanInterval(mean, mean, mean)
        interval = mean_interval(rates)
        return MeanInterval(mean, max(interval.low, 0.0), min(interval.high, 1.0))

    def per_participant(self, measure: str, system: str) -> FloatArray:
        """Return what each participant counts with, in their order; NaN for no score."""
        if measure not in RATES:
            assert self.questionnaire is not None
            scores = self.questionnaire.scores[measure]
            return np.array([scores.get((name, system), np.nan) for name in self.participants])
        return mean_rates(self.drives, self.participants, measure, self.compared[system])


def mean_rates(
    drives: Sequence[DriveRow], participants: Sequence[str], measure: str, phases: Collection[str]
) -> FloatArray:
    """Return each participant's mean of one rate over the drives of some phases; NaN if none."""
    rates: dict[str, list[float]] = {name: [] for name in participants}
    written = as_written([getattr(drive, f"{measure}_rate") for drive in drives])
    for drive, rate in zip(drives, written.tolist(), strict=True):
        if drive.phase in phases:
            rates[drive.participant].append(rate)
    return np.array([float(np.mean(v)) if v else np.nan for v in rates.values()])


def analyse(study: StudyFolder, reading: Reading = lambda _done, _all: None) -> Analysis:
    """Analyse the study in ``study.folder``.

    Raises:
        StudyError: naming file, line, participant and phase of all that is missing or unusable.
        ModelError: there is nothing to analyse.
    """
    compared = study.compared()
    found = gather(study, reading)
    problems = list(_wrong_drives(study, found, compared))
    left, told = _who_leaves(study, found, compared)
    participants = tuple(dict.fromkeys(who for who, _ in found.driven if who not in left))
    try:
        answers = _questionnaire(study, participants, left, bool(problems))
    except ModelError as error:
        problems += findings_of(error, str(study.questionnaire))
    if problems:
        raise StudyError(problems)
    if not all(compared.values()):
        raise ModelError(f"{study.folder}: no drives with both systems, so nothing to compare")
    if len(participants) < PARTICIPANTS_MIN:
        people = "1 participant" if len(participants) == 1 else f"{len(participants)} participants"
        raise ModelError(
            f"{study.folder}: {people}; comparing systems needs at least {PARTICIPANTS_MIN}; look "
            "at the drives of one person with 'pldf plot'"
        )
    order = {name: at for at, name in enumerate(participants)}
    drives = [drive for drive in found.drives if drive.participant in order]
    drives.sort(key=lambda drive: order[drive.participant])
    untested = Analysis(tuple(drives), participants, compared, {}, answers, found.source)
    notes = (*found.notes, *study.names.notes(), *told)
    return _tested(study, replace(untested, notes=notes, exclusions=study.exclusions.listed))


def _wrong_drives(
    study: StudyFolder, found: Gathered, compared: Mapping[str, Sequence[str]]
) -> Iterator[Finding]:
    """Yield all that is wrong with the drives."""
    yield from found.problems
    yield from repeated(found.drives)
    if found.driven:
        needed = [name for names in compared.values() for name in names]
        yield from missing(found.driven, needed, str(found.source), study.exclusions)


def _who_leaves(
    study: StudyFolder, found: Gathered, compared: Mapping[str, Sequence[str]]
) -> tuple[set[str], list[Finding]]:
    """Return who has no drive left with one of the systems, and what exclusions did to whom.

    The rule: who has drives left with both systems counts with the mean over those that are left;
    who has none left with one of them leaves the study.
    """
    driven = set(found.driven)
    left: set[str] = set()
    told = []
    for who in dict.fromkeys(participant for participant, _ in found.driven):
        place = f"participant {who}"
        for system, phases in compared.items():
            there = [phase for phase in phases if (who, phase) in driven]
            if phases and not there:
                left.add(who)
                text = f"no drive with system {system} is left ({', '.join(phases)} left out)"
                so = "the participant is in no mean, test or figure of the study"
                told.append(Finding("warning", str(found.source), 0, place, text, so))
            elif len(there) < len(phases):
                out = [phase for phase in phases if phase not in there]
                text = f"{', '.join(out)} left out, so {system} is the mean of {', '.join(there)}"
                told.append(Finding("note", str(found.source), 0, place, text))
    return left, told


def _tested(study: StudyFolder, untested: Analysis) -> Analysis:
    """Return the analysis with the systems compared."""
    answers = untested.questionnaire
    measures = (*RATES, *(answers.scores if answers else ()))
    values = {m: [untested.per_participant(m, system) for system in SYSTEMS] for m in measures}
    whole = {measure: np.isfinite(ab).all(axis=0) for measure, ab in values.items()}
    comparisons = {
        measure: compare(*(values[measure][at][both] for at in range(len(SYSTEMS))))
        for measure, both in whole.items()
        if both.sum() >= PARTICIPANTS_MIN
    }
    left_out = _left_out(study, untested.participants, values) if answers else ()
    notes = (*untested.notes, *(answers.notes if answers else ()), *left_out)
    return replace(untested, comparisons=comparisons, notes=notes)


def _left_out(
    study: StudyFolder, participants: Sequence[str], values: Mapping[str, Sequence[FloatArray]]
) -> Iterator[Finding]:
    """Yield, per scale, who has no score and what that costs.

    Args:
        study: where the questionnaire lies.
        participants: the people.
        values: measure -> one number per participant, for A and for B.
    """
    for scale in (name for name in values if name not in RATES):
        missing = [
            f"{name} ({', '.join(lacking)})"
            for name, *ab in zip(participants, *values[scale], strict=True)
            if (lacking := [s for s, score in zip(SYSTEMS, ab, strict=True) if np.isnan(score)])
        ]
        count = len(participants) - len(missing)
        if missing:
            yield Finding(
                "warning", str(study.questionnaire), 0, scale, f"no score of {', '.join(missing)}",
                f"A and B are compared for the other {count} participants"
                if count >= PARTICIPANTS_MIN
                else f"{count} participants are left, so A and B are not compared",
                "all drives count all the same",
            )  # fmt: skip


def _questionnaire(
    study: StudyFolder, participants: Collection[str], left: Collection[str], in_doubt: bool
) -> Questionnaire | None:
    """Return the answers of the participants.

    Args:
        study: where they lie.
        participants: who counts.
        left: participants who leave the study.
        in_doubt: not all participants are known, so that nobody is a stranger.
    """
    path = study.questionnaire
    if not path.exists():
        if study.survey.file != SurveyMap().file:
            raise ModelError(
                f"{path}: no such file; the mapping file names it ([questionnaire] file); put the "
                "export there or correct its name"
            )
        return None

    def left_out(participant: str, phase: str) -> bool:
        return participant in left or study.exclusions.has(participant, phase)

    def known_as(name: str) -> str:
        return study.names.take(name, str(path)) if name in study.names else name

    answers = read_questionnaire(path, left_out, study.survey, known_as)
    answered = {name for values in answers.items.values() for name, _ in values}
    if not in_doubt and (strangers := answered.difference(participants)):
        raise ModelError(
            f"{path}: answers of {', '.join(sorted(strangers))}, of whom there are no drives; "
            "leave them out with --without"
        )
    return answers
