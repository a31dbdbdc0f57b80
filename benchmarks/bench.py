"""Every speed that the README quotes, measured in one run and printed as one JSON.

    python benchmarks/bench.py [--dist dist]

Times are medians in seconds of wall clock. Expect noise on shared machines: compare ratios.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

from empty_fmu import build_empty_fmu
from fmu_step import time_fmu
from kernel_times import STUDY_KM, peak_memory_mb, plan_and_learn, step_times, toppra_s
from pldf.kernel.state import PldfState

LENGTHS_KM: Final = (STUDY_KM, 45.0, 450.0, 1000.0)
CRUISE: Final = {"vehicle.speed_mps": 25.0}


def main() -> int:
    """Measure, print, return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dist", type=Path, default=Path("dist"), help="folder of the built FMUs")
    options = parser.parse_args()
    path = options.dist / "AdaptivePLDF.fmu"
    if not path.is_file():
        print(f"{path} is missing; build it with: python build_fmu.py", file=sys.stderr)
        return 1
    result = {
        "machine": {"python": platform.python_version(), "processor": platform.machine()},
        "fmu": _fmu(path),
        "kernel_step": step_times(),
        "toppra_4.5_km_s": toppra_s(),
        "by_length": [_by_length(length_km) for length_km in LENGTHS_KM],
    }
    print(json.dumps(result, indent=2))
    return 0


def _fmu(path: Path) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        empty = build_empty_fmu(PldfState, Path(folder, "Empty.fmu"))
        rounds = [(time_fmu(path, CRUISE), time_fmu(empty, CRUISE)) for _ in range(5)]
    ours, stock = zip(*rounds, strict=True)
    step_s = sorted(times.step_s for times in ours)[2]
    empty_s = sorted(times.step_s for times in stock)[2]
    return {
        "step_s": step_s,
        "empty_step_s": empty_s,
        "step_ratio": step_s / empty_s,
        "instantiate_and_initialize_s": sorted(times.start_s for times in ours)[2],
    }


def _by_length(length_km: float) -> dict[str, Any]:
    return {**plan_and_learn(length_km), "peak_memory_mb": peak_memory_mb(length_km)}


if __name__ == "__main__":
    sys.exit(main())
