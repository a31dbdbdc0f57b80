"""FMI 3.0 of the native FMUs: the same results as FMI 2.0, and the standard's rules of its own."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fmi3_host import Host3, Slave3
from fmi_host import Host
from fmpy import fmi3 as fmi
from fmpy import simulate_fmu

symbols = pytest.importorskip(
    "pldf.build.native.symbols", reason="needs the extra: pip install -e .[native]"
)
NAMES = ("AdaptivePLDF", "LeadVehicle", "LongitudinalVehicle", "ScriptedDriver")


@pytest.fixture(scope="module", params=NAMES)
def pair(request: pytest.FixtureRequest, native_folder: Path) -> tuple[Host, Host3]:
    """Return one model's FMU for FMI 2.0 and for FMI 3.0."""
    archive = f"{request.param}.fmu"
    return Host(native_folder / archive), Host3(native_folder / "fmi3" / archive)


@pytest.fixture(scope="module")
def host(native_folder: Path) -> Host3:
    return Host3(native_folder / "fmi3" / "AdaptivePLDF.fmu")


@pytest.fixture
def slave(host: Host3) -> Iterator[Slave3]:
    one = host.instantiate()
    yield one
    one.free()


# The same results


def inputs_at(host: Host, k: int) -> dict[str, Any]:
    """Return inputs that drive on, press every key and change every value."""
    values: dict[str, Any] = {}
    inputs = [v for v in host.description.modelVariables if v.causality == "input"]
    for i, variable in enumerate(inputs):
        if variable.type == "Real":
            far = variable.name.endswith("s_m")
            values[variable.name] = 0.22 * k if far else (7 * k + 13 * i) % 97 / 97.0
        else:
            values[variable.name] = (k + 37 * i) % 400 > 390
    return values


def bits(values: dict[str, Any]) -> dict[str, Any]:
    return {n: _bits(value) for n, value in values.items()}


def _bits(value: Any) -> Any:
    if isinstance(value, str):
        return value
    return value.hex() if isinstance(value, float) else int(value)


def test_every_output_of_every_step_equals_that_of_fmi2(pair: tuple[Host, Host3]) -> None:
    """Also right after initialization, after a set without a step, and in steps of other sizes."""
    slaves = [host.instantiate().start() for host in pair]
    time_s = 0.0
    for k in range(1500):
        found = []
        for slave in slaves:
            before = bits(slave.outputs())
            slave.set(**inputs_at(pair[0], k))
            after = bits(slave.outputs())
            slave.fmu.doStep(time_s, 0.01 if k % 7 else 0.037)
            found.append((before, after, bits(slave.outputs())))
        assert found[0] == found[1]
        time_s += 0.01 if k % 7 else 0.037
    for slave in slaves:
        slave.fmu.terminate()
        slave.free()


def test_a_state_of_fmi2_goes_on_in_fmi3(pair: tuple[Host, Host3]) -> None:
    old, new = (host.instantiate().start() for host in pair)
    old.run(0.0, 200, **inputs_at(pair[0], 3))
    new.run(0.0, 20, **inputs_at(pair[0], 5))
    assert new.restore(old.state()) == 0
    assert new.state() == old.state()
    more = inputs_at(pair[0], 391)
    assert new.run(2.0, 200, **more) == old.run(2.0, 200, **more)
    assert old.restore(new.state()) == 0
    for slave in (old, new):
        slave.free()


def test_fmpy_simulates_both_archives_alike(native_folder: Path) -> None:
    # Without a logger of its own: fmpy would leave the address of that one in its library, and the
    # next FMU of this process that has something to say would call it after it is gone.
    for name in NAMES:
        first, second = (
            simulate_fmu(str(folder / f"{name}.fmu"), stop_time=2.005)
            for folder in (native_folder, native_folder / "fmi3")
        )
        assert set(first.dtype.names) == set(second.dtype.names)  # fmpy orders them by type
        assert len(first) > 200
        for column in first.dtype.names:  # an enumeration's numbers have another size
            assert first[column].tolist() == second[column].tolist()


# Life cycle


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"token": "{0}"}, "token is that of another FMU"),
        ({"event_mode": True}, "no event mode"),
        ({"intermediate": [1]}, "no intermediate variables"),
    ],
)
def test_refuses_to_be_instantiated(host: Host3, changes: dict[str, Any], text: str) -> None:
    slave = Slave3(host, "one", None, **changes)
    assert not slave.fmu.component
    assert text in slave.texts()[0]


def test_an_instance_needs_a_name_and_no_address_of_resources(host: Host3) -> None:
    slave = Slave3(host, "", None)
    assert not slave.fmu.component
    assert slave.texts() == ["the instance needs a name"]
    slave = Slave3(host, "C:\\a name", None)
    slave.start()
    assert slave.texts("logEvents") == [
        "route/0.prepared: not in the folder of resources that the importer named (none), so it is "
        f"read from {host.folder}/resources"
    ]
    slave.free()


def test_model_exchange_and_scheduled_execution_are_refused(host: Host3) -> None:
    slave = host.instantiate()
    told: list[str] = []
    tell = fmi.fmi3LogMessageCallback(lambda _, __, ___, text: told.append(text.decode()))
    library = slave.fmu.dll
    common = [b"one", host.description.guid.encode(), None, False, True, None, tell]
    callbacks = [fmi.fmi3ClockUpdateCallback(), fmi.fmi3LockPreemptionCallback()]
    callbacks += [fmi.fmi3UnlockPreemptionCallback()]
    for name, more in (("ModelExchange", []), ("ScheduledExecution", callbacks)):
        instantiate = getattr(library, f"fmi3Instantiate{name}")
        instantiate.restype = ctypes.c_void_p
        assert instantiate(*common, *more) is None
    assert told == 2 * ["only co-simulation is possible"]
    slave.free()


def test_the_order_of_calls_is_checked(slave: Slave3) -> None:
    def refused(*calls: tuple[Any, ...]) -> bool:
        before = len(slave.texts())
        statuses = [slave.status(*call) for call in calls]
        return statuses == [3] * len(calls) and len(slave.texts()) == before + len(calls)

    assert refused(("doStep", 0.0, 0.01), ("terminate",), ("exitInitializationMode",))
    slave.set(route_id=0, planner__accel_max_mps2=1.5)
    assert refused(("enterInitializationMode", None, float("nan")))
    slave.fmu.enterInitializationMode(startTime=0.0)
    slave.set(planner__accel_max_mps2=1.4, vehicle__speed_mps=20.0)
    assert refused(("enterInitializationMode",), ("doStep", 0.0, 0.01), ("terminate",))
    slave.fmu.exitInitializationMode()
    fixed = slave.variables["planner.accel_max_mps2"].valueReference
    assert refused(("setFloat64", [fixed], [1.5]), ("exitInitializationMode",))
    assert refused(("doStep", 0.0, 0.0), ("doStep", 0.0, float("nan")), ("doStep", -1.0, 0.01))
    slave.run(0.0, 3)
    slave.fmu.terminate()
    given = slave.variables["vehicle.speed_mps"].valueReference
    assert refused(("setFloat64", [given], [1.0]), ("doStep", 0.03, 0.01), ("terminate",))
    assert slave.get("time") == pytest.approx(0.03)
    slave.fmu.reset()
    slave.start().run(0.0, 3)


def test_the_stop_time_binds(slave: Slave3) -> None:
    slave.fmu.enterInitializationMode(startTime=0.0, stopTime=0.1)
    slave.fmu.exitInitializationMode()
    slave.run(0.0, 9)
    assert slave.status("doStep", 0.09, 0.02) == 3
    assert "stop time" in slave.texts()[0]
    assert slave.status("doStep", 0.09 + 1e-13, 0.01) == 0


def test_a_reset_instance_drives_as_a_new_one(slave: Slave3, host: Host3) -> None:
    slave.start().run(0.0, 100, **inputs_at(host, 391))
    slave.fmu.reset()
    fresh = host.instantiate()
    assert slave.state() == fresh.state()
    assert slave.start().run(0.0, 50) == fresh.start().run(0.0, 50)
    fresh.free()


def test_a_step_tells_its_end_and_accepts_no_places_for_it(slave: Slave3) -> None:
    slave.fmu.enterInitializationMode(startTime=5.0)
    assert slave.get("time") == 5.0
    slave.fmu.exitInitializationMode()
    assert slave.fmu.doStep(5.0, 0.25) == (False, False, False, 5.25)
    assert slave.fmu.fmi3DoStep(slave.fmu.component, 5.25, 0.5, True, None, None, None, None) == 0
    assert slave.get("time") == 5.75


# Values


def test_each_kind_of_variable_has_its_type(slave: Slave3, tmp_path: Path) -> None:
    values = {
        "planner__accel_max_mps2": 1.25, "driver_id": 7, "learn": 1, "lever__resume": True,
        "profile_store": str(tmp_path / "störe"),
    }  # fmt: skip
    slave.start(**values)
    assert {name: slave.get(name.replace("__", ".")) for name in values} == values
    assert slave.get("profile.status") == 0
    types = {"Float64", "Int32", "Int64", "Boolean", "String"}
    for name in values:
        variable = slave.variables[name.replace("__", ".")]
        own = "Int64" if variable.type == "Enumeration" else variable.type
        for other in types - {own}:
            assert slave.status(f"get{other}", [variable.valueReference]) == 3
            assert "no variable of this type" in slave.texts()[-1]


def test_unknown_references_and_numbers_of_values_are_refused(slave: Slave3) -> None:
    slave.start()
    behind = 1 + max(v.valueReference for v in slave.variables.values())
    for reference in (behind, 4_000_000_000):
        for call in ("Float64", "Int32", "Int64", "Boolean", "String"):
            assert slave.status(f"get{call}", [reference]) == 3
            assert str(reference) in slave.texts()[-1]
    (time,) = [v.valueReference for v in slave.variables.values() if v.name == "time"]
    assert slave.status("setFloat64", [time], [1.0]) == 3
    given = slave.variables["vehicle.speed_mps"].valueReference
    assert slave.status("getFloat64", [given], 2) == 3
    assert slave.status("setFloat64", [given], [1.0, 2.0]) == 3
    assert slave.texts()[-2:] == 2 * ["2 values for 1 variables"]
    assert slave.status("getFloat64", []) == 0
    assert slave.status("setString", [slave.variables["route_file"].valueReference], ["x"]) == 3


def test_an_output_cannot_be_set(slave: Slave3) -> None:
    output = slave.variables["target_speed_mps"].valueReference
    assert slave.status("setFloat64", [output], [1.0]) == 3
    assert "is an output" in slave.texts()[-1]


def test_what_is_not_supported_says_so(slave: Slave3) -> None:
    slave.start()
    for size in ("Float32", "Int8", "UInt8", "Int16", "UInt16", "UInt32", "UInt64"):
        assert slave.status(f"get{size}", [0]) == 3
        assert slave.status(f"set{size}", [0], [0]) == 3
        assert slave.texts()[-2:] == [
            f"fmi3{verb}{size} is not supported" for verb in ("Get", "Set")
        ]
    calls: tuple[tuple[Any, ...], ...] = (
        ("getBinary", [0]), ("getClock", [0]), ("setClock", [0], [True]), ("enterEventMode",),
        ("enterStepMode",), ("updateDiscreteStates",), ("enterConfigurationMode",),
        ("getOutputDerivatives", [0], [1]), ("getDirectionalDerivative", [0], [0], [1.0]),
    )  # fmt: skip
    for call in calls:
        assert slave.status(*call) == 3
        assert slave.texts()[-1].endswith("is not supported")


# States


@pytest.mark.parametrize("damage", ["shortened", "changed", "empty", "lengthened"])
def test_damaged_states_are_refused(slave: Slave3, damage: str) -> None:
    slave.start().run(0.0, 10)
    good = slave.state()
    changed = good[:5000] + bytes([good[5000] ^ 4]) + good[5001:]
    bad = {"shortened": good[:-8], "changed": changed, "empty": b"", "lengthened": good + bytes(8)}
    handle = fmi.fmi3FMUState()
    assert slave.status("deserializeFMUState", bad[damage], handle) == 3
    assert "not a state of this FMU" in slave.texts()[-1]
    assert slave.state() == good


def test_a_state_taken_twice_goes_on_alike(slave: Slave3, host: Host3) -> None:
    slave.start().run(0.0, 300, **inputs_at(host, 391))
    state = slave.state()
    first = slave.run(3.0, 300, **inputs_at(host, 20))
    assert slave.restore(state) == 0
    assert slave.get("time") == pytest.approx(3.0)
    assert slave.run(3.0, 300, **inputs_at(host, 20)) == first


# Messages


def test_categories_of_messages(slave: Slave3, host: Host3) -> None:
    """Errors and warnings are always told, events as long as they are asked for."""

    def events() -> int:
        before = len(slave.log)
        slave.run(slave.get("time"), 3, vehicle__speed_mps=float("nan"))
        slave.run(slave.get("time"), 3, vehicle__speed_mps=20.0)
        told = [category for _, category, _ in slave.log[before:]]
        assert "logStatusWarning" in told
        return told.count("logEvents")

    slave.start()
    assert events() == 1
    for on, categories, expected in (
        (False, [], 0), (True, ["logStatusError"], 0), (True, ["logEvents"], 1), (True, [], 1),
        (False, ["logEvents"], 0), (True, ["logAll"], 1),
    ):  # fmt: skip
        slave.fmu.setDebugLogging(on, categories)
        assert events() == expected
    assert {status for status, category, _ in slave.log if category == "logEvents"} == {0}


def test_a_number_sign_is_no_reference_to_a_variable(slave: Slave3, tmp_path: Path) -> None:
    slave.set(route_file=str(tmp_path / "100% #1#"))
    slave.fmu.enterInitializationMode(startTime=0.0)
    assert slave.status("exitInitializationMode") == 3
    assert "/100% ##1##: " in slave.texts()[0]


# The library


def library_of(host: Host3) -> Path:
    (library,) = host.folder.glob("binaries/x86_64-linux/*.so")
    return library


def test_exports_every_function_of_both_standards_and_nothing_else(host: Host3) -> None:
    assert len(symbols.fmi_functions()) == 119
    symbols.check_library(library_of(host))


def test_no_function_needs_an_instance_to_survive(host: Host3) -> None:
    library = ctypes.CDLL(str(library_of(host)))
    for name in symbols.fmi_functions():
        if re.search("Version|Platform|Instantiate|FreeInstance", name) is None:
            assert getattr(library, name)(*[None] * 13) == 3, name
    assert library.fmi3InstantiateCoSimulation(*[None] * 12) == 0
    assert library.fmi2Instantiate(*[None] * 7) == 0
    library.fmi3FreeInstance(None)
