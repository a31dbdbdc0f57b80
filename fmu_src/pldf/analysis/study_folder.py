"""Where the files of a study lie, and what its drives are called in which order."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from ..errors import ModelError
from ..findings import Finding
from ..function import DrivingFunction
from ..profiles.store import StoredProfile
from ..recordings.derived import completed
from ..recordings.inputs import SUFFIXES
from ..recordings.mapping import RecordingMap, remembered_map
from ..recordings.recording import Recording, read_recording
from ..roads import Route
from ..study.drive_row import PHASE
from ..study.own_files import PROFILES, RECORDINGS, STUDY
from ..study.phases import PHASES, Phase, repeated
from ..study.study_tables import StudyTables
from ..toml_file import TomlFile
from .exclusions import EXCLUSIONS, Exclusions, read_exclusions
from .followed import Profiles
from .names import Names
from .problems import StudyError
from .questionnaires import SurveyMap, survey_map

Seen = Callable[[Path, Recording], None]

# The road that was driven, if the folder has it: a cockpit leaves it there.
OWN_ROAD: Final = "road.csv"
SYSTEMS: Final = ("A", "B")

# What says of a drive what the function had learned before.
_LEARNED: Final = ("set_speed_offset_mps", "profile_mps")


@dataclass(frozen=True, eq=False)
class StudyFolder:
    """Where a study lies and what of it counts.

    Attributes:
        folder: with ``drives.csv`` or ``recordings/``, and ``questionnaire.csv`` if there is one.
        route: the route driven, for recordings that lack columns.
        without: what to leave out beside ``exclusions.csv``: participants, drives such as
            ``P07_B2``, or recordings by the name of their file, whatever it is.
        profiles: folder of the learned profiles, for recordings of B that do not tell what was
            learned before; None: ``profiles`` in the folder, if there.
        map: what columns and answers are called; None: ``map.toml`` in the folder, if there.
        names: the participants met so far.
        seen: called with each recording as it was read, before columns are derived for it.
    """

    folder: Path
    route: Route | None = None
    without: frozenset[str] = frozenset()
    map: RecordingMap | None = None
    profiles: Path | None = None
    names: Names = field(default_factory=Names)
    seen: Seen = lambda _path, _recording: None

    @cached_property
    def exclusions(self) -> Exclusions:
        """What is left out, and why."""
        return read_exclusions(self.folder / EXCLUSIONS, self.without)

    @cached_property
    def survey(self) -> SurveyMap:
        """What columns and answers of the questionnaire mean."""
        found = self.map or remembered_map(self.folder / SurveyMap.file)
        return survey_map(found.questionnaire, found.name) if found else SurveyMap()

    @property
    def questionnaire(self) -> Path:
        """The file with the answers, if there is one."""
        return self.folder / self.survey.file

    @cached_property
    def study_file(self) -> Mapping[str, Any]:
        """The study file that a simulation left in the folder; empty for real participants."""
        path = self.folder / STUDY
        if not path.exists():
            return {}
        file = TomlFile(path)
        file.read(StudyTables)  # refuses what no study has
        return file.table

    def order(self) -> list[Phase]:
        """Return the drives in the order of the study; repeated phases are numbered anew."""
        drives = self.study_file.get("drives", {})
        return repeated(drives.get("phases", PHASES), drives.get("per_phase", 1))

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
        """Return the recordings by (participant, phase), without what is left out.

        Participants are in order of their names, drives in that of the systems and numbers.

        Raises:
            StudyError: files have names that tell neither, or two are of one drive.
        """
        paths, problems = self.listed
        if problems:
            raise StudyError(problems)
        return paths

    @cached_property
    def listed(self) -> tuple[dict[tuple[str, str], Path], list[Finding]]:
        """The recordings by (participant, phase), and what is wrong with names of files."""
        found: dict[tuple[str, str], Path] = {}
        problems: list[Finding] = []
        for path in self.files():
            participant, _, phase = path.stem.rpartition("_")
            if self.exclusions.has_file(path.stem):
                continue
            if not participant or not re.fullmatch(PHASE.pattern, phase):
                text = "not named PARTICIPANT_PHASE, the phase being A or B and a number"
                way_out = f"name it such as P001_A1.csv, or --without {path.stem}"
                problems.append(Finding("error", str(path), 0, "", text, "", way_out))
                continue
            drive = self.names.take(participant, str(path)), phase
            other = found.setdefault(drive, path)
            if other is not path:
                text = f"the same drive as {other}: {' '.join(drive)}"
                problems.append(Finding("error", str(path), 0, "", text, "", "keep one of them"))
        people = list(dict.fromkeys(who for who, _ in found))
        order = sorted(found, key=lambda at: (people.index(at[0]), at[1][0], int(at[1][1:])))
        return {drive: found[drive] for drive in order}, problems

    def files(self) -> list[Path]:
        """Return all files of recordings in order of their names, those left out included."""
        return [path for path in self._entries if path.suffix.lower() in SUFFIXES]

    def others(self) -> Iterator[Finding]:
        """Yield the files among the recordings that are not read, whatever they are."""
        for path in self._entries:
            if path.suffix.lower() not in SUFFIXES:
                yield Finding(
                    "warning", str(path), 0, "", f"not read: no recording ends in {path.suffix}",
                    "it counts nowhere", f"save it as one of {', '.join(SUFFIXES)}",
                )  # fmt: skip

    @property
    def _entries(self) -> list[Path]:
        found = sorted((self.folder / RECORDINGS).glob("*.*"))
        return [path for path in found if not path.name.startswith(".")]

    def read(self, path: Path) -> Recording:
        """Read one of the recordings, with all columns that can be known.

        Without a route these are the columns that were recorded.

        Raises:
            ModelError: the file, or the profile that the drive followed, cannot be used.
        """
        recording = read_recording(path, self.map)
        self.seen(path, recording)
        if self.route is None:
            return recording
        participant, phase = next(drive for drive, one in self.listed[0].items() if one == path)
        function = self._function
        if phase[0] == "A" or all(name in recording for name in _LEARNED):
            return completed(recording, function, str(path))
        try:
            stored = self._followed(participant, phase)
        except ModelError:
            if "set_speed_offset_mps" not in recording:
                raise
            stored = None  # a profile less in a figure
        if stored is None:
            return completed(recording, function, str(path), profile_known=False)
        function = self._follower
        function.follow(stored)
        whole = completed(recording, function, str(path))
        text = f"followed iteration {len(stored.iterations)} of its learned profile"
        return replace(whole, notes=(*whole.notes, Finding("note", str(path), 0, "", text)))

    def _followed(self, participant: str, phase: str) -> StoredProfile | None:
        """Return the profile as it was before a drive of B; None if there are no profiles."""
        return self._profiles.followed(participant, phase) if self._profiles else None

    @cached_property
    def _function(self) -> DrivingFunction:
        """The function on the route, with the base profile."""
        return self._prepared()

    @cached_property
    def _follower(self) -> DrivingFunction:
        """The same, for profiles that were learned."""
        return self._prepared()

    def _prepared(self) -> DrivingFunction:
        assert self.route is not None
        function = DrivingFunction()
        function.prepare(self.route)
        return function

    @cached_property
    def _profiles(self) -> Profiles | None:
        """The learned profiles, if they are there."""
        folder = self.profiles or self.folder / PROFILES
        if self.route is None or not (self.profiles or folder.is_dir()):
            return None
        return Profiles(folder, self.route, self.order())
