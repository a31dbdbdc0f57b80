"""One FMU instance without pythonfmu: the order of calls, when the model is initialized, its state.

The outputs are brought up to date only when somebody reads them. The model is initialized when
initialization mode ends, and earlier only if outputs are read in it; whatever was read, the run
starts from what is set at the end.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from math import inf, isfinite
from typing import Any, Final

from ..errors import ModelError
from ..instance import Instance, require_in_range
from ..kernel.signals import Signal, parameters_of, variables_of
from .access import Group
from .phases import Phase, next_phase

# Longer steps are a mistake in units, and their internal steps would seem to hang the simulator.
STEP_MAX_S: Final = 60.0
_STATE: Final = struct.Struct("<8sBBBd")  # magic, phase, ready, stale, time
_MAGIC: Final = b"PLDFFMU1"


class Session:
    """A model between instantiation and release.

    Attributes:
        create: returns a new model with default values.
        model: the present model.
        signals: its variables in the order of their value references.
        phase: where the session stands.
    """

    def __init__(self, create: Callable[[], Instance[Any]]) -> None:
        self.create = create
        self.model = create()
        self.signals = variables_of(self.model.record, self.model.texts)
        self.phase = Phase.INSTANTIATED
        self._time = -inf
        self._prepared = False  # this model was initialized, with these parameters
        self._ready = False  # the outputs belong to the parameters
        self._stale = False  # the outputs do not belong to the inputs
        self._finished = False

    def set_start(self, time: float) -> None:
        """Take over the start time; ModelError unless it is finite."""
        next_phase(self.phase, "fmi2SetupExperiment")
        if not isfinite(time):
            raise ModelError(f"the start time must be finite, not {time}")
        self._time = time

    def enter(self) -> None:
        """Enter initialization mode."""
        self.phase = next_phase(self.phase, "fmi2EnterInitializationMode")

    def exit(self) -> None:
        """Leave initialization mode; ModelError, and the mode stays, if the model refuses."""
        phase = next_phase(self.phase, "fmi2ExitInitializationMode")
        self._refresh()
        self.phase = phase

    def problem(self, time: float, step_s: float) -> str:
        """Return why a step makes no sense, an empty string if it does."""
        if self.phase is not Phase.STEPPING:
            return f"fmi2DoStep is not allowed in phase {self.phase.name}; step discarded"
        if not 0.0 < step_s <= STEP_MAX_S:  # NaN compares false
            return f"a step must be above 0 and at most {STEP_MAX_S:g} s, not {step_s}; discarded"
        if not isfinite(time):
            return f"a step must start at a finite time, not {time}; step discarded"
        # Communication points are sums of steps in the importer: they may drift, not go back.
        if time < self._time - 1e-9 * max(1.0, abs(self._time)):
            return f"time went back from {self._time} s to {time} s; step discarded"
        return ""

    def step(self, time: float, step_s: float) -> None:
        """Advance by a step that makes sense."""
        self.model.step(step_s)
        self._time = time + step_s
        self._stale = False

    def terminate(self) -> None:
        """End the run."""
        self.phase = next_phase(self.phase, "fmi2Terminate")
        self.finish()

    def finish(self) -> None:
        """Let the model do what the end of a run asks for, once in the life of the session."""
        if not self._finished:
            self._finished = True
            self.model.finish()

    def read(self, group: Group) -> list[Any]:
        """Return numeric values, up to date."""
        if group.outputs and (self._stale or not self._ready):
            self._refresh()
        return group.read(self.model.record)

    def read_texts(self, group: Group) -> list[str]:
        """Return String values, up to date."""
        if group.outputs:
            if self._stale or not self._ready:
                self._refresh()
            self.model.say()
        return group.read(self.model.texts)

    def write(self, group: Group, values: list[Any]) -> None:
        """Set numeric values; ModelError if that is not allowed in this phase."""
        self._write(group, values, self.model.record)

    def write_texts(self, group: Group, values: list[str]) -> None:
        """Set String values."""
        self._write(group, values, self.model.texts)

    def state(self) -> bytes:
        """Return everything that a run depends on."""
        head = _STATE.pack(_MAGIC, self.phase, self._ready, self._stale, self._time)
        return head + self.model.snapshot()

    def restore(self, state: bytes) -> None:
        """Take over a state; ModelError, and nothing changed, if it is not one of this FMU."""
        if len(state) < _STATE.size or not state.startswith(_MAGIC):
            raise ModelError("these bytes are not a state of this FMU; not restored")
        _, phase, ready, stale, time = _STATE.unpack_from(state)
        if phase > Phase.TERMINATED or not (isfinite(time) or time == -inf):
            raise ModelError(f"this FMU state was changed (phase {phase}, time {time})")
        self._restore_model(state[_STATE.size :], Phase(phase))
        self.phase = Phase(phase)
        # Before the first step nothing is lost when the model is initialized once more.
        stepped = self.phase >= Phase.STEPPING
        self._ready = bool(ready and stepped)
        self._stale, self._time = bool(stale), time

    def _initialize(self) -> None:
        """Initialize a new model with what was set so far, so that repeating it starts anew."""
        fresh = self.create()
        _carry(self.signals, self.model, fresh)
        self._ready = self._prepared = False
        self.model = fresh
        fresh.initialize()
        self._ready = self._prepared = True
        self._stale = False

    def _restore_model(self, state: bytes, phase: Phase) -> None:
        """Restore the model; what it holds besides its state follows from its parameters."""
        model = self.create()
        model.restore(state)
        here = self._prepared and self._has_parameters_of(model)
        if phase is not Phase.STEPPING:
            self.model.restore(state)
            self._prepared = here
            return
        lengths = [len(array) for array in model.arrays]
        if not here:
            model.initialize()
        if [len(array) for array in (self.model if here else model).arrays] != lengths:
            raise ModelError("the route of this state has changed; not restored")
        if here:
            self.model.restore(state)
        else:
            model.restore(state)
            self.model, self._prepared = model, True

    def _has_parameters_of(self, other: Instance[Any]) -> bool:
        ours = self.model
        return _texts(ours) == _texts(other) and all(
            getattr(ours.record, s.field) == getattr(other.record, s.field)
            for s in self.signals
            if s.causality == "parameter" and s.kind != "String" and not s.tunable
        )

    def _refresh(self) -> None:
        """Bring the outputs up to date with what was set since they were computed."""
        if self.phase is Phase.INITIALIZING and not self._ready:
            self._initialize()
        elif self._stale and self.phase in (Phase.INITIALIZING, Phase.STEPPING):
            self.model.refresh()
            self._stale = False

    def _write(self, group: Group, values: list[Any], record: Any) -> None:
        rule = "setting a fixed parameter" if group.fixed else "setting a variable"
        next_phase(self.phase, rule)
        for at, parameter in group.tunable:
            require_in_range(parameter, values[at])
        for name, value in zip(group.fields, values, strict=True):
            setattr(record, name, value)
        self._stale = True
        if group.fixed:
            self._ready = self._prepared = False


def _carry(signals: tuple[Signal, ...], old: Instance[Any], new: Instance[Any]) -> None:
    """Copy parameters and inputs from one model to another."""
    for signal in signals:
        if signal.causality in ("parameter", "input") and signal.kind != "String":
            setattr(new.record, signal.field, getattr(old.record, signal.field))
    for name, text in _texts(old).items():
        setattr(new.texts, name, text)


def _texts(model: Instance[Any]) -> dict[str, str]:
    """Return the String parameters by field."""
    return {name: getattr(model.texts, name) for name in parameters_of(model.texts)}
