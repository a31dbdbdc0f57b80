"""A state that somebody changed is refused, and changes nothing, or is driven like any other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from math import isfinite
from pathlib import Path
from typing import Any

import pytest
from forged import forgeries
from pldf.errors import ModelError
from pldf.fmi.phases import Phase
from pldf.fmi.session import Session
from pldf.function import DrivingFunction
from pldf.instance import Instance
from pldf.kernel.codes import XY
from pldf.kernel.ranges import Range, columns_of, holds, ranges_of, whole
from pldf.kernel.signals import count_output, since

from vehicle_models.driver import ScriptedDriver
from vehicle_models.driver_state import SCRIPT
from vehicle_models.lead import LeadVehicle
from vehicle_models.lead_state import BY_SCRIPT
from vehicle_models.vehicle import LongitudinalVehicle

MODELS: dict[str, tuple[Callable[[], Instance[Any]], dict[str, Any]]] = {
    "function": (DrivingFunction, {"learn": 1}),
    "function by coordinates": (DrivingFunction, {"localization": XY}),
    "car ahead": (LeadVehicle, {"traffic_free_s": 0.1}),
    "car ahead by a script": (LeadVehicle, {"kind": BY_SCRIPT}),
    "vehicle": (LongitudinalVehicle, {}),
    "driver": (ScriptedDriver, {}),
    "driver with a script": (ScriptedDriver, {"kind": SCRIPT}),
}


@pytest.fixture
def road(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)  # a forged state may name any store, seen from here
    path = tmp_path / "road.csv"
    path.write_text("s_m,curvature_per_m,speed_limit_mps,x_m,y_m\n0,0,20,0,0\n40,0,20,40,0\n")
    return str(path)


def driven(name: str, road: str) -> Session:
    """Return a session of a model with parameters, in the middle of a drive."""
    create, parameters = MODELS[name]
    session = Session(create)
    session.model.texts.route_file = road
    for field, value in parameters.items():
        setattr(session.model.record, field, value)
    session.enter()
    session.exit()
    step(session, 30)
    return session


def step(session: Session, count: int) -> None:
    """Drive on with inputs that open and close interventions; all outputs are numbers."""
    numbers = [s for s in session.signals if s.kind != "String"]
    outputs = [s.field for s in numbers if s.causality == "output"]
    inputs = {s.field for s in session.signals if s.causality == "input"}
    for k in range(count):
        values = {
            "vehicle_s_m": 0.3 * k,
            "vehicle_x_m": 0.3 * k,
            "vehicle_speed_mps": 15.0,
            "driver_gas_pedal": 0.5 * (k % 7 > 4),
            "lever_resume": int(k == 1),
            "lever_up_long": int(k % 10 == 9),
        }
        for field in values.keys() & inputs:
            setattr(session.model.record, field, values[field])
        session.model.step(0.02)
        session.model.refresh()
        assert all(isfinite(getattr(session.model.record, name)) for name in outputs)


@pytest.mark.parametrize("name", MODELS)
def test_every_field_of_a_state(name: str, road: str) -> None:
    session = driven(name, road)
    honest = session.state()
    tried = accepted = 0
    for what, state in forgeries(session):
        tried += 1
        try:
            session.restore(state)
        except ModelError:
            assert session.state() == honest, what
            continue
        accepted += 1
        if session.phase is Phase.STEPPING:
            step(session, 3)
            session.terminate()
        session.restore(honest)
    assert tried / 20 < accepted < tried / 2, (tried, accepted)


@pytest.mark.parametrize("name", MODELS)
def test_an_honest_state_is_restored_in_every_phase(name: str, road: str) -> None:
    """Before initialization, too, where arrays are missing; and behind the end."""
    driving = driven(name, road)
    create = MODELS[name][0]
    before = Session(create).state()
    state = driving.state()
    driving.terminate()
    for other in (before, state, driving.state()):
        session = Session(create)
        session.restore(other)
        assert session.state() == other


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"route_file": 1, "profile_store": ""}', '{"route_file": ""}', "[" * 99999]
)
def test_texts_that_are_no_texts(text: str, road: str) -> None:
    session = driven("function", road)
    honest = session.state()
    size = 51  # behind the head of the session and the digest
    old = int.from_bytes(honest[size : size + 8], "little")
    at = len(honest) - 8 * sum(map(len, session.model.arrays)) - old
    state = honest[:size] + len(text).to_bytes(8, "little") + honest[size + 8 : at]
    with pytest.raises(ModelError, match="texts"):
        session.restore(state + text.encode() + honest[at + old :])
    assert session.state() == honest


def test_a_state_of_a_road_that_has_changed_changes_nothing(road: str, tmp_path: Path) -> None:
    state = driven("function", road).state()
    other = tmp_path / "other.csv"
    other.write_text(Path(road).read_text())
    session = driven("function", str(other))
    honest = session.state()
    Path(road).write_text(Path(road).read_text().replace("40,", "30,"))
    with pytest.raises(ModelError, match="route of this state has changed"):
        session.restore(state)
    assert session.state() == honest
    step(session, 3)


def test_ranges_are_declared() -> None:
    for create, _ in MODELS.values():
        model = create()
        ranges = ranges_of(type(model.record))
        assert list(ranges) == [field.name for field in fields(model.record)]
        assert all(columns_of(group) for group in model.groups)
    function = ranges_of(type(DrivingFunction().record))
    assert function["mode"] == Range(0, 4)
    assert function["nodes"] == Range(0, 999_999_999, "NODES", "first_node")
    assert function["vehicle_s_m"] is None
    assert function["lever_up"] == Range(0, 1)
    assert function["acceleration_request_mps2"] == Range(-10.0, 5.0)


def test_an_integer_without_a_range_is_a_mistake() -> None:
    @dataclass
    class Record:
        """One output that says what it may hold, and a number of the memory that does not."""

        count: int = since("0.3", holds(whole(0, 7), count_output("Count")))
        lost: int = 0

    with pytest.raises(ValueError, match="lost: an integer of the memory has to declare"):
        ranges_of(Record)
