"""The one place where function, vehicle, driver and car ahead are coupled: an FMI 2.0 master.

They all step with the outputs of the last communication point (Jacobi), so none of them depends on
the order of stepping. Nothing is wired by hand: see ``connections``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stderr
from dataclasses import dataclass
from io import StringIO
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final, NamedTuple

import numpy as np

from ..errors import ModelError
from ..recordings.columns import COLUMNS, INPUTS, LEARNED_DELTA, OUTPUTS
from ..recordings.recording import Recording
from .ctrl_c import noted_ctrl_c
from .drive_limits import SLOWEST_MPS, STANDSTILL_MAX_S, STANDSTILL_MPS, STEP_S
from .fmu import BufferElement, Fmu, Slave, unpack
from .kinds import PARTS
from .native_files import readable_values
from .values import FmuMessage, Value, Values

_PROGRESS_STEPS: Final = 200

ARRIVED: Final = "reached the end of the route"

Link = tuple[BufferElement, BufferElement]
Rows = list[list[float]]
Seen = dict[str, BufferElement]  # column of the recording -> where its value lies


class Connection(NamedTuple):
    """An output and the input that it feeds, each as (part, variable)."""

    source: tuple[str, str]
    target: tuple[str, str]


@dataclass(frozen=True, eq=False)
class Drive:
    """What came out of one drive.

    Attributes:
        recording: one row per step.
        outputs: outputs of the driving function at the end, by name.
        messages: messages of the FMUs.
        arrived: the vehicle reached the end of the route.
        ending: how the drive ended, for people.
    """

    recording: Recording
    outputs: dict[str, float]
    messages: list[FmuMessage]
    arrived: bool
    ending: str


@contextmanager
def unpacked(folder: Path, parts: Mapping[str, str] = PARTS) -> Iterator[dict[str, Fmu]]:
    """Unpack FMUs in ``folder`` for any number of drives; by part.

    Args:
        folder: where they are.
        parts: their names by part: ``PARTS`` or ``PARTS_IN_TRAFFIC``.

    Raises:
        ModelError: one of them is missing or not usable, or does not fit the others.
    """
    with TemporaryDirectory(prefix="pldf-", ignore_cleanup_errors=True) as place:
        fmus = {
            part: unpack(folder / f"{name}.fmu", Path(place) / name) for part, name in parts.items()
        }
        connections(fmus)
        yield fmus


def connections(fmus: Mapping[str, Fmu]) -> list[Connection]:
    """Return what feeds what.

    The rule: an input is fed by the output of the same name of another part. An input
    ``vehicle.NAME`` is fed by the vehicle's output ``NAME``. All other inputs keep their start
    value.

    Raises:
        ModelError: two outputs have the name, or type or unit of the two ends differ.
    """
    sources: dict[str, list[tuple[str, str]]] = {}
    for part, fmu in fmus.items():
        for signal in fmu.named("output"):
            sources.setdefault(signal.name, []).append((part, signal.name))
            if part == "vehicle":
                sources.setdefault(f"vehicle.{signal.name}", []).append((part, signal.name))
    wires = []
    for part, fmu in fmus.items():
        for signal in fmu.named("input"):
            feeding = [source for source in sources.get(signal.name, ()) if source[0] != part]
            if len(feeding) > 1:
                raise ModelError(f"{part}, {signal.name}: more than one output has this name")
            if feeding:
                wires.append(Connection(feeding[0], (part, signal.name)))
                _require_match(fmus, wires[-1])
    return wires


def _require_match(fmus: Mapping[str, Fmu], connection: Connection) -> None:
    source, target = (fmus[part].signals[name] for part, name in connection)
    ends = [(s.kind, s.unit, s.enumeration) for s in (source, target)]
    if ends[0] != ends[1]:
        raise ModelError(
            f"{source.name} and {target.name} differ in type or unit; build all FMUs anew with "
            "'pldf build'"
        )


def _unwatched(_: float) -> None:
    """Nobody wants to know where the vehicle is."""


def drive(
    fmus: Mapping[str, Fmu],
    values: Values,
    length_m: float,
    step_s: float = STEP_S,
    progress: Callable[[float], None] = _unwatched,
) -> Drive:
    """Drive once from the start to ``length_m``.

    Args:
        fmus: from ``unpacked``.
        values: per part, parameters and unconnected inputs to set, by name; files of roads and
            scripts as for Python FMUs.
        length_m: the drive ends when the vehicle is here.
        step_s: communication step.
        progress: called now and then with the vehicle's position in m.

    Raises:
        ModelError: an FMU refused a value or a call.
        KeyboardInterrupt: Ctrl-C, between two steps.
    """
    values = readable_values(fmus, values)
    slaves: dict[str, Slave] = {}
    with _silenced(slaves), noted_ctrl_c() as raise_noted:

        def report(s_m: float) -> None:
            raise_noted()
            progress(s_m)

        try:
            return _drive(fmus, slaves, values, length_m, step_s, report)
        finally:
            for slave in slaves.values():
                slave.free()


@contextmanager
def _silenced(slaves: Mapping[str, Slave]) -> Iterator[None]:
    """Keep back what the FMUs print on stderr of what their loggers have told already."""
    printed = StringIO()
    try:
        with redirect_stderr(printed):
            yield
    finally:
        rest = printed.getvalue()
        for part, slave in slaves.items():
            for message in slave.messages:
                rest = rest.replace(f"{message.fmu} {part!r}: {message.text}\n", "")
        sys.stderr.write(rest)


def _drive(
    fmus: Mapping[str, Fmu],
    slaves: dict[str, Slave],
    values: Values,
    length_m: float,
    step_s: float,
    progress: Callable[[float], None],
) -> Drive:
    wires = connections(fmus)
    for part, fmu in fmus.items():
        fed = [wire.target[1] for wire in wires if wire.target[0] == part]
        slaves[part] = Slave(fmu, part, fed)
        slaves[part].set(values.get(part, {}))
    links = [
        (slaves[source[0]].outputs[source[1]], slaves[target[0]].inputs[target[1]])
        for source, target in wires
    ]
    _initialize(slaves, links)
    seen = _seen(slaves, wires)
    rows, ending = _run(slaves, links, seen, length_m, step_s, progress)
    outputs = {name: float(element.value) for name, element in slaves["pldf"].outputs.items()}
    for slave in slaves.values():
        slave.terminate()
    fixed = _fixed(fmus["pldf"], seen, values.get("pldf", {}))
    return Drive(
        recording=_recording(rows, list(seen), fixed, step_s),
        outputs=outputs,
        messages=[message for slave in slaves.values() for message in slave.messages],
        arrived=ending == ARRIVED,
        ending=ending,
    )


def _seen(slaves: Mapping[str, Slave], wires: list[Connection]) -> Seen:
    """Return what is recorded: what feeds the function's inputs, and its outputs."""
    sources = {wire.target[1]: wire.source for wire in wires if wire.target[0] == "pldf"}
    inputs = {
        column: slaves[sources[name][0]].outputs[sources[name][1]]
        for column, name in INPUTS.items()
        if name in sources
    }
    outputs = slaves["pldf"].outputs
    shown = {**OUTPUTS, "learned_delta_mps": LEARNED_DELTA}
    return {**inputs, **{c: outputs[name] for c, name in shown.items() if name in outputs}}


def _fixed(function: Fmu, seen: Seen, values: Mapping[str, Value]) -> dict[str, float]:
    """Return the inputs of the function that nothing feeds, by column."""
    return {
        column: _as_number(values.get(name, function.signals[name].start))
        for column, name in INPUTS.items()
        if column not in seen and name in function.signals
    }


def _as_number(value: Value) -> float:
    """Return a value as a file or a model description states it, as a number."""
    flags = {"true": 1.0, "false": 0.0, "": 0.0}
    return flags[value] if value in flags else float(value)


def _initialize(slaves: Mapping[str, Slave], links: list[Link]) -> None:
    """Make the first outputs fit together: each part knows the outputs of those before it.

    The function comes last and is asked once: planning takes time.
    """
    for slave in slaves.values():
        slave.begin()
        slave.write()
        slave.read()
        _exchange(links)
    for slave in slaves.values():
        slave.ready()


def _run(
    slaves: Mapping[str, Slave],
    links: list[Link],
    recorded: Seen,
    length_m: float,
    step_s: float,
    progress: Callable[[float], None],
) -> tuple[Rows, str]:
    """Step until the drive ends; return what was seen before each step and how it ended."""
    rows: Rows = []
    seen = list(recorded.values())
    position, speed = (slaves["vehicle"].outputs[name] for name in ("s_m", "speed_mps"))
    moved = 0  # last step at which the vehicle moved
    time_max_s = STANDSTILL_MAX_S + length_m / SLOWEST_MPS
    for k in range(ceil(time_max_s / step_s)):
        for slave in slaves.values():
            slave.read()
        if position.value >= length_m:
            return rows, ARRIVED
        moved = k if speed.value > STANDSTILL_MPS else moved
        if (k - moved) * step_s > STANDSTILL_MAX_S:
            return rows, f"stood still for {STANDSTILL_MAX_S:g} s at {position.value:.0f} m"
        rows.append([element.buffer[element.at] for element in seen])
        if k % _PROGRESS_STEPS == 0:
            progress(position.value)
        _exchange(links)
        for slave in slaves.values():
            slave.write()
            slave.step(k * step_s, step_s)
    return rows, f"only at {position.value:.0f} m after {time_max_s:.0f} s"


def _exchange(links: list[Link]) -> None:
    for source, target in links:
        target.buffer[target.at] = source.buffer[source.at]


def _recording(rows: Rows, seen: list[str], fixed: dict[str, float], step_s: float) -> Recording:
    values = np.array(rows, dtype=np.float64).reshape(len(rows), len(seen))
    columns = dict(zip(seen, values.T, strict=True))
    columns |= {name: np.full(len(rows), value) for name, value in fixed.items()}
    columns["profile_mps"] = columns["base_mps"] + columns.pop("learned_delta_mps")
    columns["time_s"] = np.arange(float(len(rows))) * step_s
    return Recording({n: np.ascontiguousarray(columns[n]) for n in COLUMNS if n in columns})
