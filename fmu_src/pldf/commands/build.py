"""``pldf build``: the FMUs, and the study's SSP packages of them."""

from __future__ import annotations

import argparse
from pathlib import Path
from time import perf_counter
from typing import Final

from ..cosim.kinds import NATIVE_FOLDER, PARTS_IN_TRAFFIC
from ..cosim.platforms import PLATFORMS
from ..errors import ModelError

EXAMPLE: Final = (
    "pldf build\n"
    "      all FMUs and packages of Python source, into dist\n"
    "  pldf build --native\n"
    "      all FMUs for all platforms, into dist/native: the first time takes minutes, later "
    "seconds\n"
    "  pldf build --native --target linux64 --only AdaptivePLDF\n"
    "      the quick way to see whether a changed kernel still compiles\n"
    "  pldf build --wasm\n"
    "      all FMUs as WebAssembly, for a page in a browser, into dist/wasm"
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``pldf build``."""
    parser.add_argument(
        "--only",
        choices=sorted(PARTS_IN_TRAFFIC.values()),
        help="build this FMU alone, no packages",
    )
    parser.add_argument(
        "--out", type=Path, default=Path("dist"), metavar="FOLDER", help="default: dist"
    )
    parser.add_argument(
        "--native",
        action="store_true",
        help="FMUs without Python instead: FMI 2.0 into OUT/native, FMI 3.0 into OUT/native/fmi3",
    )
    parser.add_argument(
        "--wasm",
        action="store_true",
        help="FMUs for a page in a browser instead: NAME.wasm and NAME.xml into OUT/wasm",
    )
    parser.add_argument(
        "--target",
        action="append",
        default=[],
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
    parser.set_defaults(refuse=parser.error)


def run(options: argparse.Namespace) -> None:
    """Build and validate; ends with ModelError unless every FMU and package is valid."""
    if options.target and not options.native:
        options.refuse("--target goes with --native")
    if options.wasm and options.native:
        options.refuse("--wasm and --native make different files: run pldf build twice")
    if options.wasm and options.ssp_sources:
        options.refuse("--ssp-sources does not go with --wasm: no package has modules for a page")
    from ..build import fmus  # noqa: PLC0415 - brings pythonfmu and fmpy

    made: list[Path] = []
    names = [options.only] if options.only else list(fmus.FMUS)
    for number, name in enumerate(names, start=1):
        made += _build(f"[{number}/{len(names)}] {name}", name, options)
    if not options.only and not options.wasm:
        folder = options.out / NATIVE_FOLDER if options.native else options.out
        written = fmus.build_packages(folder, made, options.ssp_sources)
        if written:
            names = [path.relative_to(folder).as_posix() for path in written]
            print(f"{folder}: {', '.join(names)} (valid)")


def _build(label: str, name: str, options: argparse.Namespace) -> list[Path]:
    """Build one FMU, say what is being done, and return its archives."""
    from ..build import fmus  # noqa: PLC0415 - as above

    work = WorkLog(label)
    try:
        if options.wasm:
            paths = fmus.build_wasm(name, options.out, work.begin)
        elif options.native:
            paths = fmus.build_native(name, options.out, options.target, work.begin)
        else:
            paths = fmus.build_python(name, options.out, work.begin)
    except OSError:
        work.end("failed")
        raise
    except ValueError as problem:
        work.end("failed")
        raise ModelError(f"{name}: {problem}") from None
    work.end()
    for path in paths:
        print(f"    {path} ({path.stat().st_size / 1024:.0f} KiB)")
    return paths


class WorkLog:
    """Says what is being done and how long it took: a line for each piece of work."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._since: float | None = None

    def begin(self, work: str) -> None:
        """Begin ``work``; what was begun before is done."""
        self.end()
        print(f"{self._label}: {work} ... ", end="", flush=True)
        self._since = perf_counter()

    def end(self, result: str = "") -> None:
        """All work is done, or has ended with ``result``."""
        if self._since is not None:
            print(result or f"{perf_counter() - self._since:.1f} s", flush=True)
        self._since = None
