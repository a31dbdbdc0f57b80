"""The three models in all their kinds, driven by nonsense, in Python and by the C host."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, Final

import numpy as np
from forged import REAL
from native_hosts import PLATFORMS, Unpacked, Value, compiled_host
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.codes import XY
from pldf.kernel.signals import Signal

from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_state import SCRIPT
from vehicle_models.lead import LeadVehicle
from vehicle_models.lead_state import BY_SCRIPT
from vehicle_models.vehicle import LongitudinalVehicle

from . import built

HERE: Final = PLATFORMS["linux64"]
ROAD: Final = """s_m,curvature_per_m,speed_limit_mps,x_m,y_m
0,0,20,0,0
40,0.02,9,40,0
60,0,9,60,0
"""


@dataclass(frozen=True)
class Kind:
    """One of the models with parameters that make it use another part of its kernel."""

    fmu: str
    create: Callable[[], Instance[Any]]
    parameters: Mapping[str, int]


KINDS: Final = (
    Kind("AdaptivePLDF", DrivingFunction, {"learn": 1}),
    Kind("AdaptivePLDF", DrivingFunction, {"localization": XY}),
    Kind("LeadVehicle", LeadVehicle, {}),
    Kind("LeadVehicle", LeadVehicle, {"kind": BY_SCRIPT}),
    Kind("LongitudinalVehicle", LongitudinalVehicle, {}),
    Kind("ScriptedDriver", ScriptedDriver, {}),
    Kind("ScriptedDriver", ScriptedDriver, {"kind": SCRIPT}),
)


@contextmanager
def short_road() -> Iterator[Path]:
    """Give the file of a short road; a forged state may name any folder, seen from here."""
    with tempfile.TemporaryDirectory(prefix="faults_") as folder, chdir(folder):
        path = Path(folder, "road.csv")
        path.write_text(ROAD, encoding="utf-8")
        yield path


def of(signals: Sequence[Signal], causality: str) -> list[Signal]:
    """Return the numbers of this causality."""
    return [s for s in signals if s.causality == causality and s.kind != "String"]


def set_senseless(
    model: Instance[Any], signals: Sequence[Signal], rng: np.random.Generator, count: int
) -> None:
    """Set so many of the signals to what makes no sense."""
    for index in rng.permutation(len(signals))[:count]:
        setattr(model.record, signals[index].field, _senseless(signals[index], rng))


def _senseless(signal: Signal, rng: np.random.Generator) -> float:
    if signal.kind == "Boolean":
        return int(rng.integers(0, 2))
    if signal.kind != "Real":
        return int(rng.choice((0, 1, 2, 3, 4, 5, -1, 1000, 2**31 - 1, -(2**31))))
    if rng.random() < 0.3:
        return float(rng.choice((*REAL, 0.0, -0.0, 1e-300, 1e9, -1e9, 4499.9, 4500.0)))
    low, high = (min(max(bound, -100.0), 100.0) for bound in signal.range)
    return float(rng.uniform(low, high))


def is_sound_step(
    model: Instance[Any], signals: Sequence[Signal], rng: np.random.Generator
) -> bool:
    """Step once; tell whether outputs are numbers and a request keeps its limits and its jerk."""
    inputs = of(signals, "input")
    set_senseless(model, inputs, rng, int(rng.integers(0, len(inputs) + 1)))
    step_s = float(rng.choice((1e-3, 0.01, 0.037, 0.1, 1.0, 1.7e-13)))
    before = getattr(model.record, "acceleration_request_mps2", 0.0)
    model.step(step_s)
    if rng.random() < 0.5:
        set_senseless(model, inputs, rng, 1)
        model.refresh()
    good = all(isfinite(getattr(model.record, s.field)) for s in of(signals, "output"))
    if isinstance(model, DrivingFunction):
        st = model.record
        change = st.control_request_jerk_max_mps3 * step_s + 1e-9
        # The limits hold from wherever the request was: it moves towards them.
        low = min(st.control_request_min_mps2, before)
        high = max(st.control_request_max_mps2, before)
        good &= max(low, before - change) <= st.acceleration_request_mps2
        good &= st.acceleration_request_mps2 <= min(high, before + change)
    return good


@contextmanager
def c_host() -> Iterator[tuple[Path, Path]]:
    """Give a folder and the C host in it."""
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        compiled_host(HERE, Path(folder, "host"))
        yield Path(folder), Path(folder, "host")


def run(host: Path, job: str, *arguments: str) -> str | None:
    """Run a job of the C host; None if it has met a broken promise, or crashed."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith("PLDF_")}
    done = subprocess.run(
        [host, job, *arguments], env=kept, cwd=host.parent, capture_output=True, check=False
    )
    return done.stdout.decode() if done.returncode == 0 else None


def described(
    folder: Path, version: int, fmu: str, settings: Mapping[str, Value] | None = None
) -> str:
    """Return the file that tells the C host of a native FMU."""
    archives = built.folder("native") / ("fmi3" if version == 3 else "")
    unpacked = Unpacked.of(archives / f"{fmu}.fmu", folder / f"{fmu}{version}")
    return str(unpacked.described(HERE, folder / "fmu.txt", settings))
