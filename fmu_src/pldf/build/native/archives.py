"""The archives of one native model, for FMI 2.0 and FMI 3.0, around the same libraries."""

from __future__ import annotations

import importlib
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, NamedTuple
from xml.etree.ElementTree import Element, indent, tostring

from ...build_version import native_making
from ...cosim.platforms import TARGETS
from ...fmi.description import Model, model_description
from ...fmi.slave import LOG_CATEGORIES
from ...kernel.signals import Signal
from ..archive import DESCRIPTION, guid_of, with_guid, with_version, write_archive
from ..builder import Announce, license_of
from ..description3 import model_description3
from ..documentation import as_machine_code, document
from .language import check_language
from .linking import FLAGS, HEADERS, LINKED_AS, link, universal
from .model import NativeModel
from .objects import compile_objects
from .symbols import check_library
from .table import signals, source
from .table_header import header

_TEXTS: Final = {
    "route_file": "Route prepared by 'pldf route FILE --export OUT.prepared', in place of route_id",
    "script_file": "Script prepared by 'pldf script FILE --export OUT.prepared', "
    "in place of script_id",
}


Describe = Callable[[Model, Mapping[str, str]], Element]


class _Standard(NamedTuple):
    """What differs between versions of FMI.

    Attributes:
        version: of FMI.
        place: where the archives go, below ``out``.
        icon: where it lies in an archive.
        describe: makes the model description.
        folder: of a target's library below ``binaries/``; empty: there is none.
    """

    version: str
    place: str
    icon: str
    describe: Describe
    folder: Callable[[str], str]


_FMI2: Final = _Standard("2.0", "", "model.png", model_description, lambda t: TARGETS[t].fmi2)
_FMI3: Final = _Standard("3.0", "fmi3", "terminalsAndIcons/icon.png", model_description3, str)


@dataclass(frozen=True)
class NativeRecipe:
    """What one native FMU is made of.

    Attributes:
        model: ``module:name`` of the ``NativeModel``.
        runtime: folder of the C sources.
        resources: prepared files by their path below ``resources/``.
        guide: what a user should know, for the documentation.
        icon: PNG shown by importers.
        version: shown by importers.
    """

    model: str
    runtime: Path
    resources: Mapping[str, bytes]
    guide: str
    icon: Path
    version: str


def build_native(
    recipe: NativeRecipe, targets: Sequence[str], out: Path, announce: Announce
) -> list[Path]:
    """Build the archives of one model.

    Args:
        recipe: what to build.
        targets: names in ``TARGETS``.
        out: gets ``NAME.fmu`` (FMI 2.0, unless no target is known there) and ``fmi3/NAME.fmu``.
        announce: hears what is being done.

    Returns:
        The paths of the archives.

    Raises:
        ValueError: the kernel cannot be compiled, or a library not be linked or loaded anywhere.
    """
    module, _, name = recipe.model.partition(":")
    model: NativeModel = getattr(importlib.import_module(module), name)
    announce("compile the kernel")
    check_language(model.modules, model.record)
    objects = compile_objects(recipe.model, targets)
    contents = [_contents(recipe, model, standard, targets) for standard in (_FMI2, _FMI3)]
    inner = {**made_of(recipe, model), **objects}
    guid, token = (guid_of({**members, **inner}) for members in contents)
    libraries = {}
    with tempfile.TemporaryDirectory(prefix="native_") as temporary:
        folder = Path(temporary)
        write_tables(folder, header(model), source(model, guid, token))
        for target in targets:
            announce(f"link {target}")
            (folder / f"{target}.o").write_bytes(objects[target])
            library = link(folder, recipe.runtime, target, model.name, announce)
            check_library(library)
            libraries[target] = library.read_bytes()
    ready = ((_FMI2, with_guid(contents[0], guid)), (_FMI3, with_guid(contents[1], token)))
    return [
        _written(out / standard.place, model.name, {**members, **binaries})
        for standard, members in ready
        if (binaries := _binaries(standard, model.name, libraries))
    ]


def _written(folder: Path, name: str, members: Mapping[str, bytes]) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.fmu"
    write_archive(path, members)
    return path


def write_tables(folder: Path, head: str, body: str) -> None:
    """Write what the C runtime is compiled with."""
    (folder / "table.h").write_text(head, encoding="utf-8", newline="\n")
    (folder / "table.c").write_text(body, encoding="utf-8", newline="\n")


def _folders(standard: _Standard, targets: Iterable[str]) -> dict[str, list[str]]:
    """Return the folders of an archive's libraries, and for which targets each is."""
    targets_of: dict[str, list[str]] = {}
    for target in targets:
        if standard.folder(target):
            targets_of.setdefault(standard.folder(target), []).append(target)
    return targets_of


def _binaries(standard: _Standard, name: str, libraries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the libraries by their place in an archive; those in one folder become one."""
    libraries_at = {}
    for folder, targets in _folders(standard, libraries).items():
        parts = [libraries[target] for target in targets]
        place = f"binaries/{folder}/{name}{TARGETS[targets[0]].suffix}"
        libraries_at[place] = parts[0] if len(parts) == 1 else universal(parts)
    return libraries_at


def made_of(recipe: NativeRecipe, model: NativeModel) -> dict[str, bytes]:
    """Return what else decides the bytes of a library, besides the objects."""
    headers = [*HEADERS.glob("fmi[23]*.h")]
    files = {path.name: path.read_bytes() for path in (*headers, *recipe.runtime.glob("*.[ch]"))}
    tables = header(model) + source(model, "", "")
    tool = f"ziglang {metadata.version('ziglang')} {FLAGS} {LINKED_AS}"
    return {**files, "table": tables.encode(), "tool": tool.encode()}


def _contents(
    recipe: NativeRecipe, model: NativeModel, standard: _Standard, targets: Sequence[str]
) -> dict[str, bytes]:
    """Return the archive without libraries, and without GUID or token."""
    shown = _shown(model)
    licenses = dict(_licenses(targets))
    platforms = ", ".join(_folders(standard, targets))
    running = as_machine_code(standard.version, platforms, tuple(licenses))
    page = document(model.name, model.about, recipe.guide, shown, running)
    members = {
        DESCRIPTION: description(model, standard.describe),
        standard.icon: recipe.icon.read_bytes(),
        "documentation/index.html": page.encode(),
        "documentation/licenses/license.txt": license_of("adaptive-pldf"),
        **{f"documentation/licenses/{name}.txt": text for name, text in licenses.items()},
        **{f"resources/{place}": data for place, data in recipe.resources.items()},
    }
    return with_version(members, recipe.version)


def description(model: NativeModel, describe: Describe = model_description) -> bytes:
    """Return the model description of a native FMU, without GUID or token and version."""
    root = describe(
        Model(model.name, model.about, _shown(model), 300.0, native=True), LOG_CATEGORIES
    )
    tool = f"{root.get('generationTool')} {native_making()}"
    root.set("generationTool", tool)  # by which ``cosim.which_fmus`` knows older ones
    indent(root)
    text: Any = tostring(root, encoding="UTF-8", xml_declaration=True)
    return bytes(text)


def _shown(model: NativeModel) -> tuple[Signal, ...]:
    return tuple(_as_native(signal) for signal in signals(model))


def _as_native(signal: Signal) -> Signal:
    return replace(signal, description=_TEXTS.get(signal.field, signal.description))


def zig_folder() -> Path:
    """Return where zig is, with the C libraries that it brings."""
    zig = find_spec("ziglang")
    assert zig is not None and zig.submodule_search_locations
    return Path(zig.submodule_search_locations[0])


def _licenses(targets: Sequence[str]) -> Iterator[tuple[str, bytes]]:
    """Yield name and licence of what zig links into a library."""
    folder = zig_folder()
    yield "zig", (folder / "LICENSE").read_bytes()
    if "x86_64-windows" in targets:
        yield "mingw-w64", (folder / "lib" / "libc" / "mingw" / "COPYING").read_bytes()
