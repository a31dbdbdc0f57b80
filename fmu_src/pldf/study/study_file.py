"""The study file: who drives what, in which order, with which function (``studies/``)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from vehicle_models.vehicle_state import VehicleState

from ..cosim.fmu import Value
from ..cosim.master import STEP_S
from ..instance import ModelError
from ..kernel.signals import Signal, signals_of
from ..kernel.state import PldfState
from ..roads import Route
from .participants import SEED_MAX, Participant, StudySettings
from .participants_file import read_participants
from .phases import PHASES, Phase, choose_route
from .population import Distribution, read_distribution, sample_participants
from .study_text import StudyText

# Studies that come with the package, by name.
PACKAGED: Final = Path(__file__).parent / "studies"
COUNT_MAX: Final = 1_000_000
PER_PHASE_MAX: Final = 1000
ORDERS: Final = ("fixed", "counterbalanced")
STEP_MIN_S: Final = 1e-4
STEP_MAX_S: Final = 0.1
# Parameters that follow from the study file's other keys.
_NOT_TO_SET: Final = (
    "apply_learned", "driver_id", "learn", "learn_faithful", "localization", "main_switch",
    "route_id", "start_s_m",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Study:
    """A study as described by its file.

    Attributes:
        title: for people.
        settings: what is the same for all participants.
        participants: in the order of their numbers.
        out: where the results go.
        source: the file's content.
    """

    title: str
    settings: StudySettings
    participants: tuple[Participant, ...]
    out: Path
    source: str


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


def read_study(path: Path) -> Study:
    """Read a study file.

    Raises:
        ModelError: naming file, line, key and the allowed values.
    """
    file = StudyText(path)
    function, vehicle = _settable(PldfState), _settable(VehicleState)
    file.check_keys(
        {
            "": ("title", "output"),
            "participants": ("count", "seed", "file"),
            "drives": ("phases", "order", "per_phase", "step_s"),
            "road": ("route",),
            "function": function,
            "vehicle": vehicle,
            "distribution": tuple(Distribution().as_table()),
            "recordings": ("participants",),
        }
    )
    people = _participants(file)
    everybody = [one.id for one in people]
    route, road = _route(file)
    settings = StudySettings(
        route=route,
        road=road,
        phases=_phases(file),
        counterbalanced=file.choice(("drives", "order"), ORDERS) == "counterbalanced",
        function=_parameters(file, "function", function),
        vehicle=_parameters(file, "vehicle", vehicle),
        step_s=file.number(("drives", "step_s"), STEP_MIN_S, STEP_MAX_S, STEP_S),
        recorded=frozenset(file.list_of(("recordings", "participants"), everybody, ())),
    )
    return Study(
        title=file.words(("title",), path.stem),
        settings=settings,
        participants=people,
        out=Path(file.words(("output",), f"out/{path.stem}")),
        source=file.text,
    )


def _settable(record: type[PldfState] | type[VehicleState]) -> dict[str, Signal]:
    return {
        signal.name: signal
        for signal in signals_of(record)
        if signal.causality == "parameter" and signal.name not in _NOT_TO_SET
    }


def _parameters(file: StudyText, table: str, known: dict[str, Signal]) -> dict[str, Value]:
    given = file.value((table,)) or {}
    return {name: file.parameter((table, name), known[name]) for name in given}


def _route(file: StudyText) -> tuple[Route, dict[str, Value]]:
    key = ("road", "route")
    name = file.words(key, "study")
    beside = file.path.parent / name
    try:
        return choose_route(str(beside) if beside.is_file() else name)
    except ModelError as problem:
        file.fail(key, str(problem))


def _phases(file: StudyText) -> tuple[Phase, ...]:
    """Return the phases in order; driven more than once, they are numbered on per system."""
    names = file.list_of(("drives", "phases"), PHASES, tuple(PHASES))
    if not names:
        file.fail(("drives", "phases"), f"empty; choose out of {', '.join(PHASES)}")
    repeats = file.whole(("drives", "per_phase"), 1, PER_PHASE_MAX, 1)
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


def _participants(file: StudyText) -> tuple[Participant, ...]:
    table = file.value(("participants",)) or {}
    if "file" in table:
        for key in ("count", "seed"):
            if key in table:
                file.fail(("participants", key), "not together with file, which says it all")
        if "distribution" in file.table:
            file.fail(("distribution",), "not together with a file of participants")
        return read_participants(file.path.parent / file.words(("participants", "file"), ""))
    count = file.whole(("participants", "count"), 1, COUNT_MAX, 43)
    seed = file.whole(("participants", "seed"), 0, SEED_MAX, 1)
    return tuple(sample_participants(count, seed, _distribution(file)))


def _distribution(file: StudyText) -> Distribution:
    table = file.value(("distribution",)) or {}
    for name, law in table.items():
        try:
            read_distribution({name: law})
        except ModelError as problem:
            file.fail(("distribution", name), str(problem))
    return read_distribution(table)
