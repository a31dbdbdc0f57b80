"""Simulated participants through the three FMUs: slow, and the same to the bit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from ..cosim.fmu import Fmu, Value
from ..cosim.master import Drive, drive
from ..instance import ModelError
from ..kernel.state import PldfState
from ..profiles.store import ProfileStore
from .participants import (
    DRIVER_SIGNALS,
    DriveResult,
    Participant,
    StudySettings,
    order_of,
    seed_of,
)
from .phases import Phase, Setting, values_of
from .simulation import Outcome, Person, Simulation, prepared, row_of


def drive_participant(
    fmus: Mapping[str, Fmu], settings: StudySettings, participant: Participant
) -> tuple[DriveResult, ...]:
    """Drive all phases with ``participant``; see ``simulation.simulate_participant``."""
    simulation = prepared(settings)
    person = simulation.person(participant)
    # Where the FMUs were unpacked: it goes with them, even if this process is killed.
    place = fmus["pldf"].folder.parent
    with TemporaryDirectory(dir=place, ignore_cleanup_errors=True) as folder:
        return tuple(
            _drive(fmus, simulation, person, (number, phase, Path(folder)))
            for number, phase in enumerate(order_of(settings, participant))
        )


def _drive(
    fmus: Mapping[str, Fmu],
    simulation: Simulation,
    person: Person,
    task: tuple[int, Phase, Path],
) -> DriveResult:
    number, phase, folder = task
    settings, participant = simulation.settings, person.participant
    values: dict[str, Value] = {
        DRIVER_SIGNALS[name].name: participant.value(name) for name in participant.values
    }
    setting = Setting(
        route=settings.route,
        road=dict(settings.road),
        driver_id=participant.number,
        store=folder,
        step_s=settings.step_s,
        more={
            "pldf": settings.function,
            "vehicle": settings.vehicle,
            "driver": {**values, "seed": seed_of(participant, number)},
        },
    )
    store = ProfileStore(folder)
    blank = simulation.stored_for(participant)
    key = (blank.driver_id, blank.route, blank.nodes)
    before = store.load(*key) or blank
    profile = simulation.followed(before, phase)
    driven = drive(fmus, values_of(phase, setting, number), setting.course(lambda _: None))
    _require_good(f"participant {participant.id}, drive {phase.name}", driven)
    after = store.load(*key) or blank
    duration_s = float(driven.recording["time_s"][-1])
    return DriveResult(
        row=row_of(person, phase, number + 1, Outcome(duration_s, _outputs(driven), profile)),
        recording=driven.recording if participant.id in settings.recorded else None,
        iteration=after.iterations[-1] if phase.learn else None,
    )


def _outputs(driven: Drive) -> PldfState:
    return PldfState(
        rate_pedal=driven.outputs["rate.pedal"],
        rate_set_speed=driven.outputs["rate.set_speed"],
        rate_combined=driven.outputs["rate.combined"],
        drive_interventions=int(driven.outputs["drive.interventions"]),
    )


def _require_good(where: str, driven: Drive) -> None:
    for said in driven.said:
        if said.level == "error":
            raise ModelError(f"{where}: {said.fmu}: {said.text}")
    if not driven.arrived:
        raise ModelError(f"{where} was given up: the vehicle {driven.ending}")
