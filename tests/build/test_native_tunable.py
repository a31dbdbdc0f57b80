"""Tunable parameters of the native FMUs: as in the Python model, to the bit, in FMI 2.0 and 3.0."""

from __future__ import annotations

from itertools import pairwise
from math import nan
from pathlib import Path
from typing import Any

import pytest
from fmi3_host import Host3
from fmi_host import Host, Slave

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

OK, ERROR = 0, 3
CHANGES: dict[int, dict[str, Any]] = {
    40: {"control__tip_short_mps": 2.5},
    80: {"control__tip_long_mps": 0.75, "hmi__language": 1, "hmi__unit": 1},
    120: {"following__desired_time_gap_s": 2.6, "following__standstill_gap_m": 7.5},
}


def driven(slave: Slave) -> list[dict[str, Any]]:
    """Drive with tips of the lever and another car ahead, while parameters change."""
    found = []
    for k in range(200):
        slave.set(**CHANGES.get(k, {}))
        lever = {"lever__up": k % 20 == 5, "lever__down_long": k % 20 == 15}
        lead = {"lead__present": k > 100, "lead__gap_m": 30.0, "lead__speed_mps": 18.0}
        moving = {"vehicle__s_m": 100.0 + k, "vehicle__speed_mps": 20.0, "lever__resume": k == 1}
        found += slave.run(0.05 * k, 1, 0.05, **moving, **lever, **lead)
    return found


def hosts_of(native: Path, python: Path) -> list[Host]:
    name = "AdaptivePLDF.fmu"
    return [Host(python / name), Host(native / name), Host3(native / "fmi3" / name)]


def bits(rows: list[dict[str, Any]]) -> list[list[str]]:
    return [[v if isinstance(v, str) else float(v).hex() for v in row.values()] for row in rows]


def test_a_drive_with_changing_parameters_is_the_same_in_all(
    native_folder: Path, fmu_folder: Path
) -> None:
    slaves = [host.instantiate().start() for host in hosts_of(native_folder, fmu_folder)]
    python, *native = [driven(slave) for slave in slaves]
    speeds = [row["set_speed_mps"] for row in python]
    assert {round(1 / 3.6, 6), 2.5, -0.75} <= {round(b - a, 6) for a, b in pairwise(speeds)}
    for rows in native:
        assert bits(rows) == bits(python)
    for slave in slaves:
        slave.free()


@pytest.mark.parametrize("version", [2, 3])
def test_what_is_refused_changes_nothing(version: int, native_folder: Path) -> None:
    name, real = "AdaptivePLDF.fmu", "setReal" if version == 2 else "setFloat64"
    host = Host(native_folder / name) if version == 2 else Host3(native_folder / "fmi3" / name)
    slave = host.instantiate().start()
    slave.run(0.0, 5, 0.05, vehicle__s_m=100.0, vehicle__speed_mps=20.0)
    before = slave.state()
    tip, long_tip, fixed = (
        slave.variables[name].valueReference
        for name in ("control.tip_short_mps", "control.tip_long_mps", "control.preview_s")
    )
    for value in (-0.1, 20.5, nan):
        assert slave.status(real, [long_tip, tip], [1.0, value]) == ERROR
        assert "parameter control.tip_short_mps" in slave.texts()[-1]
        assert "between 0 and 20" in slave.texts()[-1]
    assert slave.status(real, [tip, fixed], [1.0, 0.1]) == ERROR
    assert "control.preview_s is not allowed in phase STEPPING" in slave.texts()[-1]
    slave.get("set_speed_mps")  # a value that was set makes outputs stale, a refused one may, too
    assert slave.state() == before
    assert slave.status(real, [long_tip, tip], [1.0, 2.0]) == OK
    slave.free()
