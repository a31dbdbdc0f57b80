"""Simulated participants through the three FMUs: slow, and the same to the bit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from ..cosim.fmu import Fmu
from ..cosim.master import Drive, drive
from ..cosim.road_values import road_values
from ..cosim.values import Value
from ..errors import ModelError
from ..kernel.state import PldfState
from ..profiles.store import ProfileStore
from ..profiles.stored_profile import StoredProfile
from .participants import DRIVER_SIGNALS, DriveResult, Participant, StudySettings, order_of
from .person import row_of_drive, wish_errors
from .phases import DriveSetting, Phase, values_of
from .simulation import prepared

# Called now and then with the number of this participant's drives that are done, 2.5 for example.
Watch = Callable[[float], None]


def drive_participant(
    fmus: Mapping[str, Fmu], settings: StudySettings, participant: Participant, watch: Watch
) -> tuple[DriveResult, ...]:
    """Drive all phases with ``participant``; see ``simulation.simulate_participant``."""
    # Where the FMUs were unpacked: it goes with them, even if this process is killed.
    place = fmus["pldf"].folder.parent
    with TemporaryDirectory(dir=place, ignore_cleanup_errors=True) as folder:
        driver = _Driver(fmus, settings, participant, Path(folder))
        return tuple(
            driver.drive(number, phase, watch)
            for number, phase in enumerate(order_of(settings, participant))
        )


class _Driver:
    """One participant with the FMUs and a profile store of their own in ``folder``."""

    def __init__(
        self,
        fmus: Mapping[str, Fmu],
        settings: StudySettings,
        participant: Participant,
        folder: Path,
    ) -> None:
        self._fmus = fmus
        self._settings = settings
        self._simulation = prepared(settings)
        self._person = self._simulation.person(participant)
        self._setting = DriveSetting(
            route=settings.route,
            road=road_values(settings.road, folder),
            driver_id=participant.number,
            person_seed=participant.seed,
            store=folder,
            learn=settings.learn,
            more={
                # Whether a drive learns at all is a matter of its phase.
                "pldf": {k: v for k, v in settings.function.items() if k != "learn"},
                "vehicle": settings.vehicle,
            },
        )

    def drive(self, number: int, phase: Phase, watch: Watch) -> DriveResult:
        """Drive ``phase`` as the drive with this number, from 0."""
        participant = self._person.participant
        setting = replace(
            self._setting,
            seed=self._person.seed_of(number),
            more={**self._setting.more, "driver": self._described(number)},
        )
        followed = self._simulation.followed(self._stored(), phase)
        wish = self._simulation.wish_of_drive(self._person, number)
        done = drive(
            self._fmus,
            values_of(phase, setting),
            setting.length_m,
            self._settings.step_s,
            lambda s_m: watch(number + s_m / setting.length_m),
        )
        _require_good(f"participant {participant.id}, drive {phase.name}", done)
        duration_s = float(done.recording["time_s"][-1])
        return DriveResult(
            row=row_of_drive(
                self._person,
                phase,
                number,
                duration_s,
                _outputs(done),
                wish_errors(followed, self._person.wish, wish),
            ),
            recording=done.recording if participant.id in self._settings.recorded else None,
            iteration=self._stored().iterations[-1] if phase.learn else None,
            warnings=tuple(m for m in done.messages if m.level == "warning"),
        )

    def _described(self, number: int) -> dict[str, Value]:
        """Return the parameters of the driver before the drive with this number, from 0."""
        one = self._person.participant
        described: dict[str, Value] = {
            DRIVER_SIGNALS[name].name: one.value(name) for name in one.values
        }
        threshold = DRIVER_SIGNALS["driver_threshold_mps"]
        grown_mps = one.value(threshold.field) * self._settings.threshold_factor(number)
        return {**described, threshold.name: grown_mps}

    def _stored(self) -> StoredProfile:
        blank = self._simulation.stored_for(self._person.participant)
        store = ProfileStore(self._setting.store or "")
        return store.load(blank.driver_id, blank.route, blank.nodes) or blank


def _outputs(done: Drive) -> PldfState:
    return PldfState(
        rate_pedal=done.outputs["rate.pedal"],
        rate_set_speed=done.outputs["rate.set_speed"],
        rate_combined=done.outputs["rate.combined"],
        drive_interventions=int(done.outputs["drive.interventions"]),
    )


def _require_good(where: str, done: Drive) -> None:
    for message in done.messages:
        if message.level == "error":
            raise ModelError(f"{where}: {message.fmu}: {message.text}")
    if not done.arrived:
        raise ModelError(f"{where} was given up: the vehicle {done.ending}")
