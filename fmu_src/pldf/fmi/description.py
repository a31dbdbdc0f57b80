"""The model description of an FMI 2.0 FMU, made from the model's table of signals.

Written for the importers that are strict: ``start`` on inputs and parameters and on nothing else,
no ``initial`` on inputs, explicit variability, every unit with its base units, enumerations as
types, every output among Outputs and InitialUnknowns, elements in the order of the XML schema.
``packing/description3.py`` says the same in FMI 3.0.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Set
from datetime import UTC, datetime
from typing import Final, NamedTuple
from xml.etree.ElementTree import Element, SubElement

from .. import __version__
from ..kernel.signals import Enumeration, Signal, by_reference
from .units import DISPLAY, PURE, QUANTITIES, base_unit

STEP_SIZE_S: Final = 0.01
# Replaced when the archive is written.
NO_GUID: Final = "{00000000-0000-0000-0000-000000000000}"
NO_VERSION: Final = f"{__version__}+000000000000"
_EPOCH_S: Final = 1767225600  # 2026-01-01: the same source gives the same bytes on every day
_NAME: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
_NAME_MAX: Final = 55

_CAPABILITIES: Final = {
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
    """What the description says of a model.

    Attributes:
        name: also the model identifier.
        about: one sentence.
        signals: variables in the order of their value references.
        stop_time_s: end of the default experiment.
        native: machine code; else Python and NumPy of the target machine do the work.
    """

    name: str
    about: str
    signals: tuple[Signal, ...]
    stop_time_s: float
    native: bool = False


def model_description(model: Model, log_categories: Mapping[str, str]) -> Element:
    """Return the root element; ValueError if a signal breaks a rule of FMI."""
    check(model.signals)
    root = Element("fmiModelDescription", {"fmiVersion": "2.0", "guid": NO_GUID, **header(model)})
    capabilities = {"needsExecutionTool": str(not model.native).lower(), **_CAPABILITIES}
    SubElement(root, "CoSimulation", {"modelIdentifier": model.name, **capabilities})
    add_units(root, {unit_of(s) for s in model.signals})
    _types(root, model.signals)
    add_defaults(root, model, log_categories)
    variables = SubElement(root, "ModelVariables")
    for reference, signal in by_reference(model.signals).items():
        variables.append(_variable(signal, reference))
    _structure(root, model.signals)
    return root


def header(model: Model) -> dict[str, str]:
    """Return the attributes of the root element that all versions of FMI have."""
    moment = datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", _EPOCH_S)), UTC)
    made_as = ", native" if model.native else " with pythonfmu"
    return {
        "modelName": model.name,
        "description": model.about,
        "version": NO_VERSION,
        "license": "MIT",
        "generationTool": f"Adaptive PLDF {__version__}{made_as}",
        "generationDateAndTime": moment.strftime("%Y-%m-%dT%H:%M:%SZ"),
        "variableNamingConvention": "structured",
    }


def add_units(root: Element, units: Set[str]) -> None:
    """Define the units, with base and display units; the empty one is none."""
    if not units - {""}:
        return
    definitions = SubElement(root, "UnitDefinitions")
    for name in sorted(units - {""}):
        unit = SubElement(definitions, "Unit", {"name": name})
        base = base_unit(name)
        attributes = {symbol: str(power) for symbol, power in base.exponents.items()}
        if base.factor != 1.0:
            attributes["factor"] = f"{base.factor:.16g}"
        SubElement(unit, "BaseUnit", attributes)
        if name in DISPLAY:
            display, factor = DISPLAY[name]
            SubElement(unit, "DisplayUnit", {"name": display, "factor": f"{factor:g}"})


def add_defaults(root: Element, model: Model, log_categories: Mapping[str, str]) -> None:
    """Name the log categories and the default experiment."""
    categories = SubElement(root, "LogCategories")
    for name, text in log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": text})
    times = {"startTime": "0", "stopTime": f"{model.stop_time_s:g}", "stepSize": f"{STEP_SIZE_S:g}"}
    SubElement(root, "DefaultExperiment", times)


def enumerations(signals: tuple[Signal, ...]) -> dict[str, Enumeration]:
    """Return the enumerations in use by name."""
    return {s.enumeration.name: s.enumeration for s in signals if s.enumeration is not None}


def _types(root: Element, signals: tuple[Signal, ...]) -> None:
    used = enumerations(signals)
    if not used:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for name, enumeration in used.items():
        kind = SubElement(SubElement(definitions, "SimpleType", {"name": name}), "Enumeration")
        add_items(kind, enumeration)


def add_items(kind: Element, enumeration: Enumeration) -> None:
    """List the items of an enumeration with their codes."""
    for code, item in enumerate(enumeration.items):
        SubElement(kind, "Item", {"name": item, "value": str(code)})


def _variable(signal: Signal, reference: int) -> Element:
    variable = Element("ScalarVariable", attributes(signal, reference))
    SubElement(variable, signal.kind, type_attributes(signal))
    return variable


def attributes(signal: Signal, reference: int) -> dict[str, str]:
    """Return what is said of a variable of any type."""
    described = {
        "name": signal.name,
        "valueReference": str(reference),
        "description": signal.description,
        "causality": signal.causality,
        "variability": _variability(signal),
    }
    if signal.causality == "parameter":
        described["initial"] = "exact"
    elif signal.causality != "input":
        described["initial"] = "calculated"
    return described


def _variability(signal: Signal) -> str:
    if signal.causality == "parameter":
        return "tunable" if signal.tunable else "fixed"
    return "continuous" if signal.kind == "Real" else "discrete"


def type_attributes(signal: Signal) -> dict[str, str]:
    """Return what is said of a variable of its type: enumeration, unit, range and start."""
    described = {}
    if signal.enumeration is not None:
        described["declaredType"] = signal.enumeration.name
    unit = unit_of(signal)
    if unit:
        described["unit"] = unit
    if unit in DISPLAY:
        described["displayUnit"] = DISPLAY[unit][0]
    if unit in QUANTITIES:
        described["quantity"], nominal = QUANTITIES[unit]
        if signal.causality != "parameter":
            described["nominal"] = literal(signal, nominal)
    for name, bound in (("min", signal.low), ("max", signal.high)):
        if bound is not None:
            described[name] = literal(signal, bound)
    if signal.causality in ("parameter", "input"):
        described["start"] = literal(signal, signal.start)
    return described


def unit_of(signal: Signal) -> str:
    """Return the unit in which a variable is written; every Real has one, others have none."""
    return signal.unit or (PURE if signal.kind == "Real" else "")


def literal(signal: Signal, value: float | str) -> str:
    """Return ``value`` as it is written in XML, exact to the bit for Real."""
    if isinstance(value, str):
        return value
    if signal.kind == "Boolean":
        return "true" if value else "false"
    return repr(float(value)) if signal.kind == "Real" else str(int(value))


def _structure(root: Element, signals: tuple[Signal, ...]) -> None:
    indices = {i: signal for i, signal in enumerate(signals, start=1)}
    structure = SubElement(root, "ModelStructure")
    for name, initial in (("Outputs", False), ("InitialUnknowns", True)):
        known = list(dependencies(indices, initial))
        if known:  # an empty list of unknowns is not allowed by the schema, an absent one is
            unknowns = SubElement(structure, name)
            for index, given in known:
                SubElement(unknowns, "Unknown", {"index": str(index), "dependencies": given})


def dependencies(numbered: Mapping[int, Signal], initial: bool) -> Iterable[tuple[int, str]]:
    """Yield each output with the numbers of what it depends on, as the model structure wants them.

    Args:
        numbered: the variables by what stands for them: index or value reference.
        initial: in initialization mode, where any parameter may count; else between steps.
    """
    for number, output in numbered.items():
        if output.causality == "output":
            given = (
                str(other)
                for other, signal in numbered.items()
                if signal.field in output.follows or (initial and signal.causality == "parameter")
            )
            yield number, " ".join(given)


def check(signals: tuple[Signal, ...]) -> None:
    """Raise ValueError if a signal breaks a rule of FMI."""
    types: dict[str, Enumeration] = {}
    names: set[str] = set()
    inputs = {signal.field for signal in signals if signal.causality == "input"}
    for signal in signals:
        if not _NAME.fullmatch(signal.name) or len(signal.name) > _NAME_MAX:
            raise ValueError(f"{signal.name!r} is not a structured name of at most {_NAME_MAX}")
        if signal.name in names:
            raise ValueError(f"variable name {signal.name!r} is used twice")
        names.add(signal.name)
        if not inputs.issuperset(signal.follows):
            raise ValueError(f"{signal.name} follows {signal.follows}, not all of them are inputs")
        kind = signal.enumeration
        if kind is not None and types.setdefault(kind.name, kind) != kind:
            raise ValueError(f"two different enumerations are named {kind.name!r}")
        _check_start(signal)


def _check_start(signal: Signal) -> None:
    low, high = signal.range
    outside = not isinstance(signal.start, str) and not low <= signal.start <= high
    if outside and signal.causality in ("parameter", "input"):
        raise ValueError(f"{signal.name}: start {signal.start} is not in {low:g} .. {high:g}")
