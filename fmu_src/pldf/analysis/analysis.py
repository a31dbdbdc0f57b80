"""The analysis of a study, the same for real and for simulated participants.

Every participant counts with the mean over the drives with interventions per system (A1 and A2, B1
and B2), as in the paper. Drives without interventions (A3, B3) are reported but not tested.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..kernel.arrays import FloatArray
from ..recordings.interventions import Rates
from ..study.drive_row import DriveRow
from .drives_table import check_complete, read_drives, row_of_recording
from .questionnaires import Questionnaire, read_questionnaire
from .rounding import as_written
from .statistics import Comparison, MeanInterval, compare, mean_interval
from .study_folder import SYSTEMS, StudyFolder

RATES: Final = Rates._fields
PARTICIPANTS_MIN: Final = 2

# Called with the number of recordings read and of all.
Reading = Callable[[int, int], None]


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
    """

    drives: Sequence[DriveRow]
    participants: tuple[str, ...]
    compared: Mapping[str, tuple[str, ...]]
    comparisons: Mapping[str, Comparison]
    questionnaire: Questionnaire | None
    source: Path
    notes: tuple[Finding, ...] = ()

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
        ModelError: naming file, line, participant and phase of what is missing or unusable.
    """
    drives, origin = _drives(study, reading)
    compared = study.compared()
    check_complete(drives, [name for names in compared.values() for name in names], str(origin))
    participants = tuple(dict.fromkeys(drive.participant for drive in drives))
    if len(participants) < PARTICIPANTS_MIN:
        raise ModelError(
            f"{origin}: {len(participants)} participants; comparing systems needs at least "
            f"{PARTICIPANTS_MIN}"
        )
    order = {name: at for at, name in enumerate(participants)}
    drives.sort(key=lambda drive: order[drive.participant])
    answers = _questionnaire(study, participants)
    untested = Analysis(tuple(drives), participants, compared, {}, answers, origin)
    measures = (*RATES, *(answers.scores if answers else ()))
    if not all(compared.values()):
        raise ModelError(f"{study.folder}: no drives with both systems, so nothing to compare")
    values = {m: [untested.per_participant(m, system) for system in SYSTEMS] for m in measures}
    whole = {measure: np.isfinite(ab).all(axis=0) for measure, ab in values.items()}
    comparisons = {
        measure: compare(*(values[measure][at][both] for at in range(len(SYSTEMS))))
        for measure, both in whole.items()
        if both.sum() >= PARTICIPANTS_MIN
    }
    left_out = _left_out(study, participants, values) if answers else ()
    notes = (*(answers.notes if answers else ()), *left_out)
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


def _drives(study: StudyFolder, reading: Reading) -> tuple[list[DriveRow], Path]:
    """Return all drives, from the table of drives if there is one, else from the recordings."""
    table = study.folder / "drives.csv"
    if table.exists():
        return read_drives(table, study.without), table
    recordings = study.recordings()
    if not recordings:
        raise ModelError(
            f"{study.folder}: no drives.csv and no recordings/PARTICIPANT_PHASE.csv to analyse; "
            "name a folder that 'pldf study' wrote, or put recordings there"
        )
    drives = []
    for number, ((participant, phase), path) in enumerate(recordings.items(), start=1):
        drives.append(row_of_recording(participant, phase, study.read(path), str(path)))
        reading(number, len(recordings))
    return drives, study.folder / "recordings"


def _questionnaire(study: StudyFolder, participants: Collection[str]) -> Questionnaire | None:
    path = study.questionnaire
    if not path.exists():
        return None
    answers = read_questionnaire(path, study.without, study.survey)
    answered = {name for values in answers.items.values() for name, _ in values}
    if strangers := answered.difference(participants):
        raise ModelError(
            f"{path}: answers of {', '.join(sorted(strangers))}, of whom there are no drives; "
            "leave them out with --without"
        )
    return answers
