"""Runs a package in an importer, which writes its own kind of result into a folder.

``python master_results.py IMPORTER PACKAGE SECONDS FOLDER``, in a process of its own, as
``ssp_masters`` is.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.util import write_csv
from ssp_masters import STEP_S, handed_over, load_tbb


def fmpy(package: str, seconds: float, folder: Path) -> None:
    rows = simulate_ssp(
        package, stop_time=seconds, step_size=STEP_S, parameter_set=handed_over(package)
    )
    write_csv(folder / "fmpy.csv", rows)
    np.save(folder / "fmpy.npy", rows)


def libcosim(package: str, seconds: float, folder: Path) -> None:
    from libcosimpy.CosimExecution import CosimExecution  # noqa: PLC0415
    from libcosimpy.CosimObserver import CosimObserver  # noqa: PLC0415

    execution = CosimExecution.from_ssp_file(package, step_size=STEP_S * 1e9)
    observer = CosimObserver.create_to_dir(str(folder))
    assert execution.add_observer(observer)
    for _ in range(round(seconds / STEP_S)):
        assert execution.step()


def ecos(package: str, seconds: float, folder: Path) -> None:
    load_tbb()
    from ecospy import EcosSimulation  # noqa: PLC0415

    with EcosSimulation(step_size=STEP_S, ssp_path=package) as simulation:
        simulation.add_csv_writer(str(folder / "ecos.csv"))
        assert simulation.init(parameter_set="initialValues")
        for _ in range(round(seconds / STEP_S)):
            simulation.step()
        simulation.terminate()


if __name__ == "__main__":
    _, importer, package, seconds, folder = sys.argv
    run = {"fmpy": fmpy, "libcosim": libcosim, "ecos": ecos}[importer]
    run(package, float(seconds), Path(folder))
