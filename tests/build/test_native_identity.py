"""The same drives in every way they can be driven: the same bits in every output of every step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from native_drives import CASES, Table, by_fmpy, by_source, by_wasmtime
from native_hosts import ON, PLATFORMS, Hosts, Unpacked
from wasm_host import loaded

FOLDER = "Profile Müller Ж 車"  # no file system or code page may mind

Outcome = tuple[list[bytes], bytes]  # results of each drive, profile at the end


def outcome(results: list[Table], store: Path) -> Outcome:
    """Return what is compared; nothing but one profile may be in the store."""
    profiles = list(store.iterdir()) if store.exists() else []
    assert len(profiles) <= 1
    return [table.tobytes() for table in results], b"".join(p.read_bytes() for p in profiles)


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Outcome]:
    """Return what the kernels' source does in CPython, by name of the case."""
    found = {}
    for name, case in CASES.items():
        store = tmp_path_factory.mktemp("source") / FOLDER
        script = case.script()
        results = [by_source(case, script, store) for _ in range(case.drives)]
        assert np.isfinite(results).all()
        found[name] = outcome(results, store)
    return found


def test_drives_reach_what_there_is_to_compare(expected: dict[str, Outcome]) -> None:
    for name, case in CASES.items():
        columns = np.frombuffer(expected[name][0][0]).reshape(len(case.script()) + 1, -1).T
        if case.learns:
            assert set(columns[2]) == {1.0, 2.0, 3.0, 4.0}  # all modes of a drive
            assert columns[11, -1] > 3.0  # interventions
            assert b"iteration 2 " in expected[name][1]
        elif name != "hands off":
            assert len(np.unique(columns[0])) > 1
    assert b" forget 0 forget at " in expected["words"][1]
    assert b" undo 0 undo of 1" in expected["undo"][1]
    assert len({found[0][0] for found in expected.values()}) == len(CASES)


def in_fmpy(name: str, fmu: Unpacked, store: Path) -> Outcome:
    case = CASES[name]
    settings = case.stored(str(store))
    return outcome([by_fmpy(fmu, case.script(), settings) for _ in range(case.drives)], store)


@pytest.mark.parametrize("name", CASES)
def test_python_fmu(
    name: str, fmu_folder: Path, tmp_path: Path, expected: dict[str, Outcome]
) -> None:
    model = CASES[name].model
    fmu = Unpacked.of(fmu_folder / f"{model}.fmu", tmp_path / model)
    assert in_fmpy(name, fmu, tmp_path / FOLDER) == expected[name]


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", CASES)
def test_native_fmu_in_fmpy(
    name: str, version: int, hosts: Hosts, tmp_path: Path, expected: dict[str, Outcome]
) -> None:
    fmu = hosts.fmu("linux64", version, CASES[name].model)
    assert in_fmpy(name, fmu, tmp_path / FOLDER) == expected[name]


@pytest.mark.parametrize(("platform", "version"), ON)
@pytest.mark.parametrize("name", CASES)
def test_native_fmu_in_a_host_without_python(
    name: str,
    platform: str,
    version: int,
    hosts: Hosts,
    tmp_path: Path,
    expected: dict[str, Outcome],
) -> None:
    case, store = CASES[name], tmp_path / FOLDER
    fmu, where = hosts.fmu(platform, version, case.model), PLATFORMS[platform]
    settings = case.stored(where.path(store))
    description = fmu.described(where, tmp_path / "fmu.txt", settings)
    script, found = tmp_path / "script", tmp_path / "results"
    case.script().tofile(script)
    results = []
    for _ in range(case.drives):
        hosts.run(platform, "replay", description, script, found, cwd=tmp_path)
        results.append(np.fromfile(found))
    assert outcome(results, store) == expected[name]


@pytest.mark.parametrize("name", CASES)
def test_web_assembly(name: str, wasm_folder: Path, expected: dict[str, Outcome]) -> None:
    case, fmu = CASES[name], loaded(wasm_folder, CASES[name].model)
    results, files = [], dict[str, bytes]()
    for _ in range(case.drives):
        table, files = by_wasmtime(fmu, case.script(), case.stored(f"/{FOLDER}"), files)
        results.append(table)
    assert all(path.startswith(f"{FOLDER}/") for path in files)
    assert len(files) == int(case.learns)
    assert ([table.tobytes() for table in results], b"".join(files.values())) == expected[name]
