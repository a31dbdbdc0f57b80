"""The model description of an FMI 3.0 FMU: the variables of FMI 2.0, with the same references.

What FMI 3.0 adds is the variable ``time``. Every variable is a scalar.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final
from xml.etree.ElementTree import Element, SubElement

from ..fmi.description import (
    NO_GUID,
    Model,
    add_defaults,
    add_items,
    add_units,
    attributes,
    check,
    dependencies,
    enumerations,
    header,
    type_attributes,
    unit_of,
)
from ..kernel.signals import Signal, by_reference, time_reference

_CAPABILITIES: Final = {
    "needsExecutionTool": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "providesDirectionalDerivatives": "false",
    "providesAdjointDerivatives": "false",
    "providesPerElementDependencies": "false",
    "canHandleVariableCommunicationStepSize": "true",
    "maxOutputDerivativeOrder": "0",
    "providesIntermediateUpdate": "false",
    "mightReturnEarlyFromDoStep": "false",
    "canReturnEarlyAfterIntermediateUpdate": "false",
    "hasEventMode": "false",
    "providesEvaluateDiscreteStates": "false",
}
_TIME: Final = "time"
_TYPES: Final = {"Real": "Float64", "Integer": "Int32"}  # the others kept their names


def model_description3(model: Model, log_categories: Mapping[str, str]) -> Element:
    """Return the root element; ValueError if a signal breaks a rule of FMI."""
    check(model.signals)
    if _TIME in {signal.name for signal in model.signals}:
        raise ValueError(f"{_TIME!r} is the name of the independent variable")
    about = {"fmiVersion": "3.0", "instantiationToken": NO_GUID, **header(model)}
    root = Element("fmiModelDescription", about)
    SubElement(root, "CoSimulation", {"modelIdentifier": model.name, **_CAPABILITIES})
    add_units(root, {"s", *(unit_of(s) for s in model.signals)})
    _types(root, model.signals)
    add_defaults(root, model, log_categories)
    variables = SubElement(root, "ModelVariables")
    variables.extend(_variable(signal, i) for i, signal in by_reference(model.signals).items())
    variables.append(_time(time_reference(model.signals)))
    structure = SubElement(root, "ModelStructure")
    structure.extend(_unknowns(model.signals))
    return root


def _types(root: Element, signals: tuple[Signal, ...]) -> None:
    used = enumerations(signals)
    if not used:
        return
    definitions = SubElement(root, "TypeDefinitions")
    for name, enumeration in used.items():
        add_items(SubElement(definitions, "EnumerationType", {"name": name}), enumeration)


def _variable(signal: Signal, reference: int) -> Element:
    described = {**attributes(signal, reference), **type_attributes(signal)}
    start = described.pop("start", None) if signal.kind == "String" else None
    variable = Element(_TYPES.get(signal.kind, signal.kind), described)
    if start is not None:
        SubElement(variable, "Start", {"value": start})
    return variable


def _time(reference: int) -> Element:
    described = {
        "name": _TIME,
        "valueReference": str(reference),
        "description": "Simulation time",
        "causality": "independent",
        "variability": "continuous",
        "unit": "s",
    }
    return Element("Float64", described)


def _unknowns(signals: tuple[Signal, ...]) -> Iterable[Element]:
    """Yield all outputs, twice: what they depend on between steps, and in initialization mode."""
    for name, initial in (("Output", False), ("InitialUnknown", True)):
        for reference, given in dependencies(by_reference(signals), initial):
            yield Element(name, {"valueReference": str(reference), "dependencies": given})
