"""Build the FMUs, and the study's SSP packages of them: ``python build_fmu.py [--out dist]``.

``--native`` builds the FMUs without Python (extra ``[native]``) instead: for FMI 2.0 into
``dist/native``, for FMI 3.0 into ``dist/native/fmi3``.

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
from pldf.build_version import build_version
from pldf.fmi.packing.builder import Package, Recipe, build
from pldf.native.targets import PLATFORMS
from pldf.study.master import unpacked
from pldf.study.packages import write_packages, write_sources

EXAMPLES: Final = """examples:
  python build_fmu.py
      all FMUs and packages of Python source, into dist
  python build_fmu.py --native
      all FMUs for all platforms, into dist/native: the first time takes minutes, later seconds
  python build_fmu.py --native --target linux64 --only AdaptivePLDF
      the quick way to see whether a changed kernel still compiles
"""
ROOT: Final = Path(__file__).resolve().parent
PLDF: Final = Package(
    ROOT / "fmu_src" / "pldf",
    # Research tools, and what builds FMUs: none of it runs inside one.
    skip=(
        "build_version.py",
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
    icon = ROOT / "fmu_src" / "model.png"
    return Recipe(ROOT / script, packages, icon, ROOT / "LICENSE", build_version())


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


class Progress:
    """Says what is being done and how long it took: a line for each piece of work."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._since: float | None = None

    def __call__(self, work: str) -> None:
        """Begin ``work``; what was begun before is done."""
        self.end()
        print(f"{self._label}: {work} ... ", end="", flush=True)
        self._since = perf_counter()

    def end(self, result: str = "") -> None:
        """All work is done, or has ended with ``result``."""
        if self._since is not None:
            print(result or f"{perf_counter() - self._since:.1f} s", flush=True)
        self._since = None


def main(arguments: Sequence[str] | None = None) -> int:
    """Build and validate; return the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.target and not options.native:
        parser.error("--target goes with --native")
    made: list[Path] = []
    names = [options.only] if options.only else list(FMUS)
    for number, name in enumerate(names, start=1):
        progress = Progress(f"[{number}/{len(names)}] {name}")
        try:
            paths = (build_native if options.native else build_python)(name, options, progress)
            progress("validate")
            require_valid(paths)
        except ValueError as problem:
            progress.end("failed")
            print(f"build_fmu.py: {name}: {problem}", file=sys.stderr)
            return 1
        progress.end()
        for path in paths:
            print(f"    {path} ({path.stat().st_size / 1024:.0f} KiB)")
        made += paths
    return 0 if options.only else build_packages(made, options)


def require_valid(paths: Sequence[Path]) -> None:
    """Raise ValueError, and leave none of the archives, if fmpy finds a problem in one."""
    for path in paths:
        problems = validate_fmu(str(path))
        if problems:
            for made in paths:
                made.unlink()
            raise ValueError(f"{path} is not a valid FMU:\n  " + "\n  ".join(problems))


def build_python(name: str, options: argparse.Namespace, tell: Progress) -> list[Path]:
    """Build one FMU of Python source; ValueError if it cannot be packed."""
    tell("pack the Python source")
    return [build(FMUS[name], options.out)]


def build_native(name: str, options: argparse.Namespace, tell: Progress) -> list[Path]:
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
    packed = FMUS[name]
    recipe = native.NativeRecipe(
        NATIVE[name],
        ROOT / "native",
        resources,
        documented_class(packed.script),
        packed.icon,
        packed.license,
        packed.version,
    )
    targets = [t for platform in options.target or PLATFORMS for t in PLATFORMS[platform]]
    return native.build_native(recipe, targets, options.out / "native", tell)


def documented_class(script: Path) -> str:
    """Return the docstring of the class that ``script`` defines, without running it."""
    body = ast.parse(script.read_text(encoding="utf-8")).body
    return next(ast.get_docstring(node) or "" for node in body if isinstance(node, ast.ClassDef))


def build_packages(made: Sequence[Path], options: argparse.Namespace) -> int:
    """Build the SSP packages of the FMI 2.0 FMUs among those made; return the exit status."""
    folder = options.out / "native" if options.native else options.out
    if not {folder / f"{name}.fmu" for name in FMUS} <= set(made):
        return 0  # made for platforms that FMI 2.0 does not know
    try:
        with unpacked(folder) as fmus:
            written = write_packages(folder, fmus)
            if options.ssp_sources:
                write_sources(options.ssp_sources, fmus)
    except ValueError as problem:
        print(f"build_fmu.py: {problem}", file=sys.stderr)
        return 1
    print(f"{folder}: {', '.join(path.name for path in written)} (valid)")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=str(__doc__).replace("``", ""),
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--only", choices=sorted(FMUS), help="build this FMU alone, no packages")
    parser.add_argument(
        "--out", type=Path, default=Path("dist"), metavar="FOLDER", help="default: dist"
    )
    parser.add_argument(
        "--native",
        action="store_true",
        help="FMUs without Python instead: FMI 2.0 into OUT/native, FMI 3.0 into OUT/native/fmi3",
    )
    parser.add_argument(
        "--target",
        action="append",
        choices=tuple(PLATFORMS),
        help="with --native: build for this platform alone (repeatable; default: all; darwin64 is "
        "macOS on both processors; aarch64-linux is in FMI 3.0 archives only)",
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
