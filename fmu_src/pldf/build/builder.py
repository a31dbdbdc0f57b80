"""One FMU from a slave script: isolate its packages, let pythonfmu build, make it reproducible."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Set
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module, invalidate_caches, metadata
from pathlib import Path
from types import ModuleType

from pythonfmu import FmuBuilder  # type: ignore[import-untyped]

from ..fmi.slave import ModelSlave
from .archive import read_members, with_guid, with_version, write_archive
from .documentation import IN_PYTHON, document
from .isolate import copy_file, copy_package, digest, packed_files

# Called with each piece of work when it begins.
Announce = Callable[[str], None]


@dataclass(frozen=True)
class Package:
    """A package that goes into an FMU; ``skip`` names what stays out, relative to ``folder``."""

    folder: Path
    skip: tuple[str, ...] = ()


@dataclass(frozen=True)
class Recipe:
    """What one FMU is made of.

    Attributes:
        script: module that defines the slave class.
        packages: they may import each other by name.
        icon: PNG shown by importers.
        version: shown by importers.
        resources: further files by their path below ``resources/``.
    """

    script: Path
    packages: tuple[Package, ...]
    icon: Path
    version: str
    resources: Mapping[str, bytes] = field(default_factory=dict)


def build(recipe: Recipe, out: Path) -> Path:
    """Build the FMU into folder ``out`` and return its path; ValueError if it cannot be packed."""
    out.mkdir(parents=True, exist_ok=True)
    name = identity(recipe)
    with tempfile.TemporaryDirectory(prefix="fmu_") as temporary:
        stage = Path(temporary, "stage")
        stage.mkdir()
        names = {p.folder.name: f"{p.folder.name}_{name}" for p in recipe.packages}
        for package in recipe.packages:
            folder = package.folder
            copy_package(folder, stage / names[folder.name], package.skip, names)
        script = stage / f"{recipe.script.stem}_{name}.py"
        copy_file(recipe.script, script, names)
        with _importing_from(stage, script.stem, names):
            slave = slave_of(script.stem)
            folders = [stage / name for name in names.values()]
            raw = FmuBuilder.build_FMU(script, dest=temporary, project_files=folders)
            members = {**read_members(raw), **_extras(recipe, slave)}
    path = out / f"{type(slave).__name__}.fmu"
    write_archive(path, with_guid(with_version(members, recipe.version)))
    return path


def identity(recipe: Recipe) -> str:
    """Return hexadecimal digits of everything that is packed."""
    files = {recipe.script.name: recipe.script}
    for package in recipe.packages:
        for path in packed_files(package.folder, package.skip):
            files[f"{package.folder.name}/{path}"] = package.folder / path
    return digest(files)


def slave_of(module: str) -> ModelSlave:
    """Return an instance of the slave class that ``module`` defines."""
    for thing in vars(import_module(module)).values():
        own = isinstance(thing, type) and thing.__module__ == module
        if own and any(base.__name__ == ModelSlave.__name__ for base in thing.__mro__):
            slave: ModelSlave = thing(instance_name="description")
            return slave
    raise ValueError(f"module {module} defines no slave class")


def _extras(recipe: Recipe, slave: ModelSlave) -> dict[str, bytes]:
    name, guide = type(slave).__name__, slave.__doc__ or ""
    page = document(name, slave.about, guide, slave.signals, IN_PYTHON)
    return {
        "model.png": recipe.icon.read_bytes(),
        "documentation/index.html": page.encode(),
        "documentation/licenses/license.txt": license_of("adaptive-pldf"),
        "documentation/licenses/pythonfmu.txt": license_of("pythonfmu"),
        **{f"resources/{place}": data for place, data in recipe.resources.items()},
    }


def license_of(distribution: str) -> bytes:
    """Return the licence text of an installed distribution; ValueError if it has none."""
    for file in metadata.files(distribution) or ():
        if file.name.startswith("LICENSE"):
            return Path(str(file.locate())).read_bytes()
    raise ValueError(f"the installed {distribution} has no licence file")


@contextmanager
def _importing_from(stage: Path, script: str, names: Mapping[str, str]) -> Iterator[None]:
    """Import from ``stage`` for a while; nothing loaded before is used or lost."""
    tops = {script, *names.values()}
    path = list(sys.path)
    before = _unload(tops)
    sys.path.insert(0, str(stage))
    invalidate_caches()
    try:
        yield
    finally:
        sys.path[:] = path
        _unload(tops)
        sys.modules.update(before)


def _unload(tops: Set[str]) -> dict[str, ModuleType]:
    """Take the modules below these names out of ``sys.modules`` and return them."""
    names = [name for name in sys.modules if name.partition(".")[0] in tops]
    return {name: sys.modules.pop(name) for name in names}
