"""What a simulated study is made of, as values: participants, settings, results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import prod
from typing import Final

from vehicle_models.driver_state import DriverState

from ..cosim.drive_limits import STEP_S
from ..cosim.values import FmuMessage, Value
from ..kernel.codes import LEARN_FAITHFUL
from ..kernel.signals import Signal, signals_of
from ..profiles.store import Iteration
from ..recordings.recording import Recording
from ..roads import Road, Route
from .drive_row import DriveRow
from .phases import Phase

_OF_THE_DRIVE: Final = ("kind", "script_id", "route_id", "seed", "person_seed")
# The parameters of the driver model that make one driver differ from another, by field.
DRIVER_SIGNALS: Final[dict[str, Signal]] = {
    signal.field: signal
    for signal in signals_of(DriverState)
    if signal.causality == "parameter" and signal.name not in _OF_THE_DRIVE
}


@dataclass(frozen=True)
class Participant:
    """One simulated driver.

    Attributes:
        id: P and the number in the study: P001.
        seed: of what lasts in the driver's wish (``person_seed``), and of the first drive; see
            ``seed_of_drive``.
        values: parameters by field of ``DriverState``; those absent keep their defaults.
    """

    id: str
    seed: int
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def number(self) -> int:
        """Number in the study, from 1; also the driver whose profile is learned."""
        return int(self.id[1:])

    def value(self, name: str) -> float | int:
        """Return the parameter of this field, given or default, as whole number where it is one."""
        signal = DRIVER_SIGNALS[name]
        value = self.values.get(name, float(signal.start))
        return value if signal.kind == "Real" else int(value)


@dataclass(frozen=True, eq=False)
class StudySettings:
    """What is the same for all participants.

    Attributes:
        road: where everybody drives.
        phases: in the order of driving; one name may occur more than once.
        counterbalanced: every second participant drives B before A.
        function: parameters of the driving function that differ from their defaults, by FMI name.
        vehicle: the same of the vehicle.
        step_s: communication step.
        recorded: ids of the participants whose recordings and profiles are kept.
        threshold_growth_per_drive: share by which a driver's threshold grows with each drive: of
            people who get used to the function.
    """

    road: Road
    phases: tuple[Phase, ...]
    counterbalanced: bool = False
    function: Mapping[str, Value] = field(default_factory=dict)
    vehicle: Mapping[str, Value] = field(default_factory=dict)
    step_s: float = STEP_S
    recorded: frozenset[str] = frozenset()
    threshold_growth_per_drive: float = 0.0

    @property
    def route(self) -> Route:
        """The route of every drive."""
        return self.road.route

    @property
    def learn(self) -> int:
        """How the drives learn that do (LEARN in ``kernel.codes``)."""
        return int(self.function.get("learn", LEARN_FAITHFUL))

    def threshold_factor(self, drives: int) -> float:
        """Return by what the threshold of who has driven so many ``drives`` is multiplied."""
        # Products, not a power: a C library's may differ in the last bit.
        return prod([1.0 + self.threshold_growth_per_drive] * drives, start=1.0)


@dataclass(frozen=True, eq=False)
class DriveResult:
    """One drive of one participant.

    Attributes:
        row: the numbers of the drive.
        recording: one row per step, if it is kept.
        iteration: what the drive taught; None if the phase does not learn.
        warnings: of the FMUs, if they drove.
    """

    row: DriveRow
    recording: Recording | None = None
    iteration: Iteration | None = None
    warnings: tuple[FmuMessage, ...] = ()


def order_of(settings: StudySettings, participant: Participant) -> tuple[Phase, ...]:
    """Return the phases in the order in which ``participant`` drives them.

    Counterbalanced, participants with even numbers drive B first. The drives with A that B learns
    from come before it all the same: without them there would be nothing to drive B with.
    """
    if not settings.counterbalanced or participant.number % 2 == 1:
        return settings.phases
    learned = [p for p in settings.phases if not p.apply_learned and p.learn]
    adaptive = [p for p in settings.phases if p.apply_learned]
    rest = [p for p in settings.phases if not p.apply_learned and not p.learn]
    return (*learned, *adaptive, *rest)
