"""The drives of the paper's study, and what each of them sets in the FMUs (section 5)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

from ..cosim.values import Value, Values
from ..kernel.codes import LEARN_FAITHFUL, LEARN_OFF
from ..roads import Route
from ..route_facts import route_facts

# Seeds of the driver model end here.
SEED_MAX: Final = 999_999_999
# Kinds of ``ScriptedDriver``.
HANDS_OFF: Final = 0
SCRIPT: Final = 1
PREFERENCE: Final = 2
# Kinds of ``LeadVehicle``.
TRAFFIC_SCRIPT: Final = 1
TRAFFIC: Final = 2


class Phase(NamedTuple):
    """One drive of the study.

    B is pre-trained on A2 alone: that is the only drive with the base function that is learned.
    """

    name: str
    apply_learned: bool
    learn: bool
    intervenes: bool

    @property
    def about(self) -> str:
        """What the drive is, for titles."""
        function = "learned profile" if self.apply_learned else "base function"
        driver = "driver intervenes" if self.intervenes else "driver does not intervene"
        return f"{function}, {driver}{', learned afterwards' if self.learn else ''}"


PHASES: Final = {
    phase.name: phase
    for phase in (
        Phase("A1", apply_learned=False, learn=False, intervenes=True),
        Phase("A2", apply_learned=False, learn=True, intervenes=True),
        Phase("A3", apply_learned=False, learn=False, intervenes=False),
        Phase("B1", apply_learned=True, learn=True, intervenes=True),
        Phase("B2", apply_learned=True, learn=True, intervenes=True),
        Phase("B3", apply_learned=True, learn=False, intervenes=False),
    )
}


def repeated(names: Iterable[str], repeats: int) -> list[Phase]:
    """Return the phases of these names, each ``repeats`` times in a row.

    Driven more than once, they are numbered on per system: A1, A2, ..., B1, B2, ...
    """
    phases = [PHASES[name] for name in names for _ in range(repeats)]
    if repeats == 1:
        return phases
    counts = {"A": 0, "B": 0}
    for at, phase in enumerate(phases):
        system = phase.name[0]
        counts[system] += 1
        phases[at] = phase._replace(name=f"{system}{counts[system]}")
    return phases


def seed_of_drive(first: int, drive: int) -> int:
    """Return the driver's seed for the drive with this number, from 0.

    Each drive takes the next seed after ``first``, the driver's own; behind the last comes 0.
    """
    return (first + drive) % (SEED_MAX + 1)


@dataclass(frozen=True)
class DriveSetting:
    """What one drive of the FMUs needs beside its phase.

    Attributes:
        route: the route, for all FMUs.
        road: the parameters that make the FMUs use this route.
        driver_id: whose profile.
        seed: of the drive: the driver's small irregularities and occasion's wish, and traffic.
        store: folder of profiles; None: the environment decides.
        more: further values by part; they win.
        traffic: values of the car ahead; None: there is none.
        learn: how the drives learn that do (LEARN in ``kernel.codes``).
        person_seed: of what lasts in the driver's wish.
    """

    route: Route
    road: Mapping[str, Value]
    driver_id: int = 1
    seed: int = 1
    store: Path | None = None
    more: Values = field(default_factory=dict)
    traffic: Mapping[str, Value] | None = None
    learn: int = LEARN_FAITHFUL
    person_seed: int = 1

    @property
    def length_m(self) -> float:
        """How far is driven; the function knows the route to the last whole metre."""
        return self.route.nodes - 1.0


def values_of(phase: Phase, setting: DriveSetting) -> dict[str, dict[str, Value]]:
    """Return what to set in the FMUs for ``phase``, by part and name.

    The car starts at the speed that the base profile has at its start.
    """
    pldf: dict[str, Value] = {
        **setting.road,
        "driver_id": setting.driver_id,
        "apply_learned": int(phase.apply_learned),
        "learn": setting.learn if phase.learn else LEARN_OFF,
    }
    if setting.store is not None:
        pldf["profile_store"] = str(setting.store.resolve())
    start_m = float(setting.more.get("vehicle", {}).get("start_s_m", 0.0))
    base_mps = route_facts(setting.route).base_mps
    start_mps = float(base_mps[max(0, min(int(start_m), len(base_mps) - 1))])
    chosen: dict[str, dict[str, Value]] = {
        "pldf": pldf,
        "vehicle": {**setting.road, "start_speed_mps": start_mps},
        "driver": {
            **setting.road,
            "kind": PREFERENCE if phase.intervenes else HANDS_OFF,
            "seed": setting.seed,
            "person_seed": setting.person_seed,
        },
    }
    if setting.traffic is not None:
        chosen["lead"] = {**setting.road, "seed": setting.seed, **setting.traffic}
    return {part: {**chosen[part], **setting.more.get(part, {})} for part in chosen}
