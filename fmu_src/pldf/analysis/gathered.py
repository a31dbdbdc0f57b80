"""The drives of a study, from its table or its recordings, with all that is wrong with them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..findings import Finding
from ..recordings.derived import NO_SET_SPEED
from ..recordings.recording import Recording
from ..study.drive_row import DriveRow
from ..study.own_files import DRIVES, RECORDINGS
from .drives_table import read_drives, row_of_recording
from .exclusions import EXCLUSIONS
from .problems import brought_together, findings_of
from .study_folder import StudyFolder

# Called with the number of recordings read and of all.
Reading = Callable[[int, int], None]

# What the rates are counted from.
_PEDALS_AND_LEVER: Final = ("brake_pedal", "set_speed_offset_mps")


@dataclass
class Gathered:
    """The drives of a study.

    Attributes:
        source: file or folder that they come from.
        drives: those that could be read.
        driven: participant and phase of all, those that could not be read included.
        problems: why the study cannot be analysed.
        notes: how the drives were read.
        met: names of participants, drives and files, those left out included.
    """

    source: Path
    drives: list[DriveRow] = field(default_factory=list)
    driven: list[tuple[str, str]] = field(default_factory=list)
    problems: list[Finding] = field(default_factory=list)
    notes: list[Finding] = field(default_factory=list)
    met: set[str] = field(default_factory=set)

    def meet(self, participant: str, phase: str) -> None:
        """Remember a drive, whether it is left out or not."""
        self.met |= {participant, f"{participant}_{phase}"}


def gather(study: StudyFolder, reading: Reading) -> Gathered:
    """Return all drives, from the table of drives if there is one, else from the recordings.

    Raises:
        ModelError: there is neither.
    """
    table = study.folder / DRIVES
    found = Gathered(table if table.exists() else study.folder / RECORDINGS)
    if table.exists():
        _read_table(study, found)
    elif not study.files():
        raise ModelError(
            f"{study.folder}: no drives.csv and no recordings/PARTICIPANT_PHASE.csv to analyse; "
            f"{_way_out(study.folder)}"
        )
    else:
        _read_recordings(study, found, reading)
    found.notes += (*study.exclusions.notes, *study.exclusions.idle(found.met))
    found.notes += [*study.others(), *_apart(study, found)]
    found.problems = brought_together(found.problems)
    found.notes = brought_together(found.notes)
    return found


def _way_out(folder: Path) -> str:
    """Return what to do in a folder without drives, which may be that of a study with variants."""
    within = sorted(table.parent for table in folder.glob(f"*/{DRIVES}"))
    if within:
        return f"{len(within)} of its folders have drives: name one of them, such as '{within[0]}'"
    return "name a folder that 'pldf study' wrote, or put recordings there"


def _apart(study: StudyFolder, found: Gathered) -> Iterator[Finding]:
    """Yield drives that are none of the study's."""
    own = [phase.name for phase in study.order()]
    apart = sorted({phase for _, phase in found.driven if phase not in own})
    if apart:
        yield Finding(
            "warning", str(found.source), 0, "",
            f"{', '.join(apart)} are none of the study's drives, {', '.join(own)}",
            "their means are in phases.csv, but they are in no comparison of A and B",
        )  # fmt: skip


def _read_table(study: StudyFolder, found: Gathered) -> None:
    def left_out(cells: Mapping[str, str]) -> bool:
        found.meet(cells["participant"], cells["phase"])
        return study.exclusions.has(cells["participant"], cells["phase"])

    try:
        rows = read_drives(found.source, left_out, found.notes)
    except ModelError as error:
        found.problems += findings_of(error, str(found.source))
        return
    for row in rows:
        who = study.names.take(row.participant, row.where)
        found.drives.append(replace(row, participant=who))
        found.driven.append((who, row.phase))


def _read_recordings(study: StudyFolder, found: Gathered, reading: Reading) -> None:
    for path in study.files():
        participant, _, phase = path.stem.rpartition("_")
        found.meet(participant, phase)
        found.met.add(path.stem)
    paths, problems = study.listed
    found.problems += problems
    silent: list[Path] = []
    for number, ((participant, phase), path) in enumerate(paths.items(), start=1):
        found.driven.append((participant, phase))
        try:
            recording = study.read(path)
        except ModelError as error:
            found.problems += findings_of(error, str(path))
        else:
            found.notes += recording.notes
            unknown = list(_unknown(study, recording, phase, str(path)))
            found.problems += unknown
            if not unknown:
                found.drives.append(row_of_recording(participant, phase, recording, str(path)))
            silent += [path for note in recording.notes if note.text == NO_SET_SPEED]
        reading(number, len(paths))
    if len(silent) < len(paths):
        found.problems += [_silent(str(path)) for path in silent]


def _unknown(study: StudyFolder, recording: Recording, phase: str, file: str) -> Iterator[Finding]:
    """Yield what the rates of a drive need and is neither recorded nor derived."""
    gone = [name for name in _PEDALS_AND_LEVER if name not in recording]
    if gone and study.route is None:
        profiles = ", and the learned profiles with --profiles" if phase[0] == "B" else ""
        yield Finding(
            "error", file, 0, "", f"no column {', '.join(gone)}", "",
            f"name the route driven with --route{profiles} to have it derived",
        )  # fmt: skip
    elif gone:
        yield Finding(
            "error", file, 0, "",
            f"no column {', '.join(gone)}, and what the function had learned before is not known",
            "a learned offset would count as set by the driver",
            "record set_speed_offset_mps, or name the folder of the learned profiles with "
            "--profiles",
        )  # fmt: skip


def _silent(file: str) -> Finding:
    return Finding(
        "error", file, 0, "", f"{NO_SET_SPEED}, but in other drives", "rates cannot be compared",
        f"record one of them, with zeros if nobody could set it, or leave them out ({EXCLUSIONS})",
    )  # fmt: skip
