"""Runs an SSP package in one importer: ``python ssp_masters.py IMPORTER PACKAGE SECONDS OUT.npy``.

In a process of its own: a crash of the importer ends one test. Writes a row per step with the time
after the step and the vehicle's speed then.
"""

from __future__ import annotations

import ctypes
import sys
from importlib import metadata
from pathlib import Path

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import Parameter, ParameterSet, read_ssd

STEP_S = 0.01


def handed_over(package: str) -> ParameterSet:
    """Return the parameter sets of a package: fmpy reads them and forgets them.

    They have to be handed over, with the component's name, and Booleans as numbers (any text counts
    as true).
    """
    values = ParameterSet(name="initialValues")
    for component in read_ssd(package).system.elements:
        for binding in component.parameterBindings:
            for one in binding.parameterValues[0].parameters:
                value = {"true": 1.0, "false": 0.0}.get(one.value, one.value)
                parameter = Parameter(name=f"{component.name}.{one.name}")
                parameter.value = value
                values.parameters.append(parameter)
    return values


def fmpy(package: str, seconds: float) -> list[tuple[float, float]]:
    rows = simulate_ssp(
        package, stop_time=seconds, step_size=STEP_S, parameter_set=handed_over(package)
    )
    # Its time is that before the step, its values are those after it.
    return list(zip(rows["time"] + STEP_S, rows["vehicle.speed_mps"], strict=True))


def libcosim(package: str, seconds: float) -> list[tuple[float, float]]:
    from libcosimpy.CosimExecution import CosimExecution  # noqa: PLC0415
    from libcosimpy.CosimObserver import CosimObserver  # noqa: PLC0415

    execution = CosimExecution.from_ssp_file(package, step_size=STEP_S * 1e9)
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    vehicle = execution.slave_index_from_instance_name("vehicle")
    variables = execution.slave_variables(vehicle)
    speed = [v.reference for v in variables if v.name == b"speed_mps"]
    rows = []
    for _ in range(round(seconds / STEP_S)):
        assert execution.step()
        time_s = execution.status().current_time * 1e-9
        rows.append((time_s, observer.last_real_values(vehicle, speed)[0]))
    return rows  # the execution terminates its FMUs when it is deleted


def load_tbb() -> None:
    """Load the library that the one of ecos wants on Linux, and that its wheel does not bring."""
    if sys.platform == "linux":
        files = metadata.files("tbb") or ()
        library = next(file for file in files if file.name == "libtbb.so.12")
        ctypes.CDLL(str(library.locate()), ctypes.RTLD_GLOBAL)


def ecos(package: str, seconds: float) -> list[tuple[float, float]]:
    load_tbb()
    from ecospy import EcosSimulation  # noqa: PLC0415

    rows = []
    with EcosSimulation(step_size=STEP_S, ssp_path=package) as simulation:
        assert simulation.init(parameter_set="initialValues")
        for _ in range(round(seconds / STEP_S)):
            simulation.step()
            rows.append((simulation.get_time(), simulation.get_real("vehicle::speed_mps")))
        simulation.terminate()
    return rows


if __name__ == "__main__":
    _, importer, package, seconds, out = sys.argv
    run = {"fmpy": fmpy, "libcosim": libcosim, "ecos": ecos}[importer]
    np.save(Path(out), np.array(run(package, float(seconds))))
