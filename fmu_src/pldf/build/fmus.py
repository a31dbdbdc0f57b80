"""The four FMUs: what each is made of, and how it is built, of Python source or native.

Everything that a build needs lies in the installed packages. The same sources give the same bytes.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fmpy.validation import validate_fmu  # type: ignore[import-untyped]

from .. import hmi_texts
from ..build_version import build_version
from ..cosim.kinds import NATIVE_FOLDER, PARTS_IN_TRAFFIC, WASM_FOLDER
from ..cosim.master import unpacked
from ..cosim.platforms import PLATFORMS
from ..errors import ModelError
from .builder import Announce, Package, Recipe, build
from .packages import write_packages, write_sources

if TYPE_CHECKING:
    from .native.archives import NativeRecipe

HERE: Final = Path(__file__).resolve().parent
RUNTIME: Final = HERE / "runtime"
# What the extra ``native`` brings.
EXTRA: Final = ("lief", "llvmlite", "ziglang")
NEEDS_EXTRA: Final = "run: pip install 'adaptive-pldf[native]'"


def _folder_of(package: str) -> Path:
    spec = find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise ImportError(f"package {package} is not installed")
    return Path(spec.submodule_search_locations[0])


PLDF: Final = Package(
    HERE.parent,
    # Research tools, and what builds FMUs: none of it runs inside one.
    skip=(
        "__init__.pyi",
        "__main__.py",
        "analysis",
        "api.py",
        "build",
        "build_version.py",
        "cache.py",
        "cli.py",
        "cockpit",
        "commands",
        "compiled.py",
        "cosim",
        "kernel_cache.py",
        "recordings",
        "report",
        "roads/make_study_road.py",
        "route_facts.py",
        "settings.py",
        "study",
        "toml_file.py",
    ),
)
MODELS: Final = Package(
    _folder_of("vehicle_models"),
    skip=("lead_vehicle.py", "longitudinal_vehicle.py", "native.py", "scripted_driver.py"),
)


def _recipe(script: Path, *packages: Package) -> Recipe:
    return Recipe(script, packages, HERE / "model.png", build_version())


FMUS: Final = {
    "AdaptivePLDF": replace(
        _recipe(HERE / "adaptive_pldf.py", PLDF),
        resources={hmi_texts.FILE: hmi_texts.as_json()},
    ),
    "LeadVehicle": _recipe(MODELS.folder / "lead_vehicle.py", PLDF, MODELS),
    "LongitudinalVehicle": _recipe(MODELS.folder / "longitudinal_vehicle.py", PLDF, MODELS),
    "ScriptedDriver": _recipe(MODELS.folder / "scripted_driver.py", PLDF, MODELS),
}

# Where the native build finds its models.
NATIVE: Final = {
    "AdaptivePLDF": "pldf.build.native.driving_function:MODEL",
    "LeadVehicle": "vehicle_models.native:LEAD",
    "LongitudinalVehicle": "vehicle_models.native:VEHICLE",
    "ScriptedDriver": "vehicle_models.native:DRIVER",
}


def build_python(name: str, out: Path, announce: Announce) -> list[Path]:
    """Build and validate one FMU of Python source in ``out``.

    Args:
        name: a key of ``FMUS``.
        out: folder of the FMU, made if needed.
        announce: hears what is being done.

    Raises:
        ValueError: it cannot be packed, or fmpy finds a problem in it.
    """
    announce("pack the Python source")
    paths = [build(FMUS[name], out)]
    announce("validate")
    require_valid(paths)
    return paths


def build_native(name: str, out: Path, targets: Sequence[str], announce: Announce) -> list[Path]:
    """Build and validate one native FMU in ``out/native``, for FMI 2.0 and 3.0.

    Args:
        name: a key of ``FMUS``.
        out: folder of the Python FMUs.
        targets: keys of ``cosim.platforms.PLATFORMS``; empty: all.
        announce: hears what is being done.

    Raises:
        ValueError: the extra is not installed, the build fails, or fmpy finds a problem.
    """
    require_extra("native FMUs need")
    from .native import archives  # noqa: PLC0415 - needs the extra

    recipe = _native_recipe(name)
    chosen = [t for platform in targets or PLATFORMS for t in PLATFORMS[platform]]
    paths = archives.build_native(recipe, chosen, out / NATIVE_FOLDER, announce)
    announce("validate")
    require_valid(paths)
    return paths


def build_wasm(name: str, out: Path, announce: Announce) -> list[Path]:
    """Build one FMU for a page in a browser: ``NAME.wasm`` and ``NAME.xml`` in ``out/wasm``.

    Args:
        name: a key of ``FMUS``.
        out: folder of the Python FMUs.
        announce: hears what is being done.

    Raises:
        ValueError: the extra is not installed, or the build fails.
    """
    require_extra("WebAssembly needs")
    from .native import wasm  # noqa: PLC0415 - needs the extra

    return wasm.build_wasm(_native_recipe(name), out / WASM_FOLDER, announce)


def require_extra(what_needs: str) -> None:
    """Raise ValueError unless the compilers of the extra are installed."""
    absent = [module for module in EXTRA if find_spec(module) is None]
    if absent:
        raise ValueError(f"{what_needs} {', '.join(absent)}; {NEEDS_EXTRA}")


def _native_recipe(name: str) -> NativeRecipe:
    from .native.archives import NativeRecipe  # noqa: PLC0415 - needs the extra

    packed = FMUS[name]
    return NativeRecipe(
        NATIVE[name],
        RUNTIME,
        native_resources(name),
        documented_class(packed.script),
        packed.icon,
        packed.version,
    )


def native_resources(name: str) -> dict[str, bytes]:
    """Return what native code reads below ``resources/``: files by path."""
    from vehicle_models.native import (  # noqa: PLC0415 - brings numba
        packed_scripts,
        packed_traffic_scripts,
    )

    from ..cosim.prepared import packed_files  # noqa: PLC0415

    resources = packed_files()
    if name == "ScriptedDriver":
        resources |= packed_scripts()
    elif name == "LeadVehicle":
        resources |= packed_traffic_scripts()
    return {**resources, **FMUS[name].resources}


def require_valid(paths: Sequence[Path]) -> None:
    """Raise ValueError, and leave none of the archives, if fmpy finds a problem in one."""
    for path in paths:
        problems = validate_fmu(str(path))
        if problems:
            for made in paths:
                made.unlink()
            raise ValueError(f"{path} is not a valid FMU:\n  " + "\n  ".join(problems))


def documented_class(script: Path) -> str:
    """Return the docstring of the class that ``script`` defines, without running it."""
    body = ast.parse(script.read_text(encoding="utf-8")).body
    return next(ast.get_docstring(node) or "" for node in body if isinstance(node, ast.ClassDef))


def build_packages(folder: Path, made: Sequence[Path], sources: Path | None = None) -> list[Path]:
    """Build the SSP packages of the FMI 2.0 FMUs in ``folder``, if all are among ``made``.

    Args:
        folder: where the FMUs are and the packages go.
        made: FMUs that were just built.
        sources: also write what the packages say as readable files into this folder.

    Raises:
        ModelError: a package cannot be made or is not valid.
    """
    if not {folder / f"{name}.fmu" for name in FMUS} <= set(made):
        return []  # made for platforms that FMI 2.0 does not know
    try:
        with unpacked(folder, PARTS_IN_TRAFFIC) as fmus:
            written = write_packages(folder, fmus)
            if sources is not None:
                write_sources(sources, fmus)
    except ValueError as problem:
        raise ModelError(str(problem)) from None
    return written
