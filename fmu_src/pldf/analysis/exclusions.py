"""Who and which drives are left out of a study, and why: ``exclusions.csv`` and ``--without``."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

from ..files.tables import Column, Format, read_table
from ..findings import Finding
from ..study.drive_row import PHASE
from .names import key_of

EXCLUSIONS: Final = "exclusions.csv"
_FORMAT: Final = Format(
    "list of exclusions",
    "exclusion",
    (
        Column("participant", "text", wanted="the name of a participant"),
        Column(
            "phase", "text", pattern=PHASE.pattern, needed=False, blank=True,
            wanted="A or B and the number of the drive, such as A1, nor empty for all drives",
        ),
        Column("reason", "text", wanted="a reason, which the report quotes"),
    ),
    rows_min=0,
    key=("participant", "phase"),
)  # fmt: skip


class Exclusion(NamedTuple):
    """One thing left out.

    Attributes:
        participant: who; or a file of recordings without its ending, whatever it is called.
        phase: which drive; empty: all.
        reason: why.
        source: what says so, file and line or an option.
    """

    participant: str
    phase: str
    reason: str
    source: str

    @property
    def what(self) -> str:
        """Who and which drive, for people."""
        return f"{self.participant} {self.phase}".strip()


@dataclass(frozen=True)
class Exclusions:
    """All that is left out, and how it was read."""

    listed: tuple[Exclusion, ...] = ()
    notes: tuple[Finding, ...] = ()

    def has(self, participant: str, phase: str = "") -> bool:
        """Tell whether a participant, or one drive of theirs, is left out."""
        who, drive = key_of(participant), key_of(f"{participant}_{phase}")
        return any(
            (key_of(one.participant) == who and one.phase in ("", phase))
            or (phase and not one.phase and key_of(one.participant) == drive)
            for one in self.listed
        )

    def has_file(self, name: str) -> bool:
        """Tell whether the recording in the file ``name``, without its ending, is left out."""
        participant, _, phase = name.rpartition("_")
        named = any(key_of(one.participant) == key_of(name) for one in self.listed if not one.phase)
        return named or bool(participant and self.has(participant, phase))

    def idle(self, known: Collection[str]) -> Iterator[Finding]:
        """Yield what leaves nobody out; ``known`` are all participants, drives and files."""
        keys = {key_of(name) for name in known}
        for one in self.listed:
            if key_of(one.participant) not in keys:
                yield Finding(
                    "warning", one.source, 0, "", f"there is no participant {one.participant}",
                    "nothing is left out by it", "correct the name",
                )  # fmt: skip


def read_exclusions(path: Path, without: Collection[str] = ()) -> Exclusions:
    """Return what the file ``path``, if there is one, and the names in ``without`` leave out.

    Args:
        path: CSV with the columns participant, phase (empty: all drives) and reason.
        without: participants, drives (``PARTICIPANT_PHASE``) or names of files without ending.

    Raises:
        ModelError: naming file, line, column and value of all that is wrong.
    """
    named = [Exclusion(name, "", "no reason was given", "--without") for name in sorted(without)]
    if not path.exists():
        return Exclusions(tuple(named))
    table = read_table(path, _FORMAT)
    phases = table.texts.get("phase", [""] * len(table))
    rows = zip(table.texts["participant"], phases, table.texts["reason"], table.lines, strict=True)
    listed = [Exclusion(who, drive, why, f"{path.name}, line {at}") for who, drive, why, at in rows]
    return Exclusions((*listed, *named), tuple(table.notes))
