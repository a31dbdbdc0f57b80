"""Times of the native FMUs, measured by a C host without Python (``native_step.c``)."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, Final, NamedTuple
from zipfile import ZipFile

from empty_native import build_empty, build_host
from study_inputs import Load, study_loads

NS: Final = 1e-9
MEMORY: Final = Path("/dev/shm")  # a folder without a disk, where Linux has it
HOST: Final = Path(__file__).with_name("native_step.c")
LEARNS: Final = "AdaptivePLDF"
_PERCENTILES: Final = ("p50_s", "p99_9_s", "max_s")


class Effort(NamedTuple):
    """How much is measured."""

    drive_steps: int = 1_000_000  # of the study's drive, which has 20,000
    runs: int = 20
    drives: int = 5  # in each run, of either FMU in turn
    single_steps: int = 10_000_000
    starts: int = 101
    finishes: int = 21


def native_times(folder: Path, effort: Effort) -> dict[str, Any]:
    """Return the times of all native FMUs in ``folder`` (FMI 2.0), in seconds."""
    result: dict[str, Any] = {}
    with TemporaryDirectory() as temporary:
        program = Path(temporary, "native_step")
        build_host(HOST, program)
        for name, load in study_loads(folder, effort.drive_steps):
            print(f"native: {name}", file=sys.stderr, flush=True)
            place = Path(temporary, name)
            place.mkdir()
            bench = Bench(program, load, place)
            result[name] = _times(bench, effort)
            if name == LEARNS:
                result["terminate_with_learning"] = _finish_times(bench, effort.finishes, folder)
    return result


class Bench:
    """The C host with one FMU and its empty twin; ``place`` is an empty folder for its files."""

    def __init__(self, program: Path, load: Load, place: Path) -> None:
        self.program = program
        name = load.fmu.description.coSimulation.modelIdentifier
        guid = load.fmu.description.guid
        library = load.fmu.folder / "binaries" / "linux64" / f"{name}.so"
        (place / "table").write_bytes(load.table)
        (place / "empty").mkdir()
        self.fmu, self.empty = place / "fmu.txt", place / "empty.txt"
        twin = build_empty(name, guid, place / "empty")
        for path, shared in ((self.fmu, library), (self.empty, twin)):
            resources = (load.fmu.folder / "resources").as_uri()
            lines = [shared, guid, resources, load.signals, place / "table"]
            path.write_text("\n".join(map(str, lines)) + "\n")

    def run(self, *arguments: object, store: str = "") -> list[list[str]]:
        """Return the words of each line that the host prints."""
        command = [str(self.program), *map(str, arguments)]
        environment = {**os.environ, "PLDF_PROFILE_STORE": store}
        done = subprocess.run(
            command, env=environment, stdout=subprocess.PIPE, text=True, check=True
        )
        return [line.split() for line in done.stdout.splitlines()]


def _times(bench: Bench, effort: Effort) -> dict[str, Any]:
    runs = [bench.run("cost", bench.fmu, bench.empty, effort.drives) for _ in range(effort.runs)]
    costs = _columns([list(map(median, _columns(run))) for run in runs])
    quantiles = bench.run("tail", bench.fmu, bench.empty, effort.single_steps)
    single = {
        who: dict(zip(_PERCENTILES, (NS * float(x) for x in numbers), strict=True))
        for who, *numbers in quantiles
    }
    firsts = [bench.run("start", bench.fmu, 1)[0] for _ in range(5)]
    later = _columns(bench.run("start", bench.fmu, effort.starts)[1:])
    step_s, empty_s = (NS * median(column) for column in costs)
    return {
        "step_cpu_s": step_s,
        "empty_step_cpu_s": empty_s,
        "step_ratio": step_s / empty_s,
        "step_cpu_min_s": NS * min(costs[0]),
        "single_step": single["fmu"],
        "single_step_of_empty": single["empty"],
        "single_call_of_clock": single["clock"],
        "first_start_in_a_process": _cpu_and_wall(_columns(firsts)),
        "instantiate_and_initialize": _cpu_and_wall(later),
    }


def _finish_times(bench: Bench, times: int, disk: Path) -> dict[str, Any]:
    """Time ``terminate`` after the study's drive; each with a new store, if with any."""
    result = {"without_store": _cpu_and_wall(_columns(bench.run("finish", bench.fmu, times)))}
    places = {"store_in_memory": MEMORY, "store_on_disk": disk}
    for name, parent in places.items():
        if not os.access(parent, os.W_OK):
            continue
        lines = []
        for _ in range(times):
            with TemporaryDirectory(dir=parent) as store:
                lines += bench.run("finish", bench.fmu, 1, store=store)
        result[name] = _cpu_and_wall(_columns(lines))
    return result


def _columns(lines: Sequence[Sequence[str | float]]) -> list[list[float]]:
    return [[float(word) for word in column] for column in zip(*lines, strict=True)]


def _cpu_and_wall(columns: Sequence[Sequence[float]]) -> dict[str, float]:
    cpu, wall = columns
    return {"cpu_s": NS * median(cpu), "wall_s": NS * median(wall)}


def archive_sizes(folder: Path) -> dict[str, Any]:
    """Return size and platforms of each archive below ``folder``."""
    result = {}
    for path in sorted(folder.rglob("*.fmu")):
        with ZipFile(path) as archive:
            names = [n.split("/") for n in archive.namelist() if n.startswith("binaries/")]
        platforms = sorted({parts[1] for parts in names if len(parts) > 2})
        name = path.relative_to(folder).as_posix()
        result[name] = {"bytes": path.stat().st_size, "platforms": platforms}
    return result
