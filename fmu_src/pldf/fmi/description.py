"""The model description of an FMU, made from the model's table of signals.

Written for the importers that are strict: ``start`` on inputs and parameters and on nothing else,
no ``initial`` on inputs, explicit variability, every unit with its base units, enumerations as
types, every output among Outputs and InitialUnknowns, elements in the order of the XML schema.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from math import inf
from typing import Final, NamedTuple
from xml.etree.ElementTree import Element, SubElement

from .. import __version__
from ..kernel.signals import Enumeration, Signal
from .units import DISPLAY, base_unit

STEP_SIZE_S: Final = 0.01
NO_GUID: Final = "{00000000-0000-0000-0000-000000000000}"  # replaced when the archive is written
_EPOCH_S: Final = 1767225600  # 2026-01-01: the same source gives the same bytes on every day
_NAME: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
_NAME_MAX: Final = 55

_CAPABILITIES: Final = {
    # True as pythonfmu has it: Python and NumPy of the target machine do the work.
    "needsExecutionTool": "true",
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
    "maxOutputDerivativeOrder": "0",
    "canRunAsynchronuously": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
    "providesDirectionalDerivative": "false",
}


class Model(NamedTuple):
    """What the description says of a model; ``name`` is also the model identifier."""

    name: str
    about: str
    signals: tuple[Signal, ...]
    stop_time_s: float


def model_description(model: Model, log_categories: Mapping[str, str]) -> Element:
    """Return the root element; ValueError if a signal breaks a rule of FMI."""
    _check(model.signals)
    root = Element("fmiModelDescription", _header(model))
    SubElement(root, "CoSimulation", {"modelIdentifier": model.name, **_CAPABILITIES})
    _units(root, sorted({s.unit for s in model.signals if s.unit}))
    _types(root, model.signals)
    categories = SubElement(root, "LogCategories")
    for name, text in log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": text})
    times = {"startTime": "0", "stopTime": f"{model.stop_time_s:g}", "stepSize": f"{STEP_SIZE_S:g}"}
    SubElement(root, "DefaultExperiment", times)
    variables = SubElement(root, "ModelVariables")
    for reference, signal in enumerate(model.signals):
        variables.append(_variable(signal, reference))
    _structure(root, model.signals)
    return root


def _header(model: Model) -> dict[str, str]:
    moment = datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", _EPOCH_S)), UTC)
    return {
        "fmiVersion": "2.0",
        "modelName": model.name,
        "guid": NO_GUID,
        "description": model.about,
        "version": __version__,
        "license": "MIT",
        "generationTool": f"Adaptive PLDF {__version__} with pythonfmu",
        "generationDateAndTime": moment.strftime("%Y-%m-%dT%H:%M:%SZ"),
        "variableNamingConvention": "structured",
    }


def _units(root: Element, units: Sequence[str]) -> None:
    if not units:
        return
    definitions = SubElement(root, "UnitDefinitions")
    for name in units:
        unit = SubElement(definitions, "Unit", {"name": name})
        base = base_unit(name)
        attributes = {symbol: str(power) for symbol, power in base.exponents.items()}
        if base.factor != 1.0:
            attributes["factor"] = f"{base.factor:.16g}"
        SubElement(unit, "BaseUnit", attributes)
        if name in DISPLAY:
            display, factor = DISPLAY[name]
            SubElement(unit, "DisplayUnit", {"name": display, "factor": f"{factor:g}"})


def _types(root: Element, signals: tuple[Signal, ...]) -> None:
    found = {s.enumeration.name: s.enumeration for s in signals if s.enumeration is not None}
    if not found:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for name, enumeration in found.items():
        kind = SubElement(SubElement(definitions, "SimpleType", {"name": name}), "Enumeration")
        for code, item in enumerate(enumeration.items):
            SubElement(kind, "Item", {"name": item, "value": str(code)})


def _variable(signal: Signal, reference: int) -> Element:
    attributes = {
        "name": signal.name,
        "valueReference": str(reference),
        "description": signal.description,
        "causality": signal.causality,
        "variability": _variability(signal),
    }
    if signal.causality == "parameter":
        attributes["initial"] = "exact"
    elif signal.causality != "input":
        attributes["initial"] = "calculated"
    variable = Element("ScalarVariable", attributes)
    SubElement(variable, signal.kind, _type_attributes(signal))
    return variable


def _variability(signal: Signal) -> str:
    if signal.causality == "parameter":
        return "tunable" if signal.tunable else "fixed"
    return "continuous" if signal.kind == "Real" else "discrete"


def _type_attributes(signal: Signal) -> dict[str, str]:
    attributes = {}
    if signal.enumeration is not None:
        attributes["declaredType"] = signal.enumeration.name
    if signal.unit:
        attributes["unit"] = signal.unit
        if signal.unit in DISPLAY:
            attributes["displayUnit"] = DISPLAY[signal.unit][0]
    for name, bound in (("min", signal.low), ("max", signal.high)):
        if bound is not None:
            attributes[name] = literal(signal, bound)
    if signal.causality in ("parameter", "input"):
        attributes["start"] = literal(signal, signal.start)
    return attributes


def literal(signal: Signal, value: float | str) -> str:
    """Return ``value`` as it is written in XML, exact to the bit for Real."""
    if isinstance(value, str):
        return value
    if signal.kind == "Boolean":
        return "true" if value else "false"
    return repr(float(value)) if signal.kind == "Real" else str(int(value))


def _structure(root: Element, signals: tuple[Signal, ...]) -> None:
    outputs = [(i, s) for i, s in enumerate(signals, start=1) if s.causality == "output"]
    parameters = [str(i) for i, s in enumerate(signals, start=1) if s.causality == "parameter"]
    structure = SubElement(root, "ModelStructure")
    # What an output that is held depends on; no list means everything.
    known = {"Outputs": "", "InitialUnknowns": " ".join(parameters)}
    # An empty list of unknowns is not allowed by the schema, an absent one is.
    for name, dependencies in known.items() if outputs else ():
        unknowns = SubElement(structure, name)
        for index, signal in outputs:
            held = {"dependencies": dependencies} if signal.held else {}
            SubElement(unknowns, "Unknown", {"index": str(index), **held})


def _check(signals: tuple[Signal, ...]) -> None:
    types: dict[str, Enumeration] = {}
    names: set[str] = set()
    for signal in signals:
        if not _NAME.fullmatch(signal.name) or len(signal.name) > _NAME_MAX:
            raise ValueError(f"{signal.name!r} is not a structured name of at most {_NAME_MAX}")
        if signal.name in names:
            raise ValueError(f"variable name {signal.name!r} is used twice")
        names.add(signal.name)
        kind = signal.enumeration
        if kind is not None and types.setdefault(kind.name, kind) != kind:
            raise ValueError(f"two different enumerations are named {kind.name!r}")
        _check_start(signal)


def _check_start(signal: Signal) -> None:
    low, high = bounds(signal)
    outside = not isinstance(signal.start, str) and not low <= signal.start <= high
    if outside and signal.causality in ("parameter", "input"):
        raise ValueError(f"{signal.name}: start {signal.start} is not in {low:g} .. {high:g}")


def bounds(signal: Signal) -> tuple[float, float]:
    """Return the declared range of a signal, infinite where none is declared."""
    if signal.enumeration is not None:
        return 0, len(signal.enumeration.items) - 1
    low = -inf if signal.low is None else signal.low
    high = inf if signal.high is None else signal.high
    return low, high
