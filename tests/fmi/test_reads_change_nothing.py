"""Reading outputs, and setting inputs to what they are, changes neither outputs nor the drive."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from math import nan
from pathlib import Path
from typing import Any, Final

import pytest
from hypothesis import Phase, given, seed, settings
from hypothesis import strategies as hs
from pldf.fmi.access import Access
from pldf.fmi.session import Session
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.codes import INPUT_OK, OFF_ROUTE, XY
from pldf.kernel.signals import by_reference, signals_of

from vehicle_models.driver import ScriptedDriver
from vehicle_models.lead import LeadVehicle
from vehicle_models.vehicle import LongitudinalVehicle

Values = dict[str, Any]
NUMBERS: Final = frozenset({"Real", "Integer", "Boolean", "Enumeration"})


class Run:
    """One session, by names of fields."""

    def __init__(
        self, create: Callable[[], Instance[Any]], parameters: Values, route: Path
    ) -> None:
        self.session = Session(create)
        self.session.model.texts.route_file = str(route)
        self.access = Access(self.session.signals, NUMBERS)
        self.references = {s.field: i for i, s in by_reference(self.session.signals).items()}
        outputs = [s for s in self.session.signals if s.causality == "output"]
        self.outputs = [s.field for s in outputs if s.kind != "String"]
        self.texts = [self.references[s.field] for s in outputs if s.kind == "String"]
        self.spoken = Access(self.session.signals, frozenset({"String"}))
        self.set(parameters)

    def set(self, values: Values) -> None:
        """Set inputs or parameters."""
        group = self.access.writable([self.references[name] for name in values])
        self.session.write(group, list(values.values()))

    def read(self) -> list[Any]:
        """Return all outputs, numbers first."""
        numbers = self.access.group([self.references[n] for n in self.outputs])
        texts = self.session.read_texts(self.spoken.group(self.texts))
        return [*self.session.read(numbers), *texts]

    def memory(self) -> list[str]:
        """Return all that the model remembers."""
        model = self.session.model
        numbers = asdict(model.record).items()
        return [f"{name} {float(value).hex()}" for name, value in numbers] + [
            array.tobytes().hex() for array in model.arrays
        ]


@dataclass(frozen=True)
class Model:
    """A model with inputs worth trying; every other input keeps its start value."""

    create: Callable[[], Instance[Any]]
    parameters: Values
    inputs: dict[str, hs.SearchStrategy[Any]]

    def rows(self) -> hs.SearchStrategy[Values]:
        """Return values of all its inputs."""
        record = self.create().record
        starts = {s.field: hs.just(s.start) for s in signals_of(record) if s.causality == "input"}
        return hs.fixed_dictionaries({**starts, **self.inputs})


@pytest.fixture(scope="module")
def route(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a short road along x with a sign; it does not begin at x = 0."""
    path = tmp_path_factory.mktemp("route") / "short.csv"
    path.write_text(
        "s_m,curvature_per_m,speed_limit_mps,x_m,y_m\n"
        "0,0,25,-50,0\n300,0,25,250,0\n300,0,15,250,0\n600,0,15,550,0\n",
        encoding="utf-8",
    )
    return path


flag = hs.integers(0, 1)
pedal = hs.sampled_from([0.0, 0.0, 0.3, 1.0, nan])
place = hs.sampled_from([0.0, 100.0, 102.0, 104.0, 290.0, 400.0, 550.0, 1e6, -50.0, nan])
speed = hs.sampled_from([0.0, 20.0, 30.0, nan])
acceleration = hs.sampled_from([0.0, 1.5, -2.0, nan])
FUNCTION_INPUTS: Final = {
    "vehicle_s_m": place,
    "vehicle_x_m": place,
    "vehicle_y_m": hs.sampled_from([0.0, 2.0, 500.0]),
    "vehicle_speed_mps": speed,
    "vehicle_acceleration_mps2": acceleration,
    "driver_gas_pedal": pedal,
    "driver_brake_pedal": pedal,
    "lever_resume": flag,
    "lever_up_long": flag,
    "eligible": flag,
}
MODELS: Final = {
    "function by arc length": Model(DrivingFunction, {"learn": 1}, FUNCTION_INPUTS),
    "function by line": Model(DrivingFunction, {"localization": XY}, FUNCTION_INPUTS),
    "car ahead": Model(
        LeadVehicle,
        {"traffic_free_s": 0.1},
        {"vehicle_s_m": place, "vehicle_speed_mps": speed},
    ),
    "vehicle": Model(
        LongitudinalVehicle,
        {},
        {
            "acceleration_request_mps2": acceleration,
            "driver_gas_pedal": pedal,
            "driver_brake_pedal": pedal,
            "function_active": flag,
        },
    ),
    "driver": Model(
        ScriptedDriver,
        {},
        {
            "vehicle_s_m": place,
            "vehicle_speed_mps": speed,
            "vehicle_acceleration_mps2": acceleration,
            "mode": hs.integers(0, 4),
            "target_speed_mps": speed,
            "set_speed_mps": speed,
            "limit_mps": speed,
        },
    ),
}


def exactly(values: list[Any]) -> list[str]:
    """Return what tells values apart, numbers to the bit; NaN equals itself."""
    return [v if isinstance(v, str) else float(v).hex() for v in values]


def idle(run: Run, present: Values, data: hs.DataObject, model: Model) -> Iterator[None]:
    """Do something that must not matter, several times."""
    for _ in range(data.draw(hs.integers(0, 3))):
        chosen = data.draw(hs.lists(hs.sampled_from(sorted(present)), max_size=3, unique=True))
        run.set({name: present[name] for name in chosen})
        if data.draw(hs.booleans()):  # somewhere else for a moment
            run.set(data.draw(model.rows()))
            run.read()
            run.set(present)
        yield


@pytest.mark.parametrize("name", MODELS)
@settings(max_examples=60, deadline=None, phases=[Phase.generate])
@seed(20260213)
@given(data=hs.data())
def test_what_lies_between_two_steps_leaves_no_trace(
    name: str, route: Path, data: hs.DataObject
) -> None:
    model = MODELS[name]
    quiet, busy = (Run(model.create, model.parameters, route) for _ in range(2))
    present = data.draw(model.rows())
    for run in (quiet, busy):
        run.session.enter()
    busy.read()
    for run in (quiet, busy):
        run.set(present)
        run.session.exit()
    for k in range(data.draw(hs.integers(1, 6))):
        expected = exactly(quiet.read())
        for _ in idle(busy, present, data, model):
            assert exactly(busy.read()) == expected
        present = data.draw(model.rows())
        for run in (quiet, busy):
            run.set(present)
        if data.draw(hs.booleans()):
            busy.read()
        for run in (quiet, busy):
            run.session.step(0.1 * k, 0.1)
    assert quiet.memory() == busy.memory()
    assert exactly(quiet.read()) == exactly(busy.read())


@pytest.mark.parametrize("asked", [False, True])
def test_a_car_set_down_on_the_route_has_not_jumped(asked: bool, route: Path) -> None:
    run = Run(DrivingFunction, {}, route)
    run.set({"vehicle_s_m": -500.0})
    run.session.enter()
    run.session.exit()
    run.session.step(0.0, 0.1)
    assert run.session.model.record.input_state == OFF_ROUTE
    run.set({"vehicle_s_m": 400.0})
    if asked:
        run.read()
    run.session.step(0.1, 0.1)
    assert run.session.model.record.input_state == INPUT_OK


def test_a_new_position_counts_at_once_and_a_new_pedal_moves_no_car(route: Path) -> None:
    run = Run(DrivingFunction, {}, route)
    run.set({"vehicle_s_m": 100.0, "vehicle_speed_mps": 20.0})
    run.session.enter()
    run.session.exit()
    run.session.step(0.0, 0.1)
    distance = run.outputs.index("hmi_next_distance_m")
    sign_m = 100.0 + 0.1 * 20.0 + run.read()[distance]  # outputs belong to the end of the step
    run.set({"driver_gas_pedal": 0.2})
    assert run.read()[distance] == sign_m - 102.0
    run.set({"vehicle_s_m": 110.0})
    assert run.read()[distance] == sign_m - 110.0
