"""The study through native FMUs: every file as through the Python FMUs, to the byte."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from laboratory import files
from pldf import cli
from pldf.build_version import build_version
from pldf.cosim.fmu import Slave
from pldf.cosim.master import unpacked
from pldf.cosim.prepared import write_prepared_route, write_prepared_script
from pldf.errors import ModelError
from pldf.profiles.store import ProfileStore
from pldf.roads import fingerprint, packed_route, read_route
from pldf.study.phases import PHASES

from vehicle_models.driver_script import read_script, script_arrays

ROAD = "s_m,curvature_per_m,speed_limit_mps\n0,0,20\n150,0.004,20\n400,0,25\n900,0,25\n"
SCRIPT = """at,unit,control,value,duration_s
0.5,s,resume,,0.3
5,s,gas,0.3,2.0
120,m,up_long,,0.3
250,m,brake,0.2,1.0
300,m,resume,,0.3
"""
STUDY = """
title = "a small study on a road of its own"
[participants]
count = 2
seed = 5
[drives]
step_s = 0.05
threshold_growth_per_drive = 0.1
[road]
route = "road.csv"
[recordings]
participants = ["P001", "P002"]
"""


def test_all_six_drives_are_those_of_the_python_fmus(
    fmu_folder: Path, native_folder: Path, tmp_path: Path
) -> None:
    found = []
    for kind, folder in (("Python", fmu_folder), ("native", native_folder)):
        out = tmp_path / kind
        fmus = ["--step", "0.05", "--fmu", kind.lower(), "--fmus", str(folder)]
        assert cli.main(["study", "--out", str(out), *fmus]) == 0
        assert len(ProfileStore(out / "profiles").files()) == 1
        found.append(files(out))
        versions = json.loads(found[-1].pop("versions.json"))
        assert versions["through"] == f"{kind} FMU, version {build_version()}"
    assert found[0] == found[1]
    recordings = {f"recordings/P001_{name}.csv" for name in PHASES}
    assert recordings | {"drives.csv"} < set(found[0])


def test_a_library_that_does_not_load_is_an_error(
    native_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with unpacked(native_folder) as fmus:
        library = fmus["vehicle"].folder / "binaries" / "linux64" / "LongitudinalVehicle.so"
        library.write_bytes(b"no machine code")
        with pytest.raises(
            ModelError, match=r"^LongitudinalVehicle: cannot be loaded here: .*\.so"
        ):
            Slave(fmus["vehicle"], "vehicle", [])
        library.unlink()
        with pytest.raises(ModelError, match="cannot be loaded here: Cannot find shared library"):
            Slave(fmus["vehicle"], "vehicle", [])
    assert Path.cwd() == tmp_path


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the working folder, with a road, a script and a study."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("road.csv", ROAD), ("script.csv", SCRIPT), ("study.toml", STUDY)):
        Path(name).write_text(text)
    return tmp_path


def test_participants_drive_a_road_that_native_fmus_cannot_read(
    folder: Path, native_folder: Path
) -> None:
    """In two processes, each of which hands them the prepared road; as the kernels in process."""
    found = []
    for out, more in (
        ("kernels", []),
        ("native", ["--fmu", "native", "--fmus", str(native_folder)]),
    ):
        assert cli.main(["study", "study.toml", "--out", out, "--jobs", "2", *more]) == 0
        found.append(files(Path(out)))
    through = [json.loads(one.pop("versions.json"))["through"] for one in found]
    assert through == ["kernels", f"native FMU, version {build_version()}"]
    assert found[0] == found[1]
    assert sum(name.startswith("recordings/") for name in found[0]) == 2 * len(PHASES)
    assert sum(name.startswith("profiles/") for name in found[0]) == 2


def test_roads_and_scripts_are_prepared_on_the_way(
    folder: Path, fmu_folder: Path, native_folder: Path
) -> None:
    write_prepared_route(read_route("road.csv"), Path("road.prepared"))
    write_prepared_script(script_arrays(read_script(Path("script.csv"))), Path("script.prepared"))
    prepared = [f"{part}.route_file={folder / 'road.prepared'}" for part in ("pldf", "vehicle")]
    prepared_too = [word for setting in prepared for word in ("--set", setting)]
    found = []
    for name, fmus, script, more in (
        ("python", fmu_folder, "script.csv", []),
        ("native", native_folder, "script.csv", []),
        ("prepared", native_folder, "script.prepared", prepared_too),
    ):
        drive = ["drive", "--fmus", str(fmus), "--route", "road.csv", "--learn", "FAITHFUL"]
        out = ["--store", name, "--out", f"{name}/drive.csv", "--plot", f"{name}.svg"]
        assert cli.main([*drive, "--script", script, *out, *more]) == 0
        found.append(files(Path(name)))
    assert found[0] == found[1] == found[2]
    (profile,) = ProfileStore("native").files()
    assert fingerprint(read_route("road.csv")) in profile.name
    assert fingerprint(packed_route(0)) not in profile.name


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--script", "none.csv"], "{}none.csv: cannot be read (No such file"),
        (["--script", "road.csv"], "{}road.csv, line 1: missing column at, unit, control"),
        (["--set", "pldf.route_file=script.csv"], "script.csv, line 1: missing column s_m"),
    ],
)
def test_what_cannot_be_prepared_is_told_with_file_and_line(
    folder: Path,
    native_folder: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    told: str,
) -> None:
    drive = ["drive", "--fmus", str(native_folder), "--route", "road.csv", "--driver", "script"]
    assert cli.main([*drive, *arguments]) == 1
    error = capsys.readouterr().err
    assert told.format(str(folder.resolve()) + "/") in error
    assert error.startswith("pldf: ")
    assert error.count("\n") <= 2
