"""The study file: who drives what, in which order, with which function (``studies/``)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from msgspec.structs import asdict

from vehicle_models.vehicle_state import VehicleState

from ..errors import ModelError
from ..findings import Finding
from ..kernel.codes import LEARN_FAITHFUL, LEARN_OFF
from ..kernel.signals import Signal, signals_of
from ..kernel.state import PldfState
from ..roads import Road, RoadOptions, open_road
from ..roads.options import OptionNeededError, said
from ..settings import parameter_value
from ..toml_file import Key, TomlFile, listed, shown
from .participants import DRIVER_SIGNALS, Participant, StudySettings
from .participants_file import read_participants
from .phases import PHASES, Phase
from .population import Distribution, read_distribution, sample_participants
from .study_tables import StudyTables, parameter_table

# The packaged study of one driver through the FMUs.
ONE_DRIVER: Final = "one_driver"
# Studies that come with the package, by name.
PACKAGED: Final = Path(__file__).parent / "studies"
# Parameters that follow from the study file's other keys.
_NOT_TO_SET: Final = (
    "apply_learned", "driver_id", "learn_consistent", "learn_faithful", "localization",
    "main_switch", "route_id", "start_s_m",
)  # fmt: skip


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
    """

    title: str
    settings: StudySettings
    participants: tuple[Participant, ...]
    through: str
    out: Path
    source: str
    notes: tuple[Finding, ...] = ()


def study_path(name: str) -> Path:
    """Return the study file that a person named: a file, or a packaged study such as ``paper``.

    Raises:
        ModelError: there is neither.
    """
    path, packaged = Path(name), PACKAGED / f"{name}.toml"
    if path.exists():
        return path
    if packaged.is_file():
        return packaged
    known = ", ".join(sorted(file.stem for file in PACKAGED.glob("*.toml")))
    raise ModelError(f"{name}: no such study file; packaged are {known}")


def changes_of(settings: Mapping[str, str]) -> dict[Key, Any]:
    """Return parameters that a person named, as changes of a study file.

    Args:
        settings: text by FMI name, with ``pldf.``, ``vehicle.`` or ``driver.`` before it where
            more than one of the three has it.

    Raises:
        ModelError: there is no such parameter in a study file, or it cannot have this value.
    """
    places: dict[str, list[Key]] = {}
    for table, part in _PARTS.items():
        for name in SETTABLE[table]:
            places.setdefault(name, []).append((table, name))
            places.setdefault(f"{part}.{name}", []).append((table, name))
    changes = {}
    for given, text in settings.items():
        if given not in places:
            near = ", ".join(get_close_matches(given, places, n=3, cutoff=0.5)) or "learning.weight"
            raise ModelError(f"--set {given}: not in a study file; did you mean {near}?")
        if len(places[given]) > 1:
            both = " or ".join(f"{_PARTS[table]}.{name}" for table, name in places[given])
            raise ModelError(f"--set {given}: more than one FMU has it, write {both}")
        (key,) = places[given]
        changes[key] = _uncoded(SETTABLE[key[0]][key[1]], text)
    return changes


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
    people = _participants(file, tables, notes)
    settings = StudySettings(
        road=_road(file, tables, typed=bool(changes)),
        phases=_phases(file, tables),
        counterbalanced=tables.drives.order == "counterbalanced",
        function=_function(file),
        vehicle=_parameters(file, "vehicle", SETTABLE["vehicle"]),
        step_s=tables.drives.step_s,
        recorded=_recorded(file, tables, [person.id for person in people]),
    )
    return Study(
        title=tables.title or path.stem,
        settings=settings,
        participants=people,
        through=tables.drives.through,
        out=Path(tables.output or f"out/{path.stem}"),
        source=file.text,
        notes=(*settings.road.route.notes, *notes),
    )


def _settable(record: type[PldfState] | type[VehicleState]) -> dict[str, Signal]:
    return {
        signal.name: signal
        for signal in signals_of(record)
        if signal.causality == "parameter" and signal.name not in _NOT_TO_SET
    }


# The tables of parameters, and what the coupled models are called.
_PARTS: Final = {"function": "pldf", "vehicle": "vehicle", "driver": "driver"}
# The tables of parameters: what may be set there, by FMI name.
SETTABLE: Final[Mapping[str, Mapping[str, Signal]]] = {
    "function": _settable(PldfState),
    "vehicle": _settable(VehicleState),
    "driver": {signal.name: signal for signal in DRIVER_SIGNALS.values()},
}


def _parameters(file: TomlFile, table: str, known: Mapping[str, Signal]) -> dict[str, float | int]:
    """Return a table of parameters; enumerations and Booleans as numbers."""
    read = file.read(parameter_table(known.values()), table)
    return {
        name: _coded(known[name], getattr(read, known[name].field))
        for name in file.table.get(table, {})
    }


def _function(file: TomlFile) -> dict[str, float | int]:
    """Return the parameters of the driving function; ``learn`` is how drives learn that do."""
    values = _parameters(file, "function", SETTABLE["function"])
    if values.get("learn", LEARN_FAITHFUL) == LEARN_OFF:
        file.fail(
            ("function", "learn"),
            '"OFF": the drives say whether they learn, this says how: write "FAITHFUL" or '
            '"CONSISTENT", or choose drives that do not learn in [drives], such as A1',
        )
    return values


def _uncoded(signal: Signal, text: str) -> Any:
    """Return what a study file says for a value that was given as text."""
    value = parameter_value(signal, text)
    if signal.enumeration is not None and 0 <= value < len(signal.enumeration.items):
        return signal.enumeration.items[int(value)]
    return bool(value) if signal.kind == "Boolean" else value


def _coded(signal: Signal, value: Any) -> float | int:
    if signal.enumeration is not None:
        return signal.enumeration.items.index(value)
    return float(value) if signal.kind == "Real" else int(value)


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
    names, repeats = tables.drives.phases, tables.drives.per_phase
    key = ("drives", "phases")
    if not names:
        file.fail(key, f"empty; choose out of {', '.join(PHASES)}")
    if len(set(names)) < len(names):
        file.fail(key, "an item occurs twice")
    phases = [PHASES[name] for name in names for _ in range(repeats)]
    if repeats == 1:
        return tuple(phases)
    counts = {"A": 0, "B": 0}
    numbered = []
    for phase in phases:
        system = phase.name[0]
        counts[system] += 1
        numbered.append(phase._replace(name=f"{system}{counts[system]}"))
    return tuple(numbered)


def _recorded(file: TomlFile, tables: StudyTables, known: list[str]) -> frozenset[str]:
    names = tables.recordings.participants
    if names == "all":
        return frozenset(known)
    everybody = set(known)
    for name in names:
        if name not in everybody:
            file.fail(
                ("recordings", "participants"), f"{shown(name)} must be one of {listed(known)}"
            )
    return frozenset(names)


def _participants(
    file: TomlFile, tables: StudyTables, notes: list[Finding]
) -> tuple[Participant, ...]:
    """Return those of a file, the one driver who is described, or people who are drawn."""
    table, given = tables.participants, file.table.get("participants", {})
    if table.file:
        _refuse(file, ("count", "seed", "first"), ("driver", "distribution"), "participants.file")
        return read_participants(file.path.parent / table.file, notes)
    if tables.driver is not None:
        _refuse(file, (), ("distribution",), "a driver who is described")
        if given.get("count", 1) != 1:
            file.fail(("participants", "count"), "[driver] describes one driver: write count = 1")
        values = _parameters(file, "driver", SETTABLE["driver"])
        fields = {SETTABLE["driver"][name].field: float(value) for name, value in values.items()}
        return (Participant(f"P{table.first:03d}", table.seed, fields),)
    return tuple(sample_participants(table.count, table.seed, _distribution(file), table.first))


def _refuse(file: TomlFile, keys: tuple[str, ...], tables: tuple[str, ...], beside: str) -> None:
    """Fail if one of these is given, since ``beside`` says it all."""
    for key in keys:
        if key in file.table["participants"]:
            file.fail(("participants", key), f"not together with {beside}, which says it all")
    for table in tables:
        if table in file.table:
            file.fail((table,), f"not together with {beside}")


def _distribution(file: TomlFile) -> Distribution:
    table = file.table.get("distribution", {})
    for name, law in table.items():
        try:
            read_distribution({name: law})
        except ModelError as problem:
            file.fail(("distribution", name), str(problem))
    return read_distribution(table)
