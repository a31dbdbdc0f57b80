"""An FMU as WebAssembly: life cycle, files, messages, states, stores."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from native_drives import CASES, by_type, by_wasmtime, read
from native_hosts import MODELS
from wasm_host import ERROR, OK, WARNING, WasmFmu, WasmSlave, loaded

FUNCTION = "AdaptivePLDF"


@pytest.fixture
def function(wasm_folder: Path) -> WasmFmu:
    return loaded(wasm_folder, FUNCTION)


def begun(fmu: WasmFmu, case: str, rows: int) -> tuple[WasmSlave, list[list[float]]]:
    """Return an instance after the first rows of a case, and the case's other rows."""
    slave = WasmSlave(fmu)
    slave.set_named(fmu, CASES[case].settings)
    slave.initialize()
    script = CASES[case].script().tolist()
    drive(slave, fmu, script[:rows])
    return slave, script[rows:]


def drive(slave: WasmSlave, fmu: WasmFmu, rows: list[list[float]]) -> list[list[float]]:
    """Drive rows of a case; return all outputs after each."""
    inputs, outputs = (by_type(fmu, causality) for causality in ("input", "output"))
    results = []
    for time_s, step_s, *values in rows:
        for kind, (places, references) in inputs.items():
            chosen = [values[i] if kind == "Real" else int(values[i]) for i in places]
            getattr(slave, f"set{kind}")(references, chosen)
        if step_s:
            slave.doStep(time_s, step_s)
        results.append(list(read(slave, outputs)))
    return results


@pytest.mark.parametrize("case", ["words", "hills", "traffic", "wish"])
def test_state_goes_on_in_another_instance(case: str, wasm_folder: Path) -> None:
    fmu = loaded(wasm_folder, CASES[case].model)
    first, rest = begun(fmu, case, 700)
    saved = first.serialized()
    expected = drive(first, fmu, rest[:700])
    second, _ = begun(fmu, case, 10)
    assert second.restore(saved) == OK
    assert np.array_equal(drive(second, fmu, rest[:700]), expected)
    assert second.serialized() == first.serialized()


@pytest.mark.parametrize("model", MODELS)
def test_damaged_state_is_refused_and_told(model: str, wasm_folder: Path) -> None:
    fmu = loaded(wasm_folder, model)
    slave = WasmSlave(fmu)
    slave.initialize()
    saved = slave.serialized()
    at = len(saved) // 2
    damaged = saved[:at] + bytes([saved[at] ^ 1]) + saved[at + 1 :]
    for refused in (damaged, saved[:-1], b""):
        before = len(slave.messages())
        assert slave.restore(refused) == ERROR
        assert [status for status, _ in slave.messages()[before:]] == [ERROR]
    assert slave.restore(saved) == OK


def test_calls_in_the_wrong_order_are_refused_and_told(function: WasmFmu) -> None:
    slave = WasmSlave(function)
    component = slave._component
    assert slave.call("fmi2DoStep", component, 0.0, 0.01, 1) == ERROR
    assert slave.messages()[-1][1].startswith("fmi2DoStep is not allowed in phase ")
    slave.initialize()
    assert slave.call("fmi2DoStep", component, 0.0, -1.0, 1) == ERROR
    assert "a step must be above 0" in slave.messages()[-1][1]
    slave.doStep(0.0, 0.01)


def test_text_with_signs_of_formats_is_told_as_it_is(function: WasmFmu) -> None:
    slave = WasmSlave(function)
    slave.set_named(function, {"route_file": "100% # of Müller.prepared"})
    assert slave.call("fmi2SetupExperiment", slave._component, 0, 0.0, 0.0, 0, 0.0) == OK
    slave.must("fmi2EnterInitializationMode")
    assert slave.call("fmi2ExitInitializationMode", slave._component) == ERROR
    assert "100% # of Müller.prepared" in slave.messages()[-1][1]


def test_road_is_a_file_that_the_page_gives(function: WasmFmu) -> None:
    road = function.resources["route/0.prepared"]
    expected = WasmSlave(function)
    by_file = WasmSlave(replace(function, resources={}), {"roads/mine.prepared": road})
    by_file.set_named(function, {"route_file": "roads/mine.prepared"})
    outputs = by_type(function, "output")
    for slave in (expected, by_file):
        slave.initialize()
        slave.doStep(0.0, 0.01)
    assert read(by_file, outputs) == read(expected, outputs)


@pytest.mark.parametrize("store", ["profiles", "/profiles", "/deep/below/profiles"])
def test_profile_is_found_wherever_the_store_is(function: WasmFmu, store: str) -> None:
    case = CASES["learn"]
    script = case.script()[:1500]
    _, files = by_wasmtime(function, script, case.stored(store), {})
    (path,) = files
    assert path.startswith(f"{store.strip('/')}/driver-")
    _, again = by_wasmtime(function, script, case.stored(store), files)
    assert b"iteration 2 " in again[path]


def test_damaged_profile_is_kept_aside_and_told(function: WasmFmu) -> None:
    case = CASES["learn"]
    script = case.script()[:1500]
    _, files = by_wasmtime(function, script, case.stored("profiles"), {})
    (path,) = files
    damaged = files[path][:-9]
    slave = WasmSlave(function, {path: damaged})
    slave.set_named(function, case.stored("profiles"))
    slave.initialize()
    assert any(status == WARNING for status, _ in slave.messages())
    drive(slave, function, script.tolist())
    slave.terminate()
    left = slave.files()
    aside = [name for name in left if name != path]
    assert left[path] == files[path]
    assert [left[name] for name in aside] == [damaged]


def test_files_are_replaced_and_removed(function: WasmFmu) -> None:
    slave = WasmSlave(function, {"a/b": b"first"})
    slave.write_file("a/b", b"")
    slave.write_file("/c", b"second")
    assert slave.files() == {"a/b": b"", "c": b"second"}
    slave.remove_file("a/b")
    slave.remove_file("never there")
    assert slave.files() == {"c": b"second"}


def test_many_instances_leave_no_memory_behind(function: WasmFmu) -> None:
    """One module, instance after instance: the memory stops growing."""
    slave = WasmSlave(function)
    sizes = []
    for _ in range(6):
        slave.initialize()
        slave.doStep(0.0, 0.01)
        slave.must("fmi2Reset")
        sizes.append(slave.memory_size())
    assert sizes[1:] == [sizes[1]] * 5
