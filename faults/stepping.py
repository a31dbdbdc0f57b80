"""Steps that make no sense, and days in one instance."""

from __future__ import annotations

import gc
import os
from collections import Counter
from hashlib import sha256
from pathlib import Path
from typing import Final

import numpy as np
from fmi3_host import Host3, Slave3
from fmi_host import Host, Slave
from pldf.errors import ModelError
from pldf.fmi.session import Session

from . import built
from .experiment import Counts, Experiment, Progress
from .models import KINDS, c_host, described, is_sound_step, of, run, set_senseless, short_road

STEPS: Final = 100  # of a round in Python
NATIVE_STEPS: Final = 100_000
HOUR_S: Final = 3600.0
LONG_STEP_S: Final = 0.25
SPEED_MPS: Final = 20.0
GROWTH_MAX_BYTES: Final = 4_000_000  # a page now and then is the allocator's
REALS: Final = ("Real", "Float64")
FMUS: Final = tuple(dict.fromkeys(kind.fmu for kind in KINDS))


def fuzzed_steps(count: int, seed: int, progress: Progress) -> Counts:
    """Drive the Python models: senseless inputs, step sizes, parameters; watch all outputs."""
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter(steps=0, refused=0, violations=0)
    with short_road() as road:
        for round_ in range(count):
            kind = KINDS[round_ % len(KINDS)]
            session = Session(kind.create)
            if round_ % 50:  # else the study's, which takes a while to plan
                session.model.texts.route_file = str(road)
            set_senseless(
                session.model, of(session.signals, "parameter"), rng, int(rng.integers(0, 3))
            )
            found.update(_fuzzed(session, rng))
            progress(round_ + 1)
    return dict(found)


def _fuzzed(session: Session, rng: np.random.Generator) -> Counts:
    try:
        session.enter()
        session.exit()
    except ModelError:
        return {"refused": 1}
    sound = [is_sound_step(session.model, session.signals, rng) for _ in range(STEPS)]
    session.restore(session.state())  # no range is too narrow for what a drive can come to
    return {"steps": STEPS, "violations": STEPS - sum(sound)}


def fuzzed_steps_native(count: int, seed: int, progress: Progress) -> Counts:
    """Let the C host drive the native FMUs of both versions of FMI with nonsense."""
    found: Counter[str] = Counter(steps=0, violations=0)
    fmus = [(fmu, version) for fmu in FMUS for version in (2, 3)]
    with c_host() as (folder, host):
        for round_ in range(count):
            fmu, version = fmus[round_ % len(fmus)]
            file = described(folder, version, fmu)
            ran = run(host, "hostile", file, str(NATIVE_STEPS), str(seed + round_))
            found.update(steps=NATIVE_STEPS, violations=int(ran is None))
            progress(round_ + 1)
    return dict(found)


def long_run(count: int, seed: int, progress: Progress) -> Counts:
    """Drive hour after hour in one instance of each native FMU, and the first one again."""
    rng = np.random.default_rng(seed)
    slaves: list[Slave] = []
    for fmu in FMUS:
        slaves.append(Host(built.folder("native") / f"{fmu}.fmu").instantiate().start())
        slaves.append(Host3(built.folder("native") / "fmi3" / f"{fmu}.fmu").instantiate().start())
    drives = [_Drive(slave, rng) for slave in slaves]
    states = [slave.state() for slave in slaves]
    firsts = [drive.hour(0.0) for drive in drives]
    violations, memory = 0, 0
    for hour in range(count + 1):
        for slave, drive, state, first in zip(slaves, drives, states, firsts, strict=True):
            drive.hour(HOUR_S * (hour + 1))
            here = slave.state()
            violations += slave.restore(state) != 0 or drive.hour(0.0) != first
            violations += slave.restore(here) != 0
        memory = memory or _resident_bytes()  # behind the first hour: all that is kept is there
        progress(hour)
    grown = _resident_bytes() - memory
    for slave in slaves:
        slave.free()
    return {
        "hours": 2 * (count + 1) * len(slaves),
        "grown_bytes": grown,
        "violations": violations + (grown > GROWTH_MAX_BYTES),
    }


class _Drive:
    """The same inputs every hour: laps of the road, pedals and lever now and then."""

    def __init__(self, slave: Slave, rng: np.random.Generator) -> None:
        known = slave.variables.values()
        self.slave = slave
        self.reals = [v for v in known if v.causality == "input" and v.type in REALS]
        self.flags = [v for v in known if v.causality == "input" and v.type == "Boolean"]
        self.outputs = [
            v.valueReference for v in known if v.causality == "output" and v.type in REALS
        ]
        steps = int(HOUR_S / LONG_STEP_S)
        self.values = rng.uniform(0.0, 0.3, (steps, len(self.reals)))
        self.values[:, [v.unit == "m/s" for v in self.reals]] += SPEED_MPS
        place = SPEED_MPS * LONG_STEP_S * np.arange(steps)[:, None] % 4000.0
        self.values[:, [v.name == "vehicle.s_m" for v in self.reals]] = place
        self.pressed = rng.random((steps, len(self.flags))) < 0.05

    def hour(self, start_s: float) -> str:
        """Drive an hour from a time on; return the digest of all Real outputs."""
        fmu, digest = self.slave.fmu, sha256()
        set_real, get_real = (getattr(fmu, f"{call}{self._real}") for call in ("set", "get"))
        reals = [v.valueReference for v in self.reals]
        flags = [v.valueReference for v in self.flags]
        for step, (values, pressed) in enumerate(
            zip(self.values.tolist(), self.pressed.tolist(), strict=True)
        ):
            set_real(reals, values)
            fmu.setBoolean(flags, pressed)
            fmu.doStep(start_s + LONG_STEP_S * step, LONG_STEP_S)
            digest.update(np.array(get_real(self.outputs)).tobytes())
        self.slave.log.clear()  # what was told is the importer's memory, not the FMU's
        return digest.hexdigest()

    @property
    def _real(self) -> str:
        return "Float64" if isinstance(self.slave, Slave3) else "Real"


def _resident_bytes() -> int:
    gc.collect()
    pages = Path("/proc/self/statm").read_text().split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


EXPERIMENTS: Final = (
    Experiment(
        "fuzzed_steps",
        "Whatever is set, outputs are numbers, and requests keep to their limits and jerk.",
        fuzzed_steps,
        count=3200,
        short=30,
    ),
    Experiment(
        "fuzzed_steps_native",
        "Nonsense crashes no native FMU and gets out no output that is not a number.",
        fuzzed_steps_native,
        count=240,
        short=6,
    ),
    Experiment(
        "long_run",
        "Memory does not grow in days of one instance, and the first hour can be driven again.",
        long_run,
        count=9,
        short=1,
    ),
)
