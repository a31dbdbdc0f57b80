"""A drive once more from its recording: the function is given the same inputs, step by step.

With the same version, profile and parameters it answers with the same bits, so a drive that
somebody wonders about can be looked into; with others it shows what they would have done to the
same inputs. The car is that of the recording: it does not answer.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ..errors import ModelError
from ..findings import Finding
from ..function import DrivingFunction
from ..kernel.arrays import FloatArray
from ..kernel.recorder import learns
from ..kernel.signals import signals_of
from ..profiles.stored_profile import Iteration
from .columns import COLUMNS, INPUTS, LEARNED_DELTA, OUTPUTS
from .recording import Recording

# Without them there is no telling what the function was given; the others may stay at their start.
_NEEDED: Final = (
    "s_m", "speed_mps", "acceleration_mps2", "gas_pedal", "brake_pedal",
    "lever_resume", "lever_cancel", "lever_up", "lever_down", "lever_up_long", "lever_down_long",
)  # fmt: skip


class Replay(NamedTuple):
    """A drive that was driven once more.

    Attributes:
        recording: the inputs as they were recorded, and what the function answers now.
        iteration: what it learned, if its parameters say that it learns.
    """

    recording: Recording
    iteration: Iteration | None


def replay(recording: Recording, function: DrivingFunction, file: str = "") -> Replay:
    """Give ``function`` the inputs of ``recording``, a row per communication step.

    Args:
        recording: one row per step of the simulation, as ``pldf drive`` writes it.
        function: prepared for the route; it follows the profile that was driven.
        file: of the recording, for messages.

    Raises:
        ModelError: inputs were not recorded.
    """
    where = f"{file}: " if file else ""
    if lacking := [name for name in _NEEDED if name not in recording]:
        raise ModelError(
            f"{where}not recorded: {', '.join(lacking)}; only a recording with every step and all "
            "inputs can be replayed, as 'pldf drive' and 'pldf study' write it"
        )
    st = function.record
    fields = {signal.name: signal.field for signal in signals_of(st)}
    inputs = {fields[name]: recording[column].tolist() for column, name in INPUTS.items()
              if column in recording}  # fmt: skip
    whole = {field for field in inputs if isinstance(getattr(st, field), int)}
    shown = {**OUTPUTS, "learned_delta_mps": LEARNED_DELTA}
    rows = []
    for k, step_s in enumerate(_steps(recording["time_s"])):
        for field, values in inputs.items():
            setattr(st, field, int(values[k]) if field in whole else values[k])
        if k == 0:
            function.refresh()
        rows.append([float(getattr(st, fields[name])) for name in shown.values()])
        function.step(step_s)
    answers = dict(zip(shown, np.array(rows).T.copy(), strict=True))
    answers["profile_mps"] = answers["base_mps"] + answers.pop("learned_delta_mps")
    columns = {**recording.columns, **answers}
    kept = {name: columns[name] for name in COLUMNS if name in columns}
    notes = (*recording.notes, *_at_start(recording, file))
    iteration = function.learn() if learns(st) and st.nodes >= 2 else None
    return Replay(Recording(kept, recording.comments, notes), iteration)


def _steps(time_s: FloatArray) -> list[float]:
    """Return the communication steps, whole nanoseconds; the last is as long as that before."""
    steps = np.round(1e9 * np.diff(time_s)) / 1e9
    return [*steps.tolist(), float(steps[-1])]


def _at_start(recording: Recording, file: str) -> tuple[Finding, ...]:
    absent = [name for name in INPUTS if name not in recording]
    if not absent:
        return ()
    text = f"not recorded, so as at the start of every drive: {', '.join(absent)}"
    return (Finding("note", file, 0, "", text),)
