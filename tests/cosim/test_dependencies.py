"""Outputs follow exactly the inputs that are declared, in the sources and in the built FMUs.

A claim that is missing gives a master wrong values, one that is too much an algebraic loop.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from graphlib import TopologicalSorter
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_host import Host, Slave
from lxml import etree
from pldf.cosim.fmu import Fmu
from pldf.cosim.kinds import PARTS_IN_TRAFFIC
from pldf.cosim.master import connections
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.signals import Signal, signals_of
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.roads import fingerprint, packed_route, route_arrays
from profile_examples import drive_result

from vehicle_models.driver import ScriptedDriver
from vehicle_models.lead import LeadVehicle
from vehicle_models.vehicle import LongitudinalVehicle

MODELS: dict[str, type[Instance[Any]]] = {
    "vehicle": LongitudinalVehicle,
    "lead": LeadVehicle,
    "driver": ScriptedDriver,
    "pldf": DrivingFunction,
}


def disturb(model: Instance[Any], rng: np.random.Generator) -> None:
    """Set all inputs to other values that a drive can have."""
    for signal in signals_of(model.record):
        if signal.causality == "input":
            setattr(model.record, signal.field, value(signal, rng))


def value(signal: Signal, rng: np.random.Generator) -> float | int:
    if signal.kind != "Real":
        return int(rng.integers(int(signal.high or 1) + 1))
    if signal.name.endswith("s_m"):
        return float(rng.uniform(0.0, 4400.0))
    return float(rng.uniform(max(signal.low or 0.0, -30.0), min(signal.high or 0.0, 40.0)))


def held(model: Instance[Any]) -> dict[str, float]:
    found = [s for s in signals_of(model.record) if s.causality == "output" and not s.follows]
    return {signal.name: getattr(model.record, signal.field) for signal in found}


@pytest.mark.parametrize("part", PARTS_IN_TRAFFIC)
def test_held_outputs_do_not_follow_the_inputs(part: str) -> None:
    rng = np.random.default_rng(7)
    first: dict[str, float] = {}
    moved = False
    for _ in range(10):
        model = MODELS[part]()
        disturb(model, rng)
        model.initialize()
        first = first or held(model)
        assert held(model) == first
        for _ in range(10):
            before = held(model)
            disturb(model, rng)
            model.refresh()
            assert held(model) == before
            for _ in range(40):  # long enough for a driver to react
                model.step(0.1)
                moved = moved or held(model) != first
    assert moved


# Declaration against probe


class Probed:
    """A built FMU, and what moves when one input is set between steps or in initialization mode."""

    def __init__(self, path: Path) -> None:
        self.host = Host(path)
        self.rng = np.random.default_rng(11)
        self.signals = {
            v.name: Signal(v.name, v.name, v.causality, v.type, 0.0, "", low=_bound(v.min, 0.0))
            for v in self.host.description.modelVariables
        }
        self.outputs = [n for n, s in self.signals.items() if s.causality == "output"]
        self.inputs = [n for n, s in self.signals.items() if s.causality == "input"]
        self.line = route_arrays(packed_route(0))
        self.signs = np.flatnonzero(np.diff(self.line.limit_mps))
        self.seen: set[tuple[str, str]] = set()

    def drive(self, unknowns: str, **parameters: Any) -> None:
        """Drive somewhere, and probe after each step or, of initial unknowns, before the first."""
        slave = self.host.instantiate()
        slave.set(**{n.replace(".", "__"): v for n, v in parameters.items() if n in self.signals})
        slave.fmu.setupExperiment(startTime=0.0)
        slave.fmu.enterInitializationMode()
        at = int(self.rng.choice(self.signs) - self.rng.integers(60))
        self.set(slave, self.situation(at))
        if unknowns == "InitialUnknowns":
            self.probe(slave)
        slave.fmu.exitInitializationMode()
        for k in range(30 if unknowns == "Outputs" else 0):
            self.set(slave, {**self.situation(at + 2 * k), **self.usual(k)})
            slave.fmu.doStep(0.1 * k, 0.1)
            self.probe(slave)
        slave.free()

    def situation(self, at: int) -> dict[str, Any]:
        """Return values of all inputs, with a car on the road beside its line."""
        place = {"vehicle.s_m": float(at), "vehicle.x_m": self.line.x_m[at] + 1.0}
        place["vehicle.y_m"] = self.line.y_m[at] + 1.0
        self.place = place
        return {name: place.get(name, self.other(name)) for name in self.inputs}

    def usual(self, k: int) -> dict[str, Any]:
        """Return inputs with which the function is active and the lever is used, mostly."""
        if k % 10 == 9:
            return {}
        values = {"vehicle.speed_mps": 20.0, "vehicle.acceleration_mps2": 0.0}
        values |= {"driver.gas_pedal": 0.0, "driver.brake_pedal": 0.0, "limit.override_mps": 0.0}
        contacts = {n: False for n in self.inputs if n.startswith(("lever.", "teach.", "lead."))}
        tips = ("lever.up_long", "lever.down_long")
        pressed = tips[k // 2 % 2] if k > 15 else "lever.resume"
        chosen = {**values, **contacts, pressed: k % 2 == 0}
        return {name: value for name, value in chosen.items() if name in self.inputs}

    def other(self, name: str) -> Any:
        """Return a value that this input can have."""
        signal = self.signals[name]
        if signal.kind == "Boolean":
            return bool(self.rng.integers(4) == 0)
        if signal.kind == "Real" and self.rng.integers(20) == 0:
            return nan
        if signal.kind == "Real" and "pedal" in name:
            return float(max(0.0, self.rng.uniform(-1.0, 1.0)))
        if signal.kind != "Real":
            return int(self.rng.integers(5))
        if name in self.place:
            return self.place[name] + float(self.rng.uniform(-25.0, 25.0))
        return float(self.rng.uniform(-5.0 if (signal.low or 0.0) < 0.0 else 0.0, 40.0))

    def set(self, slave: Slave, values: dict[str, Any]) -> None:
        """Set inputs and remember them."""
        slave.set(**{name.replace(".", "__"): value for name, value in values.items()})
        self.present = values

    def probe(self, slave: Slave) -> None:
        """Set each input to another value and back, and note which outputs moved."""
        before = slave.outputs()
        for name in self.inputs:
            for _ in range(6 if name in self.place else 2):
                slave.set(**{name.replace(".", "__"): self.other(name)})
                after = slave.outputs()
                self.seen |= {(output, name) for output in after if after[output] != before[output]}
            slave.set(**{name.replace(".", "__"): self.present[name]})
            assert slave.outputs() == before, name


def _bound(value: Any, otherwise: float) -> float:
    return otherwise if value is None else float(value)


def learned_store(folder: Path) -> str:
    """Return a folder in which much was learned on the study's road by driver 0."""
    route = packed_route(0)
    model = DrivingFunction()
    model.initialize()
    base = np.array(model.profile.base_mps)
    new = StoredProfile(0, fingerprint(route), base)
    ProfileStore(str(folder)).append(new, drive_result(new))
    return str(folder)


@pytest.mark.parametrize("unknowns", ["Outputs", "InitialUnknowns"])
@pytest.mark.parametrize("part", PARTS_IN_TRAFFIC)
def test_a_built_fmu_depends_on_exactly_what_it_declares(
    part: str, unknowns: str, native_folder: Path, tmp_path: Path
) -> None:
    probed = Probed(native_folder / f"{PARTS_IN_TRAFFIC[part]}.fmu")
    known = {"apply_learned": True, "learn": 1, "start_speed_mps": 20.0}
    for localization in (0, 1):
        for number in range(2 if unknowns == "Outputs" else 20):
            store = learned_store(tmp_path / f"{localization} {number}")
            probed.drive(unknowns, localization=localization, profile_store=store, **known)
    declared = set(dependent(native_folder, part, unknowns))
    assert sorted(probed.seen - declared) == []
    if unknowns == "Outputs":  # before the drive some are always the same
        assert sorted(declared - probed.seen) == []


def dependent(folder: Path, part: str, unknowns: str) -> Iterator[tuple[str, str]]:
    """Yield the pairs (output, input on which it may depend) that an FMU declares."""
    with zipfile.ZipFile(folder / f"{PARTS_IN_TRAFFIC[part]}.fmu") as archive:
        root = etree.fromstring(archive.read("modelDescription.xml"))
    variables = root.findall("ModelVariables/ScalarVariable")
    for unknown in root.iterfind(f"ModelStructure/{unknowns}/Unknown"):
        listed = unknown.get("dependencies")
        known = variables if listed is None else [variables[int(i) - 1] for i in listed.split()]
        for variable in known:
            if variable.get("causality") == "input":
                yield variables[int(unknown.get("index")) - 1].get("name"), variable.get("name")


@pytest.mark.parametrize("unknowns", ["Outputs", "InitialUnknowns"])
def test_the_coupled_fmus_have_no_algebraic_loop(
    fmu_folder: Path, traffic_fmus: Mapping[str, Fmu], unknowns: str
) -> None:
    graph: TopologicalSorter[tuple[str, str]] = TopologicalSorter()
    for source, target in connections(traffic_fmus):
        graph.add(target, source)
    for part in PARTS_IN_TRAFFIC:
        for output, given in dependent(fmu_folder, part, unknowns):
            graph.add((part, output), (part, given))
    graph.prepare()  # raises CycleError
