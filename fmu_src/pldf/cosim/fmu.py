"""FMUs as seen from an importer: unpacked once, instantiated for every drive, read in batches.

Knows FMI 2.0 and fmpy, nothing of driving. What an FMU has to say through its logger is collected.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable, Mapping
from contextlib import chdir
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, cast

from ..errors import ModelError
from ..instance import Level
from ..kernel.signals import Causality, Enumeration, Kind, Signal
from .values import FmuMessage, Value

# ruff: noqa: PLC0415 - fmpy is slow to import, and most studies drive no FMUs

_LEVELS: Final[tuple[Level, ...]] = ("info", "warning", "error", "error", "error", "info")
_WRAPPERS_NOTE: Final = "Fatal py exception"  # says only that pythonfmu caught something
_C_TYPES: Final[dict[str, Any]] = {
    "Real": ctypes.c_double,
    "Integer": ctypes.c_int32,
    "Boolean": ctypes.c_int32,
}


@dataclass(frozen=True, slots=True)
class BufferElement:
    """Where the value of one variable lies: element ``at`` of a batch's buffer."""

    buffer: Any
    at: int

    @property
    def value(self) -> float:
        """The value as a number; Booleans are 0 or 1."""
        number: float = self.buffer[self.at]
        return number


@dataclass(frozen=True, slots=True)
class _Batch:
    """All variables of one type that travel together."""

    type: str
    references: Any  # C array of value references
    count: int
    buffer: Any


@dataclass(frozen=True, eq=False)
class Fmu:
    """An unpacked FMU.

    Attributes:
        folder: where it was unpacked.
        description: fmpy's model description.
        signals: variables by name; ``field`` equals ``name``.
        references: value references by name.
    """

    folder: Path
    description: Any
    signals: dict[str, Signal]
    references: dict[str, int]

    @property
    def native(self) -> bool:
        """Whether it needs no Python."""
        return not self.description.coSimulation.needsExecutionTool

    @property
    def about(self) -> str:
        """Kind and version: what decides the results."""
        return f"{'native' if self.native else 'Python'} FMU, version {self.description.version}"

    def named(self, causality: Causality) -> list[Signal]:
        """Return the variables of one causality in the order of the FMU."""
        return [s for s in self.signals.values() if s.causality == causality]


def unpack(path: Path, folder: Path) -> Fmu:
    """Unpack the FMU ``path`` into ``folder``.

    Raises:
        ModelError: it is not there or not an FMU for co-simulation.
    """
    import fmpy  # type: ignore[import-untyped]

    description = describe(path)
    try:
        fmpy.extract(str(path), unzipdir=str(folder))
    except Exception as error:  # fmpy raises bare Exception for all that is wrong with an archive
        raise _unusable(path, error) from error
    return described(description, folder)


def described(description: Any, folder: Path) -> Fmu:
    """Return the FMU of fmpy's ``description`` that was unpacked into ``folder``."""
    items = {
        kind.name: Enumeration(kind.name, tuple(item.name for item in kind.items))
        for kind in description.typeDefinitions
        if kind.items
    }
    variables = description.modelVariables
    signals = {v.name: _signal(v, items) for v in variables}
    return Fmu(folder, description, signals, {v.name: v.valueReference for v in variables})


def describe(path: Path) -> Any:
    """Return fmpy's description of the FMU ``path``; ModelError as ``unpack``."""
    if not path.is_file():
        raise ModelError(
            f"{path}: no such FMU; build the FMUs with 'pldf build' or name their folder "
            "with --fmus"
        )
    import fmpy

    try:
        description = fmpy.read_model_description(str(path))
    except Exception as error:  # as above
        raise _unusable(path, error) from error
    if description.coSimulation is None:
        raise ModelError(f"{path}: this FMU is not for co-simulation")
    return description


def _unusable(path: Path, error: Exception) -> ModelError:
    return ModelError(f"{path}: not a usable FMU ({error}); build it again")


def _signal(variable: Any, enumerations: Mapping[str, Enumeration]) -> Signal:
    declared = variable.declaredType
    return Signal(
        field=variable.name,
        name=variable.name,
        causality=cast(Causality, variable.causality),
        kind=cast(Kind, variable.type),
        start=variable.start or "",
        description=variable.description or "",
        unit=variable.unit or (declared.unit if declared else "") or "",
        low=None if variable.min is None else float(variable.min),
        high=None if variable.max is None else float(variable.max),
        enumeration=enumerations.get(declared.name) if declared else None,
    )


class Slave:
    """One instance of an FMU, for one drive.

    Args:
        fmu: the unpacked FMU.
        part: name of the instance.
        inputs: names of the inputs that ``write`` sets at every communication point.

    Attributes:
        messages: of the FMU's logger so far.
        inputs: where to put the values that ``write`` sets, by name.
        outputs: where the values lie that ``read`` gets, by name.

    Raises:
        ModelError: from every method, with the FMU's own text, when it refuses a call.
    """

    def __init__(self, fmu: Fmu, part: str, inputs: Iterable[str]) -> None:
        self.fmu = fmu
        self.messages: list[FmuMessage] = []
        self._set, self.inputs = self._batches(inputs)
        self._get, self.outputs = self._batches(
            s.name for s in fmu.named("output") if s.kind != "String"
        )
        self.name: str = fmu.description.modelName
        from fmpy import fmi2 as fmi

        self._slave = self._load(part)
        self._callbacks = fmi.fmi2CallbackFunctions()
        self._callbacks.logger = fmi.fmi2CallbackLoggerTYPE(self._hear)
        self._callbacks.allocateMemory = fmi.fmi2CallbackAllocateMemoryTYPE(fmi.calloc)
        self._callbacks.freeMemory = fmi.fmi2CallbackFreeMemoryTYPE(fmi.free)
        self._call(self._slave.instantiate, callbacks=self._callbacks, loggingOn=True)

    def set(self, values: Mapping[str, Value]) -> None:
        """Set parameters and unconnected inputs before initialization."""
        for name, value in values.items():
            if name not in self.fmu.signals:
                raise ModelError(
                    f"{self.name}: this FMU has no variable {name} (version "
                    f"{self.fmu.description.version}); build all FMUs anew with 'pldf build'"
                )
            kind = self.fmu.signals[name].kind
            setter = getattr(self._slave, f"set{'Integer' if kind == 'Enumeration' else kind}")
            self._call(setter, [self.fmu.references[name]], [value])

    def begin(self) -> None:
        """Enter initialization mode at time 0."""
        self._call(self._slave.setupExperiment, startTime=0.0)
        self._call(self._slave.enterInitializationMode)

    def ready(self) -> None:
        """Leave initialization mode."""
        self._call(self._slave.exitInitializationMode)

    def read(self) -> None:
        """Get all outputs into their buffers."""
        for batch in self._get:
            get = getattr(self._slave, f"fmi2Get{batch.type}")
            self._call(get, self._slave.component, batch.references, batch.count, batch.buffer)

    def write(self) -> None:
        """Set the inputs from their buffers."""
        for batch in self._set:
            put = getattr(self._slave, f"fmi2Set{batch.type}")
            self._call(put, self._slave.component, batch.references, batch.count, batch.buffer)

    def step(self, time_s: float, step_s: float) -> None:
        """Advance from ``time_s`` by ``step_s``."""
        self._call(self._slave.doStep, time_s, step_s)

    def terminate(self) -> None:
        """End the drive; learning and saving happen here."""
        self._call(self._slave.terminate)

    def free(self) -> None:
        """Release the instance, whatever state it is in."""
        if self._slave.component:
            self._slave.freeInstance()
            self._slave.component = None

    def _load(self, part: str) -> Any:
        from fmpy import fmi2 as fmi

        model = self.fmu.description
        try:
            with chdir("."):  # fmpy stays in the library's folder when that cannot be loaded
                return fmi.FMU2Slave(
                    guid=model.guid,
                    unzipDirectory=str(self.fmu.folder),
                    modelIdentifier=model.coSimulation.modelIdentifier,
                    instanceName=part,
                )
        except Exception as error:  # fmpy raises bare Exception
            raise ModelError(f"{self.name}: cannot be loaded here: {error}") from error

    def _call(self, call: Callable[..., Any], *arguments: Any, **named: Any) -> None:
        try:
            call(*arguments, **named)
        except Exception as problem:
            from fmpy.fmi1 import FMICallException  # type: ignore[import-untyped]

            if not isinstance(problem, FMICallException):
                raise
            errors = [message.text for message in self.messages if message.level == "error"]
            text = errors[-1] if errors else str(problem)
            raise ModelError(f"{self.name}: {text}") from None

    def _hear(self, _: Any, name: bytes, status: int, category: bytes, text: bytes) -> None:
        # The text is a printf format without arguments.
        plain = text.decode("utf-8", "replace").replace("%%", "%")
        message = FmuMessage(self.name, _LEVELS[status], plain)
        if message not in self.messages and not plain.startswith(_WRAPPERS_NOTE):
            self.messages.append(message)

    def _batches(self, names: Iterable[str]) -> tuple[list[_Batch], dict[str, BufferElement]]:
        groups: dict[str, list[str]] = {}
        for name in names:
            kind = self.fmu.signals[name].kind
            groups.setdefault("Integer" if kind == "Enumeration" else kind, []).append(name)
        batches = []
        elements: dict[str, BufferElement] = {}
        for c_type, members in groups.items():
            count = len(members)
            references = (ctypes.c_uint32 * count)(*(self.fmu.references[n] for n in members))
            buffer = (_C_TYPES[c_type] * count)()
            batches.append(_Batch(c_type, references, count, buffer))
            elements.update({name: BufferElement(buffer, at) for at, name in enumerate(members)})
        return batches, elements
