"""The analysis of a study, the same for real and for simulated participants.

Every participant counts with the mean over the drives with interventions per system (A1 and A2, B1
and B2), as in the paper. Drives without interventions (A3, B3) are reported but not tested.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..function import DrivingFunction
from ..kernel.arrays import FloatArray
from ..recordings.interventions import Rates
from ..recordings.recording import Recording, completed, read_recording
from ..roads import Route
from ..study.drive_row import DriveRow
from ..study.phases import PHASES, Phase
from .drives_table import check_complete, check_phase, read_drives, row_of_recording
from .questionnaires import Questionnaire, SurveyMap, read_questionnaire
from .rounding import as_written
from .statistics import Comparison, MeanInterval, compare, mean_interval

SYSTEMS: Final = ("A", "B")
RATES: Final = Rates._fields
PARTICIPANTS_MIN: Final = 2

# What a recording must hold for the rates, and what is derived when the route is known.
_PEDALS_AND_LEVER: Final = ("brake_pedal", "set_speed_offset_mps")

# Called with the number of recordings read and of all.
Reading = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class StudyFolder:
    """Where a study lies and what of it counts.

    Attributes:
        folder: with ``drives.csv`` or ``recordings/``, and ``questionnaire.csv`` if there is one.
        route: the route driven, for recordings that lack columns.
        without: participants to leave out.
        survey: what columns and answers of the questionnaire mean.
    """

    folder: Path
    route: Route | None = None
    without: frozenset[str] = frozenset()
    survey: SurveyMap = field(default_factory=SurveyMap)

    @property
    def questionnaire(self) -> Path:
        """The file with the answers, if there is one."""
        return self.folder / self.survey.file

    @cached_property
    def study_file(self) -> Mapping[str, Any]:
        """The study file that a simulation left in the folder; empty for real participants."""
        path = self.folder / "study.toml"
        try:
            return tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        except (OSError, ValueError) as error:
            raise ModelError(f"{path}: {error}") from error

    def order(self) -> list[Phase]:
        """Return the drives in the order of the study; repeated phases are numbered anew."""
        drives = self.study_file.get("drives", {})
        repeats = drives.get("per_phase", 1)
        phases = [PHASES[name] for name in drives.get("phases", PHASES) for _ in range(repeats)]
        if repeats == 1:
            return phases
        counts = dict.fromkeys(SYSTEMS, 0)
        for at, phase in enumerate(phases):
            system = phase.name[0]
            counts[system] += 1
            phases[at] = phase._replace(name=f"{system}{counts[system]}")
        return phases

    def compared(self) -> dict[str, tuple[str, ...]]:
        """Return, per system, the drives in which the drivers intervene."""
        acting = dict.fromkeys(phase.name for phase in self.order() if phase.intervenes)
        return {s: tuple(name for name in acting if name[0] == s) for s in SYSTEMS}

    def development(self) -> dict[str, str]:
        """Return each drive learned from -> the next one with the learned profile."""
        followed_in: dict[str, str] = {}
        taught = ""
        for phase in self.order():
            if phase.apply_learned and taught:
                followed_in.setdefault(taught, phase.name)
            taught = phase.name if phase.learn else taught
        return followed_in

    def recordings(self) -> dict[tuple[str, str], Path]:
        """Return the recordings by (participant, phase); ModelError for a name that tells neither.

        Participants are in order of their names, drives in the order of the study.
        """
        paths = {}
        for path in sorted((self.folder / "recordings").glob("*.csv")):
            participant, _, phase = path.stem.rpartition("_")
            if not participant:
                raise ModelError(
                    f"{path}: name recordings PARTICIPANT_PHASE.csv, such as P001_A1.csv"
                )
            check_phase(str(path), phase)
            if participant not in self.without:
                paths[participant, phase] = path
        return paths

    def read(self, path: Path) -> Recording:
        """Read a recording with all columns, or with pedals and lever at least.

        Raises:
            ModelError: columns are missing and the route is not known.
        """
        recording = read_recording(path)
        missing = [name for name in _PEDALS_AND_LEVER if name not in recording]
        if self.route is None:
            if missing:
                raise ModelError(
                    f"{path}: no column {', '.join(missing)}; name the route driven with --route "
                    "to have it derived"
                )
            return recording
        function = DrivingFunction()
        function.prepare(self.route)
        return completed(recording, function.route, function.profile)


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
