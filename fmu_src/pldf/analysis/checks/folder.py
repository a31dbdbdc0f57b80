"""The folder of a study checked: each file, and the files against each other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from ...errors import ModelError
from ...findings import Finding
from ...recordings.inputs import SUFFIXES
from ...recordings.mapping import MAP_FILE
from ...roads import route_arrays
from ...study.study_file import read_study
from ..analysis import analyse
from ..problems import findings_of
from ..study_folder import StudyFolder
from .checked import CheckedFile, Checks
from .files import Known, check_file, check_recording
from .names import people

Done = Callable[[int, int], None]

RECORDINGS: Final = "recordings"
_STUDY: Final = "study.toml"
_MARKS: Final = (RECORDINGS, "drives.csv", "questionnaire.csv", _STUDY, "participants.csv")
_TABLES: Final = (_STUDY, MAP_FILE, "participants.csv", "drives.csv")
_HALF: Final = 0.9  # of the way that the others drive


def is_study(folder: Path) -> bool:
    """Tell whether a folder is that of a study."""
    return any((folder / name).exists() for name in _MARKS)


def check_folder(study: StudyFolder, done: Done = lambda _done, _all: None) -> Checks:
    """Return all that is wrong with the files of a study, each and together.

    Args:
        study: the folder, and what is known about it.
        done: called with the number of recordings checked and of all.
    """
    checks = check_drives(study, done)
    known = Known(map=study.map)
    tables = [study.questionnaire, *(study.folder / name for name in _TABLES)]
    tables += sorted((study.folder / "profiles").glob("*.pldf"))
    checks += Checks(tuple(check_file(path, known) for path in tables if path.exists()))
    return checks + Checks(shared=tuple(_analysed(study)))


def check_drives(study: StudyFolder, done: Done = lambda _done, _all: None) -> Checks:
    """Return what is wrong with the recordings of a study, each and together."""
    known = Known(route_arrays(study.route) if study.route else None, study.map)
    paths = _recordings(study)
    files = []
    for number, path in enumerate(paths, start=1):
        checked = check_recording(path, known)
        participant, _, phase = path.stem.rpartition("_")
        files.append(replace(checked, participant=participant or path.stem, phase=phase))
        done(number, len(paths))
    if known.route is None:
        files = list(_with_half_drives(files))
    if not study.study_file:  # simulated drivers may well drive the same twice
        files = list(with_copies(files))
    names = people((file.participant for file in files), str(study.folder / RECORDINGS))
    return Checks(tuple(files), tuple(names))


def _recordings(study: StudyFolder) -> list[Path]:
    """Return the files of recordings that are not left out."""
    return [
        path
        for path in sorted((study.folder / RECORDINGS).glob("*.*"))
        if path.suffix.lower() in SUFFIXES
        and not study.without.intersection((path.stem, path.stem.rpartition("_")[0]))
    ]


def _analysed(study: StudyFolder) -> Iterator[Finding]:
    """Yield what an analysis says of tables and files together."""
    try:
        analysis = analyse(study)
    except ModelError as error:
        yield from findings_of(error, str(study.folder))
        return
    yield from analysis.notes
    if not (study.folder / RECORDINGS).is_dir():
        yield from people(analysis.participants, str(analysis.source))


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


def with_own_road(study: StudyFolder) -> StudyFolder:
    """Return a simulated study with the road of its study file, if none was named."""
    path = study.folder / _STUDY
    if study.route is not None or not path.exists():
        return study
    try:
        return replace(study, route=read_study(path).settings.road.route)
    except ModelError:
        return study  # what is wrong with the study file is told on its own
