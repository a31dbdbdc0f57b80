"""Scripted drives of the three models, and the ways to drive them that need Python.

A drive is a table of float64: time in s, step in s (0: inputs are set and outputs read without a
step), then all inputs. Its results are a table of all outputs, first after initialization, then
after each row. Both have the order of the value references.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from native_hosts import Unpacked, Value
from numpy.typing import NDArray
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.signals import variables_of
from pldf.roads import packed_route
from wasm_host import WasmFmu, WasmSlave

from vehicle_models.driver import ScriptedDriver
from vehicle_models.lead import LeadVehicle
from vehicle_models.vehicle import LongitudinalVehicle

Table = NDArray[np.float64]
STEPS: Final = 4000
STORE: Final = "profile_store"


@dataclass(frozen=True)
class Case:
    """One model with parameters; a case with a store is driven twice in it.

    Attributes:
        model: name of the FMU.
        settings: parameters by name.
        inputs: function that returns inputs by field from (random numbers, step sizes in s).
        learns: whether it needs a profile store.
    """

    model: str
    settings: dict[str, Value]
    inputs: Callable[[np.random.Generator, Table], dict[str, Table]]
    learns: bool = False

    def stored(self, store: str) -> dict[str, Value]:
        """Return the parameters for this profile store."""
        return {**self.settings, STORE: store} if self.learns else self.settings

    @property
    def drives(self) -> int:
        """How often the drive is driven, with one store."""
        return 2 if self.learns else 1

    def script(self) -> Table:
        """Return the table of the drive."""
        rng = np.random.default_rng(20240611)
        step_s = rng.choice(
            [0.02, 0.037, 0.05, 1e-3, 1.7e-13, 0.0], STEPS, p=[0.6, 0.2, 0.1, 0.05, 0.03, 0.02]
        )
        inputs = self.inputs(rng, step_s)
        made = INSTANCES[self.model]()
        known = variables_of(made.record, made.texts)
        signals = [s for s in known if s.causality == "input"]
        assert inputs.keys() <= {s.field for s in signals}
        columns = [inputs.get(s.field, np.full(STEPS, float(s.start))) for s in signals]
        return np.column_stack([np.cumsum(step_s) - step_s, step_s, *columns])


# Inputs


def pressed(rng: np.random.Generator, gap: int, length: int) -> Table:
    """Return a contact that is closed now and then, for about ``length`` rows every ``gap``."""
    changes = rng.random(STEPS)
    closed = np.zeros(STEPS)
    for k in range(1, STEPS):
        closed[k] = changes[k] > 1 / length if closed[k - 1] else changes[k] < 1 / gap
    return closed


def with_nonsense(rng: np.random.Generator, column: Table) -> Table:
    """Return the column with three short spans in which it makes no sense."""
    for first in rng.integers(STEPS // 2, STEPS - 20, 3):
        column[first : first + 9] = rng.choice([math.nan, math.inf, -math.inf, 1e300, -1e9])
    return column


def motion(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return position, speed and acceleration of a plausible drive with two jumps and nonsense."""
    time_s = np.cumsum(step_s)
    speed = 20.0 + 4.0 * np.sin(0.11 * time_s) + 0.05 * rng.standard_normal(STEPS)
    place = 300.0 + np.cumsum(speed * step_s)
    place[STEPS // 2 :] += 600.0
    place[3 * STEPS // 4 :] -= 900.0
    return {
        "vehicle_s_m": place,
        "vehicle_speed_mps": with_nonsense(rng, speed),
        "vehicle_acceleration_mps2": with_nonsense(rng, 0.44 * np.cos(0.11 * time_s)),
    }


def function_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return pedals, lever, jumps, a car beside the road, nonsense."""
    moved = motion(rng, step_s)
    route = packed_route(0)
    line = {
        name: np.interp(moved["vehicle_s_m"], route.s_m, knots) + 0.2 * rng.standard_normal(STEPS)
        for name, knots in (("vehicle_x_m", route.x_m), ("vehicle_y_m", route.y_m))
    }
    line["vehicle_x_m"][3500:3550] += 400.0
    levers = ("cancel", "up", "down", "up_long", "down_long")
    return {
        **moved,
        **line,
        "driver_gas_pedal": with_nonsense(rng, pressed(rng, 300, 60) * rng.random(STEPS)),
        "driver_brake_pedal": pressed(rng, 600, 30) * rng.random(STEPS),
        "lever_resume": pressed(rng, 60, 8),
        **{f"lever_{name}": pressed(rng, 400, 12) for name in levers},
        "eligible": 1.0 - pressed(rng, 900, 30),
    }


def word_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return the same with a driver who pauses, forgets, and takes back this drive."""
    return {
        **function_inputs(rng, step_s),
        "teach_pause": pressed(rng, 900, 60),
        "teach_forget_here": pressed(rng, 500, 5),
        "teach_undo": pressed(rng, 1200, 5),
    }


def undo_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return the same with a driver who takes back this drive, the last one, and nothing."""
    undo = np.zeros(STEPS)
    for first in (2000, 2010, 2020):
        undo[first : first + 5] = 1.0
    return {**function_inputs(rng, step_s), "teach_undo": undo}


def vehicle_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return requests and pedals up to standstill, and nonsense."""
    wave = 2.5 * np.sin(0.3 * np.cumsum(step_s)) + 0.2 * rng.standard_normal(STEPS)
    return {
        "acceleration_request_mps2": with_nonsense(rng, wave),
        "driver_gas_pedal": pressed(rng, 300, 100) * 2.0 * rng.random(STEPS),
        "driver_brake_pedal": with_nonsense(rng, pressed(rng, 600, 100) * rng.random(STEPS)),
        "function_active": 1.0 - pressed(rng, 300, 200),
    }


def driver_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return what a driver sees: a drive, all modes and two that do not exist, speeds, nonsense."""
    modes = np.repeat(rng.choice([0, 1, 2, 2, 2, 3, 4, 7, -1], STEPS // 50), 50).astype(float)
    return {
        **motion(rng, step_s),
        "mode": modes,
        "target_speed_mps": with_nonsense(rng, 20.0 + 3.0 * rng.standard_normal(STEPS)),
        "set_speed_mps": np.repeat(rng.uniform(0.0, 40.0, STEPS // 100), 100),
        "limit_mps": np.repeat(rng.choice([50.0, 70.0, 100.0], STEPS // 200) / 3.6, 200),
        "lead_present": pressed(rng, 300, 200),
        "lead_gap_m": with_nonsense(rng, 80.0 * rng.random(STEPS)),
        "lead_speed_mps": with_nonsense(rng, np.repeat(rng.uniform(0.0, 25.0, STEPS // 100), 100)),
    }


def lead_inputs(rng: np.random.Generator, step_s: Table) -> dict[str, Table]:
    """Return a drive with jumps and nonsense."""
    moved = motion(rng, step_s)
    return {name: moved[name] for name in ("vehicle_s_m", "vehicle_speed_mps")}


INSTANCES: Final[dict[str, Callable[[], Instance[Any]]]] = {
    "AdaptivePLDF": DrivingFunction,
    "LeadVehicle": LeadVehicle,
    "LongitudinalVehicle": LongitudinalVehicle,
    "ScriptedDriver": ScriptedDriver,
}
CASES: Final = {
    "learn": Case("AdaptivePLDF", {"learn": 1}, function_inputs, learns=True),
    "by line": Case(
        "AdaptivePLDF", {"learn_faithful": 1, "localization": 1}, function_inputs, learns=True
    ),
    "words": Case(
        "AdaptivePLDF", {"learn_faithful": 1, "apply_learned": 1}, word_inputs, learns=True
    ),
    "undo": Case(
        "AdaptivePLDF", {"learn_faithful": 1, "apply_learned": 1}, undo_inputs, learns=True
    ),
    "hills": Case(
        "LongitudinalVehicle", {"grade_from_route": 1, "start_speed_mps": 20.0}, vehicle_inputs
    ),
    "slope": Case(
        "LongitudinalVehicle", {"grade_from_route": 0, "grade_constant": 0.07}, vehicle_inputs
    ),
    "one car": Case(
        "LeadVehicle", {"kind": 0, "scene.change_s": 9.0, "scene.leave_s": 40.0}, lead_inputs
    ),
    "traffic script": Case("LeadVehicle", {"kind": 1, "script_id": 1}, lead_inputs),
    "traffic": Case(
        "LeadVehicle", {"kind": 2, "traffic.free_s": 2.0, "traffic.stay_s": 9.0}, lead_inputs
    ),
    "hands off": Case("ScriptedDriver", {"kind": 0}, driver_inputs),
    "script": Case("ScriptedDriver", {"kind": 1}, driver_inputs),
    "wish": Case(
        "ScriptedDriver", {"kind": 2, "seed": 7, "driver.uses_lever": 1, "driver.spread": 0.5},
        driver_inputs,
    ),
    "wish that varies": Case(
        "ScriptedDriver",
        {
            "kind": 2, "seed": 7, "person_seed": 999_999_999, "driver.uses_lever": 1,
            "wish.offset_person_sd_mps": 1.0, "wish.offset_place_sd_mps": 0.8,
            "wish.offset_occasion_sd_mps": 0.6, "wish.lateral_person_sigma": 0.2,
            "wish.lateral_place_sigma": 0.1, "wish.lateral_occasion_sigma": 0.1,
        },
        driver_inputs,
    ),
}  # fmt: skip


# Ways


def by_source(case: Case, script: Table, store: Path) -> Table:
    """Drive in CPython, without FMI; return the results."""
    instance = INSTANCES[case.model]()
    signals = variables_of(instance.record, instance.texts)
    numbers = [s for s in signals if s.kind != "String"]
    inputs, outputs = ([s.field for s in numbers if s.causality == c] for c in ("input", "output"))
    fields = {s.name: s.field for s in signals}
    for name, value in case.settings.items():
        setattr(instance.record, fields[name], value)
    if case.learns:
        instance.texts.profile_store = str(store)
    kinds = [type(getattr(instance.record, field)) for field in inputs]
    instance.initialize()
    results = [[getattr(instance.record, field) for field in outputs]]
    for _, step_s, *values in script.tolist():
        for field, kind, value in zip(inputs, kinds, values, strict=True):
            setattr(instance.record, field, kind(value))
        if step_s:
            instance.step(step_s)
        else:
            instance.refresh()
        results.append([getattr(instance.record, field) for field in outputs])
    instance.finish()
    return np.array(results, np.float64)


def by_fmpy(fmu: Unpacked, script: Table, settings: Mapping[str, Value]) -> Table:
    """Drive an FMU of either version in fmpy; return the results."""
    slave = started(fmu, settings)
    results = driven(slave, fmu, script)
    slave.freeInstance()
    return results


def by_wasmtime(
    fmu: WasmFmu, script: Table, settings: Mapping[str, Value], files: Mapping[str, bytes]
) -> tuple[Table, dict[str, bytes]]:
    """Drive an FMU as WebAssembly; return the results and the files that it leaves."""
    slave = WasmSlave(fmu, files)
    slave.set_named(fmu, settings)
    slave.initialize()
    return driven(slave, fmu, script), slave.files()


def driven(slave: Any, fmu: Unpacked | WasmFmu, script: Table) -> Table:
    """Drive an instance that is initialized to the end; return the results."""
    inputs, outputs = (by_type(fmu, causality) for causality in ("input", "output"))
    results = [read(slave, outputs)]
    for time_s, step_s, *values in script.tolist():
        for kind, (places, references) in inputs.items():
            whole = kind not in ("Real", "Float64")
            chosen = [int(values[i]) if whole else values[i] for i in places]
            getattr(slave, f"set{kind}")(references, chosen)
        if step_s:
            slave.doStep(time_s, step_s)
        results.append(read(slave, outputs))
    slave.terminate()
    return np.array(results, np.float64)


def started(fmu: Unpacked, settings: Mapping[str, Value]) -> Any:
    """Return an instance of fmpy, initialized with these parameters."""
    kind = FMU2Slave if fmu.version == 2 else FMU3Slave
    slave = kind(
        guid=fmu.description.guid,
        unzipDirectory=str(fmu.folder),
        modelIdentifier=fmu.description.coSimulation.modelIdentifier,
        instanceName="drive",
    )
    slave.instantiate()
    for v in fmu.description.modelVariables:
        if v.name in settings:
            getattr(slave, f"set{setter(v.type, fmu.version)}")(
                [v.valueReference], [settings[v.name]]
            )
    if fmu.version == 2:
        slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave


def setter(kind: str, version: int) -> str:
    """Return the name that the type has in the names of functions."""
    return {"Enumeration": "Integer" if version == 2 else "Int64"}.get(kind, kind)


def by_type(fmu: Unpacked | WasmFmu, causality: str) -> dict[str, tuple[list[int], list[int]]]:
    """Return places and value references of the variables with this causality, by type."""
    found: dict[str, tuple[list[int], list[int]]] = {}
    for place, variable in enumerate(fmu.variables(causality)):
        places, references = found.setdefault(setter(variable.type, fmu.version), ([], []))
        places.append(place)
        references.append(variable.valueReference)
    return found


def read(slave: Any, outputs: dict[str, tuple[list[int], list[int]]]) -> Sequence[float]:
    """Return all outputs in the order of the value references."""
    row = [0.0] * sum(len(places) for places, _ in outputs.values())
    for kind, (places, references) in outputs.items():
        for place, value in zip(places, getattr(slave, f"get{kind}")(references), strict=True):
            row[place] = float(value)
    return row
