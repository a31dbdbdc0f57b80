"""Native FMUs in the C host (``native_host/``), on this and on emulated platforms."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Final

import fmpy
import pytest
from built_once import once
from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ScalarVariable
from pldf import cli
from pldf.build import fmus as fmu_build
from pldf.build.native.linking import HEADERS, zig
from pldf.cosim.platforms import TARGETS

Value = str | int | float
Process = subprocess.Popen[bytes]
SOURCES: Final = Path(__file__).parent / "native_host"
WARNINGS: Final = ("-Wall", "-Wextra", "-Werror")
MODELS: Final = tuple(fmu_build.FMUS)
KINDS: Final = ("Real", "Integer", "Enumeration", "Boolean", "String")  # as in host.h
_KIND_OF: Final = {"Float64": "Real", "Int32": "Integer"}
_CROSS: Final = "/usr/aarch64-linux-gnu"


@dataclass(frozen=True)
class Platform:
    """Where a C host runs.

    Attributes:
        target: its name in ``TARGETS``.
        versions: of FMI that know it.
        runner: program, with arguments, that runs the platform's programs here.
        needs: what that takes (commands, files), and the Debian packages that have it.
        root: stands before absolute paths.
    """

    target: str
    versions: tuple[int, ...] = (2, 3)
    runner: tuple[str, ...] = ()
    needs: Mapping[str, str] = field(default_factory=dict)
    root: str = ""

    def require(self) -> None:
        """Skip the test if programs of this platform cannot be run here."""
        for thing, package in self.needs.items():
            if not (shutil.which(thing) or Path(thing).exists()):
                missing(f"{thing} is missing: apt-get install {package}")

    def path(self, path: Path) -> str:
        """Return an absolute path as programs of this platform write it."""
        return f"{self.root}{path}"


# By their name for ``pldf build --target``.
PLATFORMS: Final = {
    "linux64": Platform("x86_64-linux"),
    "win64": Platform("x86_64-windows", runner=("wine",), needs={"wine": "wine wine64"}, root="Z:"),
    "aarch64-linux": Platform(
        "aarch64-linux",
        (3,),
        ("qemu-aarch64-static", "-L", _CROSS),
        {"qemu-aarch64-static": "qemu-user-static", _CROSS: "libc6-arm64-cross"},
    ),
}
ON: Final = [(name, version) for name, p in PLATFORMS.items() for version in p.versions]


def missing(reason: str) -> None:
    """Skip a test for want of something; in CI nothing may be wanting."""
    if os.environ.get("PLDF_CI"):
        pytest.fail(reason)
    pytest.skip(reason)


def address(path: str) -> str:
    """Return the file:// address of an absolute path."""
    return f"file://{path}" if path.startswith("/") else f"file:///{path}"


def kind_of(variable: ScalarVariable) -> int:
    """Return the number that the C host has for the variable's type."""
    return KINDS.index(_KIND_OF.get(variable.type, variable.type))


@dataclass(frozen=True)
class Unpacked:
    """An unpacked FMU of either version of FMI."""

    folder: Path
    description: ModelDescription

    @staticmethod
    def of(archive: Path, folder: Path) -> Unpacked:
        """Unpack ``archive`` into ``folder``, unless that was done before."""
        if not folder.exists():
            fmpy.extract(str(archive), unzipdir=str(folder))
        return Unpacked(folder, read_model_description(str(folder)))

    @property
    def version(self) -> int:
        """Of FMI."""
        return int(self.description.fmiVersion[0])

    def variables(self, causality: str) -> list[ScalarVariable]:
        """Return those with this causality, in the order of their value references.

        String outputs are left out: results are rows of numbers.
        """
        found = [v for v in self.description.modelVariables if v.causality == causality]
        return [v for v in found if causality != "output" or v.type != "String"]

    def library(self, platform: Platform) -> Path:
        """Return the path of the library for ``platform``."""
        target = TARGETS[platform.target]
        place = target.fmi2 if self.version == 2 else platform.target
        model = self.description.coSimulation.modelIdentifier
        return self.folder / "binaries" / place / f"{model}{target.suffix}"

    def described(
        self,
        platform: Platform,
        path: Path,
        settings: Mapping[str, Value] | None = None,
        library: Path | None = None,
        resources: Path | None = None,
    ) -> Path:
        """Write what the C host has to know to ``path``, and return it.

        Args:
            platform: where the C host runs.
            path: of the file to be written.
            settings: parameters by name.
            library: in place of the FMU's own.
            resources: folder that the importer names, in place of the FMU's own.
        """
        named = platform.path(resources or self.folder / "resources")
        lines = [
            f"version {self.version}",
            f"library {platform.path(library or self.library(platform))}",
            f"token {self.description.guid}",
            f"resources {named + '/' if self.version == 3 else address(named)}",
        ]
        for causality in ("parameter", "input", "output"):
            for v in self.variables(causality):
                lines.append(f"{causality} {kind_of(v)} {v.valueReference}")
        known = {v.name: v for v in self.description.modelVariables}
        for name, value in (settings or {}).items():
            text = value if isinstance(value, str) else float(value).hex()
            lines.append(f"set {kind_of(known[name])} {known[name].valueReference} {text}")
        path.write_text("\n".join([*lines, ""]), encoding="utf-8", newline="\n")
        return path


class Hosts:
    """The C host and the native FMUs for every platform, built when they are first needed."""

    def __init__(self, factory: pytest.TempPathFactory) -> None:
        self._factory = factory
        self.fmu = cache(self._fmu)
        self.program = cache(self._program)
        self._environment = cache(self._made_environment)

    def _fmu(self, platform: str, version: int, model: str) -> Unpacked:
        """Return an FMU for one platform."""
        PLATFORMS[platform].require()
        folder = native_archives(self._factory, platform) / ("fmi3" if version == 3 else "")
        own = self._factory.mktemp("unpacked")
        return Unpacked.of(folder / f"{model}.fmu", own / model)

    def _program(self, platform: str) -> Path:
        """Return the C host for one platform."""
        PLATFORMS[platform].require()

        def build(folder: Path) -> None:
            compiled_host(PLATFORMS[platform], folder / "host.exe")

        return once(self._factory, f"host_{platform}", build) / "host.exe"

    def run(self, platform: str, *arguments: str | Path, cwd: Path) -> None:
        """Run the C host; paths are given as they are here. It must end with status 0."""
        self.end(self.start(platform, *arguments, cwd=cwd))

    def start(self, platform: str, *arguments: str | Path, cwd: Path) -> Process:
        """Start the C host."""
        where = PLATFORMS[platform]
        given = [where.path(a) if isinstance(a, Path) else a for a in arguments]
        command = [*where.runner, str(self.program(platform)), *given]
        kept = self._environment(platform)
        return subprocess.Popen(command, env=kept, cwd=cwd, stderr=subprocess.PIPE)

    def end(self, process: Process) -> None:
        """Wait for the end of a C host; its status must be 0."""
        _, told = process.communicate()
        assert process.returncode == 0, (process.returncode, told[-3000:].decode(errors="replace"))

    def _made_environment(self, platform: str) -> dict[str, str]:
        """Return the environment of the C host: without a profile store, wine with a home."""
        kept = {k: v for k, v in os.environ.items() if not k.startswith("PLDF_")}
        if PLATFORMS[platform].runner[:1] != ("wine",):
            return kept

        def build(folder: Path) -> None:
            made = {**kept, "WINEPREFIX": str(folder), "WINEDEBUG": "-all"}
            subprocess.run(["wineboot", "--init"], env=made, capture_output=True, check=True)

        prefix = once(self._factory, "wine", build)
        return {**kept, "WINEPREFIX": str(prefix), "WINEDEBUG": "-all"}


def native_archives(factory: pytest.TempPathFactory, platform: str) -> Path:
    """Return the folder of the native FMUs for one platform, validated by fmpy."""
    pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")
    if sys.platform != "linux":
        pytest.skip("native FMUs are built on every system, but tested on Linux")

    def build(folder: Path) -> None:
        arguments = ["--native", "--target", platform, "--out", str(folder)]
        assert cli.main(["build", *arguments]) == 0

    return once(factory, f"native_{platform}", build) / "native"


def compiled_host(platform: Platform, path: Path, main: str = "main", *flags: str) -> None:
    """Compile the C host with the program in ``main`` for a platform."""
    windows = TARGETS[platform.target].suffix == ".dll"
    libraries = ["-lm"] if windows else ["-lm", "-ldl", "-lpthread"]
    # As for FMUs: zig has then compiled its C library.
    how = ["-std=gnu11", "-O2", "-s", "-fPIC", *WARNINGS, f"-I{HEADERS}", *flags]
    command = zig(platform.target, *how, *host_sources(main), "-o", path, *libraries)
    subprocess.run(command, check=True)


def host_sources(main: str = "main") -> list[str]:
    """Return the sources of the C host with the program in ``main``."""
    others = {"main", "quiet", "recorded"} - {main}
    return [str(path) for path in sorted(SOURCES.glob("*.c")) if path.stem not in others]
