"""Outputs that are declared to be held do not follow the inputs; so no loop is algebraic."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from pldf.cosim.fmu import Fmu
from pldf.cosim.kinds import PARTS_IN_TRAFFIC
from pldf.cosim.master import connections
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.signals import Signal, signals_of

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
    found = [s for s in signals_of(model.record) if s.held]
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
