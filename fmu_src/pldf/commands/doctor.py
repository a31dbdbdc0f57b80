"""``pldf doctor``: what is installed and where things lie, in one block for a bug report."""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement

from .. import __version__
from ..cache import CACHE_VARIABLE, user_cache
from ..errors import ModelError

EXAMPLE: Final = "pldf doctor"

_PACKAGE: Final = "adaptive-pldf"
_PATIENCE_S: Final = 60.0


class Findings:
    """What was found, line by line, and what of it keeps pldf from working."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.broken: list[str] = []

    def add(self, title: str, text: str) -> None:
        """Add a line; one with the title of the line before goes on with that."""
        again = any(line.startswith(f"{title:10} ") for line in self.lines)
        self.lines.append(f"{'' if again else title:10} {text}")

    def add_broken(self, title: str, text: str) -> None:
        """Add a line that says what does not work and the way out."""
        self.add(title, f"BROKEN: {text}")
        self.broken.append(text)


def configure(parser: argparse.ArgumentParser) -> None:
    """There is nothing to choose."""


def run(_: argparse.Namespace) -> None:
    """Print what was found; ModelError if something needed does not work."""
    findings = Findings()
    looks: tuple[Callable[[Findings], None], ...] = (
        _installation,
        _packages,
        _extras,
        _compiler,
        _fmus,
        _cockpit,
        _store,
        _cache,
    )
    for look in looks:
        look(findings)
    print("\n".join(findings.lines))
    if findings.broken:
        raise ModelError("; ".join(findings.broken))


def _installation(findings: Findings) -> None:
    findings.add("pldf", f"{__version__}, in {Path(__file__).parents[1]}")
    findings.add("Python", f"{platform.python_version()}, {sys.executable}")
    findings.add("platform", f"{platform.platform()}, {os.cpu_count()} cores")


def _requirements(extra: str = "") -> list[Requirement]:
    """Return what the package needs in this environment, or what one of its extras adds."""
    needed = [Requirement(text) for text in requires(_PACKAGE) or ()]
    return [each for each in needed if _counts(each, extra) and not (extra and _counts(each, ""))]


def _counts(requirement: Requirement, extra: str) -> bool:
    return requirement.marker is None or requirement.marker.evaluate({"extra": extra})


def _state(requirement: Requirement) -> tuple[str, bool]:
    """Return what is installed of a requirement, and whether that will do."""
    try:
        installed = version(requirement.name)
    except PackageNotFoundError:
        return f"{requirement.name} is missing", False
    if not requirement.specifier.contains(installed, prereleases=True):
        return f"{requirement.name} {installed} is not {requirement.specifier}", False
    return f"{requirement.name} {installed}", True


def _packages(findings: Findings) -> None:
    states = [_state(requirement) for requirement in _requirements()]
    findings.add("packages", ", ".join(text for text, good in states if good))
    for text, good in states:
        if not good:
            findings.add_broken("packages", f"{text}; run: pip install {_PACKAGE}")


def _extras(findings: Findings) -> None:
    for name in sorted(metadata(_PACKAGE).get_all("Provides-Extra") or ()):
        states = [_state(requirement) for requirement in _requirements(name)]
        text = ", ".join(text for text, _ in states)
        if not all(good for _, good in states):
            text += f"; if you need it: pip install '{_PACKAGE}[{name}]'"
        findings.add("extras", f"{name}: {text}")


def _compiler(findings: Findings) -> None:
    """Ask the compiler of native FMUs, which comes with the extra, for its version."""
    if not _state(Requirement("ziglang"))[1]:
        findings.add("compiler", "none for native FMUs, they need the extra native")
        return
    try:
        done = subprocess.run(
            [sys.executable, "-m", "ziglang", "version"],
            capture_output=True,
            text=True,
            check=False,
            timeout=_PATIENCE_S,
        )
        answer = done.stdout.strip() or done.stderr.strip() or f"exit status {done.returncode}"
    except (OSError, subprocess.TimeoutExpired) as problem:
        answer = str(problem)
    findings.add("compiler", f"zig for native FMUs: {answer}")


def _fmus(findings: Findings) -> None:
    """Say which FMUs ``pldf drive`` would drive here, without building any."""
    try:
        from ..build import first_use  # noqa: PLC0415 - brings what may be broken
        from ..build_version import build_version  # noqa: PLC0415
        from ..cosim.kinds import USUAL_FOLDER  # noqa: PLC0415
        from ..cosim.which_fmus import choose_fmus  # noqa: PLC0415

        findings.add("sources", build_version())
        if first_use.nobody_built():
            cached = first_use.cached_folder()
            when = "Python, in" if cached.is_dir() else "none yet; the first drive builds them into"
            findings.add("FMUs", f"{when} {cached}")
            return
        choice = choose_fmus(USUAL_FOLDER)
    except (ImportError, ModelError) as problem:
        findings.add_broken("FMUs", str(problem))
        return
    findings.add("FMUs", f"{choice.kind}, in {choice.folder.resolve()}")
    for note in choice.notes:
        findings.add("FMUs", note)


def _cockpit(findings: Findings) -> None:
    """Say where the FMUs of the cockpit's page are, without compiling any."""
    try:
        from ..cockpit.wasm_models import place_of_models  # noqa: PLC0415 - as above

        place = place_of_models()
    except ImportError as problem:
        findings.add_broken("cockpit", str(problem))
        return
    if place:
        findings.add("cockpit", f"FMUs as WebAssembly, in {place}")
    elif _state(Requirement("ziglang"))[1]:
        findings.add("cockpit", "none yet; 'pldf cockpit' compiles its FMUs once, for minutes")
    else:
        findings.add("cockpit", "no FMUs as WebAssembly; compiling them needs the extra native")


def _store(findings: Findings) -> None:
    try:
        from ..profiles.store import STORE_VARIABLE, ProfileStore  # noqa: PLC0415 - as above
    except ImportError as problem:
        findings.add_broken("profiles", str(problem))
        return
    folder = os.environ.get(STORE_VARIABLE, "")
    if not folder:
        findings.add("profiles", f"{STORE_VARIABLE} is not set: kept where --store says, if at all")
    elif not _writable(Path(folder)):
        findings.add_broken("profiles", f"{STORE_VARIABLE}: {folder} cannot be written")
    else:
        store = ProfileStore(folder)
        count, refused = len(store.files()), len(store.refused())
        findings.add("profiles", f"{count} in {folder}, {refused} put aside as unusable")
        for older, newer in store.readings_of_one_road():
            findings.add(
                "profiles",
                f"{older.name} and {newer.name} are probably of one road, read in two ways: "
                "'pldf profiles move' carries the older one over",
            )


def _cache(findings: Findings) -> None:
    folder = user_cache()
    if _writable(folder):
        size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
        findings.add("cache", f"{folder}, {size / 1e6:.0f} MB")
    else:
        findings.add(
            "cache",
            f"{folder} cannot be written: kernels are compiled anew each time, and FMUs must be "
            f"built with 'pldf build'; set {CACHE_VARIABLE} to another folder",
        )


def _writable(folder: Path) -> bool:
    """Tell whether files can be written into a folder, which is made when it is needed."""
    existing = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    return existing.is_dir() and os.access(existing, os.W_OK | os.X_OK)
