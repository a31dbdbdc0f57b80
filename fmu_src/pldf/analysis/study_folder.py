"""Where the files of a study lie, and what its drives are called in which order."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from ..errors import ModelError
from ..function import DrivingFunction
from ..recordings.derived import completed
from ..recordings.inputs import SUFFIXES
from ..recordings.mapping import RecordingMap, remembered_map
from ..recordings.recording import Recording, read_recording
from ..roads import Route
from ..study.phases import PHASES, Phase
from .drives_table import check_phase
from .questionnaires import SurveyMap, survey_map

SYSTEMS: Final = ("A", "B")

# What a recording must hold for the rates, and what is derived when the route is known.
_PEDALS_AND_LEVER: Final = ("brake_pedal", "set_speed_offset_mps")


@dataclass(frozen=True, eq=False)
class StudyFolder:
    """Where a study lies and what of it counts.

    Attributes:
        folder: with ``drives.csv`` or ``recordings/``, and ``questionnaire.csv`` if there is one.
        route: the route driven, for recordings that lack columns.
        without: participants to leave out.
        map: what columns and answers are called; None: ``map.toml`` in the folder, if there.
    """

    folder: Path
    route: Route | None = None
    without: frozenset[str] = frozenset()
    map: RecordingMap | None = None

    @cached_property
    def survey(self) -> SurveyMap:
        """What columns and answers of the questionnaire mean."""
        found = self.map or remembered_map(self.folder / "questionnaire.csv")
        return survey_map(found.questionnaire, found.name) if found else SurveyMap()

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
        paths: dict[tuple[str, str], Path] = {}
        for path in sorted((self.folder / "recordings").glob("*.*")):
            if path.suffix.lower() not in SUFFIXES:
                continue
            participant, _, phase = path.stem.rpartition("_")
            if not participant:
                raise ModelError(
                    f"{path}: name recordings PARTICIPANT_PHASE.csv, such as P001_A1.csv"
                )
            check_phase(str(path), phase)
            if participant not in self.without:
                if other := paths.get((participant, phase)):
                    raise ModelError(f"{path}: the same drive as {other}; leave one of them there")
                paths[participant, phase] = path
        return paths

    def read(self, path: Path) -> Recording:
        """Read a recording with all columns, or with pedals and lever at least.

        Raises:
            ModelError: columns are missing and the route is not known.
        """
        recording = read_recording(path, self.map)
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
        return completed(recording, function, str(path))
