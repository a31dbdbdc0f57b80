"""The native session: its checks of parameters, FMU states, and what it tells at the end."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fmi_host import Host, Slave
from pldf.function import DrivingFunction
from pldf.instance import ModelError

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")


OK, WARNING, ERROR = 0, 1, 3


@pytest.fixture(scope="module")
def host(native_folder: Path) -> Host:
    return Host(native_folder / "AdaptivePLDF.fmu")


@pytest.fixture
def slave(host: Host) -> Iterator[Slave]:
    one = host.instantiate()
    yield one
    one.free()


def drive(slave: Slave, first: int, steps: int) -> list[Any]:
    """Drive with 20 m/s from step ``first`` on and return the outputs after each step."""
    found = []
    for k in range(first, first + steps):
        values = {"vehicle__s_m": 100.0 + k, "vehicle__speed_mps": 20.0}
        found += slave.run(0.05 * k, 1, 0.05, **values)
    return found


def terminated(slave: Slave) -> int:
    return int(slave.fmu.dll.fmi2Terminate(ctypes.c_void_p(slave.fmu.component)))


# Parameters


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"learning.accel_max_mps2": 1.0},
        {"planner.accel_max_mps2": 2.0, "learning.accel_max_mps2": 2.0},
        {"planner.accel_max_mps2": 2.0, "learning.accel_max_mps2": 1.75},
        {"planner.accel_min_mps2": -1.5, "learning.accel_min_mps2": -1.25},
        {"planner.accel_min_mps2": -1.5, "learning.accel_min_mps2": -1.5},
        {"planner.lateral_accel_max_mps2": 4.0, "learning.lateral_accel_max_mps2": 3.0},
        {"learning.lateral_accel_max_mps2": 1e9},
        {"learning.lateral_accel_max_mps2": math.nan},
        {"learning.accel_min_mps2": 0.5},
    ],
)
def test_parameters_are_refused_as_by_the_python_model(
    slave: Slave, values: dict[str, float]
) -> None:
    model = DrivingFunction()
    for name, value in values.items():
        setattr(model.record, name.replace(".", "_"), value)
    try:
        model.initialize()
        refusal = ""
    except ModelError as error:
        refusal = str(error)
    slave.set(**{name.replace(".", "__"): value for name, value in values.items()})
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    assert slave.status("exitInitializationMode") == (ERROR if refusal else OK)
    said, told = refusal.split(": ", 1), "".join(slave.texts()).split(": ", 1)
    assert said[1:] == told[1:]  # before it stands the value, in other digits
    assert said[0].split(" = ")[0] == told[0].split(" = ")[0]
