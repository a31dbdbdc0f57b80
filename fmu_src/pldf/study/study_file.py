"""The study file: who drives what, in which order, with which function (``studies/``)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from msgspec.structs import asdict

from ..cosim.values import Value
from ..errors import ModelError
from ..findings import Finding
from ..roads import Road, RoadOptions, open_road
from ..roads.options import OptionNeededError, said
from ..toml_file import Key, TomlFile, shown
from .participants import Participant, StudySettings
from .phases import PHASES, Phase, repeated
from .study_parameters import function_of, parameters_of
from .study_people import check_thresholds, people_of, recorded_of
from .study_tables import StudyTables
from .study_variants import variants_of

# The packaged study of one driver through the FMUs.
ONE_DRIVER: Final = "one_driver"
# Studies that come with the package, by name.
PACKAGED: Final = Path(__file__).parent / "studies"


@dataclass(frozen=True, eq=False)
class Study:
    """A study as described by its file.

    Attributes:
        title: for people.
        settings: what is the same for all participants.
        participants: in the order of their numbers.
        through: what drives, unless the command says otherwise: "kernels" or "fmus".
        out: where the results go.
        source: the file's content, with the changes asked for.
        notes: how the road and the list of participants were read.
        variants: the studies to be driven in its place, by name: the same but for the function.
    """

    title: str
    settings: StudySettings
    participants: tuple[Participant, ...]
    through: str
    out: Path
    source: str
    notes: tuple[Finding, ...] = ()
    variants: Mapping[str, Study] = field(default_factory=dict)


def study_path(name: str) -> Path:
    """Return the study file that a person named: a file, or a packaged study such as ``paper``.

    Raises:
        ModelError: there is neither.
    """
    path, packaged = Path(name), PACKAGED / f"{name}.toml"
    if path.is_file():
        return path
    if packaged.is_file():
        return packaged
    known = ", ".join(sorted(file.stem for file in PACKAGED.glob("*.toml")))
    raise ModelError(f"{name}: no such study file; packaged are {known}")


def read_study(path: Path, changes: Mapping[Key, Any] | None = None) -> Study:
    """Read a study file.

    Args:
        path: the file.
        changes: values that count in place of the file's, by (table, key).

    Raises:
        ModelError: naming file, line, key and the allowed values.
    """
    file = TomlFile(path, changes)
    tables = file.read(StudyTables)
    notes: list[Finding] = []
    people = people_of(file, tables, notes)
    road = _road(file, tables, typed=bool(changes))
    settings = StudySettings(
        road=road,
        phases=_phases(file, tables),
        counterbalanced=tables.drives.order == "counterbalanced",
        function=function_of(file),
        vehicle=parameters_of(file, "vehicle"),
        step_s=tables.drives.step_s,
        recorded=recorded_of(file, tables, people, road.route),
        threshold_growth_per_drive=tables.drives.threshold_growth_per_drive,
    )
    check_thresholds(file, settings, people)
    study = Study(
        title=tables.title or path.stem,
        settings=settings,
        participants=people,
        through=tables.drives.through,
        out=Path(tables.output or f"out/{path.stem}"),
        source=file.text,
        notes=(*settings.road.route.notes, *notes),
    )
    variants = {name: _variant(study, name, own) for name, own in variants_of(file).items()}
    if tables.variant:
        return replace(variants[tables.variant], source=file.text)
    return replace(study, variants=variants)


def _variant(study: Study, name: str, parameters: Mapping[str, Value]) -> Study:
    """Return a variant as a study of its own, whose file says which one of them it is."""
    function = {**study.settings.function, **parameters}
    return replace(
        study,
        title=f"{study.title}: {name}",
        settings=replace(study.settings, function=function),
        out=study.out / name,
        source=f"variant = {shown(name)}\n{study.source}",
    )


def _road(file: TomlFile, tables: StudyTables, *, typed: bool) -> Road:
    """Return the road; ``typed``: what the file says was typed as options of a command."""
    road = tables.road
    beside = file.path.parent / road.route
    try:
        return open_road(
            str(beside) if beside.is_file() else road.route,
            RoadOptions(**{name: _said(v) for name, v in asdict(road).items() if name != "route"}),
        )
    except OptionNeededError as problem:  # this file has keys where a command has options
        file.fail(("road", "route"), str(problem) if typed else problem.told(_keys))
    except ModelError as problem:
        file.fail(("road", "route"), str(problem))


def _said(value: Any) -> Any:
    """Return a value of the table [road] as the reader wants it; ids may be written as numbers."""
    if isinstance(value, tuple):
        return tuple(map(str, value))
    return str(value) if type(value) is int else value


def _keys(options: RoadOptions) -> str:
    """Return the options as they are written into the table [road]."""
    written = (
        f"{name} = {shown(list(value) if isinstance(value, tuple) else value)}"
        for name, value in said(options).items()
    )
    return ", ".join(written)


def _phases(file: TomlFile, tables: StudyTables) -> tuple[Phase, ...]:
    """Return the phases in order; driven more than once, they are numbered on per system."""
    names = tables.drives.phases
    key = ("drives", "phases")
    if not names:
        file.fail(key, f"empty; choose out of {', '.join(PHASES)}")
    if len(set(names)) < len(names):
        file.fail(key, "an item occurs twice")
    return tuple(repeated(names, tables.drives.per_phase))
