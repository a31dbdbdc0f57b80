"""Time of one FMU step through fmpy: set all inputs, step, get all outputs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

from fmpy import extract, read_model_description  # type: ignore[import-untyped]
from fmpy.fmi2 import FMU2Slave  # type: ignore[import-untyped]
from pldf.fmi.wrapper import release_at_exit

_CALLS = {"Real": "Real", "Integer": "Integer", "Enumeration": "Integer", "Boolean": "Boolean"}


class FmuTimes(NamedTuple):
    """Seconds: from instantiation to the end of initialization, and per step (median)."""

    start_s: float
    step_s: float


def time_fmu(path: Path, inputs: dict[str, float], steps: int = 2000) -> FmuTimes:
    """Measure an FMU.

    Args:
        path: the FMU.
        inputs: values of inputs that shall differ from their start value; ``vehicle.s_m``, if there
            is one, advances with ``vehicle.speed_mps``.
        steps: number of steps of 10 ms.
    """
    description = read_model_description(str(path))
    folder = Path(extract(str(path)))
    for library in folder.glob("binaries/linux64/*.so"):
        release_at_exit(library)  # the empty FMU is stock pythonfmu
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    began = perf_counter()
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    start_s = perf_counter() - began
    variables = [v for v in description.modelVariables if v.type in _CALLS]
    step = _stepper(slave, variables, inputs)
    times = []
    for index in range(steps):
        began = perf_counter()
        step(index * 0.01)
        times.append(perf_counter() - began)
    slave.terminate()
    slave.freeInstance()
    return FmuTimes(start_s, sorted(times)[steps // 2])


def _stepper(slave: Any, variables: list[Any], inputs: dict[str, float]) -> Callable[[float], None]:
    setters, getters = [], []
    for kind in ("Real", "Integer", "Boolean"):
        ours = [v for v in variables if _CALLS[v.type] == kind]
        ins = [v for v in ours if v.causality == "input"]
        outs = [v.valueReference for v in ours if v.causality == "output"]
        if ins:
            number = float if kind == "Real" else int
            values = [number(inputs.get(v.name, _start(v))) for v in ins]
            position = next((i for i, v in enumerate(ins) if v.name == "vehicle.s_m"), None)
            references = [v.valueReference for v in ins]
            setters.append((getattr(slave, f"set{kind}"), references, values, position))
        if outs:
            getters.append((getattr(slave, f"get{kind}"), outs))
    speed = inputs.get("vehicle.speed_mps", 0.0)

    def step(time: float) -> None:
        for set_values, references, values, position in setters:
            if position is not None:
                values[position] = speed * time
            set_values(references, values)
        slave.doStep(time, 0.01)
        for get_values, references in getters:
            get_values(references)

    return step


def _start(variable: Any) -> float:
    text = str(variable.start)
    return {"true": 1.0, "false": 0.0}[text] if text in ("true", "false") else float(text)


if __name__ == "__main__":  # the first start in a process, imports included
    print(time_fmu(Path(sys.argv[1]), {}, steps=1).start_s)
