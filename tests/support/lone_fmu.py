"""Drives one FMU in one importer: ``python lone_fmu.py IMPORTER FMU OUT.npy``.

The FMU is the driving function, loaded by itself, with the same inputs in every importer. In a
process of its own, as in ``ssp_masters.py``. Writes one row of outputs per step.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from ssp_masters import STEP_S, load_tbb

STEPS = 1000
REALS_IN = ("vehicle.s_m", "vehicle.speed_mps", "driver.gas_pedal")
SWITCH = "lever.resume"
REALS_OUT = ("acceleration_request_mps2", "target_speed_mps", "base_speed_mps", "limit_mps")


def inputs(k: int) -> tuple[list[float], bool]:
    """Return what is set before step ``k``: a car that drives on, a pedal, the lever."""
    return [0.27 * k, 26.5 + 0.002 * k, 0.3 * (k % 500 > 450)], 20 <= k < 50


def libcosim(fmu: str) -> list[list[float]]:
    from libcosimpy.CosimExecution import CosimExecution  # noqa: PLC0415
    from libcosimpy.CosimManipulator import CosimManipulator  # noqa: PLC0415
    from libcosimpy.CosimObserver import CosimObserver  # noqa: PLC0415
    from libcosimpy.CosimSlave import CosimLocalSlave  # noqa: PLC0415

    execution = CosimExecution.from_step_size(STEP_S * 1e9)
    one = execution.add_local_slave(CosimLocalSlave(fmu, "one"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    assert execution.add_manipulator(manipulator)
    assert execution.add_observer(observer)
    references = {v.name.decode(): v.reference for v in execution.slave_variables(one)}
    rows = []
    for k in range(STEPS):
        reals, resume = inputs(k)
        assert manipulator.slave_real_values(one, [references[n] for n in REALS_IN], reals)
        assert manipulator.slave_boolean_values(one, [references[SWITCH]], [resume])
        assert execution.step()
        rows.append(observer.last_real_values(one, [references[name] for name in REALS_OUT]))
    return rows


def ecos(fmu: str) -> list[list[float]]:
    load_tbb()
    from ecospy import EcosSimulation, EcosSimulationStructure  # noqa: PLC0415

    rows = []
    with EcosSimulationStructure() as structure:
        structure.add_model("one", fmu)
        with EcosSimulation(structure=structure, step_size=STEP_S) as simulation:
            simulation.init()
            for k in range(STEPS):
                reals, resume = inputs(k)
                for name, value in zip(REALS_IN, reals, strict=True):
                    simulation.set_real(f"one::{name}", value)
                simulation.set_bool(f"one::{SWITCH}", resume)
                simulation.step()
                rows.append([simulation.get_real(f"one::{name}") for name in REALS_OUT])
            simulation.terminate()
    return rows


if __name__ == "__main__":
    _, importer, fmu, out = sys.argv
    np.save(Path(out), np.array({"libcosim": libcosim, "ecos": ecos}[importer](fmu)))
