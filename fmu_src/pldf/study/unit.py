"""The unit of work of a study: one participant. Values in, values out; it can run anywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ..cosim.fmu import Fmu
from ..cosim.values import FmuMessage
from ..profiles.profile_file import encode
from ..profiles.store import ProfileStore
from ..recordings.recording import recording_csv
from .drive_row import DriveRow
from .participants import DriveResult, Participant, StudySettings
from .simulation import prepared, simulate_participant
from .through_fmus import Watch, drive_participant


@dataclass(frozen=True, eq=False)
class Job:
    """What every unit needs.

    Attributes:
        settings: of the study.
        fmus: drive through these unpacked FMUs; None: in process.
    """

    settings: StudySettings
    fmus: dict[str, Fmu] | None = None


@dataclass(frozen=True)
class ParticipantResult:
    """What came out for one participant.

    Attributes:
        participant: id.
        rows: one per drive, in order.
        files: content of the files kept, by path within the study's folder.
        warnings: of the FMUs, each once.
    """

    participant: str
    rows: tuple[DriveRow, ...]
    files: dict[str, bytes]
    warnings: tuple[FmuMessage, ...] = ()


def _unwatched(_: float) -> None:
    """Nobody wants to know how far the participant has come."""


def do_unit(job: Job, participant: Participant, watch: Watch = _unwatched) -> ParticipantResult:
    """Drive all phases with one participant."""
    if job.fmus is None:
        drives = simulate_participant(job.settings, participant)
    else:
        drives = drive_participant(job.fmus, job.settings, participant, watch)
    kept = participant.id in job.settings.recorded
    return ParticipantResult(
        participant.id,
        tuple(drive.row for drive in drives),
        _files(job.settings, participant, drives) if kept else {},
        tuple(dict.fromkeys(warning for drive in drives for warning in drive.warnings)),
    )


def _files(
    settings: StudySettings, participant: Participant, drives: Sequence[DriveResult]
) -> dict[str, bytes]:
    files = {
        f"recordings/{participant.id}_{drive.row.phase}.csv": recording_csv(drive.recording)
        for drive in drives
        if drive.recording is not None
    }
    learned = tuple(drive.iteration for drive in drives if drive.iteration is not None)
    if learned:
        blank = prepared(settings).stored_for(participant)
        name = ProfileStore("profiles").path(blank.driver_id, blank.route).name
        files[f"profiles/{name}"] = encode(replace(blank, iterations=learned))
    return files
