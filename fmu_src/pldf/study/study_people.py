"""The people of a study file: who drives, and who of them is recorded."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from ..errors import ModelError
from ..findings import Finding
from ..roads import Route
from ..toml_file import TomlFile, listed, shown
from .participants import DRIVER_SIGNALS, Participant, StudySettings
from .participants_file import read_participants
from .population import Distribution, read_distribution, sample_participants
from .study_parameters import SETTABLE, parameters_of
from .study_tables import StudyTables
from .typical import typical

# What differs from day to day in a person's wish.
_OCCASION: Final = ("wish_offset_occasion_sd_mps", "wish_lateral_occasion_sigma")


def people_of(file: TomlFile, tables: StudyTables, notes: list[Finding]) -> tuple[Participant, ...]:
    """Return those of a file, the one driver who is described, or people who are drawn."""
    table, given = tables.participants, file.table.get("participants", {})
    if table.file:
        _refuse(file, ("count", "seed", "first"), ("driver", "distribution"), "participants.file")
        path = file.path.parent / table.file
        people = read_participants(path, notes)
        notes += _shared_days(
            str(path), people, len(tables.drives.phases) * tables.drives.per_phase
        )
        return people
    if tables.driver is not None:
        _refuse(file, (), ("distribution",), "a driver who is described")
        if given.get("count", 1) != 1:
            file.fail(("participants", "count"), "[driver] describes one driver: write count = 1")
        values = parameters_of(file, "driver")
        fields = {SETTABLE["driver"][name].field: float(value) for name, value in values.items()}
        return (Participant(f"P{table.first:03d}", table.seed, fields),)
    return tuple(sample_participants(table.count, table.seed, _distribution(file), table.first))


def _shared_days(path: str, people: Sequence[Participant], drives: int) -> list[Finding]:
    """Return what is to be said of people whose seeds are so near that they share occasions."""
    varying = [one for one in people if any(one.value(part) > 0.0 for part in _OCCASION)]
    by_seed = sorted(varying, key=lambda one: one.seed)
    near = [(a, b) for a, b in pairwise(by_seed) if 0 < b.seed - a.seed < drives]
    if not near:
        return []
    (a, b), others = near[0], len(near) - 1
    more = f", as do {others} others" if others else ""
    return [
        Finding(
            "warning", path, 0, f"{a.id} and {b.id}",
            f"seeds {a.seed} and {b.seed} are less than {drives} drives apart{more}",
            "each drive takes the next seed, so what is of one day in their wishes is the same in "
            "some drives, and means over people are less certain than they look",
            f"write seeds that are at least {drives} apart, or draw the people with count and seed",
        )
    ]  # fmt: skip


def recorded_of(
    file: TomlFile, tables: StudyTables, people: Sequence[Participant], route: Route
) -> frozenset[str]:
    """Return the ids of those whose recordings and profiles are kept."""
    names, known = tables.recordings.participants, [person.id for person in people]
    if names == "all":
        return frozenset(known)
    if names == "typical":
        if tables.participants.file or tables.driver is not None:
            file.fail(
                ("recordings", "participants"),
                '"typical" is who is nearest to the medians of [distribution], and these people '
                'are not drawn; write "all" or a list of participants',
            )
        return frozenset({typical(people, _distribution(file), route).id})
    everybody = set(known)
    for name in names:
        if name not in everybody:
            file.fail(
                ("recordings", "participants"), f"{shown(name)} must be one of {listed(known)}"
            )
    return frozenset(names)


def check_thresholds(
    file: TomlFile, settings: StudySettings, people: Sequence[Participant]
) -> None:
    """Fail if somebody's threshold grows beyond what the driver model takes."""
    signal = DRIVER_SIGNALS["driver_threshold_mps"]
    patient = max(people, key=lambda one: one.value(signal.field))
    before = len(settings.phases) - 1
    grown_mps = patient.value(signal.field) * settings.threshold_factor(before)
    if settings.threshold_growth_per_drive and grown_mps > signal.range[1]:
        file.fail(
            ("drives", "threshold_growth_per_drive"),
            f"{patient.id} would drive the last drive with {signal.name} = {grown_mps:.4g}, more "
            f"than {signal.range[1]:g}; choose less growth or fewer drives",
        )


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
