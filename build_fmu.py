"""Build the FMUs, and the study's SSP packages of them: ``python build_fmu.py [--out dist]``.

``--native`` builds the FMUs without Python (extra ``[native]``) instead, into ``dist/native``.

Needs the project installed (``pip install -e .``). Ends with status 1, and a message that says why,
unless every FMU and package passes the validation of fmpy. The same sources give the same bytes.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Final

from fmpy.validation import validate_fmu  # type: ignore[import-untyped]
from pldf.fmi.packing.builder import Package, Recipe, build
from pldf.study.master import unpacked
from pldf.study.packages import write_packages, write_sources

ROOT: Final = Path(__file__).resolve().parent
PLDF: Final = Package(
    ROOT / "fmu_src" / "pldf",
    # Research tools, and what builds FMUs: none of it runs inside one.
    skip=(
        "cli.py",
        "commands",
        "compiled.py",
        "study",
        "fmi/packing",
        "native",
        "roads/make_study_road.py",
    ),
)
MODELS: Final = Package(
    ROOT / "vehicle_models", skip=("longitudinal_vehicle.py", "native.py", "scripted_driver.py")
)


def recipe(script: str, *packages: Package) -> Recipe:
    """Return the recipe of the FMU whose slave is in ``script``."""
    return Recipe(ROOT / script, packages, ROOT / "fmu_src" / "model.png", ROOT / "LICENSE")


FMUS: Final = {
    "AdaptivePLDF": recipe("fmu_src/adaptive_pldf.py", PLDF),
    "LongitudinalVehicle": recipe("vehicle_models/longitudinal_vehicle.py", PLDF, MODELS),
    "ScriptedDriver": recipe("vehicle_models/scripted_driver.py", PLDF, MODELS),
}


# Where the native build finds its models.
NATIVE: Final = {
    "AdaptivePLDF": "pldf.native.driving_function:MODEL",
    "LongitudinalVehicle": "vehicle_models.native:VEHICLE",
    "ScriptedDriver": "vehicle_models.native:DRIVER",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Build and validate; return the exit status."""
    options = _parser().parse_args(arguments)
    names = [options.only] if options.only else list(FMUS)
    for number, name in enumerate(names, start=1):
        print(f"[{number}/{len(names)}] {name} ... ", end="", flush=True)
        start = perf_counter()
        try:
            path = build_valid(name, options)
        except ValueError as problem:
            print("failed", flush=True)
            print(f"build_fmu.py: {name}: {problem}", file=sys.stderr)
            return 1
        size_kb = path.stat().st_size / 1024
        print(f"{path} ({size_kb:.0f} KiB, {perf_counter() - start:.1f} s, valid)")
    return 0 if options.only or options.native else build_packages(options)


def build_valid(name: str, options: argparse.Namespace) -> Path:
    """Build one FMU; ValueError, and no file left, if fmpy finds a problem in it."""
    if options.native:
        path = build_without_python(name, options.target, options.out / "native")
    else:
        path = build(FMUS[name], options.out)
    problems = validate_fmu(str(path))
    if problems:
        path.unlink()
        raise ValueError("not a valid FMU:\n  " + "\n  ".join(problems))
    return path


def build_without_python(name: str, targets: Sequence[str] | None, out: Path) -> Path:
    """Build one native FMU; ValueError if the extra is not installed or the build fails."""
    try:
        from pldf.native import build as native  # noqa: PLC0415 - needs the extra [native]
        from pldf.native.prepared import packed_files  # noqa: PLC0415

        from vehicle_models.native import packed_scripts  # noqa: PLC0415
    except ImportError as missing:
        raise ValueError(f"{missing}; run: pip install -e .[native]") from None
    resources = packed_files()
    if name == "ScriptedDriver":
        resources |= packed_scripts()
    guide = documented_class(FMUS[name].script)
    made_of = native.NativeRecipe(
        NATIVE[name], ROOT / "native", resources, guide, FMUS[name].icon, FMUS[name].license
    )
    return native.build_native(made_of, targets or native.DEFAULT_TARGETS, out)


def documented_class(script: Path) -> str:
    """Return the docstring of the class that ``script`` defines, without running it."""
    body = ast.parse(script.read_text(encoding="utf-8")).body
    return next(ast.get_docstring(node) or "" for node in body if isinstance(node, ast.ClassDef))


def build_packages(options: argparse.Namespace) -> int:
    """Build the SSP packages of the FMUs in ``options.out``; return the exit status."""
    try:
        with unpacked(options.out) as fmus:
            written = write_packages(options.out, fmus)
            if options.ssp_sources:
                write_sources(options.ssp_sources, fmus)
    except ValueError as problem:
        print(f"build_fmu.py: {problem}", file=sys.stderr)
        return 1
    print(f"{options.out}: {', '.join(path.name for path in written)} (valid)")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description="Build the FMUs and the study's SSP packages and validate them with fmpy.",
        epilog="example: python build_fmu.py --only AdaptivePLDF --out dist",
    )
    parser.add_argument("--only", choices=sorted(FMUS), help="build this FMU alone, no packages")
    parser.add_argument(
        "--out", type=Path, default=Path("dist"), metavar="FOLDER", help="default: dist"
    )
    parser.add_argument(
        "--native", action="store_true", help="FMUs without Python instead, into OUT/native"
    )
    parser.add_argument(
        "--target",
        action="append",
        choices=("linux64", "win64", "darwin64"),
        help="with --native: build for this platform alone (repeatable; default: all)",
    )
    parser.add_argument(
        "--ssp-sources",
        type=Path,
        metavar="FOLDER",
        help="also write what the packages say as readable files (ssp/ in the repository)",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
