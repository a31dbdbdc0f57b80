"""The folder of a simulated study: parts while it runs, tables when it is complete.

A part holds the drives of one participant. It is written at once and for good, so an interrupted
study goes on with the participants that are missing; when all are there, the parts become
``drives.csv``.
"""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from .. import __version__
from ..compiled import digest
from ..cosim.fmu import Fmu
from ..errors import ModelError
from ..files.disk import free_name, reason, rename_file, replace_file
from ..files.tables import Cell, write_table
from ..instance import Instance
from ..kernel.signals import signals_of
from ..roads import fingerprint, route_arrays
from .drive_row import COLUMNS
from .own_files import (
    DAMAGED,
    DRIVES,
    FOLDERS,
    PARTICIPANTS,
    PARTS,
    STUDY,
    TABLES,
    VERSIONS,
    clear,
    clear_parts,
    is_hardly_begun,
    is_old_study,
    is_study,
)
from .part import part_json, read_part
from .participants import Participant, order_of
from .participants_file import participants_csv
from .simulation import COMPILED_MODULES, function_and_vehicle
from .study_file import Study
from .unit import ParticipantResult


class StudyResults:
    """The results of ``study`` in the folder ``out``, driven by ``fmus`` (None: the kernels).

    Raises:
        ModelError: the folder holds results of another study, or of this one with other versions.
    """

    def __init__(self, study: Study, out: Path, fmus: Mapping[str, Fmu] | None = None) -> None:
        self.study = study
        self.out = out
        self._identity = {
            VERSIONS: _versions(study, fmus),  # first: it says whose the folder is
            STUDY: study.source.encode(),
            PARTICIPANTS: participants_csv(study.participants),
        }

    def open(self, restart: bool) -> list[str]:
        """Make the folder ready for what is missing; ``restart``: for everything.

        Returns:
            What was put aside since it is damaged, a sentence each.

        Raises:
            ModelError: the folder is that of something else, or cannot be written.
        """
        cleared = restart and clear(self.out)
        if is_study(self.out):
            self._require_same()
        else:
            self._require_free(cleared)
        self.out.mkdir(parents=True, exist_ok=True)
        for name, content in self._identity.items():
            self._write(self.out / name, content)
        (self.out / PARTS).mkdir(exist_ok=True)
        return [] if self.complete else list(self._put_damaged_aside())

    def missing(self) -> list[Participant]:
        """Return the participants without results, in order."""
        if self.complete:
            return []
        there = {path.stem for path in (self.out / PARTS).glob("*.json")}
        return [person for person in self.study.participants if person.id not in there]

    @property
    def complete(self) -> bool:
        """Whether all drives are in ``drives.csv``."""
        return (self.out / DRIVES).exists()

    def keep(self, result: ParticipantResult) -> None:
        """Write what came out for one participant; its part comes last."""
        for name, content in result.files.items():
            path = self.out / name
            path.parent.mkdir(exist_ok=True)
            self._write(path, content)
        self._write(self._part(result.participant), part_json(result.rows))

    def merge(self) -> None:
        """Make the tables from all parts and take the parts away."""
        if not self.complete:
            rows = [row for person in self.study.participants for row in self._rows(person)]
            columns = zip(*rows, strict=True)
            write_table(self.out / DRIVES, dict(zip(COLUMNS, columns, strict=True)))
        clear_parts(self.out)

    def _part(self, participant: str) -> Path:
        return self.out / PARTS / f"{participant}.json"

    def _rows(self, person: Participant) -> list[list[Cell]]:
        """Return the rows of one participant's drives."""
        path = self._part(person.id)
        phases = [phase.name for phase in order_of(self.study.settings, person)]
        try:
            return read_part(path, person.id, phases)
        except ValueError as problem:
            raise ModelError(
                f"{path}: damaged ({problem}); the same command drives {person.id} anew"
            ) from None

    def _put_damaged_aside(self) -> Iterator[str]:
        missing = {person.id for person in self.missing()}
        for person in self.study.participants:
            if person.id in missing:
                continue
            try:
                self._rows(person)
            except ModelError as problem:
                (self.out / DAMAGED).mkdir(exist_ok=True)
                aside = free_name(self.out / DAMAGED / person.id, ".json")
                rename_file(self._part(person.id), aside)
                told, _, _ = str(problem).rpartition("; ")
                yield f"{told}; it is kept as {aside}, {person.id} is driven anew"

    def _write(self, path: Path, content: bytes) -> None:
        try:
            replace_file(path, content)
        except OSError as error:
            raise ModelError(
                f"{path}: cannot be written ({reason(error)}); what is done is kept, the same "
                "command goes on when it can be"
            ) from None

    def _require_free(self, cleared: bool) -> None:
        """Refuse a folder in which something else is, under the names that a study writes."""
        if is_old_study(self.out):
            raise ModelError(
                f"{self.out}: holds a study of release 0.1.0; choose another --out, or drive "
                "everything anew with --restart"
            )
        names = TABLES if cleared else (*TABLES, *FOLDERS)
        there = [name for name in names if (self.out / name).exists()]
        if there and not is_hardly_begun(self.out):
            raise ModelError(
                f"{self.out}: holds files that are not from a study of participants; choose "
                f"another --out ({', '.join(there)} may be yours)"
            )

    def _require_same(self) -> None:
        for name in (STUDY, VERSIONS, PARTICIPANTS):  # what tells most comes first
            path, content = self.out / name, self._identity[name]
            if path.exists() and path.read_bytes() != content:
                raise ModelError(
                    f"{self.out}: holds results of another study or version ({name} differs); "
                    "choose another --out, or drive everything anew with --restart"
                )


def _versions(study: Study, fmus: Mapping[str, Fmu] | None) -> bytes:
    """Return what the results depend on beside the study file, as JSON."""
    function, vehicle = function_and_vehicle(study.settings)
    models: dict[str, Instance[Any]] = {"pldf": function, "vehicle": vehicle}
    route = hashlib.sha256()
    for column in route_arrays(study.settings.route):
        route.update(np.asarray(column).tobytes())
    described = {
        "title": study.title,
        "through": ", ".join(sorted({fmu.about for fmu in fmus.values()})) if fmus else "kernels",
        "adaptive-pldf": __version__,
        "source": digest(COMPILED_MODULES),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": version("numba"),
        "machine": platform.machine(),
        "route": study.settings.route.name,
        "route_fingerprint": fingerprint(study.settings.route),
        "route_sha256": route.hexdigest(),
        "participants": len(study.participants),
        "parameters": {
            part: {
                signal.name: getattr(model.record, signal.field)
                for signal in signals_of(model.record)
                if signal.causality == "parameter"
            }
            for part, model in models.items()
        },
    }
    return (json.dumps(described, indent=2) + "\n").encode()
