"""Mutated files: whatever stands in a file, it is understood or refused, by every reader alike."""

from __future__ import annotations

import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import numpy as np
from fmi_host import Host, Slave
from hostile_files import is_prepared
from pldf.cosim.prepared import prepared_route, prepared_script
from pldf.function import DrivingFunction
from pldf.kernel.signals import signals_of
from pldf.profiles.profile_file import decode, encode
from pldf.profiles.profile_format_1 import encode_1
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.profiles.stored_profile import COLUMN_NAMES, KINDS
from pldf.roads import Route, fingerprint
from pldf.roads.load import read_route

from . import built
from .experiment import Counts, Experiment, Progress
from .mutations import mutated

DRIVER: Final = 17
STEP_S: Final = 0.25
SPEED_MPS: Final = 20.0
STEPS: Final = 8
# A short road: planning takes no time, and every byte of a file matters.
ROAD: Final = "s_m,curvature_per_m,speed_limit_mps\n0,0,20\n20,0.01,20\n40,0,15\n"
LINES: Final = 4

Rows = list[list[float]]


def profiles(count: int, seed: int, progress: Progress) -> Counts:
    """Give mutated profiles of both formats to the Python and the native driving function.

    Each goes on to drive, with a press of the gas pedal, to learn and to save.
    """
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as place:
        host = Host(built.folder("native") / "AdaptivePLDF.fmu")
        route = _road(place)
        (place / "road.prepared").write_bytes(prepared_route(route))
        sound = list(_sound_profiles(route, rng))
        for number in range(count):
            data = mutated(sound[rng.choice(len(sound))], rng)
            stores = [_store(place / who, route, data) for who in ("python", "c")]
            python = _driven_in_python(place / "road.csv", stores[0])
            native = _driven_in_c(host, place / "road.prepared", stores[1])
            found.update(_judged(python, native, stores))
            found["in_format_1"] += data.startswith(b"PLDF-PROFILE 1\n")
            progress(number + 1)
    return dict(found)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Give a temporary folder, in memory where that is possible: what is saved is flushed."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(
        prefix="faults_", dir=memory if memory.is_dir() else None
    ) as folder:
        yield Path(folder)


def _road(folder: Path) -> Route:
    """Return the road, written to ``road.csv``."""
    path = folder / "road.csv"
    path.write_text(ROAD, encoding="utf-8")
    return read_route(path)


def _sound_profiles(route: Route, rng: np.random.Generator) -> Iterator[bytes]:
    """Yield profiles of both formats, with up to three iterations of all kinds."""
    base = rng.uniform(10.0, 20.0, route.nodes)
    profile = StoredProfile(DRIVER, fingerprint(route), base)
    yield from (encode(profile), encode_1(profile))
    for kind in KINDS:
        changed = rng.choice(COLUMN_NAMES, 9, replace=False)
        values = {
            name: rng.uniform(5.0, 25.0, route.nodes)
            if name.endswith("_mps")
            else rng.integers(0, 3, route.nodes).astype(float)
            for name in changed
        }
        note = "rollback of 0" if kind == "rollback" else kind
        profile = profile.with_iteration(profile.next_iteration(kind, note, 2, values))
        yield from (encode(profile), encode_1(profile))


def _store(folder: Path, route: Route, data: bytes) -> Path:
    """Return the new store ``folder`` with a profile of these bytes."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    ProfileStore(folder).path(DRIVER, fingerprint(route)).write_bytes(data)
    return folder


def _driven_in_python(road: Path, store: Path) -> Rows:
    """Return all outputs after each step; what the function reports goes nowhere."""
    function = DrivingFunction()
    st = function.record
    outputs = [s.field for s in signals_of(st) if s.causality == "output"]
    fields = {s.name: s.field for s in signals_of(st)}
    function.texts.route_file, function.texts.profile_store = str(road), str(store)
    st.learn, st.driver_id = 1, DRIVER
    function.initialize()
    rows = [[float(getattr(st, field)) for field in outputs]]
    for inputs in _drive():
        for name, value in inputs.items():
            setattr(st, fields[name], value)
        function.step(STEP_S)
        rows.append([float(getattr(st, field)) for field in outputs])
    function.finish()
    return rows


def _driven_in_c(host: Host, road: Path, store: Path) -> Rows:
    """Return the same of the native FMU."""
    slave = host.instantiate()
    slave.start(route_file=str(road), profile_store=str(store), learn=1, driver_id=DRIVER)
    rows = [_outputs(slave)]
    for number, inputs in enumerate(_drive()):
        slave.set(**inputs)
        slave.fmu.doStep(STEP_S * number, STEP_S)
        rows.append(_outputs(slave))
    slave.fmu.terminate()
    slave.free()
    return rows


def _drive() -> Iterator[dict[str, float]]:
    """Yield the inputs of each step: activated, then a press of the gas pedal."""
    for step in range(STEPS):
        yield {
            "vehicle.s_m": SPEED_MPS * STEP_S * step,
            "vehicle.speed_mps": SPEED_MPS,
            "lever.resume": step == 0,
            "driver.gas_pedal": 0.5 if 2 <= step < 5 else 0.0,
        }


def _outputs(slave: Slave) -> list[float]:
    outputs = slave.outputs().values()
    return [float(value) for value in outputs if not isinstance(value, str)]


def _judged(python: Rows, native: Rows, stores: list[Path]) -> Counts:
    """Return what is to be counted of a file that both have read."""
    kept = [{path.name: path.read_bytes() for path in store.iterdir()} for store in stores]
    refused = any(".refused-" in name for name in kept[0])
    saved = [data for name, data in kept[0].items() if name.endswith(".pldf")]
    good = (
        np.isfinite(python).all()
        and python == native
        and kept[0] == kept[1]
        and len(saved) == 1
        and len(decode(saved[0], "saved").iterations) >= 1
    )
    return {"refused" if refused else "accepted": 1, "violations": 0 if good else 1}


def prepared_files(count: int, seed: int, progress: Progress) -> Counts:
    """Give mutated prepared roads and scripts to the native FMUs, which alone read them."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(violations=0)
    with temporary_folder() as folder:
        path = folder / "mutated.prepared"
        models = {
            kind: (Host(built.folder("native") / f"{model}.fmu"), good)
            for kind, model, good in (
                ("route", "AdaptivePLDF", prepared_route(_road(folder))),
                ("script", "ScriptedDriver", _sound_script(rng)),
            )
        }
        for number in range(count):
            kind = "route" if number % 2 else "script"
            host, good = models[kind]
            data = mutated(good, rng)
            path.write_bytes(data)
            found.update(_read_in_c(host, kind, path, data))
            progress(number + 1)
    return dict(found)


def _sound_script(rng: np.random.Generator) -> bytes:
    return prepared_script(tuple(rng.integers(0, 2, LINES).astype(float) for _ in range(6)))


def _read_in_c(host: Host, kind: str, path: Path, data: bytes) -> Counts:
    slave = host.instantiate()
    slave.set(**{f"{kind}_file": str(path)}, **({"kind": 1} if kind == "script" else {}))
    slave.fmu.setupExperiment(startTime=0.0)
    slave.fmu.enterInitializationMode()
    accepted = slave.status("exitInitializationMode") == 0
    good = accepted == is_prepared(data, kind, 5 if kind == "route" else 6)
    if accepted:
        for step in range(STEPS):
            good &= slave.status("doStep", STEP_S * step, STEP_S) == 0
            good &= bool(np.isfinite(_outputs(slave)).all())
    slave.free()
    return {"accepted" if accepted else "refused": 1, "violations": 0 if good else 1}


EXPERIMENTS: Final = (
    Experiment(
        "mutated_profiles",
        "A mutated profile is refused and kept, or driven: alike to the bit in Python and C.",
        profiles,
        count=9000,
        short=150,
    ),
    Experiment(
        "mutated_prepared_files",
        "A mutated prepared file is refused, or driven with finite outputs; nothing crashes.",
        prepared_files,
        count=24_000,
        short=200,
    ),
)
