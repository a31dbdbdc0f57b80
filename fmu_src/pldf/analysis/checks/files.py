"""One file checked by the reader of its kind."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from vehicle_models.driver_script import read_script
from vehicle_models.lead_script import read_traffic

from ...errors import ModelError
from ...files.tables import read_table
from ...findings import Finding
from ...kernel.arrays import RouteArrays
from ...profiles.store import read_profile
from ...recordings.contradictions import contradictions
from ...recordings.mapping import RecordingMap, read_map, remembered_map
from ...recordings.quality import quality_of
from ...recordings.recording import Recording, read_recording
from ...roads import AS_WRITTEN, RoadOptions, read_route
from ...roads.options import OptionNeededError
from ...route_facts import route_facts
from ...study.participants_file import read_participants
from ...study.study_file import read_study
from ..drives_table import read_drives
from ..exclusions import read_exclusions
from ..long_run import read_long_run
from ..problems import findings_of
from ..questionnaires import read_questionnaire, survey_map
from .asam import asam_findings
from .checked import CheckedFile
from .kinds import PEOPLE, Kind, is_opendrive, kind_of
from .names import people

_UNKNOWN: Final = (
    "neither a road, a recording, a questionnaire, a table of drives or participants, a long "
    "run, a driver or traffic script, a profile, a study file nor a mapping file"
)


class Known(NamedTuple):
    """What is known about the files.

    Attributes:
        route: the road driven, None if it is not known.
        map: what columns are called; None: a ``map.toml`` near the file, if there.
        road: how the files of roads are to be read.
        asam: ASAM's own checker is asked about OpenDRIVE files, if it is installed.
    """

    route: RouteArrays | None = None
    map: RecordingMap | None = None
    road: RoadOptions = AS_WRITTEN
    asam: bool = False


def check_file(path: Path, known: Known) -> CheckedFile:
    """Return all that is wrong with the file ``path``, and what it was taken for."""
    kind: Kind = ""
    try:
        kind = kind_of(path)
        if not kind:
            raise ModelError(f"{path}: {_UNKNOWN}")
        if kind == "recording":
            return check_recording(path, known)
        findings = _CHECKS[kind](path, known)
    except ModelError as error:
        findings = findings_of(error, str(path))
    if known.asam and kind == "road" and is_opendrive(path):
        findings += asam_findings(path, findings)
    return CheckedFile(path, kind, tuple(findings))


def check_recording(path: Path, known: Known) -> CheckedFile:
    """Return what is wrong with a recording, and how good it is."""
    try:
        recording = read_recording(path, known.map)
    except ModelError as error:
        return CheckedFile(path, "recording", tuple(findings_of(error, str(path))))
    return checked_recording(recording, path, known)


def checked_recording(recording: Recording, path: Path, known: Known) -> CheckedFile:
    """Return what contradicts itself in a recording that was read, and how good it is."""
    return CheckedFile(
        path,
        "recording",
        (*recording.notes, *contradictions(recording, path, known.route)),
        quality_of(recording, known.route),
        content="" if _hands_off(recording) else _content(recording),
    )


def _hands_off(recording: Recording) -> bool:
    """Whether nobody did anything: then everybody's drive is the same where nothing is random."""
    done = ("gas_pedal", "brake_pedal", "set_speed_offset_mps")
    return all(name in recording.columns and not np.any(recording[name]) for name in done)


def _content(recording: Recording) -> str:
    """Return what tells drives apart, however the file is written."""
    digest = hashlib.sha256()
    for name in ("time_s", "s_m", "speed_mps"):
        digest.update(np.ascontiguousarray(recording[name]).tobytes())
    return digest.hexdigest()


def _road(path: Path, known: Known) -> list[Finding]:
    try:
        route = read_route(path, known.road)
    except OptionNeededError as error:
        if _says_a_way(known.road) or not _says_a_way(error.suggested):
            raise
        return [_no_way(one) for one in findings_of(error, str(path))]
    facts = route_facts(route)
    return [
        *route.notes,
        Finding(
            "note", str(path), 0, "",
            f"a road of {route.length_m:.0f} m, {len(facts.limits)} limits, "
            f"{len(facts.curves)} curves that bind",
        )
    ]  # fmt: skip


def _says_a_way(options: RoadOptions) -> bool:
    return bool(options.start_road or options.via or options.to)


def _no_way(needed: Finding) -> Finding:
    """Return that only the file was checked: that a network offers a choice is no fault of it."""
    consequence = "no way was named, so links, limits and curves along one were not checked"
    return needed._replace(severity="note", consequence=consequence)


def _drives(path: Path, _known: Known) -> list[Finding]:
    notes: list[Finding] = []
    drives = read_drives(path, None, notes)
    return [*notes, *people((drive.participant for drive in drives), str(path))]


def _questionnaire(path: Path, known: Known) -> list[Finding]:
    found = known.map or remembered_map(path)
    names = survey_map(found.questionnaire, found.name) if found else None
    answers = read_questionnaire(path, names=names)
    who = dict.fromkeys(name for given in answers.items.values() for name, _ in given)
    return [*answers.notes, *people(who, str(path))]


def _people(path: Path, _known: Known) -> list[Finding]:
    table = read_table(path, PEOPLE)
    who = table.texts["participant"]
    table.refuse(
        table.fault(row, "", f"{who[row]} occurs twice, first in line {line}")
        for row, line in table.repeated(who)
    )
    return [*table.notes, *people(who, str(path))]


def _exclusions(path: Path, _known: Known) -> list[Finding]:
    return list(read_exclusions(path).notes)


def _participants(path: Path, _known: Known) -> list[Finding]:
    notes: list[Finding] = []
    read_participants(path, notes)
    return notes


def _script(path: Path, _known: Known) -> list[Finding]:
    return list(read_script(path).notes)


def _traffic(path: Path, _known: Known) -> list[Finding]:
    return list(read_traffic(path).notes)


def _profile(path: Path, _known: Known) -> list[Finding]:
    profile = read_profile(path)
    text = f"a profile of {profile.nodes - 1} m with {len(profile.iterations)} iterations"
    return [Finding("note", str(path), 0, "", text)]


def _long_run(path: Path, _known: Known) -> list[Finding]:
    text = f"a long run with the variants {', '.join(read_long_run(path))}"
    return [Finding("note", str(path), 0, "", text)]


def _study_file(path: Path, _known: Known) -> list[Finding]:
    study = read_study(path)
    text = f"a study of {len(study.participants)} participants: {study.title}"
    return [*study.notes, Finding("note", str(path), 0, "", text)]


def _map(path: Path, _known: Known) -> list[Finding]:
    found = read_map(path)
    survey_map(found.questionnaire, found.name)
    return []


_CHECKS: Final[Mapping[Kind, Callable[[Path, Known], list[Finding]]]] = {
    "road": _road,
    "drives": _drives,
    "long run": _long_run,
    "questionnaire": _questionnaire,
    "participants": _participants,
    "people": _people,
    "exclusions": _exclusions,
    "driver script": _script,
    "traffic script": _traffic,
    "profile": _profile,
    "study file": _study_file,
    "mapping file": _map,
}
