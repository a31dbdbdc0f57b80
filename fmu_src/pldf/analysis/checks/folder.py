"""The folder of a study checked: each file, and the files against each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding
from ...recordings.against_road import COVERAGE
from ...recordings.mapping import MAP_FILE
from ...recordings.recording import Recording
from ...roads import read_route, route_arrays
from ...study.own_files import DRIVES, PARTICIPANTS, PROFILES, RECORDINGS, STUDY
from ...study.study_file import read_study
from ..analysis import Analysis, analyse
from ..exclusions import EXCLUSIONS
from ..gathered import Reading
from ..problems import StudyError, findings_of
from ..questionnaires import SurveyMap
from ..study_folder import OWN_ROAD, StudyFolder
from .checked import CheckedFile, Checks
from .files import Known, check_file, check_recording, checked_recording
from .names import people

_MARKS: Final = (RECORDINGS, DRIVES, SurveyMap.file, STUDY, PARTICIPANTS)
_TABLES: Final = (STUDY, MAP_FILE, EXCLUSIONS, PARTICIPANTS, DRIVES)
_HALF: Final = 0.9  # of the way that the others drive


def _silently(_done: int, _all: int) -> None:
    """Tell nobody how far reading has come."""


def is_study(folder: Path) -> bool:
    """Tell whether a folder is that of a study."""
    return any((folder / name).exists() for name in _MARKS)


def check_folder(study: StudyFolder, reading: Reading = _silently) -> Checks:
    """Return all that is wrong with the files of a study, each and together.

    Args:
        study: the folder, and what is known about it.
        reading: called with the number of recordings read and of all.
    """
    _, checks = _analysed(study, reading, every_recording=True)
    known = Known(map=study.map)
    tables = [study.folder / name for name in _TABLES]
    tables += sorted((study.folder / PROFILES).glob("*.pldf"))
    with suppress(ModelError):  # if its map is wrong, that is among the findings
        tables.append(study.questionnaire)
    return checks + Checks(tuple(check_file(path, known) for path in tables if path.exists()))


def analysed(study: StudyFolder, reading: Reading = _silently) -> tuple[Analysis, Checks]:
    """Return the analysis of a study whose files were checked first, and what the check found.

    The warnings are among the notes of the analysis. Of a simulated study only the recordings that
    its rates come from are checked.

    Raises:
        StudyError: with all that is wrong.
    """
    analysis, checks = _analysed(study, reading, every_recording=not study.study_file)
    errors = checks.of("error")
    if analysis is None or errors:
        raise StudyError(errors)
    notes = (*analysis.notes, *checks.of("warning"))
    return replace(analysis, notes=tuple(dict.fromkeys(notes))), checks


def _analysed(
    study: StudyFolder, reading: Reading, every_recording: bool
) -> tuple[Analysis | None, Checks]:
    """Analyse and check in one reading of the recordings; no analysis if there are errors."""
    known = Known(route_arrays(study.route) if study.route else None, study.map)
    checked: dict[Path, CheckedFile] = {}

    def take(path: Path, recording: Recording) -> None:
        checked[path] = checked_recording(recording, path, known)

    analysis = None
    try:
        analysis = analyse(replace(study, seen=take), reading)
        shared = list(analysis.notes)
    except ModelError as error:
        shared = findings_of(error, str(study.folder))
    drives, left_out = _drives(study)
    for path in study.files() if every_recording else ():
        if path not in checked and path not in left_out:
            checked[path] = check_recording(path, known)
    files = [
        replace(file, participant=drives[path][0], phase=drives[path][1])
        if path in drives else file for path, file in sorted(checked.items())
    ]  # fmt: skip
    files = list(map(_told_half, files) if known.route else _with_half_drives(files))
    if not study.study_file:  # simulated drivers may well drive the same twice
        files = list(with_copies(files))
    people_of = list(analysis.participants) if analysis else [who for who, _ in drives.values()]
    return analysis, Checks(tuple(files), (*shared, *people(people_of, str(study.folder))))


def _drives(study: StudyFolder) -> tuple[dict[Path, tuple[str, str]], set[Path]]:
    """Return participant and phase of each recording that tells them, and what is left out."""
    try:
        drives = {path: drive for drive, path in study.listed[0].items()}
        left_out = {path for path in study.files() if study.exclusions.has_file(path.stem)}
    except ModelError:
        return {}, set()  # the exclusions cannot be read, which is among the findings
    return drives, left_out


def with_copies(files: Sequence[CheckedFile]) -> Iterator[CheckedFile]:
    """Yield the files; one with the samples of an earlier one says so."""
    first: dict[str, CheckedFile] = {}
    for file in files:
        same = first.setdefault(file.content, file) if file.content else file
        yield file if same is file else _with(file, _copy(file, same))


def _copy(file: CheckedFile, same: CheckedFile) -> Finding:
    return Finding(
        "warning", str(file.path), 0, "", f"the samples of {same.path.name} under another name",
        "one drive counts as two, and one of them is missing",
        "put the right recording there, or leave this one out",
    )  # fmt: skip


def _told_half(file: CheckedFile) -> CheckedFile:
    """Return the file; that it covers a part of the road only counts more where rates are taken."""
    findings = (
        one._replace(severity="warning") if one.place == COVERAGE else one for one in file.findings
    )
    return replace(file, findings=tuple(findings))


def _with_half_drives(files: Sequence[CheckedFile]) -> Iterator[CheckedFile]:
    """Yield the files; where the road is not known, the others tell how long a drive is."""
    ways = {f.path: f.quality.to_m - f.quality.from_m for f in files if f.quality}
    usual = float(np.median(list(ways.values()))) if len(ways) > 2 else 0.0
    for file in files:
        way = ways.get(file.path, usual)
        yield file if way >= _HALF * usual else _with(file, _half(file, way, usual))


def _half(file: CheckedFile, way: float, usual: float) -> Finding:
    return Finding(
        "warning", str(file.path), 0, "s_m",
        f"{way:.0f} m, {100 * way / usual:.0f} % of the {usual:.0f} m of the other drives",
        "rates are those of this part",
        "was the drive broken off? leave it out, or say so in the report",
    )  # fmt: skip


def _with(file: CheckedFile, finding: Finding) -> CheckedFile:
    return replace(file, findings=(*file.findings, finding))


def with_road_beside(study: StudyFolder) -> StudyFolder:
    """Return a study with the road that a cockpit left in its folder, if none was named.

    Raises:
        ModelError: it is no road any more.
    """
    path = study.folder / OWN_ROAD
    if study.route is not None or not path.is_file():
        return study
    return replace(study, route=read_route(path))


def with_own_road(study: StudyFolder) -> StudyFolder:
    """Return a study with the road in its folder or its study file, if none was named."""
    study = with_road_beside(study)
    path = study.folder / STUDY
    if study.route is not None or not path.exists():
        return study
    try:
        return replace(study, route=read_study(path).settings.road.route)
    except ModelError:
        return study  # what is wrong with the study file is told on its own
