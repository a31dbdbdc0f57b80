"""The front door: ``import pldf``."""

from __future__ import annotations

import ast
import subprocess
import sys
from inspect import getdoc
from pathlib import Path

import numpy as np
import pldf
import pytest
from pldf.recordings.recording import recording_csv

NAMES = {
    "Analysis", "Drive", "Learned", "ModelError", "Recording", "Replay", "Route", "StoredProfile",
    "analyse", "base_profile", "drive", "learn", "open_route", "read_profile", "read_recording",
    "replay", "run_study", "write_profile",
}  # fmt: skip


def test_the_door_is_small_and_every_name_of_it_is_documented() -> None:
    assert set(pldf.__all__) == NAMES
    assert set(dir(pldf)) >= NAMES
    for name in NAMES:
        assert getdoc(getattr(pldf, name)), name


def test_type_checkers_see_the_same_names_from_the_same_places() -> None:
    stub = Path(pldf.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    seen = {
        alias.asname: f"pldf.{node.module}"
        for node in ast.parse(stub).body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert set(seen) == NAMES
    for name, module in seen.items():
        assert getattr(sys.modules[module], str(name)) is getattr(pldf, str(name))


def test_an_unknown_name_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="'pldf' has no attribute 'steer'"):
        _ = pldf.steer  # type: ignore[attr-defined]


def test_the_import_is_free_and_roads_and_recordings_bring_no_compiler() -> None:
    code = (
        "import sys, pldf\n"
        "assert 'numpy' not in sys.modules\n"
        "pldf.base_profile(pldf.open_route('study'))\n"
        "pldf.read_recording, pldf.learn\n"
        "heavy = {'fmpy', 'matplotlib', 'numba', 'plotly', 'pythonfmu', 'rich', 'scipy'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr


def test_routes_are_named_as_on_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = pldf.open_route("study")
    monkeypatch.chdir(tmp_path)
    assert pldf.open_route("0").name == study.name
    with pytest.raises(pldf.ModelError, match="route_id 7 is unknown"):
        pldf.open_route("7")
    Path("7").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n50,0,20\n")
    assert pldf.open_route("7").length_m == 50.0
    assert len(pldf.base_profile(study)) == study.nodes
    assert np.max(pldf.base_profile(study)) <= np.max(study.speed_limit_mps)


def test_a_drive_teaches_in_the_fmu_what_its_recording_teaches_afterwards(
    fmu_folder: Path, tmp_path: Path
) -> None:
    driven = pldf.drive("A2", store=tmp_path, driver_id=17, fmus=fmu_folder, seed=3)
    assert driven.arrived
    route = pldf.open_route("study")
    (file,) = tmp_path.glob("driver-000017_*.pldf")
    learned = pldf.learn(driven.recording, route)
    kept = pldf.read_profile(file)
    assert kept.driver_id == 17
    assert len(kept.iterations) == 1
    assert np.array_equal(kept.iterations[0].learned_mps, learned.iteration.learned_mps)
    assert np.any(learned.iteration.learned_mps != kept.base_mps)
    pldf.write_profile(tmp_path / "copy.pldf", kept)
    assert (tmp_path / "copy.pldf").read_bytes() == file.read_bytes()
    csv = tmp_path / "drive.csv"
    csv.write_bytes(recording_csv(driven.recording))
    recording = pldf.read_recording(csv)
    again = pldf.learn(recording, route)
    assert np.array_equal(again.iteration.learned_mps, learned.iteration.learned_mps)
    less = pldf.learn(recording, route, parameters={"learning.weight": 0.1})
    assert not np.array_equal(less.iteration.learned_mps, learned.iteration.learned_mps)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"phase": "C1"}, "phase C1: there are A1, A2"),
        ({"parameters": {"wish.ofset_mps": 1}}, "did you mean wish.offset_mps"),
        ({"parameters": {"learning.weight": 2}}, "it must lie between"),
        ({"parameters": {"vehicle.start_s_m": 4400.0, "start_speed_mps": -5.0}}, "it must lie"),
        ({"route": "nowhere.xodr"}, "nowhere.xodr: cannot be read"),
    ],
)
def test_what_cannot_be_driven_is_refused(
    arguments: dict[str, object], said: str, fmu_folder: Path
) -> None:
    with pytest.raises(pldf.ModelError, match=said):
        pldf.drive(**{"fmus": fmu_folder, **arguments})  # type: ignore[arg-type]


def test_learning_refuses_unknown_parameters_and_values(tmp_path: Path) -> None:
    empty = pldf.Recording({})
    for given, said in (
        ({"learning.weigt": 1}, "no such parameter; there are e.g. learning.weight"),
        ({"learn": "SOME"}, "learn = SOME: it must be off, faithful"),
        ({"learning.weight": 2}, "learning.weight = 2.0: it must lie between 0 and 1"),
    ):
        with pytest.raises(pldf.ModelError, match=said):
            pldf.learn(empty, pldf.open_route("study"), parameters=given)


def test_a_study_is_driven_and_analysed(tmp_path: Path) -> None:
    file = tmp_path / "small.toml"
    file.write_text('[participants]\ncount = 2\n[drives]\nphases = ["A1", "B1"]\n')
    out = pldf.run_study(file, tmp_path / "out", jobs=1)
    assert out == tmp_path / "out"
    found = pldf.analyse(out)
    assert len(found.participants) == 2
    table = (out / "drives.csv").read_bytes()
    assert pldf.run_study(file, out, jobs=1, restart=True) == out
    assert (out / "drives.csv").read_bytes() == table
    with pytest.raises(pldf.ModelError, match="at least 2"):
        pldf.analyse(out, without=[found.participants[0]])
