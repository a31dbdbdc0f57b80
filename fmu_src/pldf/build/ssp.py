"""SSP 1.0 packages of our FMUs, kept to what all importers that we know can load.

- Flat: components and connections, no nested systems, transformations or dictionaries.
- An input that nothing feeds is no connector (importers wire it to something, or fail).
- No enumerations: libcosim drops such variables and aborts where a package names one, ecos refuses
  to load it. No strings: fmpy's importer cannot set them.
- The top system says how OMSimulator shall step; without that it does not simulate. The default
  experiment says where its results go; without that it warns of deprecated content.
- Values stand in files (.ssv) or, for importers that know none (OpenMCx), in the structure itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from .. import __version__
from ..fmi.description import literal
from ..fmi.units import base_unit
from ..kernel.signals import Signal

STRUCTURE: Final = "SystemStructure.ssd"
RESOURCES: Final = "resources"
PARAMETER_SET: Final = "initialValues"  # the name under which importers look for start values
FMU_TYPE: Final = "application/x-fmu-sharedlibrary"
_SSP: Final = "http://ssp-standard.org/SSP1/SystemStructure"
_OMS: Final = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd"

Values = Mapping[str, float | str]
# (component, variable) of an output and of the input that it feeds
Connection = tuple[tuple[str, str], tuple[str, str]]


@dataclass(frozen=True)
class Component:
    """One FMU of a system.

    Attributes:
        name: plain identifier.
        fmu: file name of the FMU in ``resources/``.
        signals: variables of the FMU by name.
    """

    name: str
    fmu: str
    signals: Mapping[str, Signal]


@dataclass(frozen=True)
class System:
    """Components, what feeds what, and the default experiment.

    Attributes:
        name: plain identifier.
        about: one sentence.
        components: in the order in which they are written.
        connections: output first.
        stop_time_s: end of the default experiment.
        step_s: communication step.
    """

    name: str
    about: str
    components: Sequence[Component]
    connections: Sequence[Connection]
    stop_time_s: float
    step_s: float


def structure(system: System, inline: Mapping[str, Values] | None = None) -> bytes:
    """Return the system structure description.

    Args:
        system: what it consists of.
        inline: start values by component that shall stand in it, in place of files.

    Raises:
        ValueError: a connection or a value cannot be written.
    """
    attributes = {
        "xmlns:ssd": f"{_SSP}Description",
        "xmlns:ssc": f"{_SSP}Common",
        "xmlns:oms": _OMS,
        **({"xmlns:ssv": f"{_SSP}ParameterValues"} if inline is not None else {}),
        "version": "1.0",
        "name": system.name,
        "description": system.about,
        "generationTool": f"Adaptive PLDF {__version__}",
    }
    root = Element("ssd:SystemStructureDescription", attributes)
    top = SubElement(root, "ssd:System", {"name": "root"})
    elements = SubElement(top, "ssd:Elements")
    carried = {
        component.name: _connectors(component, system.connections)
        for component in system.components
    }
    for component in system.components:
        bound = _component(elements, component, carried[component.name])
        if inline is None:
            bound.set("source", parameter_file(component.name))
        else:
            values = SubElement(bound, "ssd:ParameterValues")
            values.append(_parameter_set(component.signals, inline[component.name]))
    connections = SubElement(top, "ssd:Connections")
    for source, target in system.connections:
        ends = dict(zip(("startElement", "startConnector"), source, strict=True))
        ends |= dict(zip(("endElement", "endConnector"), target, strict=True))
        SubElement(connections, "ssd:Connection", ends)
    _master(top, system.step_s)
    signals = [signal for found in carried.values() for signal in found]
    _units(root, "ssd:Units", signals)
    times = {"startTime": "0", "stopTime": f"{system.stop_time_s:g}"}
    results = {"resultFile": f"{system.name}.csv", "loggingInterval": "0.0", "bufferSize": "1"}
    experiment = SubElement(root, "ssd:DefaultExperiment", times)
    _simulation_information(experiment, {**results, "signalFilter": ""})
    return _text(root)


def parameter_set(signals: Mapping[str, Signal], values: Values) -> bytes:
    """Return a parameter set (.ssv) with start values of one component.

    Args:
        signals: variables of the component by name.
        values: start values by name, Booleans as 0 and 1.

    Raises:
        ValueError: one of them is out of its range, or not every importer could set it.
    """
    root = _parameter_set(signals, values)
    names = {"xmlns:ssv": f"{_SSP}ParameterValues", "xmlns:ssc": f"{_SSP}Common"}
    root.attrib = {**names, **root.attrib}
    return _text(root)


def _parameter_set(signals: Mapping[str, Signal], values: Values) -> Element:
    root = Element("ssv:ParameterSet", {"version": "1.0", "name": PARAMETER_SET})
    parameters = SubElement(root, "ssv:Parameters")
    for name, value in values.items():
        signal = signals[name]
        _require_portable(signal)
        _require_allowed(signal, value)
        parameter = SubElement(parameters, "ssv:Parameter", {"name": name})
        unit = {"unit": signal.unit} if signal.unit else {}
        SubElement(parameter, f"ssv:{signal.kind}", {"value": literal(signal, value), **unit})
    _units(root, "ssv:Units", [signals[name] for name in values])
    return root


def parameter_file(component: str) -> str:
    """Return where the parameter set of a component lies in the package."""
    return f"{RESOURCES}/{component}.ssv"


def _connectors(component: Component, connections: Sequence[Connection]) -> list[Signal]:
    """Return the inputs that are fed and all outputs that every importer can carry."""
    ends = {name for ends in connections for part, name in ends if part == component.name}
    for name in ends:
        _require_portable(component.signals[name])
    return [
        signal
        for signal in component.signals.values()
        if (signal.causality == "output" and _portable(signal)) or signal.name in ends
    ]


def _portable(signal: Signal) -> bool:
    return signal.kind in ("Real", "Integer", "Boolean")


def _require_portable(signal: Signal) -> None:
    if not _portable(signal):
        raise ValueError(f"{signal.name}: not every SSP importer can handle type {signal.kind}")


def _require_allowed(signal: Signal, value: float | str) -> None:
    low, high = signal.range
    if isinstance(value, str) or not low <= value <= high:
        raise ValueError(f"{signal.name} = {value!r} is not in {low:g} .. {high:g}")
    if signal.causality not in ("parameter", "input"):
        raise ValueError(f"{signal.name} is an output, it has no start value")


def _component(elements: Element, component: Component, connectors: Iterable[Signal]) -> Element:
    """Add a component; return the binding of its start values, still empty."""
    attributes = {
        "name": component.name,
        "type": FMU_TYPE,
        "source": f"{RESOURCES}/{component.fmu}",
        "implementation": "CoSimulation",
    }
    element = SubElement(elements, "ssd:Component", attributes)
    listed = SubElement(element, "ssd:Connectors")
    for signal in connectors:
        kind = {"name": signal.name, "kind": signal.causality}
        unit = {"unit": signal.unit} if signal.unit else {}
        SubElement(SubElement(listed, "ssd:Connector", kind), f"ssc:{signal.kind}", unit)
    bindings = SubElement(element, "ssd:ParameterBindings")
    return SubElement(bindings, "ssd:ParameterBinding")


def _master(top: Element, step_s: float) -> None:
    information = _simulation_information(top, {})
    # oms-ma: all components step with the values of the last communication point.
    steps = {"description": "oms-ma", "stepSize": f"{step_s:g}"}
    tolerances = {"absoluteTolerance": "0.0001", "relativeTolerance": "0.0001"}
    SubElement(information, "oms:FixedStepMaster", {**steps, **tolerances})


def _simulation_information(of: Element, attributes: Mapping[str, str]) -> Element:
    """Add what OMSimulator reads of an element."""
    annotations = SubElement(of, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", {"type": "org.openmodelica"})
    known = SubElement(annotation, "oms:Annotations")
    return SubElement(known, "oms:SimulationInformation", dict(attributes))


def _units(root: Element, tag: str, signals: Iterable[Signal]) -> None:
    names = sorted({signal.unit for signal in signals if signal.unit})
    if not names:
        return
    units = SubElement(root, tag)
    for name in names:
        base = base_unit(name)
        powers = {symbol: str(power) for symbol, power in base.exponents.items()}
        factor = {"factor": f"{base.factor:.16g}"} if base.factor != 1.0 else {}
        SubElement(SubElement(units, "ssc:Unit", {"name": name}), "ssc:BaseUnit", powers | factor)


def _text(root: Element) -> bytes:
    indent(root)
    text = tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()
