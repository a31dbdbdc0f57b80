"""In every kind of FMU: inputs set and outputs read between the steps leave the drive as it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from native_drives import CASES, Case, Table, by_fmpy, by_source
from native_hosts import Hosts, Unpacked

ROWS = 1500


def drive(case: Case) -> Table:
    """Return the part of the case's drive with most that is strange, time beginning at 0."""
    script = case.script()[-ROWS:]
    script[:, 0] -= script[0, 0]
    return script


def restless(script: Table) -> Table:
    """Return the drive with a row before each (new inputs, no step) and one behind (the same)."""
    rows = np.repeat(script, 3, axis=0)
    rows[0::3, 1] = rows[2::3, 1] = 0.0
    rows[2::3, 0] += rows[1::3, 1]
    return rows


def assert_unmoved(results: Table, expected: Table) -> None:
    np.testing.assert_array_equal(results[[0, *range(2, len(results), 3)]], expected)
    np.testing.assert_array_equal(results[3::3], expected[1:])


@pytest.mark.parametrize("name", CASES)
def test_python_fmu(name: str, fmu_folder: Path, tmp_path: Path) -> None:
    case = CASES[name]
    expected = by_source(case, drive(case), tmp_path / "expected")
    assert_unmoved(by_source(case, restless(drive(case)), tmp_path / "source"), expected)
    fmu = Unpacked.of(fmu_folder / f"{case.model}.fmu", tmp_path / case.model)
    settings = case.stored(str(tmp_path / "fmu"))
    assert_unmoved(by_fmpy(fmu, restless(drive(case)), settings), expected)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", CASES)
def test_native_fmu(name: str, version: int, hosts: Hosts, tmp_path: Path) -> None:
    case = CASES[name]
    expected = by_source(case, drive(case), tmp_path / "expected")
    fmu = hosts.fmu("linux64", version, case.model)
    settings = case.stored(str(tmp_path / "fmu"))
    assert_unmoved(by_fmpy(fmu, restless(drive(case)), settings), expected)
