"""Every speed that the README quotes, measured in one run and printed as one JSON.

    python benchmarks/bench.py [--dist dist]

Times are medians in seconds of wall clock. Expect noise on shared machines: compare ratios.
"""

from __future__ import annotations

import argparse
import json
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from typing import Any, Final

import fmu_step
from empty_fmu import build_empty_fmu
from fmu_step import time_fmu
from kernel_times import STUDY_KM, peak_memory_mb, plan_and_learn, step_times, toppra_s
from pldf.kernel.state import PldfState

from vehicle_models.driver_state import DriverState
from vehicle_models.vehicle_state import VehicleState

LENGTHS_KM: Final = (STUDY_KM, 45.0, 450.0, 1000.0)
ROUNDS: Final = 5
RECORDS: Final[dict[str, type[Any]]] = {
    "AdaptivePLDF": PldfState,
    "LongitudinalVehicle": VehicleState,
    "ScriptedDriver": DriverState,
}
CRUISE: Final = {"vehicle.speed_mps": 25.0}


def main() -> int:
    """Measure, print, return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dist", type=Path, default=Path("dist"), help="folder of the built FMUs")
    options = parser.parse_args()
    missing = [name for name in RECORDS if not (options.dist / f"{name}.fmu").is_file()]
    if missing:
        print(f"{options.dist} lacks {missing}; build with: python build_fmu.py", file=sys.stderr)
        return 1
    result = {
        "machine": {"python": platform.python_version(), "processor": platform.machine()},
        "fmu": {name: _fmu(options.dist / f"{name}.fmu", RECORDS[name]) for name in RECORDS},
        "kernel_step": step_times(),
        "toppra_4.5_km_s": toppra_s(),
        "by_length": [_by_length(length_km) for length_km in LENGTHS_KM],
    }
    print(json.dumps(result, indent=2))
    return 0


def _fmu(path: Path, record: type[Any]) -> dict[str, float]:
    """Compare with the empty FMU, in turn; medians of ROUNDS rounds."""
    with tempfile.TemporaryDirectory() as folder:
        empty = build_empty_fmu(record, Path(folder, "Empty.fmu"))
        ours, stock = [], []
        for _ in range(ROUNDS):
            ours.append(time_fmu(path, CRUISE))
            stock.append(time_fmu(empty, CRUISE))
    step_s = median(times.step_s for times in ours)
    empty_s = median(times.step_s for times in stock)
    return {
        "step_s": step_s,
        "empty_step_s": empty_s,
        "step_ratio": step_s / empty_s,
        "instantiate_and_initialize_s": median(times.start_s for times in ours),
        "the_same_first_in_a_process_s": median(_first_start_s(path) for _ in range(ROUNDS)),
    }


def _first_start_s(path: Path) -> float:
    command = [sys.executable, fmu_step.__file__, str(path)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def _by_length(length_km: float) -> dict[str, Any]:
    return {**plan_and_learn(length_km), "peak_memory_mb": peak_memory_mb(length_km)}


if __name__ == "__main__":
    sys.exit(main())
