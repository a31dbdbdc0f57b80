"""Time of one FMU step through fmpy: set all inputs, step, get all outputs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any, Final, NamedTuple

from fmpy import extract, read_model_description  # type: ignore[import-untyped]
from fmpy.fmi2 import FMU2Slave  # type: ignore[import-untyped]
from fmpy.fmi3 import FMU3Slave  # type: ignore[import-untyped]
from pldf.fmi.wrapper import release_at_exit

# Type of a variable -> what the functions that set and get it are called after.
_CALLS: Final = {
    "2.0": {"Real": "Real", "Integer": "Integer", "Enumeration": "Integer", "Boolean": "Boolean"},
    "3.0": {"Float64": "Float64", "Int32": "Int32", "Enumeration": "Int64", "Boolean": "Boolean"},
}


class FmuTimes(NamedTuple):
    """Seconds: from instantiation to the end of initialization, and per step (median)."""

    start_s: float
    step_s: float


def time_fmu(path: Path, inputs: dict[str, float], steps: int = 2000) -> FmuTimes:
    """Measure an FMU.

    Args:
        path: the FMU, of FMI 2.0 or 3.0.
        inputs: values of inputs that shall differ from their start value; ``vehicle.s_m``, if there
            is one, advances with ``vehicle.speed_mps``.
        steps: number of steps of 10 ms.
    """
    description = read_model_description(str(path))
    folder = Path(extract(str(path)))
    for library in folder.glob("binaries/linux64/*.so"):
        release_at_exit(library)  # the empty FMU is stock pythonfmu
    calls = _CALLS[description.fmiVersion]
    slave = (FMU2Slave if "Real" in calls else FMU3Slave)(
        guid=description.guid,
        unzipDirectory=str(folder),
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    began = perf_counter()
    slave.instantiate()
    for variable in description.modelVariables:
        if variable.name == "apply_learned":  # there is no store: no need to warn of it
            slave.setBoolean([variable.valueReference], [False])
    if "Real" in calls:
        slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    start_s = perf_counter() - began
    step = _stepper(slave, description.modelVariables, calls, inputs)
    times = []
    for index in range(steps):
        began = perf_counter()
        step(index * 0.01)
        times.append(perf_counter() - began)
    slave.terminate()
    slave.freeInstance()
    return FmuTimes(start_s, sorted(times)[steps // 2])


def _stepper(
    slave: Any, variables: list[Any], calls: dict[str, str], inputs: dict[str, float]
) -> Callable[[float], None]:
    setters, getters = [], []
    for kind in dict.fromkeys(calls.values()):
        ours = [v for v in variables if calls.get(v.type) == kind]
        ins = [v for v in ours if v.causality == "input"]
        outs = [v.valueReference for v in ours if v.causality == "output"]
        if ins:
            number = float if kind in ("Real", "Float64") else int
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
