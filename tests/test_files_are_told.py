"""What the models say of how a road was read; a study and its commands say it, too."""

from __future__ import annotations

from pathlib import Path

import pytest
from pldf.cli import main
from pldf.function import DrivingFunction
from pldf.study.study_file import read_study

ROAD = "s_m;curvature_per_m;speed_limit_mps\n0;0,0;20\n900;0;20,5\n"


@pytest.fixture
def road(tmp_path: Path) -> Path:
    path = tmp_path / "road.csv"
    path.write_text(ROAD)
    return path


def test_the_log_of_the_function(road: Path) -> None:
    function = DrivingFunction()
    function.texts.route_file = str(road)
    function.initialize()
    told = {(message.level, message.text) for message in function.messages}
    assert ("info", f"{road}: decimal commas: 0,0 is read as 0") in told


def test_commands(road: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nothing = ["--recording", str(tmp_path / "none.csv"), "--out", str(tmp_path / "out.pldf")]
    assert main(["learn", "--route", str(road), *nothing]) == 1
    assert "note: " in capsys.readouterr().err
    script = tmp_path / "script.csv"
    script.write_text("at;unit;control;value;duration_s\n1,5;s;gas;0,25;1\n")
    assert main(["script", str(script)]) == 0
    assert "decimal commas: 1,5 is read as 1.5" in capsys.readouterr().err


def test_a_study(road: Path, tmp_path: Path) -> None:
    (tmp_path / "people.csv").write_text("participant;seed\nP001;7,0\n")
    study = tmp_path / "study.toml"
    study.write_text(
        f'[road]\nroute = "{road.name}"\n[drives]\nphases = ["A1"]\n'
        '[participants]\nfile = "people.csv"\n'
    )
    notes = read_study(study).notes
    assert [Path(note.file).name for note in notes] == ["road.csv"] * 2 + ["people.csv"] * 2
