"""One native FMU: compile the kernel, link it with the C runtime, pack the archive."""

from __future__ import annotations

import importlib
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import metadata
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, indent, tostring

import fmpy  # type: ignore[import-untyped]

from .. import __version__
from ..fmi.description import NO_GUID, Model, model_description
from ..fmi.packing.archive import DESCRIPTION, guid_of, write_archive
from ..fmi.packing.documentation import document
from ..fmi.slave import LOG_CATEGORIES
from ..kernel.signals import Signal
from .model import NativeModel
from .objects import compile_objects
from .table import header, signals, source
from .targets import TARGETS

DEFAULT_TARGETS: Final = tuple(TARGETS)
HEADERS: Final = Path(str(fmpy.__file__)).parent / "c-code"
_FLAGS: Final = (
    "-std=c11", "-O2", "-ffp-contract=off", "-fwrapv", "-fvisibility=hidden",
    "-Wall", "-Wextra", "-Werror", "-shared", "-s",
)  # fmt: skip
_TEXTS: Final = {
    "route_file": "Route prepared by 'pldf route FILE --export OUT.prepared', in place of route_id",
    "script_file": "Prepared script in place of the one of script_id",
}


@dataclass(frozen=True)
class NativeRecipe:
    """What one native FMU is made of.

    Attributes:
        model: ``module:name`` of the ``NativeModel``.
        runtime: folder of the C sources.
        resources: prepared files by their path below ``resources/``.
        guide: what a user should know, for the documentation.
        icon: PNG shown by importers.
        license: licence text of the project.
    """

    model: str
    runtime: Path
    resources: Mapping[str, bytes]
    guide: str
    icon: Path
    license: Path


def build_native(recipe: NativeRecipe, targets: Sequence[str], out: Path) -> Path:
    """Build one FMU into ``out`` and return its path; ValueError if that is not possible."""
    module, _, name = recipe.model.partition(":")
    model: NativeModel = getattr(importlib.import_module(module), name)
    objects = compile_objects(recipe.model, targets)
    members = dict(_members(recipe, model))
    sources = {path.name: path.read_bytes() for path in sorted(recipe.runtime.glob("*.[ch]"))}
    zig = metadata.version("ziglang").encode()
    guid = guid_of({**members, **sources, **objects, "zig": zig})
    members[DESCRIPTION] = members[DESCRIPTION].replace(NO_GUID.encode(), guid.encode())
    with tempfile.TemporaryDirectory(prefix="native_") as folder:
        Path(folder, "table.h").write_text(header(model), encoding="utf-8")
        Path(folder, "table.c").write_text(source(model, guid), encoding="utf-8")
        for target in targets:
            Path(folder, f"{target}.o").write_bytes(objects[target])
            library = link(Path(folder), recipe.runtime, target)
            place = f"binaries/{TARGETS[target].fmi2}/{model.name}{TARGETS[target].suffix}"
            members[place] = library.read_bytes()
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{model.name}.fmu"
    write_archive(path, members)
    return path


def link(folder: Path, runtime: Path, target: str) -> Path:
    """Link table and object in ``folder`` with the C runtime; return the library."""
    library = folder / f"{target}{TARGETS[target].suffix}"
    program = [sys.executable, "-m", "ziglang", "cc", "-target", TARGETS[target].linker, *_FLAGS]
    program += [f"-I{HEADERS}", f"-I{runtime}", f"-I{folder}", "-o", str(library)]
    if target.startswith("linux"):
        program += ["-fPIC", "-Wl,-z,defs", "-Wl,--build-id=none", "-lm"]
    inputs = [*sorted(runtime.glob("*.c")), folder / "table.c", folder / f"{target}.o"]
    done = subprocess.run(
        [*program, *map(str, inputs)], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise ValueError(f"linking for {target} failed:\n{done.stderr.strip()[-2000:]}")
    return library


def _members(recipe: NativeRecipe, model: NativeModel) -> Iterator[tuple[str, bytes]]:
    shown = tuple(_as_native(signal) for signal in signals(model))
    page = document(model.name, model.about, recipe.guide, shown)
    yield DESCRIPTION, _description(model, shown)
    yield "model.png", recipe.icon.read_bytes()
    yield "documentation/index.html", page.encode()
    yield "documentation/licenses/LICENSE.txt", recipe.license.read_bytes()
    for place, data in recipe.resources.items():
        yield f"resources/{place}", data


def _as_native(signal: Signal) -> Signal:
    return replace(signal, description=_TEXTS.get(signal.field, signal.description))


def _description(model: NativeModel, shown: tuple[Signal, ...]) -> bytes:
    about = Model(model.name, model.about, shown, 300.0)
    root: Element = model_description(about, LOG_CATEGORIES)
    root.set("generationTool", f"Adaptive PLDF {__version__}, native")
    simulation = root.find("CoSimulation")
    assert simulation is not None
    simulation.set("needsExecutionTool", "false")
    indent(root)
    text: bytes = tostring(root, encoding="UTF-8", xml_declaration=True)
    return text
