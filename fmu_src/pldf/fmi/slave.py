"""The co-simulation slave of any ``Instance``: what pythonfmu calls, answered from its tables.

Statuses. pythonfmu can answer a call with OK, a step also with Discard; every exception becomes
Fatal. A step that makes no sense is therefore discarded, and any other call that is refused raises:
the text goes to the FMU's logger first (and to stderr: the wrapper is mute unless the importer
switched logging on), and the instance stays usable.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial, wraps
from pathlib import Path
from traceback import extract_tb
from typing import Any, ClassVar, Concatenate, Final, ParamSpec, TypeVar
from xml.etree.ElementTree import Element

from pythonfmu import Fmi2Slave  # type: ignore[import-untyped]
from pythonfmu.enums import Fmi2Status  # type: ignore[import-untyped]

from ..errors import ModelError
from ..instance import Instance, Level
from .access import Access
from .phases import Phase
from .session import Session
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


def _new_model(create: Callable[[], Instance[Any]], resources: str) -> Instance[Any]:
    follow(resources)
    return create()


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
        # No reference to self: a cycle would keep ``__del__`` from running at release.
        self._session = Session(partial(_new_model, self.create, self.resources or ""))
        self.signals = self._session.signals
        self._reals = Access(self.signals, frozenset({"Real"}))
        self._integers = Access(self.signals, frozenset({"Integer", "Enumeration"}))
        self._booleans = Access(self.signals, frozenset({"Boolean"}))
        self._strings = Access(self.signals, frozenset({"String"}))

    @staticmethod
    def create() -> Instance[Any]:
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
        """Take over the start time; it must be finite."""
        self._session.set_start(start_time)

    @_answered
    def enter_initialization_mode(self) -> None:
        """Wait for the values of parameters and inputs."""
        self._session.enter()

    @_answered
    def exit_initialization_mode(self) -> None:
        """Initialize the model with everything that was set."""
        self._session.exit()
        self._log_messages()

    @_answered
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the model; False (Discard) and nothing changed when the step makes no sense."""
        problem = self._session.problem(current_time, step_size)
        if problem:
            self._refuse(problem)
            return False
        self._session.step(current_time, step_size)
        self._log_messages()
        return True

    @_answered
    def terminate(self) -> None:
        """End the drive."""
        self._session.terminate()
        self._log_messages()

    def __del__(self) -> None:
        """End the drive if reset or release come without terminate; nobody listens any more."""
        session = getattr(self, "_session", None)
        if session is None or session.phase is not Phase.STEPPING:
            return
        try:
            session.finish()
        except Exception as error:  # an exception in a destructor would only be printed raw
            self._complain(_text(error))
        for message in session.model.messages:
            if message.level != "info":
                self._complain(message.text)

    # Values

    @_answered
    def get_real(self, vrs: list[int]) -> list[float]:
        """Return Real values."""
        return self._session.read(self._reals.group(vrs))

    @_answered
    def get_integer(self, vrs: list[int]) -> list[int]:
        """Return Integer values and codes of enumerations."""
        return self._session.read(self._integers.group(vrs))

    @_answered
    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """Return Boolean values."""
        return self._session.read(self._booleans.group(vrs))

    @_answered
    def get_string(self, vrs: list[int]) -> list[str]:
        """Return String values."""
        return self._session.read_texts(self._strings.group(vrs))

    @_answered
    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set Real inputs or parameters."""
        self._session.write(self._reals.writable(vrs), values)

    @_answered
    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Set Integer and enumeration inputs or parameters."""
        self._session.write(self._integers.writable(vrs), values)

    @_answered
    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """Set Boolean inputs or parameters, held as 0 or 1."""
        self._session.write(self._booleans.writable(vrs), [int(v) for v in values])

    @_answered
    def set_string(self, vrs: list[int], values: list[str | None]) -> None:
        """Set String parameters; a null pointer counts as empty."""
        self._session.write_texts(self._strings.writable(vrs), [v or "" for v in values])

    # FMU state: plain bytes, so that the static conversions cannot fail (see ``wrapper``)

    @_answered
    def _get_fmu_state(self) -> bytes:
        return self._session.state()

    @_answered
    def _set_fmu_state(self, state: bytes) -> None:
        self._session.restore(state)
        self._log_messages()

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

    def _log_messages(self) -> None:
        """Hand the model's messages to the logger; importers may print them with printf."""
        for message in self._session.model.messages:
            status, category = _LOG[message.level]
            self.log(message.text.replace("%", "%%"), status, category)
        self._session.model.messages.clear()

    def _refuse(self, text: str) -> None:
        self._log_messages()
        self.log(text.replace("%", "%%"), Fmi2Status.error, "logStatusError")
        self._complain(text)

    def _complain(self, text: str) -> None:
        if sys.stderr is not None:  # there is none in a windowed host
            print(f"{type(self).__name__} {self.instance_name!r}: {text}", file=sys.stderr)
