"""Variants of a study: the same people with other parameters of the function, compared."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from laboratory import files
from pldf import api
from pldf.analysis.drives_table import read_drives
from pldf.analysis.long_run import read_long_run
from pldf.cli import build_parser, main
from pldf.commands import study as command
from pldf.errors import ModelError
from pldf.study.own_files import DRIVES
from pldf.study.participants import Participant
from pldf.study.study_file import read_study
from pldf.study.unit import Job, ParticipantResult, do_unit

TEXT = """title = "two of them"
[participants]
count = 2
seed = 5
[drives]
phases = ["A2", "B1"]
step_s = 0.05
[function]
"learning.set_speed_gain" = 0.9
"learning.weight" = 0.4
[recordings]
participants = ["P002"]
"""
VARIANTS = """[variants."half careful"]
learn = "CONSISTENT"
"learning.set_speed_gain" = 0.5
[variants.whole]
"""
NAMES = ("half careful", "whole")
TEXT_WITH = TEXT + VARIANTS


def write(folder: Path, text: str = TEXT_WITH) -> Path:
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("variants")
    assert main(["study", str(write(folder)), "--out", str(folder / "out"), "--jobs", "1"]) == 0
    return folder / "out"


def test_what_a_variant_says_wins_over_what_all_share(tmp_path: Path) -> None:
    study = read_study(write(tmp_path))
    assert list(study.variants) == list(NAMES)
    half, whole = (study.variants[name] for name in NAMES)
    assert dict(half.settings.function) == {
        "learning.set_speed_gain": 0.5, "learning.weight": 0.4, "learn": 2,
    }  # fmt: skip
    assert whole.settings.function == study.settings.function
    assert half.participants == study.participants
    assert (half.title, half.out) == ("two of them: half careful", Path("out/my/half careful"))


def test_each_has_the_folder_of_a_study_of_its_own(driven: Path, tmp_path: Path) -> None:
    """What a plain study file with the same parameters gives, to the byte."""
    plain = write(tmp_path, TEXT)
    assert main(["study", str(plain), "--out", str(tmp_path / "plain"), "--jobs", "1"]) == 0
    expected, found = files(tmp_path / "plain"), files(driven / "whole")
    same = expected.keys() - {"study.toml", "versions.json"}  # these tell the name
    assert found.keys() == expected.keys()
    assert {name: found[name] for name in same} == {name: expected[name] for name in same}
    assert found["drives.csv"] != files(driven / NAMES[0])["drives.csv"]


def test_its_study_file_says_which_variant_it_is(driven: Path) -> None:
    for name in NAMES:
        again = read_study(driven / name / "study.toml")
        assert (again.title, again.variants) == (f"two of them: {name}", {})
        assert again.source == (driven / name / "study.toml").read_text(encoding="utf-8")
    assert again.settings.function["learning.set_speed_gain"] == 0.9


def test_each_can_be_analysed(driven: Path, tmp_path: Path) -> None:
    report = tmp_path / "r.html"
    options = ["--out", str(tmp_path / "analysis"), "--report", str(report)]
    assert main(["analyse", str(driven / NAMES[0]), *options]) == 0
    assert "two of them: half careful" in report.read_text(encoding="utf-8")


def test_who_names_the_folder_of_all_is_sent_to_one_of_them(
    driven: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["analyse", str(driven)]) == 1
    assert f"2 of its folders have drives: name one of them, such as '{driven / NAMES[0]}'" in (
        capsys.readouterr().err
    )


def test_they_are_compared_drive_by_drive(driven: Path) -> None:
    found = read_long_run(driven / "long_run.csv")
    assert list(found) == list(NAMES)
    for name in NAMES:
        rates = [row.pedal_rate for row in read_drives(driven / name / DRIVES) if row.phase == "B1"]
        assert found[name]["pedal_percent"] == pytest.approx([50.0 * sum(rates)], rel=1e-5)
    assert (driven / "long_run.png").read_bytes().startswith(b"\x89PNG")
    assert main(["check", str(driven / "long_run.csv")]) == 0


def test_from_python_the_same_comes_out(driven: Path, tmp_path: Path) -> None:
    out = api.run_study(write(tmp_path), tmp_path / "out", jobs=1)
    found, expected = files(out), files(driven)
    assert {name: found[name] for name in expected if not name.endswith(".png")} == {
        name: expected[name] for name in expected if not name.endswith(".png")
    }


def test_it_goes_on_after_an_interruption_in_the_second_variant(
    driven: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    done: list[str] = []

    def run(job: Job, participants: list[Participant]) -> Iterator[ParticipantResult]:
        for one in participants:
            if len(done) == 3:
                raise KeyboardInterrupt
            done.append(one.id)
            yield do_unit(job, one)

    command_line = ["study", str(write(tmp_path)), "--out", str(tmp_path / "out"), "--jobs", "1"]
    with monkeypatch.context() as patched:
        patched.setattr(command, "in_processes", lambda *_: run)
        with pytest.raises(KeyboardInterrupt):
            command.run(build_parser("study").parse_args(command_line))
    assert "3 of 4 participants are done" in capsys.readouterr().err
    assert (tmp_path / "out" / NAMES[0] / "drives.csv").exists()
    assert not (tmp_path / "out" / "long_run.csv").exists()
    assert main(command_line) == 0
    for name in ("long_run.csv", *(f"{variant}/drives.csv" for variant in NAMES)):
        assert (tmp_path / "out" / name).read_bytes() == (driven / name).read_bytes()


def test_another_file_needs_a_restart_which_drives_all_anew(
    driven: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "out")
    assert main(["study", str(write(tmp_path)), "--out", out, "--jobs", "1"]) == 0
    study = str(write(tmp_path, TEXT_WITH.replace("count = 2", "count = 3")))
    assert main(["study", study, "--out", out, "--jobs", "1"]) == 1
    assert "holds results of another study" in capsys.readouterr().err
    assert (tmp_path / "out" / "long_run.csv").read_bytes() == (
        driven / "long_run.csv"
    ).read_bytes()
    assert main(["study", study, "--out", out, "--jobs", "1", "--restart"]) == 0
    header, *lines = (tmp_path / "out" / "long_run.csv").read_text().splitlines()
    assert {line.split(",")[header.split(",").index("participants")] for line in lines} == {"3"}


@pytest.mark.parametrize(
    ("variants", "told"),
    [
        ("[variants.x]\n'learning.weight' = 5",
         "line 14, variants.x.learning.weight: 5 must be a number from 0 to 1"),
        ("[variants.x]\n'learning.speed_gain' = 1", "did you mean learning.set_speed_gain?"),
        ("[variants.x]\nlearn = 'OFF'", 'line 14, variants.x.learn: "OFF": the drives say'),
        ("[variants.'../x']", "line 13, variants.../x: is the name of a folder"),
        ("[variants.'long_run.csv']", "a device of Windows or a file of the study"),
        ("[variants.Con]", "line 13, variants.Con: is the name of a folder, and this one"),
        ("[variants.x]\n[variants.X]", "variants.x: the same folder as X"),
        ("[variants]\nx = 3", 'line 14, variants.x: 3 is no variant: write [variants."NAME"]'),
    ],
)  # fmt: skip
def test_what_no_variant_can_be_is_named(tmp_path: Path, variants: str, told: str) -> None:
    with pytest.raises(ModelError) as caught:
        read_study(write(tmp_path, TEXT + variants))
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("text", "told"),
    [(TEXT_WITH, 'variant: "y" must be one of "half careful", "whole"'),
     (TEXT, 'variant: "y" must be left out: there are no [variants]')],
)  # fmt: skip
def test_a_variant_that_is_not_there_is_named(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(ModelError) as caught:
        read_study(write(tmp_path, f'variant = "y"\n{text}'))
    assert told in str(caught.value)
