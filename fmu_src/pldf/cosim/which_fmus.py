"""Which FMUs drive, native ones or Python ones, and whether they are up to date."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

import fmpy  # type: ignore[import-untyped]

from ..build_version import build_version, native_making
from ..errors import ModelError
from .fmu import describe
from .kinds import NATIVE_FOLDER, PARTS, PARTS_IN_TRAFFIC, USUAL_FOLDER, Kind
from .platforms import TARGETS

PLATFORM: Final[str] = fmpy.platform_tuple

_STALE: Final = "made from other sources than those installed"


class Choice(NamedTuple):
    """FMUs to drive with.

    Attributes:
        kind: what they are.
        folder: where they are.
        notes: what a person should know of them, and the way out.
    """

    kind: Kind
    folder: Path
    notes: tuple[str, ...] = ()


def choose_fmus(folder: Path, kind: Kind | None = None) -> Choice:
    """Choose the FMUs of one kind in ``folder``, native ones in its ``native`` or directly in it.

    Without a kind native ones, if they run on this platform and were made from the sources
    installed, else Python ones.

    Raises:
        ModelError: FMUs of this kind are not there, do not run here, or cannot be read.
    """
    by_kind: dict[Kind, _FmuSet] = {}
    for place in (folder / NATIVE_FOLDER, folder):
        fmus = _look(place)
        if fmus is not None:
            by_kind.setdefault(fmus.kind, fmus)
    if not _native_folder():
        return _without_native(folder, kind, by_kind)
    if kind is None:
        return _usual(folder, by_kind)
    chosen = by_kind.get(kind)
    if chosen is None:
        raise ModelError(_missing(folder, kind))
    if not chosen.runs_here:
        raise ModelError(f"{chosen.problem}; {chosen.rebuild}, or drive with --fmu python")
    return Choice(kind, chosen.folder, chosen.notes)


@dataclass(frozen=True)
class _FmuSet:
    """The FMUs in a folder."""

    kind: Kind
    folder: Path
    up_to_date: bool
    runs_here: bool

    @property
    def problem(self) -> str:
        """What is wrong with them; empty if nothing is."""
        if not self.runs_here:
            return f"{self.folder}: native FMUs, but not for this platform ({PLATFORM})"
        return "" if self.up_to_date else f"{self.folder}: {_STALE}"

    @property
    def rebuild(self) -> str:
        """What to do about it."""
        return f"build them anew with {_command(self.folder, self.kind)}"

    @property
    def notes(self) -> tuple[str, ...]:
        return (f"{self.problem}; {self.rebuild}",) if self.problem else ()


def up_to_date(described: Any) -> bool:
    """Tell whether an FMU, as fmpy describes it, was made from the sources installed."""
    if described.version != build_version():
        return False
    native = not described.coSimulation.needsExecutionTool
    return not native or str(described.generationTool).endswith(native_making())


def _usual(folder: Path, by_kind: Mapping[Kind, _FmuSet]) -> Choice:
    native, python = by_kind.get("native"), by_kind.get("python")
    if native is None:
        # If there is nothing at all, unpacking says what is missing.
        return Choice("python", folder, python.notes if python else ())
    if not native.problem:
        return Choice("native", native.folder)
    if python is None:
        way_out = native.rebuild
        if native.runs_here:
            way_out += ", or drive with them: --fmu native"
        raise ModelError(f"{native.problem}, and no Python FMUs are there; {way_out}")
    passed_over = f"{native.problem}, so the Python FMUs drive; {native.rebuild}"
    return Choice("python", python.folder, (passed_over, *python.notes))


def _without_native(folder: Path, kind: Kind | None, by_kind: Mapping[Kind, _FmuSet]) -> Choice:
    """Choose on a platform that native FMUs of FMI 2.0 cannot be built for: nothing to note."""
    python = by_kind.get("python")
    if kind == "native" or python is None:
        raise ModelError(
            f"{folder}: native FMUs of FMI 2.0 do not exist for this platform ({PLATFORM}); build "
            f"Python FMUs with {_command(folder, 'python')} and drive with --fmu python"
        )
    return Choice("python", python.folder, python.notes)


def _look(folder: Path) -> _FmuSet | None:
    """Return what is in ``folder``; None if not all three FMUs that every drive needs are."""
    if not all((folder / f"{name}.fmu").is_file() for name in PARTS.values()):
        return None
    known = (folder / f"{name}.fmu" for name in PARTS_IN_TRAFFIC.values())
    paths = [path for path in known if path.is_file()]
    described = [describe(path) for path in paths]
    needs_python = any(fmu.coSimulation.needsExecutionTool for fmu in described)
    return _FmuSet(
        kind="python" if needs_python else "native",
        folder=folder,
        up_to_date=all(up_to_date(fmu) for fmu in described),
        runs_here=needs_python or all(_runs_here(path) for path in paths),
    )


def _runs_here(path: Path) -> bool:
    if not _native_folder():
        return False
    library = f"binaries/{_native_folder()}/{path.stem}{TARGETS[PLATFORM].suffix}"
    with zipfile.ZipFile(path) as archive:
        return library in archive.namelist()


def _native_folder() -> str:
    """Return where native FMUs have their library for this platform; empty: they cannot."""
    return TARGETS[PLATFORM].fmi2 if PLATFORM in TARGETS else ""


def _missing(folder: Path, kind: Kind) -> str:
    other = "python" if kind == "native" else "native"
    place = folder / NATIVE_FOLDER if kind == "native" else folder
    return (
        f"{place}: no {_called(kind)} FMUs are there; build them with "
        f"{_command(folder, kind)}, name their folder with --fmus, or drive with --fmu {other}"
    )


def _command(folder: Path, kind: Kind) -> str:
    out = folder.parent if folder.name == NATIVE_FOLDER else folder
    options = " --native" if kind == "native" else ""
    return f"'pldf build{options}{'' if out == USUAL_FOLDER else f' --out {out}'}'"


def _called(kind: Kind) -> str:
    return "Python" if kind == "python" else kind
