"""No kernel looks beside its arrays, whatever its inputs: machine code does not check that.

Here the kernels are compiled with checks, so that an index out of bounds is an IndexError.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
import pytest
from laboratory import road
from pldf import compiled
from pldf.compiled import Namespace, compile_modules, pack
from pldf.instance import zeros
from pldf.kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from pldf.kernel.signals import signals_of
from pldf.kernel.state import PldfState
from pldf.roads import Route, packed_route, route_arrays

from vehicle_models import vehicle_kernel
from vehicle_models.driver import KERNELS
from vehicle_models.driver_script import packed_script, read_script, script_arrays
from vehicle_models.driver_state import PREFERENCE, SCRIPT, DriverState
from vehicle_models.script_kernel import ScriptArrays
from vehicle_models.vehicle_state import VehicleState
from vehicle_models.wish_kernel import WishArrays

STEPS: Final = 5000
ODD: Final = (-0.0, -1.0, 1e300, -1e300, 1e9, -1e9, math.nan, math.inf, -math.inf, 4499.9, 4500.0)
ROUTES: Final = {"study": packed_route(0), "short": road(60.0), "shortest": road(2.0)}


@pytest.fixture(scope="module")
def checked() -> Iterator[Namespace]:
    """Return all kernels, compiled with checks of every index."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(compiled.OPTIONS, "boundscheck", True)
        function = compile_modules(compiled.KERNEL_MODULES)
        vehicle = compile_modules((vehicle_kernel,), function)
        yield {**function, **vehicle, **compile_modules(KERNELS, function)}


class Senseless:
    """Sets a record's inputs: for a while they make no sense, then they are those of a drive."""

    def __init__(self, record: Any, route: Route) -> None:
        self.st = pack(record)[0]
        self._rng = np.random.default_rng(3)
        self._route, self._length_m = route, float(route.s_m[-1])
        self._place_m = 0.0
        self._steps = 0
        inputs = [s for s in signals_of(record) if s.causality == "input"]
        self._inputs = [(s.field, s.kind) for s in inputs]

    def step_s(self) -> float:
        """Set all inputs; return the size of the next step in s; always the same ones."""
        self._steps += 1
        self._place_m = (self._place_m + 0.4) % (1.05 * self._length_m)
        choose = self._sensible if self._steps % 1000 < 700 else self._senseless
        for field, kind in self._inputs:
            self.st[field] = choose(field, kind)
        return float(self._rng.choice([0.01, 0.037, 0.1, 1.7e-13]))

    def _sensible(self, field: str, kind: str) -> float:
        if field.endswith("s_m"):
            return self._place_m
        if field in ("vehicle_x_m", "vehicle_y_m"):
            line = self._route.x_m if field == "vehicle_x_m" else self._route.y_m
            return float(np.interp(self._place_m, self._route.s_m, line))
        if kind == "Real" and not field.endswith("pedal"):
            return float(self._rng.uniform(15.0, 25.0))
        return float(field == "eligible" or self._rng.random() < 0.03)

    def _senseless(self, field: str, kind: str) -> float:
        if kind != "Real":
            return float(self._rng.integers(-1, 6))
        if self._rng.random() < 0.1:
            return float(self._rng.choice(ODD))
        return float(self._rng.uniform(-0.1, 1.1 * self._length_m if field.endswith("s_m") else 30))


def columns(route: Route) -> tuple[RouteArrays, int]:
    found = RouteArrays(*(np.array(column) for column in route_arrays(route)))
    return found, len(found.limit_mps)


def test_an_index_out_of_bounds_is_found(checked: Namespace) -> None:
    route, nodes = columns(ROUTES["short"])
    cut = RouteArrays(*(column[: nodes // 2] for column in route))
    with pytest.raises(IndexError):
        checked["plan_base"](
            pack(PldfState())[0], cut, zeros(ProfileArrays, nodes), zeros(Work, nodes)
        )


@pytest.mark.parametrize("name", ROUTES)
@pytest.mark.parametrize("localization", [0, 1])
def test_driving_function(name: str, localization: int, checked: Namespace) -> None:
    """Two drives: the second one follows what was learned in the first."""
    route, nodes = columns(ROUTES[name])
    profile, trace = zeros(ProfileArrays, nodes), zeros(TraceArrays, nodes)
    work, following = zeros(Work, nodes), zeros(NextArrays, nodes)
    inputs = Senseless(PldfState(learn=1, localization=localization), ROUTES[name])
    for _ in range(2):
        checked["start_drive"](inputs.st, route, profile, work)
        checked["refresh"](inputs.st, route, profile)
        for _ in range(STEPS):
            step_s = inputs.step_s()
            checked["drive_step"](inputs.st, route, profile, trace, step_s)
            checked["refresh"](inputs.st, route, profile)
        checked["learn_drive"](inputs.st, route, profile, trace, work, following)
        for field in set(NextArrays._fields) & set(ProfileArrays._fields):
            getattr(profile, field)[:] = getattr(following, field)
        checked["adopt_learned"](inputs.st, route, profile, work)
    assert inputs.st["samples"] > 0
    assert inputs.st["drive_interventions"] > 0 or name == "shortest"  # its end comes too soon


@pytest.mark.parametrize("name", ROUTES)
def test_vehicle(name: str, checked: Namespace) -> None:
    route, _ = columns(ROUTES[name])
    inputs = Senseless(VehicleState(grade_from_route=1, start_speed_mps=20.0), ROUTES[name])
    checked["vehicle_start"](inputs.st, route.grade)
    for _ in range(STEPS):
        step_s = inputs.step_s()
        checked["vehicle_step"](inputs.st, route.grade, step_s)
        checked["vehicle_refresh"](inputs.st, route.grade)


@pytest.mark.parametrize("name", ROUTES)
@pytest.mark.parametrize("kind", [SCRIPT, PREFERENCE])
def test_driver(name: str, kind: int, checked: Namespace) -> None:
    route, nodes = columns(ROUTES[name])
    wish = zeros(WishArrays, nodes)
    events = script_arrays(read_script(packed_script(0)))
    script = ScriptArrays(*(np.array(column) for column in events))
    inputs = Senseless(DriverState(kind=kind, driver_uses_lever=1), ROUTES[name])
    checked["prepare_wish"](inputs.st, route, wish, zeros(Work, nodes))
    checked["driver_start"](inputs.st)
    for _ in range(STEPS):
        step_s = inputs.step_s()
        checked["driver_step"](inputs.st, wish, script, step_s)
