"""How long roads take to read, and how much memory: each in a process of its own.

    python benchmarks/road_times.py

The roads are clean: arcs of 2 m, as surveys export them, along bends of 500 m radius; two
geometries across a continent, and two knots. A start of the function reads, and makes the
fingerprint.
"""

from __future__ import annotations

import cmath
import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from time import perf_counter, process_time
from typing import Final

from pldf.roads import fingerprint, read_route

MANY: Final = 1_000_000
LONG_M: Final = 9.999e6
_ARC_M: Final = 2.0
_BENDS_M: Final = 700.0
_CURVATURE_PER_M: Final = 0.002


def road_times(many: int = MANY, long_m: float = LONG_M) -> dict[str, dict[str, float]]:
    """Return times and memory for a road of ``many`` geometries and for one of ``long_m``."""
    with tempfile.TemporaryDirectory() as folder:
        paths = {
            f"{many} geometries": _written(Path(folder, "many.xodr"), _arcs(many), many * _ARC_M),
            f"{long_m / 1e3:g} km": _written(Path(folder, "long.xodr"), _halves(long_m), long_m),
        }
        csv = Path(folder, "long.csv")
        csv.write_text(f"s_m,curvature_per_m,speed_limit_mps\n0,0,25\n{long_m!r},0,25\n")
        paths[f"{long_m / 1e3:g} km, CSV"] = csv
        return {name: _measured(path) for name, path in paths.items()}


def _written(path: Path, geometries: Iterator[str], length_m: float) -> Path:
    head = f'<OpenDRIVE>\n<road id="1" length="{length_m!r}" junction="-1">\n<planView>\n'
    limit = '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'
    with path.open("w", encoding="utf-8") as file:
        file.write(head)
        file.writelines(geometries)
        file.write(f"</planView>\n{limit}\n</road>\n</OpenDRIVE>\n")
    return path


def _arcs(count: int) -> Iterator[str]:
    place, heading = 0j, 0.0
    for k in range(count):
        curvature = _CURVATURE_PER_M * math.sin(k * _ARC_M / _BENDS_M)
        yield _geometry(k * _ARC_M, place, heading, _ARC_M, f'<arc curvature="{curvature:.16e}"/>')
        half = 0.5 * curvature * _ARC_M
        chord = _ARC_M * (math.sin(half) / half if half else 1.0)
        place += chord * cmath.exp(1j * (heading + half))
        heading += 2.0 * half


def _halves(length_m: float) -> Iterator[str]:
    half_m = 0.5 * length_m
    yield _geometry(0.0, 0j, 0.3, half_m, "<line/>")
    yield _geometry(half_m, half_m * cmath.exp(0.3j), 0.3, half_m, '<arc curvature="1e-7"/>')


def _geometry(s_m: float, place: complex, heading: float, length_m: float, shape: str) -> str:
    pose = f'x="{place.real:.16e}" y="{place.imag:.16e}" hdg="{heading:.16e}"'
    return f'<geometry s="{s_m:.16e}" {pose} length="{length_m:.16e}">\n  {shape}\n</geometry>\n'


def _measured(path: Path) -> dict[str, float]:
    command = [sys.executable, __file__, str(path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    measured: dict[str, float] = json.loads(done.stdout)
    return measured


def _measure(path: Path) -> dict[str, float]:
    begin, cpu = perf_counter(), process_time()
    route = read_route(path)
    read_s, read_cpu_s = perf_counter() - begin, process_time() - cpu
    read_mb = getrusage(RUSAGE_SELF).ru_maxrss / 1024.0
    fingerprint(route)
    return {
        "read_s": read_s,
        "read_cpu_s": read_cpu_s,
        "read_and_fingerprint_s": perf_counter() - begin,
        "read_and_fingerprint_cpu_s": process_time() - cpu,
        "peak_memory_read_mb": read_mb,
        "peak_memory_mb": getrusage(RUSAGE_SELF).ru_maxrss / 1024.0,
    }


if __name__ == "__main__":
    found = _measure(Path(sys.argv[1])) if len(sys.argv) > 1 else road_times()
    print(json.dumps(found, indent=2))
