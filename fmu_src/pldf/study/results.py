"""The folder of a simulated study: parts while it runs, tables when it is complete.

A part holds the drives of one participant. It is written at once and for good, so an interrupted
study goes on with the participants that are missing; when all are there, the parts become
``drives.csv``.
"""

from __future__ import annotations

import hashlib
import json
import platform
import shutil
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

import numpy as np

from .. import __version__
from ..compiled import digest
from ..cosim.fmu import Fmu
from ..errors import ModelError
from ..files.disk import replace_file
from ..files.tables import Cell, write_table
from ..instance import Instance
from ..kernel.signals import signals_of
from ..roads import fingerprint, route_arrays
from .drive_row import COLUMNS
from .participants import Participant
from .participants_file import participants_csv
from .simulation import COMPILED_MODULES, function_and_vehicle
from .study_file import Study
from .unit import ParticipantResult

DRIVES: Final = "drives.csv"
PARTICIPANTS: Final = "participants.csv"
STUDY: Final = "study.toml"
VERSIONS: Final = "versions.json"
_PARTS: Final = "parts"
_OURS: Final = (DRIVES, PARTICIPANTS, STUDY, VERSIONS, _PARTS, "recordings", "profiles")


class StudyResults:
    """The results of ``study`` in the folder ``out``, driven by ``fmus`` (None: the kernels).

    Raises:
        ModelError: the folder holds results of another study, or of this one with other versions.
    """

    def __init__(self, study: Study, out: Path, fmus: Mapping[str, Fmu] | None = None) -> None:
        self.study = study
        self.out = out
        self._identity = {
            STUDY: study.source.encode(),
            VERSIONS: _versions(study, fmus),
            PARTICIPANTS: participants_csv(study.participants),
        }

    def open(self, restart: bool) -> None:
        """Make the folder ready for what is missing; ``restart``: for everything."""
        if restart:
            self._clear()
        if (self.out / VERSIONS).exists():
            self._require_same()
        elif any((self.out / name).exists() for name in _OURS):
            raise ModelError(
                f"{self.out}: holds files that are not from a study of participants; choose "
                "another --out"
            )
        (self.out / _PARTS).mkdir(parents=True, exist_ok=True)
        for name, content in reversed(self._identity.items()):
            replace_file(self.out / name, content)

    def missing(self) -> list[Participant]:
        """Return the participants without results, in order."""
        if self.complete:
            return []
        there = {path.stem for path in (self.out / _PARTS).glob("*.json")}
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
            replace_file(path, content)
        rows = json.dumps([row.cells for row in result.rows])
        replace_file(self.out / _PARTS / f"{result.participant}.json", rows.encode())

    def merge(self) -> None:
        """Make the tables from all parts and take the parts away."""
        if not self.complete:
            rows = [row for person in self.study.participants for row in self._part(person.id)]
            columns = zip(*rows, strict=True)
            write_table(self.out / DRIVES, dict(zip(COLUMNS, columns, strict=True)))
        shutil.rmtree(self.out / _PARTS, ignore_errors=True)

    def _part(self, participant: str) -> list[list[Cell]]:
        """Return the rows of one participant's drives."""
        path = self.out / _PARTS / f"{participant}.json"
        rows: list[list[Cell]] = json.loads(path.read_bytes())
        return rows

    def _require_same(self) -> None:
        for name, content in self._identity.items():
            path = self.out / name
            if path.exists() and path.read_bytes() != content:
                raise ModelError(
                    f"{self.out}: holds results of another study or version ({name} differs); "
                    "choose another --out, or drive everything anew with --restart"
                )

    def _clear(self) -> None:
        """Take away an earlier study of participants, and nothing that somebody else put there."""
        if not (self.out / VERSIONS).exists():
            return
        for name in (_PARTS, "recordings", "profiles"):
            shutil.rmtree(self.out / name, ignore_errors=True)
        for name in (DRIVES, PARTICIPANTS, STUDY, VERSIONS):
            (self.out / name).unlink(missing_ok=True)


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
