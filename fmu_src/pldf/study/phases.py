"""The drives of the paper's study, and what each of them sets in the three FMUs (section 5)."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

from ..cosim.fmu import Value
from ..cosim.master import STEP_S, Course, Progress, Values
from ..kernel.codes import LEARN_FAITHFUL, LEARN_OFF
from ..roads import Route, open_route, packed_route
from ..route_facts import route_facts

# Kinds of ``ScriptedDriver``.
HANDS_OFF: Final = 0
SCRIPT: Final = 1
PREFERENCE: Final = 2


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


@dataclass(frozen=True)
class Setting:
    """What stays the same from drive to drive.

    Attributes:
        route: the route, for all three FMUs.
        road: the parameters that make the FMUs use this route.
        driver_id: whose profile.
        seed: of the driver's small irregularities in the first drive; each drive takes the next.
        store: folder of profiles; None: the environment decides.
        step_s: communication step.
        more: further values by part; they win.
    """

    route: Route
    road: dict[str, Value]
    driver_id: int = 1
    seed: int = 1
    store: Path | None = None
    step_s: float = STEP_S
    more: Values = field(default_factory=dict)

    def course(self, progress: Progress) -> Course:
        """Return the whole route; the function knows it to the last whole metre."""
        return Course(self.route.nodes - 1.0, self.step_s, progress)


def choose_route(name: str) -> tuple[Route, dict[str, Value]]:
    """Return the route that a person named, and the parameters that tell the FMUs.

    Args:
        name: a route file, ``study``, or the number of a packed route.

    Raises:
        ModelError: there is no such route or it cannot be used.
    """
    if name.isdigit() and not Path(name).exists():
        return packed_route(int(name)), {"route_id": int(name)}
    if name == "study" and not Path(name).exists():
        return packed_route(0), {"route_id": 0}
    return open_route(name), {"route_file": str(Path(name).resolve())}


def values_of(phase: Phase, setting: Setting, drive: int = 0) -> Values:
    """Return what to set in the FMUs for ``phase``, the drive with this number, from 0.

    The car starts at the speed that the base profile has at its start.
    """
    pldf: dict[str, Value] = {
        **setting.road,
        "driver_id": setting.driver_id,
        "apply_learned": int(phase.apply_learned),
        "learn": LEARN_FAITHFUL if phase.learn else LEARN_OFF,
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
            "seed": setting.seed + drive,
        },
    }
    return {part: {**chosen[part], **setting.more.get(part, {})} for part in chosen}
