"""The folder of a study's results, and wrong usage of ``pldf study``."""

from __future__ import annotations

from pathlib import Path

import pytest
from laboratory import files
from pldf import cli
from small_study import write_study


def test_results_of_another_study_are_not_mixed(
    finished: Path, expected: dict[str, bytes], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    other = write_study(tmp_path, count=2)
    assert cli.main(["study", str(other), "--out", str(out)]) == 0
    again = ["study", str(finished / "small.toml"), "--out", str(out), "--jobs", "1"]
    before = files(out)
    assert cli.main(again) == 1
    assert "results of another study or version (study.toml differs)" in capsys.readouterr().err
    assert files(out) == before
    assert cli.main([*again, "--restart"]) == 0
    assert files(out) == expected


def test_a_folder_of_others_is_left_alone(
    finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drives.csv").write_text("mine")
    arguments = ["study", str(finished / "small.toml"), "--out", str(tmp_path)]
    for more in ([], ["--restart"]):
        assert cli.main([*arguments, *more]) == 1
        assert "not from a study of participants" in capsys.readouterr().err
    assert files(tmp_path) == {"drives.csv": b"mine"}


@pytest.mark.parametrize(
    "arguments",
    [
        ["--fmu"],
        ["FILE", "--seed", "3"],
        ["FILE", "--set", "wish.offset_mps=1"],
        ["FILE", "--jobs", "0"],
        ["FILE", "--fmus", "somewhere"],
        ["FILE", "--fmu", "native", "--scheduler", "tcp://nowhere:1"],
    ],
)
def test_wrong_usage(finished: Path, arguments: list[str]) -> None:
    file = str(finished / "small.toml")
    with pytest.raises(SystemExit) as caught:
        cli.main(["study", *(file if word == "FILE" else word for word in arguments)])
    assert caught.value.code == 2
