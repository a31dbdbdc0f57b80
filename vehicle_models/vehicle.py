"""``LongitudinalVehicle``: the vehicle kernel with its route's grade and its messages."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from pldf.instance import Arrays, Instance, view
from pldf.kernel.arrays import Floats
from pldf.roads import chosen_route, route_arrays

from .vehicle_kernel import vehicle_refresh, vehicle_start, vehicle_step
from .vehicle_state import VehicleState, VehicleTexts

INVALID_INPUT = (
    "an input is not a finite number: the request counts as 0, a pedal as released"
    " (said once per drive)"
)


class GradeArrays(NamedTuple):
    """What the vehicle knows of the route; one value without a route."""

    grade: Floats  # node: rise over run


class LongitudinalVehicle(Instance[VehicleState]):
    """A car on its route: follows an acceleration request, obeys the pedals.

    ``docs/vehicle.md`` describes pedals, standstill and limits.
    """

    texts: VehicleTexts
    groups = (GradeArrays,)

    def __init__(self) -> None:
        super().__init__(VehicleState(), VehicleTexts())

    def initialize(self) -> None:
        """Read the route's grade and put the car at its start; ModelError for a bad route."""
        self.check_parameters()
        self.clear_memory()
        grade = np.zeros(1)
        if self.record.grade_from_route:
            route = chosen_route(self.record.route_id, self.texts.route_file)
            self.tell(route.notes)
            grade = np.array(route_arrays(route).grade)
        self.attach((grade,))
        vehicle_start(self.record, self._grade)

    def refresh(self) -> None:
        """Recompute acceleration and jerk from the inputs."""
        vehicle_refresh(self.record, self._grade)

    def step(self, step_s: float) -> None:
        """Advance by ``step_s`` > 0 seconds."""
        vehicle_step(self.record, self._grade, step_s)
        if self.record.invalid_input and not self.record.warned:
            self.record.warned = 1
            self.report("warning", INVALID_INPUT)

    def attach(self, arrays: Arrays) -> None:
        """Take over the grade per metre (one array; none before the first initialization)."""
        super().attach(arrays)
        if arrays:
            self._grade = view(arrays[0])
