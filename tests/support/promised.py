"""What a release promises to those who upgrade from it, as one list of facts by name.

The list of a release is made of the FMUs that its code built, and lies in ``tests/upgrade``::

    pldf build && pldf build --native --target linux64
    python tests/support/promised.py dist > tests/upgrade/VERSION.json

``tests/upgrade`` compares the present FMUs and commands with the newest list.
"""

from __future__ import annotations

import argparse
import json
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final
from xml.etree.ElementTree import Element, fromstring

from pldf.cli import build_parser
from pldf.commands import COMMANDS
from pldf.cosim.prepared import packed_files
from pldf.profiles import profile_file
from pldf.recordings.columns import COLUMNS as RECORDING
from pldf.roads.route import COLUMNS as ROUTE
from pldf.study.drive_row import COLUMNS as DRIVES
from pldf.study.participants_file import PARTICIPANTS

from vehicle_models.driver_script import COLUMNS as SCRIPT

# Facts of one thing (a variable, an option, a format) by attribute; things by name.
Facts = dict[str, Any]
Things = dict[str, Facts]

FMUS: Final = ("AdaptivePLDF", "LeadVehicle", "LongitudinalVehicle", "ScriptedDriver")
ARCHIVES: Final = (".", "native", "native/fmi3")
KEPT: Final = ("valueReference", "causality", "variability", "min", "max", "unit", "start")
_TYPES: Final = {"Float64": "Real", "Int32": "Integer"}  # FMI 3.0's names in those of FMI 2.0
# It follows the machine: the number of its processors.
_DEFAULT_OF_MACHINE: Final = "pldf study --jobs"


def variables(archive: Path) -> Things:
    """Return the variables of an FMU of any kind, in the words of FMI 2.0, and its enumerations."""
    root = fromstring(zipfile.ZipFile(archive).read("modelDescription.xml"))
    items = _enumerations(root)
    things: Things = {}
    for variable in root.iterfind("ModelVariables/*"):
        named = variable[0] if variable.tag == "ScalarVariable" else variable
        start = variable.find("Start")
        said = {**variable.attrib, **named.attrib}
        said |= {"start": start.attrib["value"]} if start is not None else {}
        facts: Facts = {"type": _TYPES.get(named.tag, named.tag)}
        facts |= {key: said[key] for key in KEPT if key in said}
        if "declaredType" in said:
            facts["items"] = items[said["declaredType"]]
        things[said["name"]] = facts
    return things


def _enumerations(root: Element) -> dict[str, list[str]]:
    kinds = root.findall("TypeDefinitions/*")
    return {kind.attrib["name"]: [i.attrib["name"] for i in kind.iter("Item")] for kind in kinds}


def commands() -> Things:
    """Return the commands and their arguments; each name of an option is one of its own."""
    things: Things = {}
    for command in COMMANDS:
        parser = build_parser(command)
        known = next(a.choices for a in parser._actions if isinstance(a.choices, dict))
        things |= dict(_arguments(known[command], f"pldf {command}"))
    return things


def _arguments(parser: argparse.ArgumentParser, command: str) -> Iterator[tuple[str, Facts]]:
    yield command, {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, inner in action.choices.items():
                yield from _arguments(inner, f"{command} {name}")
            continue
        facts: Facts = {"values": action.nargs, "required": action.required}
        if action.choices is not None:
            facts["choices"] = [str(choice) for choice in action.choices]
        for name in action.option_strings or [action.dest.upper()]:
            thing = f"{command} {name}"
            default = {} if thing == _DEFAULT_OF_MACHINE else {"default": str(action.default)}
            yield thing, {**facts, **default}


def formats() -> Things:
    """Return versions of binary files and columns of tables."""
    prepared, version = packed_files()["route/0.prepared"].split(b"\n")[0].decode().split()
    tables = {
        "recording": RECORDING,
        "drives.csv": DRIVES,
        "participants.csv": PARTICIPANTS.names,
        "route": ROUTE,
        "script": SCRIPT,
    }
    return {
        "PLDF-PROFILE": {"version": profile_file.VERSION},
        prepared: {"version": int(version)},
        **{name: {"columns": list(columns)} for name, columns in tables.items()},
    }


def promised(folder: Path) -> dict[str, Things]:
    """Return all things by area: each FMU (with FMI 3.0's ``time``), commands, formats."""
    fmus = {name: variables(folder / ARCHIVES[-1] / f"{name}.fmu") for name in FMUS}
    return {**fmus, "commands": commands(), "formats": formats()}


def _written(areas: dict[str, Things]) -> str:
    """Return the list as JSON with one line per thing."""
    parts = []
    for area, things in areas.items():
        lines = [f"  {json.dumps(name)}: {json.dumps(facts)}" for name, facts in things.items()]
        parts.append(f" {json.dumps(area)}: {{\n" + ",\n".join(lines) + "\n }")
    return "{\n" + ",\n".join(parts) + "\n}\n"


if __name__ == "__main__":
    sys.stdout.write(_written(promised(Path(sys.argv[1]))))
