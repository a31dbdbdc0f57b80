"""What each FMU is fed with in a drive of the study: a realistic load for a single FMU."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final, NamedTuple

from pldf.cosim.drive_limits import STEP_S
from pldf.cosim.fmu import BufferElement, Fmu, Slave
from pldf.cosim.master import connections, unpacked
from pldf.cosim.values import Values
from pldf.roads import packed_route
from pldf.study.phases import PHASES, DriveSetting, values_of

# Letter of each type in a batch of one type; FMI 2.0 moves enumerations as Integers.
_LETTERS: Final = {"Real": "R", "Integer": "I", "Enumeration": "I", "Boolean": "B"}
_ORDER: Final = "RIB"


class Load(NamedTuple):
    """What one FMU gets; the formats are those of ``native_step.c``.

    Attributes:
        fmu: the FMU, unpacked.
        signals: its inputs, outputs and the parameters to be set.
        table: a row of inputs per step.
    """

    fmu: Fmu
    signals: str
    table: bytes


def study_loads(folder: Path, steps_max: int) -> Iterator[tuple[str, Load]]:
    """Drive A2 of the study with the FMI 2.0 FMUs in ``folder``; yield name and load of each.

    In A2 the driver intervenes by gas, brake and lever. The FMUs are unpacked for as long as the
    iterator lives; not more than ``steps_max`` steps are driven.
    """
    setting = DriveSetting(packed_route(0), {"route_id": 0})
    values = values_of(PHASES["A2"], setting)
    with unpacked(folder) as fmus:
        tables = _drive(fmus, values, setting.length_m, steps_max)
        for part, fmu in fmus.items():
            load = Load(fmu, _signals(fmu, values[part]), b"".join(tables[part]))
            yield fmu.description.coSimulation.modelIdentifier, load


def _drive(
    fmus: Mapping[str, Fmu], values: Values, length_m: float, steps_max: int
) -> dict[str, list[bytes]]:
    """Couple the FMUs as ``pldf.cosim.master`` does and keep what each is given before a step."""
    wires = connections(fmus)
    slaves = {p: Slave(fmu, p, [s.name for s in fmu.named("input")]) for p, fmu in fmus.items()}
    links = [(slaves[a].outputs[x], slaves[b].inputs[y]) for (a, x), (b, y) in wires]
    tables: dict[str, list[bytes]] = {part: [] for part in fmus}
    for part, slave in slaves.items():
        slave.set(values[part])
        _set_start_values(slave)
        slave.begin()
        slave.ready()
    position = slaves["vehicle"].outputs["s_m"]
    for k in range(steps_max):
        for slave in slaves.values():
            slave.read()
        if position.value >= length_m:
            break
        for source, target in links:
            target.buffer[target.at] = source.buffer[source.at]
        for part, slave in slaves.items():
            tables[part].append(_row(slave))
            slave.write()
            slave.step(k * STEP_S, STEP_S)
    for slave in slaves.values():
        slave.free()
    return tables


def _set_start_values(slave: Slave) -> None:
    for signal in slave.fmu.named("input"):
        text = str(signal.start)
        place = slave.inputs[signal.name]
        number = float({"true": 1.0, "false": 0.0}.get(text, text))
        place.buffer[place.at] = number if signal.kind == "Real" else int(number)


def _row(slave: Slave) -> bytes:
    """Return the inputs: Reals, Integers, Booleans; filled up to a multiple of 8 bytes."""
    places: dict[str, list[BufferElement]] = {letter: [] for letter in _ORDER}
    for signal in slave.fmu.named("input"):
        places[_LETTERS[signal.kind]].append(slave.inputs[signal.name])
    row = b"".join(
        struct.pack("d" if letter == "R" else "i", place.value)
        for letter in _ORDER
        for place in places[letter]
    )
    return row + bytes(-len(row) % 8)


def _signals(fmu: Fmu, values: Mapping[str, float | int | str]) -> str:
    words = [
        f"{causality[0]}{_LETTERS[s.kind]}{fmu.references[s.name]}"
        for causality in ("input", "output")
        for s in (fmu.named("input") if causality == "input" else fmu.named("output"))
        if s.kind != "String"
    ]
    words += [
        f"p{_LETTERS[fmu.signals[name].kind]}{fmu.references[name]}={value}"
        for name, value in values.items()
    ]
    return " ".join(words)
