"""The co-simulation slave of any ``Instance``: what pythonfmu calls, answered from its tables.

Statuses. pythonfmu can answer a call with OK, a step also with Discard; every exception becomes
Fatal. A step that makes no sense is therefore discarded, and any other call that is refused raises:
the text goes to the FMU's logger first (and to stderr: the wrapper is mute unless the importer
switched logging on), and the instance stays usable.
"""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable
from dataclasses import asdict, fields
from functools import wraps
from math import isfinite
from pathlib import Path
from traceback import extract_tb
from typing import Any, ClassVar, Concatenate, Final, ParamSpec, TypeVar
from xml.etree.ElementTree import Element

from pythonfmu import Fmi2Slave  # type: ignore[import-untyped]
from pythonfmu.enums import Fmi2Status  # type: ignore[import-untyped]

from ..instance import Instance, Level, ModelError
from ..kernel.signals import Signal, signals_of
from .access import Access, Group
from .phases import Phase, next_phase
from .wrapper import follow, hold, leave_path, release_at_exit

P = ParamSpec("P")
R = TypeVar("R")

LOG_CATEGORIES: Final = {
    "logEvents": "What the model did, at most a few messages per drive.",
    "logStatusWarning": "The model goes on, but not as the user may expect.",
    "logStatusError": "A call was refused; the text says why and the way out.",
    "logAll": "Log all messages.",
}
_LOG: Final[dict[Level, tuple[Fmi2Status, str]]] = {
    "info": (Fmi2Status.ok, "logEvents"),
    "warning": (Fmi2Status.warning, "logStatusWarning"),
    "error": (Fmi2Status.error, "logStatusError"),
}
_STATE: Final = struct.Struct("<8sBBBd")  # magic, phase, ready and pristine, stale, time
_MAGIC: Final = b"PLDFFMU1"
_NO_TIME: Final = float("-inf")


class RefusedError(Exception):
    """Raised to pythonfmu after the reason was logged."""

    def __repr__(self) -> str:
        return "the message before this one says why"


def _answered(
    call: Callable[Concatenate[ModelSlave, P], R],
) -> Callable[Concatenate[ModelSlave, P], R]:
    """Turn whatever goes wrong in ``call`` into one message and an exception that is survived."""

    @wraps(call)
    def answer(self: ModelSlave, /, *args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return call(self, *args, **kwargs)
        except BaseException as error:  # the wrapper swallows KeyboardInterrupt as well
            self._refuse(_text(error))
            hold(self, type(self), self.log_queue)
            raise RefusedError from None

    return answer


def _text(error: BaseException) -> str:
    if isinstance(error, ModelError):
        return str(error)
    place = extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} (in {place.name}, line {place.lineno})"


class ModelSlave(Fmi2Slave):  # type: ignore[misc]  # pythonfmu ships no types
    """Base of the slaves; a subclass says what ``create`` makes and what the FMU is about.

    Attributes:
        about: one sentence for the model description.
        stop_time_s: end of the default experiment.
    """

    about: ClassVar[str] = ""
    stop_time_s: ClassVar[float] = 300.0
    log_categories: ClassVar[dict[str, str]] = LOG_CATEGORIES

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        hold(vars(sys.modules[cls.__module__]))  # see ``wrapper``

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**{"instance_name": "", **kwargs})
        if "logger" in kwargs:  # called by the wrapper, not by pythonfmu's builder
            leave_path(self.resources)
            self._release_at_exit()
        self._model = self.create()
        self.signals = model_signals(self._model)
        self._reals = Access(self.signals, frozenset({"Real"}))
        self._integers = Access(self.signals, frozenset({"Integer", "Enumeration"}))
        self._booleans = Access(self.signals, frozenset({"Boolean"}))
        self._strings = Access(self.signals, frozenset({"String"}))
        self._phase = Phase.INSTANTIATED
        self._time = _NO_TIME
        self._prepared = False  # this model was initialized
        self._ready = False  # the outputs belong to the parameters
        self._pristine = False  # nothing was set since the model was initialized
        self._stale = False  # the outputs do not belong to the inputs
        self._finished = False

    def create(self) -> Instance[Any]:
        """Return a new model with the default values."""
        raise NotImplementedError

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """Return the model description; pythonfmu's own lacks units, enumerations and more."""
        from .description import Model, model_description  # noqa: PLC0415 - needed to build only

        model = Model(type(self).__name__, self.about, self.signals, self.stop_time_s)
        return model_description(model, LOG_CATEGORIES)

    # Life cycle

    @_answered
    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        """Take over the start time; ModelError unless it is finite."""
        next_phase(self._phase, "fmi2SetupExperiment")
        if not isfinite(start_time):
            raise ModelError(f"the start time must be finite, not {start_time}")
        self._time = start_time

    @_answered
    def enter_initialization_mode(self) -> None:
        """Wait for the values of parameters and inputs."""
        self._phase = next_phase(self._phase, "fmi2EnterInitializationMode")

    @_answered
    def exit_initialization_mode(self) -> None:
        """Initialize the model with everything that was set."""
        phase = next_phase(self._phase, "fmi2ExitInitializationMode")
        if not (self._ready and self._pristine):
            self._initialize()
        self._phase = phase
        self._tell()

    @_answered
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the model; False (Discard) and nothing changed when the step makes no sense."""
        problem = self._problem(current_time, step_size)
        if problem:
            self._refuse(problem)
            return False
        self._model.step(step_size)
        self._time = current_time + step_size
        self._stale = False
        self._tell()
        return True

    @_answered
    def terminate(self) -> None:
        """End the drive."""
        self._phase = next_phase(self._phase, "fmi2Terminate")
        self._finish()
        self._tell()

    def __del__(self) -> None:
        """End the drive if reset or release come without terminate; nobody listens any more."""
        if getattr(self, "_phase", None) is not Phase.STEPPING:
            return
        try:
            self._finish()
        except Exception as error:  # an exception in a destructor would only be printed raw
            self._complain(_text(error))
        for message in self._model.messages:
            if message.level != "info":
                self._complain(message.text)

    # Values

    @_answered
    def get_real(self, vrs: list[int]) -> list[float]:
        """Return Real values."""
        return self._read(self._reals.group(vrs))

    @_answered
    def get_integer(self, vrs: list[int]) -> list[int]:
        """Return Integer values and codes of enumerations."""
        return self._read(self._integers.group(vrs))

    @_answered
    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """Return Boolean values."""
        return self._read(self._booleans.group(vrs))

    @_answered
    def get_string(self, vrs: list[int]) -> list[str]:
        """Return String values."""
        return self._strings.group(vrs).read(self._model.texts)

    @_answered
    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set Real inputs or parameters."""
        self._write(self._reals.writable(vrs), values, self._model.record)

    @_answered
    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Set Integer and enumeration inputs or parameters."""
        self._write(self._integers.writable(vrs), values, self._model.record)

    @_answered
    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """Set Boolean inputs or parameters, held as 0 or 1."""
        self._write(self._booleans.writable(vrs), [int(v) for v in values], self._model.record)

    @_answered
    def set_string(self, vrs: list[int], values: list[str | None]) -> None:
        """Set String parameters; a null pointer counts as empty."""
        self._write(self._strings.writable(vrs), [v or "" for v in values], self._model.texts)

    # FMU state: plain bytes, so that the static conversions cannot fail (see ``wrapper``)

    @_answered
    def _get_fmu_state(self) -> bytes:
        flags = self._ready | self._pristine << 1
        head = _STATE.pack(_MAGIC, self._phase, flags, self._stale, self._time)
        return head + self._model.snapshot()

    @_answered
    def _set_fmu_state(self, state: bytes) -> None:
        if len(state) < _STATE.size or not state.startswith(_MAGIC):
            raise ModelError("these bytes are not a state of this FMU; not restored")
        _, phase, flags, stale, time = _STATE.unpack_from(state)
        self._restore(state[_STATE.size :], Phase(phase))
        self._phase = Phase(phase)
        # Before the first step nothing is lost when the model is initialized once more.
        stepped = self._phase >= Phase.STEPPING
        self._ready, self._pristine = bool(flags & 1) and stepped, bool(flags & 2) and stepped
        self._stale, self._time = bool(stale), time

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        return state

    # Helpers

    def _release_at_exit(self) -> None:
        library = Path(self.resources).parent / "binaries" / "linux64" / f"{type(self).__name__}.so"
        if library.is_file():
            release_at_exit(library)

    def _initialize(self) -> None:
        """Initialize a new model with what was set so far, so that repeating it starts anew."""
        follow(self.resources or "")
        fresh = self.create()
        carry(self.signals, self._model, fresh)
        self._ready = self._prepared = False
        self._model = fresh
        fresh.initialize()
        self._ready = self._pristine = self._prepared = True
        self._stale = False

    def _restore(self, state: bytes, phase: Phase) -> None:
        """Restore the model; what it holds besides its state follows from its parameters."""
        model = self.create()
        model.restore(state)
        if phase is Phase.STEPPING and not (self._prepared and self._has_parameters_of(model)):
            follow(self.resources or "")
            model.initialize()
            model.restore(state)
            self._prepared = True
            self._model = model
        else:
            self._model.restore(state)

    def _has_parameters_of(self, other: Instance[Any]) -> bool:
        ours = self._model
        return asdict(ours.texts) == asdict(other.texts) and all(
            getattr(ours.record, s.field) == getattr(other.record, s.field)
            for s in self.signals
            if s.causality == "parameter" and s.kind != "String"
        )

    def _refresh(self) -> None:
        """Bring the outputs up to date with what was set since they were computed."""
        if self._phase is Phase.INITIALIZING and not self._ready:
            self._initialize()
        elif self._stale and self._phase in (Phase.INITIALIZING, Phase.STEPPING):
            self._model.refresh()
            self._stale = False

    def _read(self, group: Group) -> list[Any]:
        if group.outputs and (self._stale or not self._ready):
            self._refresh()
        return group.read(self._model.record)

    def _write(self, group: Group, values: list[Any], record: Any) -> None:
        rule = "setting a fixed parameter" if group.fixed else "setting a variable"
        next_phase(self._phase, rule)
        for name, value in zip(group.fields, values, strict=True):
            setattr(record, name, value)
        self._stale = True
        self._pristine = False
        if group.parameters:
            self._ready = self._phase is Phase.STEPPING

    def _problem(self, current_time: float, step_size: float) -> str:
        if self._phase is not Phase.STEPPING:
            return f"fmi2DoStep is not allowed in phase {self._phase.name}; step discarded"
        if not (isfinite(step_size) and step_size > 0.0):
            return f"a step must be positive and finite, not {step_size} s; step discarded"
        if not isfinite(current_time):
            return f"a step must start at a finite time, not {current_time}; step discarded"
        # Communication points are sums of steps in the importer: they may drift, not go back.
        if current_time < self._time - 1e-9 * max(1.0, abs(self._time)):
            return f"time went back from {self._time} s to {current_time} s; step discarded"
        return ""

    def _finish(self) -> None:
        if not self._finished:
            self._finished = True
            self._model.finish()

    def _tell(self) -> None:
        """Hand the model's messages to the logger; importers may print them with printf."""
        for message in self._model.messages:
            status, category = _LOG[message.level]
            self.log(message.text.replace("%", "%%"), status, category)
        self._model.messages.clear()

    def _refuse(self, text: str) -> None:
        self._tell()
        self.log(text.replace("%", "%%"), Fmi2Status.error, "logStatusError")
        self._complain(text)

    def _complain(self, text: str) -> None:
        if sys.stderr is not None:  # there is none in a windowed host
            print(f"{type(self).__name__} {self.instance_name!r}: {text}", file=sys.stderr)


def model_signals(model: Instance[Any]) -> tuple[Signal, ...]:
    """Return the model's variables in the order of their value references."""
    return signals_of(model.record) + signals_of(model.texts)


def carry(signals: tuple[Signal, ...], old: Instance[Any], new: Instance[Any]) -> None:
    """Copy parameters and inputs from one model to another."""
    for signal in signals:
        if signal.causality in ("parameter", "input") and signal.kind != "String":
            setattr(new.record, signal.field, getattr(old.record, signal.field))
    for field in fields(old.texts):
        setattr(new.texts, field.name, getattr(old.texts, field.name))
