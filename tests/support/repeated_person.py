"""A person's drive in the page, driven again by the FMUs of Python's master."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

from pldf.cosim import master
from pldf.cosim.fmu import BufferElement, Fmu, Slave
from pldf.cosim.values import FmuMessage, Value, Values


class Change(NamedTuple):
    """From this step on, an output of the person."""

    step: int
    name: str
    value: float


def read_changes(path: Path) -> list[Change]:
    """Return what a file of inputs holds."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return [Change(int(row["step"]), row["name"], float(row["value"])) for row in rows]


class RepeatedPerson:
    """Stands in for the driver FMU: as ``Slave``, with the outputs of a list."""

    def __init__(self, fmu: Fmu, fed: Iterable[str], changes: list[Change]) -> None:
        outputs = fmu.named("output")
        self.messages: list[FmuMessage] = []
        self._is_flag = {s.name: s.kind == "Boolean" for s in outputs}
        self._values: list[float] = [0 if flag else 0.0 for flag in self._is_flag.values()]
        self._heard = [0.0] * len(fmu.signals)
        self.outputs = {s.name: BufferElement(self._values, i) for i, s in enumerate(outputs)}
        self.inputs = {name: BufferElement(self._heard, i) for i, name in enumerate(fed)}
        self._changes = changes
        self._done = 0
        self._step: int | None = None  # before the first step nobody presses anything

    def set(self, values: Mapping[str, Value]) -> None:
        """Have no parameters."""

    def begin(self) -> None:
        """Have no initialization."""

    def ready(self) -> None:
        """Begin with the first step."""
        self._step = 0

    def write(self) -> None:
        """Look at nothing: all was decided."""

    def read(self) -> None:
        """Show what holds from this step on."""
        while (
            self._step is not None
            and self._done < len(self._changes)
            and self._changes[self._done].step <= self._step
        ):
            change = self._changes[self._done]
            if change.name in self.outputs:  # steering feeds no FMU
                value = int(change.value) if self._is_flag[change.name] else change.value
                self._values[self.outputs[change.name].at] = value
            self._done += 1

    def step(self, time_s: float, step_s: float) -> None:
        """Go on."""
        assert self._step is not None
        self._step += 1

    def terminate(self) -> None:
        """Have learned nothing."""

    def free(self) -> None:
        """Hold nothing."""


def drive_again(
    fmus: Mapping[str, Fmu],
    values: Values,
    changes: list[Change],
    length_m: float,
    step_s: float,
) -> master.Drive:
    """Drive as ``master.drive`` does, with a person in place of the driver FMU."""
    with patch.object(master, "Slave", partial(_part, changes)):
        return master.drive(fmus, values, length_m, step_s)


def _part(changes: list[Change], fmu: Fmu, part: str, fed: Iterable[str]) -> Slave | RepeatedPerson:
    return RepeatedPerson(fmu, fed, changes) if part == "driver" else Slave(fmu, part, fed)
