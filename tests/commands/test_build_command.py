"""``pldf build``: what can be chosen, and what is said while it builds."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pldf import cli
from pldf.build import fmus
from pldf.commands.build import WorkLog
from pldf.cosim.kinds import PARTS_IN_TRAFFIC

Capture = pytest.CaptureFixture[str]


def test_what_can_be_built_alone_is_what_there_is() -> None:
    assert tuple(fmus.FMUS) == tuple(fmus.NATIVE) == tuple(sorted(PARTS_IN_TRAFFIC.values()))


def test_one_fmu_alone_is_validated_and_makes_no_packages(tmp_path: Path, capsys: Capture) -> None:
    assert cli.main(["build", "--only", "LongitudinalVehicle", "--out", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [re.sub(r"\d+\.\d s|\d+ KiB", "#", line) for line in lines] == [
        "[1/1] LongitudinalVehicle: pack the Python source ... #",
        "[1/1] LongitudinalVehicle: validate ... #",
        f"    {tmp_path / 'LongitudinalVehicle.fmu'} (#)",
    ]
    assert [path.name for path in tmp_path.iterdir()] == ["LongitudinalVehicle.fmu"]


def test_a_build_that_fails_says_where_and_leaves_no_archive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(fmus, "validate_fmu", lambda _: ["no variables"])
    assert cli.main(["build", "--only", "ScriptedDriver", "--out", str(tmp_path)]) == 1
    said = capsys.readouterr()
    assert said.out.splitlines()[-1] == "[1/1] ScriptedDriver: validate ... failed"
    assert said.err == (
        f"pldf: ScriptedDriver: {tmp_path / 'ScriptedDriver.fmu'} is not a valid FMU:\n"
        "  no variables\n"
    )
    assert not [*tmp_path.iterdir()]


def test_a_piece_of_work_ends_when_the_next_begins(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    times = iter([1.0, 3.5, 3.5, 3.75])
    monkeypatch.setattr("pldf.commands.build.perf_counter", lambda: next(times))
    work = WorkLog("x")
    work.begin("a")
    work.begin("b")
    work.end()
    work.end()
    assert capsys.readouterr().out == "x: a ... 2.5 s\nx: b ... 0.2 s\n"
