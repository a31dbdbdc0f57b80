"""``LeadVehicle``: the car ahead with its road or script and its messages."""

from __future__ import annotations

from pathlib import Path
from typing import Final, cast

from pldf.instance import Arrays, Instance, Level, views, zeros
from pldf.kernel.arrays import Work
from pldf.roads import chosen_route, route_arrays

from .lead_kernel import lead_start, lead_step
from .lead_script import packed_traffic, read_traffic, traffic_arrays
from .lead_script_kernel import LeadScriptArrays
from .lead_state import (
    BY_SCRIPT,
    CONTACT,
    INVALID_INPUT,
    NO_TROUBLE,
    TRAFFIC,
    LeadState,
    LeadTexts,
)
from .traffic_kernel import RoadArrays, prepare_road

TROUBLE_TEXT: Final = {
    NO_TROUBLE: "our car's position and speed are known, and it touches no car ahead",
    INVALID_INPUT: "position or speed is not a finite, plausible number: our car counts as driving "
    "on as it did",
    CONTACT: "our car has run into the car ahead",
}


class LeadVehicle(Instance[LeadState]):
    """A car ahead of ours: one by parameters, one by a script, or traffic from a seed."""

    texts: LeadTexts
    groups = (RoadArrays, LeadScriptArrays)

    def __init__(self) -> None:
        super().__init__(LeadState(), LeadTexts())
        self._reported = NO_TROUBLE

    def initialize(self) -> None:
        """Plan the road's speed or read the script; ModelError for an unusable route or script."""
        self.check_parameters()
        self.clear_memory()
        road, script = zeros(RoadArrays, 2), zeros(LeadScriptArrays, 0)
        if self.record.kind == TRAFFIC:
            road = self._planned_road()
        if self.record.kind == BY_SCRIPT:
            name = self.texts.script_file
            events = read_traffic(Path(name) if name else packed_traffic(self.record.script_id))
            self.tell(events.notes)
            script = traffic_arrays(events)
        self.attach(cast(Arrays, (*road, *script)))
        self._reported = NO_TROUBLE
        lead_start(self.record)

    def refresh(self) -> None:
        """Do nothing: the outputs change with time only."""

    def step(self, step_s: float) -> None:
        """Advance by ``step_s`` > 0 seconds."""
        lead_step(self.record, self._road, self._script, step_s)
        if self.record.trouble != self._reported:
            self._reported = self.record.trouble
            level: Level = "info" if self._reported == NO_TROUBLE else "warning"
            text = TROUBLE_TEXT[self._reported]
            self.report(level, f"t = {1e-9 * self.record.time_ns:.3f} s: {text}")

    def attach(self, arrays: Arrays) -> None:
        """Take over road and script."""
        super().attach(arrays)
        if arrays:
            count = len(RoadArrays._fields)
            self._road = views(RoadArrays(*arrays[:count]))
            self._script = views(LeadScriptArrays(*arrays[count:]))

    def _planned_road(self) -> RoadArrays:
        chosen = chosen_route(self.record.route_id, self.texts.route_file)
        self.tell(chosen.notes)
        route = route_arrays(chosen)
        road = zeros(RoadArrays, len(route.limit_mps))
        work = zeros(Work, len(route.limit_mps))
        prepare_road(self.record, views(route), views(road), views(work))
        return road
