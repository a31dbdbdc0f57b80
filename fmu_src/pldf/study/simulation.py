"""Simulated participants in one process, on compiled kernels: what the FMUs do, far faster.

A participant is the unit of work: its drives follow each other, since each learns from the last.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache, lru_cache
from math import ceil
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from vehicle_models import vehicle_kernel
from vehicle_models.driver import KERNELS as DRIVER_KERNELS
from vehicle_models.driver import ScriptedDriver
from vehicle_models.script_kernel import ScriptArrays
from vehicle_models.vehicle import LongitudinalVehicle
from vehicle_models.wish_kernel import WishArrays

from ..compiled import KERNEL_MODULES, Namespace, compile_modules, kernel, pack, unpack
from ..cosim.drive_limits import SLOWEST_MPS, STANDSTILL_MAX_S, STANDSTILL_MPS
from ..cosim.values import Value
from ..errors import ModelError
from ..function import DrivingFunction
from ..instance import Instance, zeros
from ..kernel.arrays import FloatArray, NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from ..kernel.codes import LEARN_OFF
from ..kernel.signals import signals_of
from ..kernel.state import PldfState
from ..profiles.learned_columns import fill, next_iteration
from ..profiles.store import Iteration, StoredProfile
from ..recordings.columns import COLUMNS
from ..recordings.recording import Recording
from ..roads import fingerprint, route_arrays
from ..route_facts import route_facts
from . import loop
from .loop import ARRIVED, STOOD_STILL, Ends, ModelArrays, Models, Rows
from .participants import DriveResult, Participant, StudySettings, order_of
from .person import Person, row_of_drive, wish_errors
from .phases import PHASES, Phase

Packed = NDArray[np.void]

COMPILED_MODULES: Final = (*KERNEL_MODULES, vehicle_kernel, *DRIVER_KERNELS, loop)


def simulate_participant(
    settings: StudySettings, participant: Participant
) -> tuple[DriveResult, ...]:
    """Drive all phases with ``participant``, in the participant's order.

    Raises:
        ModelError: a parameter is out of range or a drive did not reach the end of the route.
    """
    return prepared(settings).drive(participant)


def compile_all(settings: StudySettings) -> None:
    """Compile everything a study needs, for other processes to load from numba's cache."""
    phases = (PHASES["A2"], PHASES["B1"])
    with suppress(ModelError):  # it comes again where it belongs to a participant
        simulate_participant(replace(settings, phases=phases), Participant("P001", 1))


@lru_cache(maxsize=2)
def prepared(settings: StudySettings) -> Simulation:
    """Return what all participants share, made once per process."""
    return Simulation(settings)


@cache
def car_code() -> Namespace:
    """Return the compiled functions of the driving function's kernel and the vehicle's by name."""
    return {**kernel(), **compile_modules((vehicle_kernel,), kernel(), inline=True)}


@cache
def machine_code() -> Namespace:
    """Return the compiled functions of kernel, vehicle, driver and loop by name."""
    called = {**car_code(), **compile_modules(DRIVER_KERNELS, kernel(), inline=True)}
    return {**called, **compile_modules((loop,), called, inline=True)}


def function_and_vehicle(settings: StudySettings) -> tuple[DrivingFunction, LongitudinalVehicle]:
    """Return driving function and vehicle with the parameters of the study.

    The vehicle starts with the base profile's speed, unless the study says otherwise.
    """
    function, vehicle = DrivingFunction(), LongitudinalVehicle()
    set_parameters(function, settings.function)
    start = {"start_speed_mps": float(route_facts(settings.route).base_mps[0])}
    set_parameters(vehicle, {**start, **settings.vehicle})
    return function, vehicle


class Simulation:
    """A road and a driving function, planned once for any number of participants."""

    def __init__(self, settings: StudySettings) -> None:
        self.settings = settings
        self.code = machine_code()
        self.route = RouteArrays(*(np.array(column) for column in route_arrays(settings.route)))
        self.nodes = len(self.route.limit_mps)
        self.function, self.vehicle = function_and_vehicle(settings)
        self.base = zeros(ProfileArrays, self.nodes)
        st = pack(self.function.record)
        self.code["plan_base"](st[0], self.route, self.base, zeros(Work, self.nodes))
        self.fingerprint = fingerprint(settings.route)

    def drive(self, participant: Participant) -> tuple[DriveResult, ...]:
        """Drive all phases with ``participant``."""
        stored = self.stored_for(participant)
        person = self.person(participant)
        results = []
        for number, phase in enumerate(order_of(self.settings, participant)):
            result = self.drive_once(person, phase, number, stored)
            results.append(result)
            if result.iteration is not None:
                stored = stored.with_iteration(result.iteration)
        return tuple(results)

    def stored_for(self, participant: Participant) -> StoredProfile:
        """Return what is known about ``participant`` before the first drive."""
        return StoredProfile(participant.number, self.fingerprint, np.array(self.base.base_mps))

    def person(self, participant: Participant) -> Person:
        """Return the driver model of ``participant`` with the lasting wish planned."""
        model = ScriptedDriver()
        for name in participant.values:
            setattr(model.record, name, participant.value(name))
        model.record.person_seed = participant.seed
        _check_parameters_of(model, f"participant {participant.id}")
        st = pack(model.record)
        st["wish_offset_occasion_sd_mps"] = st["wish_lateral_occasion_sigma"] = 0.0
        return Person(participant, model, self._planned(st), zeros(ScriptArrays, 0))

    def wish_of_drive(self, person: Person, number: int) -> WishArrays:
        """Return what ``person`` wishes in the drive with this number, from 0."""
        if person.is_always_the_same:
            return person.wish
        st = pack(person.model.record)
        st["seed"] = person.seed_of(number)
        return self._planned(st)

    def _planned(self, driver: Packed) -> WishArrays:
        wish = zeros(WishArrays, self.nodes)
        self.code["prepare_wish"](driver[0], self.route, wish, zeros(Work, self.nodes))
        return wish

    def followed(self, stored: StoredProfile, phase: Phase) -> ProfileArrays:
        """Return new arrays with the profile that a drive of ``phase`` follows."""
        profile = ProfileArrays(*(np.array(column) for column in self.base))
        if phase.apply_learned and stored.iterations:
            fill(profile, stored.iteration())
            st = pack(self.function.record)
            self.code["adopt_learned"](st[0], self.route, profile, zeros(Work, self.nodes))
        return profile

    def drive_once(
        self, person: Person, phase: Phase, number: int, stored: StoredProfile
    ) -> DriveResult:
        """Drive ``phase`` as the drive with this number, from 0, following ``stored``."""
        arrays = ModelArrays(
            wish=self.wish_of_drive(person, number),
            script=person.script,
            route=self.route,
            profile=self.followed(stored, phase),
            trace=zeros(TraceArrays, self.nodes),
        )
        vehicle, driver = pack(self.vehicle.record), person.packed(phase, number)
        driver["driver_threshold_mps"] *= self.settings.threshold_factor(number)
        pldf = self._packed_function(phase, stored)
        ends = ends_of(self.settings)
        kept = person.participant.id in self.settings.recorded
        rows = zeros(Rows, ends.steps if kept else 0)
        models = Models(*cast(Any, (vehicle[0], driver[0], pldf[0])))
        ending, steps = self.code["run_drive"](models, arrays, ends, rows)
        if ending != ARRIVED:
            where = f"participant {person.participant.id}, drive {phase.name}"
            raise ModelError(f"{where} was given up: {_why(ending, float(vehicle['s_m'][0]))}")
        st = PldfState()
        unpack(pldf, st)
        return DriveResult(
            row=row_of_drive(
                person,
                phase,
                number,
                (steps - 1) * ends.step_s,
                st,
                wish_errors(arrays.profile, person.wish, arrays.wish),
            ),
            recording=_recording(rows, steps, ends.step_s) if kept else None,
            iteration=self._learn(pldf, arrays, stored) if phase.learn else None,
        )

    def _packed_function(self, phase: Phase, stored: StoredProfile) -> Packed:
        st = pack(self.function.record)
        st["driver_id"] = stored.driver_id
        st["apply_learned"] = phase.apply_learned
        st["learn"] = self.settings.learn if phase.learn else LEARN_OFF
        self.code["stand_by"](st[0])
        st["profile_iteration"] = len(stored.iterations)
        return st

    def _learn(self, st: Packed, arrays: ModelArrays, stored: StoredProfile) -> Iteration:
        following = zeros(NextArrays, self.nodes)
        work = zeros(Work, self.nodes)
        self.code["learn_drive"](st[0], self.route, arrays.profile, arrays.trace, work, following)
        record = PldfState()
        unpack(st, record)
        return next_iteration(record, arrays.profile, following, stored)


def set_parameters(model: Instance[Any], values: Mapping[str, Value]) -> None:
    """Set parameters by FMI name; ModelError if one is out of range."""
    fields = {signal.name: signal.field for signal in signals_of(model.record)}
    for name, value in values.items():
        setattr(model.record, fields[name], value)
    model.check_parameters()


def _check_parameters_of(model: Instance[Any], whose: str) -> None:
    """Raise ModelError that says whose parameter is out of range."""
    try:
        model.check_parameters()
    except ModelError as problem:
        raise ModelError(f"{whose}: {problem}") from None


def ends_of(settings: StudySettings) -> Ends:
    """Return when a drive is over, as in ``master``."""
    length_m = settings.route.nodes - 1.0
    time_max_s = STANDSTILL_MAX_S + length_m / SLOWEST_MPS
    steps = ceil(time_max_s / settings.step_s)
    return Ends(length_m, settings.step_s, steps, STANDSTILL_MPS, STANDSTILL_MAX_S)


def _why(ending: int, s_m: float) -> str:
    if ending == STOOD_STILL:
        return f"the vehicle stood still for {STANDSTILL_MAX_S:g} s at {s_m:.0f} m"
    return f"the vehicle was only at {s_m:.0f} m when the time was over"


def _recording(rows: Rows, steps: int, step_s: float) -> Recording:
    columns: dict[str, FloatArray] = {
        name: np.asarray(column)[:steps].copy() for name, column in rows._asdict().items()
    }
    columns["profile_mps"] = columns["base_mps"] + columns.pop("learned_delta_mps")
    columns["time_s"] = np.arange(float(steps)) * step_s
    return Recording({name: columns[name] for name in COLUMNS})
