"""``pldf drive`` and ``pldf plot``: what they write and say, and how they fail."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from pldf import cli
from pldf.commands.plot import names_of
from pldf.recordings.recording import Recording, read_recording, write_recording
from sample_recording import sample_recording as sample

Run = Callable[..., tuple[int, str, str]]

ROAD = "s_m,curvature_per_m,speed_limit_mps\n0,0,20\n150,0.0,20\n400,0,20\n"
SCRIPT = """at,unit,control,value,duration_s
0.5,s,resume,,0.3
5,s,gas,0.3,2.0
120,m,up_long,,0.3
250,m,brake,0.2,1.0
300,m,resume,,0.3
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Return a function that runs ``pldf`` in an empty folder without a profile store."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PLDF_PROFILE_STORE", raising=False)

    def runner(*arguments: str) -> tuple[int, str, str]:
        try:
            status = cli.main(arguments)
        except SystemExit as stop:
            status = int(stop.code or 0)
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner


@pytest.fixture
def drive(run: Run, fmu_folder: Path) -> Run:
    """Return a function that runs ``pldf drive`` on a short straight road."""
    Path("road.csv").write_text(ROAD)
    Path("script.csv").write_text(SCRIPT)
    common = ("drive", "--fmus", str(fmu_folder), "--route", "road.csv", "--step", "0.05")
    return lambda *arguments: run(*common, *arguments)


def test_a_drive_writes_recording_and_picture(drive: Run) -> None:
    status, out, err = drive("--driver", "none", "--out", "results")
    assert (status, err) == (0, "")
    recording = read_recording("results/drive.csv")
    assert recording["s_m"][-1] < 400.0
    assert np.all(recording["limit_mps"] == 20.0)
    assert matplotlib.image.imread("results/drive.png").shape[1] == 1650
    assert "reached the end of the route" in out
    assert "pedal 0.0%, set speed 0.0%, combined 0.0%" in out


def test_a_script_drives_and_its_lesson_is_told(drive: Run) -> None:
    status, out, err = drive(
        "--script", "script.csv", "--learn", "FAITHFUL", "--store", "s", "--out", "a.csv",
        "--plot", "pictures/a.png", "--driver-id", "17",
    )  # fmt: skip
    assert (status, err) == (0, "")
    assert "2 interventions" in out
    assert " m as drive 1, on average " in out
    told = [line.strip() for line in out.splitlines() if line.startswith("  ")]
    assert [line.partition(",")[0] for line in told[:3]] == [
        "pedal intervention 1", "pedal intervention 2", "set speed",
    ]  # fmt: skip
    assert ": learned from " in told[0] and told[2].endswith(": +5.0 km/h learned")
    assert "driver-000017_route-" in out
    assert Path("pictures/a.png").exists()
    recording = read_recording("a.csv")
    assert np.max(recording["gas_pedal"]) == pytest.approx(0.3)
    assert np.max(recording["set_speed_offset_mps"]) == pytest.approx(5.0 / 3.6)
    status, out, _ = drive(
        "--driver-id", "17", "--store", "s", "--driver", "none", "--out", "b.csv"
    )
    again = read_recording("b.csv")
    assert status == 0
    assert np.max(np.abs(again["profile_mps"] - again["base_mps"])) > 0.2
    status, out, _ = drive("--driver-id", "17", "--store", "s", "--no-apply", "--out", "c.csv")
    unlearned = read_recording("c.csv")
    assert np.array_equal(unlearned["profile_mps"], unlearned["base_mps"])


def test_phases_set_what_is_applied_learned_and_who_drives(drive: Run) -> None:
    options = ("--store", "s", "--set", "wish.offset_mps=4", "--out")
    assert drive("--phase", "A2", *options, "a2.csv")[0] == 0
    assert drive("--phase", "A1", *options, "a1.csv")[0] == 0
    assert drive("--phase", "B3", *options, "b3.csv")[0] == 0
    a1, a2, b3 = (read_recording(f"{name}.csv") for name in ("a1", "a2", "b3"))
    assert np.array_equal(a1["speed_mps"], a2["speed_mps"])
    assert np.max(a2["speed_mps"]) > 21.0
    assert np.array_equal(a1["profile_mps"], a1["base_mps"])
    assert np.max(b3["profile_mps"] - b3["base_mps"]) > 0.5
    assert np.max(b3["gas_pedal"]) == 0.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--set", "wish.ofset_mps=3"], "did you mean wish.offset_mps"),
        (["--set", "zzz=1"], "no such parameter; write e.g. pldf.learning.weight=0.4"),
        (["--set", "route_id=0"], "write one of vehicle.route_id, driver.route_id, pldf.route_id"),
        (["--set", "driver.gas_pedal=1"], "no such parameter"),  # the driver feeds it
        (["--set", "learning.weight=half"], "learning.weight = half: it must be a number"),
        (["--set", "learn=SOME"], "learn = SOME: it must be off, faithful"),
        (["--set", "seed=99999999999"], "seed = 99999999999: it must lie within"),
        (
            ["--set", "learning.weight=1.5"],
            "AdaptivePLDF: parameter learning.weight = 1.5: it must",
        ),
        (
            ["--driver", "script", "--script", "nowhere.csv"],
            "nowhere.csv: cannot be read (No such file",
        ),
        (["--route", "nowhere.xodr"], "nowhere.xodr: cannot be read"),
        (["--route", "12"], "route_id 12 is unknown; packed routes: 0 = study_road"),
        (["--fmus", "nowhere"], "pldf build"),
        (["--plot", "picture.doc"], "picture.doc: cannot be drawn"),
    ],
)
def test_bad_input_is_told_in_one_or_two_lines(
    drive: Run, arguments: list[str], message: str
) -> None:
    status, _, err = drive("--driver", "none", *arguments)
    assert status == 1
    assert err.startswith("pldf: ")
    assert message in err
    assert err.count("\n") <= 2
    assert "Traceback" not in err


@pytest.mark.parametrize(
    "arguments",
    [
        ["--phase", "C1"],
        ["--phase", "A1", "--no-apply"],
        ["--phase", "A1", "--learn", "FAITHFUL"],
        ["--driver", "preference", "--script", "script.csv"],
        ["--driver-id", "-3"],
        ["--step", "0.5"],
        ["--step", "nan"],
    ],
)
def test_wrong_usage(drive: Run, arguments: list[str]) -> None:
    status, out, err = drive(*arguments)
    assert (status, out) == (2, "")
    assert "pldf drive: error: " in err


def test_a_file_that_is_no_fmu(run: Run) -> None:
    Path("dist").mkdir()
    Path("dist/LongitudinalVehicle.fmu").write_text("nothing")
    status, _, err = run("drive")
    assert status == 1
    assert "dist/LongitudinalVehicle.fmu: not a usable FMU" in err.replace("\\", "/")


def test_learning_without_a_store_is_warned_of(drive: Run) -> None:
    status, out, err = drive("--learn", "FAITHFUL")
    assert status == 0
    assert err.count("\n") == 1
    assert "no profile store: nothing is loaded or saved" in err
    assert "nothing kept: there is no profile store" in out


def test_what_was_repaired_on_the_road_is_told_once(drive: Run) -> None:
    """By the command, not again by each FMU that reads the same file."""
    spike = "200,0,20\n200,0.05,20\n201,0.05,20\n201,0,20\n"
    lines = ROAD.splitlines(keepends=True)
    Path("road.csv").write_text("".join([*lines[:-1], spike, lines[-1]]))
    status, _, err = drive("--driver", "none")
    assert status == 0
    assert err.count("\n") == 1
    assert "is no curve of a road" in err


def test_a_drive_that_is_given_up_still_leaves_its_recording(drive: Run) -> None:
    status, out, err = drive(
        "--driver", "none", "--set", "body.power_max_w=1", "--set", "grade_from_route=false",
        "--set", "grade_constant=0.1", "--out", "up.csv",
    )  # fmt: skip
    assert status == 1
    assert "pldf: the drive was given up: the vehicle stood still for 60 s at " in err
    assert len(read_recording("up.csv")) > 100
    assert "rates" in out


def test_a_picture_of_one_recording(run: Run) -> None:
    write_recording("a.csv", sample())
    assert run("plot", "a.csv") == (0, "picture  a.png\n", "")
    for kind in ("png", "svg", "pdf"):
        for folder in ("one", "two"):
            assert run("plot", "a.csv", "--out", f"{folder}/a.{kind}")[0] == 0
        assert Path(f"one/a.{kind}").read_bytes() == Path(f"two/a.{kind}").read_bytes()
    assert matplotlib.image.imread("a.png").shape[1] == 1650


def test_several_recordings_are_compared(run: Run) -> None:
    write_recording("a.csv", sample())
    write_recording("b.csv", sample(1.0))
    assert run("plot", "a.csv", "b.csv", "--out", "both.png") == (0, "picture  both.png\n", "")


def test_a_laboratory_recording_needs_the_route(run: Run) -> None:
    whole = sample().columns
    Path("road.csv").write_text(ROAD.replace("400,", "2500,"))
    few = Recording({name: whole[name] for name in ("time_s", "s_m", "speed_mps", "mode")})
    write_recording("few.csv", few)
    status, _, err = run("plot", "few.csv")
    assert status == 1
    assert "few.csv: no column limit_mps, base_mps" in err
    assert "--route" in err
    status, _, err = run("plot", "few.csv", "--route", "road.csv")
    assert status == 0
    assert "profile_mps, set_speed_offset_mps not recorded, and what the function had" in err
    status, _, err = run("plot", "few.csv", "--route", "road.csv", "--followed", "base")
    assert status == 0
    assert "profile_mps" not in err
    write_recording("a.csv", sample())
    assert "--followed needs the road" in run("plot", "a.csv", "--followed", "base")[2]


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (["nowhere.csv"], 1),
        (["a.csv", "--profile", "nowhere.pldf"], 1),
        (["a.csv", "--out", "a.xyz"], 1),
        (["a.csv"] * 8, 2),
        ([], 2),
    ],
)
def test_plot_refuses(run: Run, arguments: list[str], status: int) -> None:
    write_recording("a.csv", sample())
    found, out, err = run("plot", *arguments)
    assert (found, out) == (status, "")
    assert "Traceback" not in err
    assert len(err.splitlines()) <= (2 if status == 1 else 8)


def test_recordings_of_one_name_are_told_apart() -> None:
    paths = [Path("x/B1.csv"), Path("y/B1.csv")]
    assert names_of(paths) == ["x/B1", "y/B1"]
    assert names_of([Path("B1.csv"), Path("B2.csv")]) == ["B1", "B2"]
    assert names_of([Path("B1.csv"), Path("B1.csv")]) == ["B1", "B1 (2)"]
