"""What a report is made of, read from the folder of a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from ..analysis.analysis import Analysis
from ..analysis.checks import UNCHECKED, Checks
from ..analysis.long_run import Columns, long_run_of, read_long_run
from ..analysis.study_folder import StudyFolder
from ..errors import ModelError
from ..files.tables import read_table
from ..findings import Finding
from ..function import DrivingFunction
from ..kernel.parameters import PlannerParameters
from ..kernel.signals import signals_of
from ..outcome_words import lines_of
from ..profiles.stored_profile import Iteration, StoredProfile
from ..recordings.offline import learn_from
from ..recordings.quality import cells_of
from ..recordings.recording import Recording
from ..recordings.steps import Steps, explain_steps
from ..roads import Route, fingerprint, open_route, route_arrays
from ..route_facts import RouteFacts, route_facts
from ..study.own_files import STUDY, VERSIONS
from ..study.participants_file import PARTICIPANTS
from ..study.study_file import read_study
from .own_versions import driven_otherwise, read_parameters, read_text

_SAME_LIMIT_MPS: Final = 0.1
_SAME_LIMIT_SHARE: Final = 0.95


@dataclass(frozen=True, eq=False)
class DriverShown:
    """One participant whose recordings are there.

    Attributes:
        participant: who.
        recordings: complete, by phase, in order of the study.
        profile: base and the profile after each learned drive (the note of its iteration), as far
            as it was driven.
        outcomes: what became of each intervention, a line each, by drive learned from; as far as
            what the drives followed is what those before had taught.
        steps: one intervention explained; None if nothing was learned from ``explained``.
        explained: the first drive learned from.
        acting: the drives recorded in which the driver intervenes.
        not_known: the drives of which it is not known what the function had learned before.
    """

    participant: str
    recordings: Mapping[str, Recording]
    profile: StoredProfile
    outcomes: Mapping[str, tuple[str, ...]]
    steps: Steps | None
    explained: str
    acting: tuple[str, ...]
    not_known: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Contents:
    """Everything that the report shows.

    Attributes:
        analysis: the numbers.
        title: of the study.
        route: the road and its base profile.
        driver: one participant in detail; None without recordings.
        long_run: columns of ``long_run.csv`` by variant; empty if there is none.
        texts: files to print in full for reproduction, by name.
        parameters: part (pldf, vehicle) -> FMI name -> value; as far as the run wrote them.
        participants: parameter of the simulated drivers -> smallest, median and largest value.
        checks: what the check of the study's files found.
    """

    analysis: Analysis
    title: str
    route: RouteFacts
    driver: DriverShown | None
    long_run: Mapping[str, Columns]
    texts: Mapping[str, str]
    parameters: Mapping[str, Mapping[str, float]]
    participants: Mapping[str, tuple[float, float, float]]
    checks: Checks = UNCHECKED

    @property
    def simulated(self) -> bool:
        """True if a simulation wrote the folder."""
        return STUDY in self.texts


def collect(
    analysis: Analysis,
    study: StudyFolder,
    driver: str | None = None,
    checks: Checks = UNCHECKED,
) -> Contents:
    """Read what the report of a study shows beside its numbers.

    Args:
        analysis: of the study.
        study: where it lies.
        driver: the participant to show in detail; None: the one nearest to the median effect.
        checks: what the check of its files found.

    Raises:
        ModelError: there are no recordings of ``driver``, or they are not from the route.
    """
    folder = study.folder
    texts = {
        name: read_text(folder / name) for name in (STUDY, VERSIONS) if (folder / name).exists()
    }
    parameters = read_parameters(folder / VERSIONS, texts.get(VERSIONS, "{}"))
    route = study.route or _route_of(study)
    function = _function(parameters.get("pldf", {}))
    shown = _choose(analysis, study, driver)
    if shown is None and study.route is None and not study.study_file:
        analysis = replace(analysis, notes=(*analysis.notes, _road_assumed(study)))
    long_run = long_run_of(folder)
    if long_run is not None:
        told = driven_otherwise(folder, long_run.parent)
        analysis = replace(analysis, notes=(*analysis.notes, *told))
    return Contents(
        analysis=analysis,
        title=_title(study),
        route=_facts(route, function),
        driver=None if shown is None else _driver(shown, study, route, function),
        long_run={} if long_run is None else read_long_run(long_run),
        texts=texts,
        parameters=parameters,
        participants=_parameter_ranges(folder / "participants.csv"),
        checks=checks,
    )


def _title(study: StudyFolder) -> str:
    """Return the title that the study file gives, with the variant driven."""
    title = str(study.study_file.get("title", f"Study {study.folder.resolve().name}"))
    variant = study.study_file.get("variant")
    return f"{title}: {variant}" if variant else title


def _road_assumed(study: StudyFolder) -> Finding:
    """Return what has to be said if neither a road was named nor recordings show which it was."""
    return Finding(
        "warning", str(study.folder), 0, "",
        "no road was named, so the report shows the study road",
        "limits and base profile in it are of another road if the drives were elsewhere",
        "name the road with --route",
    )  # fmt: skip


def _route_of(study: StudyFolder) -> Route:
    """Return the route of the study file, if its road is where that says."""
    road = study.study_file.get("road", {})
    name = str(road.get("route", "study"))
    if name == "study" or name.isdigit():
        return open_route(name)
    try:
        return read_study(study.folder / STUDY).settings.road.route
    except ModelError:
        way = ", ".join(f"{key} = {value}" for key, value in road.items() if key != "route")
        raise ModelError(
            f"{study.folder}: driven on {name}{f' ({way})' if way else ''}, which is not there as "
            "the study file says it; name the route with --route"
        ) from None


def _function(values: Mapping[str, float]) -> DrivingFunction:
    """Return a driving function with the parameters, by FMI name, of the run."""
    function = DrivingFunction()
    for signal in signals_of(function.record):
        if signal.causality == "parameter" and signal.name in values:
            value = values[signal.name]
            setattr(function.record, signal.field, value if signal.kind == "Real" else int(value))
    return function


def _facts(route: Route, function: DrivingFunction) -> RouteFacts:
    """Return the facts of the route as planned with the parameters of the run."""
    function.prepare(route)
    facts = route_facts(route)
    default = PlannerParameters().planner_lateral_accel_max_mps2
    faster = (function.record.planner_lateral_accel_max_mps2 / default) ** 0.5
    return replace(
        facts,
        base_mps=np.array(function.profile.base_mps),
        curve_speed_mps=faster * facts.curve_speed_mps,
    )


def _parameter_ranges(path: Path) -> Mapping[str, tuple[float, float, float]]:
    """Return smallest, median and largest value of each parameter of the simulated drivers."""
    if not path.exists():
        return {}
    numbers = read_table(path, PARTICIPANTS).numbers
    return {
        name: (float(np.min(values)), float(np.median(values)), float(np.max(values)))
        for name, values in numbers.items()
        if name != "seed"
    }


def _choose(analysis: Analysis, study: StudyFolder, wanted: str | None) -> str | None:
    """Return whom to show: of those recorded, who is nearest to the median fall of the rate."""
    recorded = study.recordings()
    first = _first_taught(study)
    complete = [p for p in analysis.participants if (p, first) in recorded]
    if wanted is not None:
        if wanted not in complete:
            raise ModelError(
                f"{study.folder}: no recordings/{wanted}_{first}.csv, so {wanted} cannot "
                f"be shown; recorded are {', '.join(complete) or 'none'}"
            )
        return wanted
    if not complete:
        return None
    a, b = (analysis.per_participant("combined", system) for system in "AB")
    falls = dict(zip(analysis.participants, a - b, strict=True))
    median = float(np.median(a - b))
    return min(complete, key=lambda name: abs(falls[name] - median))


def _first_taught(study: StudyFolder) -> str:
    """Return the first drive that is learned from; it follows the base profile."""
    return next((phase.name for phase in study.order() if phase.learn), "")


def _driver(
    participant: str, study: StudyFolder, route: Route, function: DrivingFunction
) -> DriverShown:
    first = _first_taught(study)
    known = replace(study, route=route)
    paths = {phase: path for (who, phase), path in known.recordings().items() if who == participant}
    recordings = {phase: known.read(path) for phase, path in paths.items()}
    for phase, recording in recordings.items():
        _require_route(paths[phase], recording, route)
    profile = StoredProfile(0, fingerprint(route), np.array(function.profile.base_mps))
    for taught, seen in known.development().items():
        if seen in recordings and "profile_mps" in recordings[seen]:
            profile = profile.with_iteration(_followed(recordings[seen], profile, taught))
    outcomes = _outcomes(recordings, study, route, function)
    return DriverShown(
        participant=participant,
        recordings=recordings,
        profile=profile,
        outcomes=outcomes,
        steps=explain_steps(learn_from(recordings[first], route, function=function)),
        explained=first,
        acting=tuple(p for names in study.compared().values() for p in names if p in recordings),
        not_known=tuple(p for p, recording in recordings.items() if "profile_mps" not in recording),
    )


def _outcomes(
    recordings: Mapping[str, Recording],
    study: StudyFolder,
    route: Route,
    function: DrivingFunction,
) -> dict[str, tuple[str, ...]]:
    """Learn from one drive after the other; return what became of the interventions of each."""
    told: dict[str, tuple[str, ...]] = {}
    stored: StoredProfile | None = None
    for phase in study.order():
        if not phase.learn:
            continue
        if phase.name not in recordings:
            break
        learned = learn_from(recordings[phase.name], route, stored, function)
        known = stored is None or "profile_mps" in recordings[phase.name]
        if not known or any(note.severity == "warning" for note in learned.notes):
            break
        told[phase.name] = tuple(lines_of(learned.function.outcomes(), learned.function.marks))
        stored = learned.profile
    return told


def _require_route(path: Path, recording: Recording, route: Route) -> None:
    """Raise ModelError unless the recorded limits are those of the route."""
    arrays = route_arrays(route)
    limit = np.asarray(arrays.limit_mps)[cells_of(recording["s_m"], arrays)]
    same = np.abs(recording["limit_mps"] - limit) < _SAME_LIMIT_MPS
    if np.mean(same) < _SAME_LIMIT_SHARE:
        raise ModelError(
            f"{path}: not driven on {route.name}: other limits; name the route with --route"
        )


def _followed(recording: Recording, profile: StoredProfile, taught: str) -> Iteration:
    """Return the profile that a drive followed as the next iteration of ``profile``."""
    passed = np.maximum.accumulate(recording["s_m"])
    speeds = np.interp(np.arange(float(profile.nodes)), passed, recording["profile_mps"])
    return profile.next_iteration("drive", taught, 0, {"learned_mps": speeds})
