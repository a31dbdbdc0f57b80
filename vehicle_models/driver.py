"""``ScriptedDriver``: the driver kernel with its wish or script and its messages."""

from __future__ import annotations

from pathlib import Path
from typing import Final, cast

from pldf.instance import Arrays, Instance, views, zeros
from pldf.kernel.arrays import Work
from pldf.roads import chosen_route, route_arrays

from . import (
    ahead_kernel,
    chance,
    clock,
    driver_kernel,
    normal,
    pedal_kernel,
    script_kernel,
    variation_kernel,
    wish_kernel,
)
from .driver_kernel import driver_start, driver_step
from .driver_script import packed_script, read_script, script_arrays
from .driver_state import PREFERENCE, SCRIPT, DriverState, DriverTexts
from .script_kernel import ScriptArrays
from .wish_kernel import WishArrays, prepare_wish

# What is compiled of the driver, beside what it uses of the driving function's kernel.
KERNELS: Final = (
    ahead_kernel,
    chance,
    clock,
    driver_kernel,
    normal,
    pedal_kernel,
    script_kernel,
    variation_kernel,
    wish_kernel,
)

INVALID_INPUT = (
    "an input is not a finite number: pedals and lever are released until it is"
    " (said once per drive)"
)


class ScriptedDriver(Instance[DriverState]):
    """A driver who follows a script, or a hidden wish, or keeps hands and feet off."""

    texts: DriverTexts
    groups = (WishArrays, ScriptArrays)

    def __init__(self) -> None:
        super().__init__(DriverState(), DriverTexts())

    def initialize(self) -> None:
        """Plan the wish or read the script; ModelError for an unusable route or script."""
        self.check_parameters()
        self.clear_memory()
        wish, script = zeros(WishArrays, 2), zeros(ScriptArrays, 0)
        if self.record.kind == PREFERENCE:
            wish = self._planned_wish()
        if self.record.kind == SCRIPT:
            name = self.texts.script_file
            path = Path(name) if name else packed_script(self.record.script_id)
            events = read_script(path)
            self.tell(events.notes)
            script = script_arrays(events)
        self.attach(cast(Arrays, (*wish, *script)))
        driver_start(self.record)

    def refresh(self) -> None:
        """Do nothing: the outputs change with time only."""

    def step(self, step_s: float) -> None:
        """Advance by ``step_s`` > 0 seconds."""
        driver_step(self.record, self._wish, self._script, step_s)
        if self.record.invalid_input and not self.record.warned:
            self.record.warned = 1
            self.report("warning", INVALID_INPUT)

    def attach(self, arrays: Arrays) -> None:
        """Take over wish and script."""
        super().attach(arrays)
        if arrays:
            count = len(WishArrays._fields)
            self._wish = views(WishArrays(*arrays[:count]))
            self._script = views(ScriptArrays(*arrays[count:]))

    def _planned_wish(self) -> WishArrays:
        chosen = chosen_route(self.record.route_id, self.texts.route_file)
        self.tell(chosen.notes)
        route = route_arrays(chosen)
        wish = zeros(WishArrays, len(route.limit_mps))
        work = zeros(Work, len(route.limit_mps))
        prepare_wish(self.record, views(route), views(wish), views(work))
        return wish
