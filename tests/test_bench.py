"""The benchmarks run, and what they say makes sense; no time is judged here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def measured(native_folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The native section after very little measuring; from the study's first 300 steps."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    import native_times  # noqa: PLC0415 - found by now

    effort = native_times.Effort(
        drive_steps=300, runs=2, drives=3, single_steps=1000, starts=3, finishes=2
    )
    times: dict[str, Any] = native_times.native_times(native_folder, effort)
    return times


def test_the_native_benchmark_measures_every_fmu(measured: dict[str, Any]) -> None:
    endings = measured.pop("terminate_with_learning")
    assert set(measured) == {"AdaptivePLDF", "LongitudinalVehicle", "ScriptedDriver"}
    for times in measured.values():
        assert times["step_ratio"] == times["step_cpu_s"] / times["empty_step_cpu_s"] > 0.0
        for single in ("single_step", "single_step_of_empty", "single_call_of_clock"):
            assert 0.0 <= times[single]["p50_s"] <= times[single]["p99_9_s"]
            assert times[single]["p99_9_s"] <= times[single]["max_s"] + 1e-9
        assert times["instantiate_and_initialize"]["cpu_s"] > 0.0
    assert {"without_store", "store_on_disk"} <= set(endings)
    assert all(times["wall_s"] > 0.0 for times in endings.values())


def test_whole_commands_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    import command_times  # noqa: PLC0415 - found by now

    times = command_times.command_times(runs=1)
    assert set(times) == {"pldf --help", "pldf route study"}
    assert all(cpu_s > 0.0 for cpu_s in times.values())


def test_reading_roads_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    import road_times  # noqa: PLC0415 - found by now

    times = road_times.road_times(many=50, long_m=2000.5)
    assert set(times) == {"50 geometries", "2.0005 km", "2.0005 km, CSV"}
    for measured in times.values():
        assert 0.0 < measured["read_s"] <= measured["read_and_fingerprint_s"]
        assert 0.0 < measured["peak_memory_read_mb"] <= measured["peak_memory_mb"]


def test_whole_studies_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    import study_times  # noqa: PLC0415 - found by now

    times = study_times.study_times(runs=1, many=2)
    assert set(times) == {"43 participants of the paper", "2 participants"}
    assert all(wall_s > 0.0 for wall_s in times.values())
