"""Every speed that the README quotes, measured in one run and printed as one JSON.

    python benchmarks/bench.py [--dist dist]

Times are medians in seconds of wall clock, unless their name says that the processor's time was
measured (``cpu``). Expect noise on shared machines: compare ratios, and what the empty FMU and the
clock alone show in the same run.
"""

from __future__ import annotations

import argparse
import json
import platform
import subprocess
import sys
import tempfile
from contextlib import redirect_stdout
from pathlib import Path
from statistics import median
from typing import Any, Final

import fmu_step
from command_times import command_times
from empty_fmu import build_empty_fmu
from fmpy import read_model_description  # type: ignore[import-untyped]
from fmu_step import time_fmu
from kernel_times import STUDY_KM, peak_memory_mb, plan_and_learn, step_times, toppra_s
from pldf.cosim.which_fmus import up_to_date
from pldf.kernel.state import PldfState
from road_times import road_times
from study_times import study_times
from wasm_times import wasm_times

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
        print(f"{options.dist} lacks {missing}; build with: pldf build", file=sys.stderr)
        return 1
    result = {
        "machine": {"python": platform.python_version(), "processor": platform.machine()},
        "command_cpu_s": command_times(),
        "study_wall_s": study_times(),
        "roads": road_times(),
        "fmu": {name: _fmu(options.dist / f"{name}.fmu", RECORDS[name]) for name in RECORDS},
        "kernel_step": step_times(),
        "toppra_4.5_km_s": toppra_s(),
        "by_length": [_by_length(length_km) for length_km in LENGTHS_KM],
        "native": _native(options.dist),
        "web_assembly": wasm_times(),
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


def _native(dist: Path) -> dict[str, Any] | None:
    """Return the times of the native FMUs; None, and say why, if they cannot be measured."""
    folder = dist / "native"
    problem = _native_problem(folder)
    try:
        from native_times import Effort, archive_sizes, native_times  # noqa: PLC0415 - an extra
    except ImportError as absent:
        problem = f"{absent}; run: pip install -e .[native]"
    if problem:
        print(f"no native times: {problem}", file=sys.stderr)
        return None
    return {
        **native_times(folder, Effort()),
        "in_fmpy": {name: _in_fmpy(dist, name) for name in RECORDS},
        "archives": archive_sizes(folder),
    }


def _native_problem(folder: Path) -> str:
    """Return what is in the way of measuring the native FMUs in ``folder``; empty if nothing."""
    rebuild = "build with: pldf build --native"
    if sys.platform != "linux":
        return "the C host runs on Linux only"
    for path in (folder / f"{name}.fmu" for name in RECORDS):
        if not path.is_file():
            return f"there is no {path}; {rebuild}"
        if not up_to_date(read_model_description(str(path))):
            return f"{path} is made from other sources; {rebuild}"
    return ""


def _in_fmpy(dist: Path, name: str) -> dict[str, float]:
    """Step the Python FMU and the native ones in turn; medians of ROUNDS rounds."""
    paths = {
        "python_fmi2": dist / f"{name}.fmu",
        "native_fmi2": dist / "native" / f"{name}.fmu",
        "native_fmi3": dist / "native" / "fmi3" / f"{name}.fmu",
    }
    built = {kind: path for kind, path in paths.items() if path.is_file()}
    with redirect_stdout(sys.stderr):  # fmpy prints there what an FMU says
        rounds = [{k: time_fmu(p, CRUISE).step_s for k, p in built.items()} for _ in range(ROUNDS)]
    steps = {f"{kind}_step_s": median(times[kind] for times in rounds) for kind in built}
    return {**steps, "python_to_native": steps["python_fmi2_step_s"] / steps["native_fmi2_step_s"]}


def _by_length(length_km: float) -> dict[str, Any]:
    return {**plan_and_learn(length_km), "peak_memory_mb": peak_memory_mb(length_km)}


if __name__ == "__main__":
    sys.exit(main())
