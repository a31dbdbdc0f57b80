"""One running model: its record, its arrays, its messages, and all of them as bytes.

The three models (driving function, vehicle, driver) derive from ``Instance``. The FMI binding, the
co-simulation and the in-process study see nothing but this class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Generic, Literal, TypeVar, cast

import numpy as np

from . import snapshot
from .errors import ModelError
from .findings import Finding
from .kernel.arrays import FloatArray, Floats
from .kernel.signals import Signal, signals_of

Arrays = tuple[FloatArray, ...]
Level = Literal["info", "warning", "error"]
RecordT = TypeVar("RecordT")
TupleT = TypeVar("TupleT", bound=tuple[Any, ...])


@dataclass(frozen=True)
class Message:
    """Something the user of a model should know; never one per step."""

    level: Level
    text: str


@dataclass(frozen=True)
class Watch:
    """A field of the record whose changes the user is told about.

    Attributes:
        field: name of an integer field; 0 is the normal value.
        texts: one per value.
        once: told once per drive, by the first step that meets it; else with the time, on each
            change.
        flag: field that is set to 1 once it was told, empty without ``once``.
        quiet: values that are no reason for a warning.
    """

    field: str
    texts: tuple[str, ...]
    once: bool = False
    flag: str = ""
    quiet: tuple[int, ...] = (0,)


class Instance(Generic[RecordT]):
    """A model that can be initialized, stepped, finished, saved and restored.

    Attributes:
        record: flat record of numbers, its class is the model's table of signals.
        texts: record of Strings (a dataclass instance without fields if there are none).
        arrays: every float64 array that belongs to the state; set by ``initialize``.
        messages: what the binding has not yet handed to the user.
        groups: named tuples of arrays that make up ``arrays``; those of one are equally long, those
            of the first have a value per node.
    """

    groups: ClassVar[tuple[Any, ...]]

    def __init__(self, record: RecordT, texts: Any) -> None:
        self.record = record
        self.texts = texts
        self.arrays: Arrays = ()
        self.messages: list[Message] = []

    def initialize(self) -> None:
        """Prepare arrays and outputs from the parameters; raise ModelError if they are unusable."""
        raise NotImplementedError

    def refresh(self) -> None:
        """Recompute the outputs from the inputs without advancing (initialization, feedthrough)."""
        raise NotImplementedError

    def step(self, step_s: float) -> None:
        """Advance by one communication step of ``step_s`` > 0 seconds."""
        raise NotImplementedError

    def say(self) -> None:
        """Bring the String outputs up to date with the record; who has none says nothing."""

    def finish(self) -> None:
        """Do what the end of a drive asks for; called once, whatever way the drive ended."""

    def report(self, level: Level, text: str) -> None:
        """Add a message for the user."""
        self.messages.append(Message(level, text))

    def report_watched(self, watch: Watch, value: int, time_ns: int) -> None:
        """Add what ``watch`` says of a field that has another value since this time."""
        level: Level = "info" if value in watch.quiet else "warning"
        self.report(level, f"t = {1e-9 * time_ns:.3f} s: {watch.texts[value]}")

    def tell(self, findings: Iterable[Finding]) -> None:
        """Report how a file of the user was read."""
        for finding in findings:
            self.report("warning" if finding.severity == "warning" else "info", str(finding))

    def check_parameters(self) -> None:
        """Raise ModelError for the first numeric parameter outside its declared range."""
        for signal in signals_of(self.record):
            if signal.causality == "parameter":
                require_in_range(signal, getattr(self.record, signal.field))

    def clear_memory(self) -> None:
        """Set everything but parameters and inputs to its start value."""
        kept = {s.field for s in signals_of(self.record) if s.causality in ("parameter", "input")}
        for f in fields(self.record):  # type: ignore[arg-type]
            if f.name not in kept:
                setattr(self.record, f.name, f.default)

    def attach(self, arrays: Arrays) -> None:
        """Make ``arrays`` the memory of this instance; models that give them names extend this."""
        self.arrays = arrays

    def snapshot(self) -> bytes:
        """Return the whole state as bytes."""
        return snapshot.encode(self)

    def restore(self, state: bytes) -> None:
        """Take over a state made by ``snapshot`` of the same model and build.

        Raises:
            ModelError: it was not, or a value is out of its range; nothing has changed.
        """
        found = snapshot.decode(self, state)
        for name, number in found.numbers.items():
            setattr(self.record, name, number)
        for name, text in found.texts.items():
            setattr(self.texts, name, text)
        self.attach(found.arrays)


def require_in_range(parameter: Signal, value: float) -> None:
    """Raise ModelError if ``value`` is outside the parameter's declared range, or NaN."""
    low, high = parameter.range
    if not low <= value <= high:
        raise ModelError(
            f"parameter {parameter.name} = {value}: it must lie between {low:g} and {high:g}"
        )


def view(array: FloatArray) -> Floats:
    """Return a memoryview of ``array``, the form in which CPython runs the kernels."""
    return cast(Floats, memoryview(cast(Any, array)))


def views(arrays: TupleT) -> TupleT:
    """Return the same named tuple of arrays with a memoryview in place of each array."""
    return type(arrays)(*[cast(Any, view(array)) for array in arrays])


def zeros(kind: Callable[..., TupleT], nodes: int) -> TupleT:
    """Return a named tuple of ``kind`` with an array of ``nodes`` zeros for each field."""
    names: tuple[str, ...] = cast(Any, kind)._fields
    return kind(*(np.zeros(nodes) for _ in names))
