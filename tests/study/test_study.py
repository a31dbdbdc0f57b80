"""The study of six drives: what each drive follows, teaches and leaves behind."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from laboratory import files
from pldf import cli
from pldf.analysis.drives_table import read_drives
from pldf.analysis.published import PUBLISHED
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.recordings.interventions import rates_of
from pldf.recordings.recording import Recording, read_recording
from pldf.roads import fingerprint, packed_route
from pldf.study.drive_row import DriveRow
from pldf.study.participants import DRIVER_SIGNALS
from pldf.study.participants_file import read_participants
from pldf.study.phases import PHASES
from pldf.study.study_file import ONE_DRIVER, read_study, study_path

# The function gives the profile where it expects the vehicle after its step: a * step**2 away.
AHEAD_MPS = 5e-3
NAMES = list(PHASES)


class Study:
    """One study in a folder, run through the command line."""

    def __init__(self, out: Path, arguments: Sequence[str]) -> None:
        self.out = out
        self.arguments = [*arguments, "--out", str(out)]

    def run(self) -> int:
        """Drive the study; return the exit status."""
        return cli.main(["study", "--step", "0.05", *self.arguments])

    def recording(self, name: str) -> Recording:
        """Return the recording of a drive."""
        return read_recording(self.out / "recordings" / f"P001_{name}.csv")

    def profile(self) -> StoredProfile:
        """Return what is in the store."""
        route = packed_route(0)
        found = ProfileStore(self.out / "profiles").load(1, fingerprint(route), route.nodes)
        assert found is not None
        return found

    def after(self, name: str) -> np.ndarray:
        """Return the columns s_m, base_mps, learned_mps, offset_mps after a drive, as exported."""
        csv = self.out.parent / f"{name}.csv"
        (file,) = ProfileStore(self.out / "profiles").files()
        number = sum(PHASES[drive].learn for drive in NAMES[: NAMES.index(name) + 1])
        what = ["profiles", "export", str(file), "--iteration", str(number), "--out", str(csv)]
        assert cli.main(what) == 0
        return np.loadtxt(csv, delimiter=",", skiprows=1).T

    def drives(self) -> dict[str, DriveRow]:
        """Return the rows of drives.csv by drive."""
        return {row.phase: row for row in read_drives(self.out / "drives.csv")}

    def files(self) -> dict[str, bytes]:
        """Return all files by name."""
        return files(self.out)


@pytest.fixture(scope="module")
def study(fmu_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    made = Study(tmp_path_factory.mktemp("study") / "out", ["--fmus", str(fmu_folder)])
    assert made.run() == 0
    return made


def test_everything_is_there(study: Study) -> None:
    recordings = {f"recordings/P001_{name}.csv" for name in NAMES}
    (profile,) = ProfileStore(study.out / "profiles").files()
    pictures = {"drives.png", "profile.png", "rates.png"}
    tables = {"drives.csv", "participants.csv", "study.toml", "versions.json"}
    assert set(study.files()) == (
        recordings | pictures | tables | {str(profile.relative_to(study.out))}
    )
    for picture in pictures:
        assert min(matplotlib.image.imread(study.out / picture).shape[:2]) > 500
    versions = json.loads((study.out / "versions.json").read_text())
    assert versions["through"].startswith("Python FMU, version ")
    assert versions["route_fingerprint"] == fingerprint(packed_route(0))


def test_the_driver_is_the_one_of_the_study_file(study: Study) -> None:
    (driver,) = read_participants(study.out / "participants.csv")
    (described,) = read_study(study_path(ONE_DRIVER)).participants
    assert (driver.id, driver.seed) == ("P001", described.seed)
    assert all(driver.value(name) == described.value(name) for name in DRIVER_SIGNALS)


def test_interventions_fall_once_the_function_has_learned(study: Study) -> None:
    combined = {name: row.combined_rate for name, row in study.drives().items()}
    assert combined["A3"] == combined["B3"] == 0.0
    assert min(combined["A1"], combined["A2"]) > 0.1
    assert combined["B1"] + combined["B2"] < combined["A1"] + combined["A2"]


def test_a_drives_with_the_base_function_and_b_with_what_was_learned(study: Study) -> None:
    for name in ("A1", "A2", "A3"):
        recording = study.recording(name)
        assert np.array_equal(recording["profile_mps"], recording["base_mps"])
    for name, teacher in (("B1", "A2"), ("B2", "B1"), ("B3", "B2")):
        recording = study.recording(name)
        s_m, _, learned_mps, _ = study.after(teacher)
        follows = np.interp(recording["s_m"], s_m, learned_mps)
        assert np.max(np.abs(recording["profile_mps"] - follows)) < AHEAD_MPS


def test_only_a2_b1_and_b2_teach(study: Study) -> None:
    profile = study.profile()
    assert len(profile.iterations) == 3
    for name, number in zip(NAMES, (0, 1, 1, 2, 3, 3), strict=True):
        s_m, base_mps, learned_mps, offset_mps = study.after(name)
        state = profile.iteration(number)
        assert np.array_equal(s_m, np.arange(profile.nodes))
        assert np.array_equal(base_mps, profile.base_mps)
        assert np.array_equal(learned_mps, state.learned_mps)
        assert np.array_equal(offset_mps, state.offset_mps)


def test_the_rates_are_those_of_the_recordings(study: Study) -> None:
    for name, row in study.drives().items():
        recording = study.recording(name)
        told = (row.pedal_rate, row.set_speed_rate, row.combined_rate)
        assert told == pytest.approx(rates_of(recording), abs=1e-12)
        assert row.duration_s == recording["time_s"][-1]


def test_the_driver_is_never_quite_the_same(study: Study) -> None:
    a1, a2 = study.recording("A1"), study.recording("A2")
    common = min(len(a1), len(a2))
    assert not np.array_equal(a1["gas_pedal"][:common], a2["gas_pedal"][:common])


def test_again_into_the_same_folder_draws_what_is_there(
    study: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    before = {path: path.stat().st_mtime_ns for path in (study.out / "recordings").iterdir()}
    files_before = study.files()
    assert study.run() == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert study.files() == files_before
    captured = capsys.readouterr()
    assert captured.err == ""
    for name in (*NAMES, "A mean", "B paper", "54.68"):
        assert name in captured.out
    assert f"Look at {study.out / 'drives.png'}" in captured.out


def test_the_kernels_give_the_same_rates_as_the_fmus(study: Study, tmp_path: Path) -> None:
    file = tmp_path / "one.toml"
    text = (study.out / "study.toml").read_text().replace('"fmus"', '"kernels"')
    file.write_text(text)
    assert cli.main(["study", str(file), "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out" / "drives.csv").read_bytes() == (study.out / "drives.csv").read_bytes()


def test_options_are_written_into_the_study_file(fmu_folder: Path, tmp_path: Path) -> None:
    road = tmp_path / "road.csv"
    road.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n150,0.004,20\n400,0,20\n")
    options = [
        "--fmus", str(fmu_folder), "--seed", "1", "--driver-id", "17", "--route", str(road),
        "--set", "wish.offset_mps=2", "--set", "pldf.learning.weight=0.4", "--set",
        "driver.uses_lever=false", "--set", "stretch_time_mode=CONSTANT_SPEED",
    ]  # fmt: skip
    options[-1] = "learning.stretch_time_mode=CONSTANT_SPEED"
    study = Study(tmp_path / "out", options)
    assert study.run() == 0
    read = read_study(tmp_path / "out" / "study.toml")
    (driver,) = read.participants
    assert (driver.id, driver.seed, driver.number) == ("P017", 1, 17)
    (described,) = read_study(study_path(ONE_DRIVER)).participants
    assert dict(driver.values) == {
        **described.values, "wish_offset_mps": 2.0, "driver_uses_lever": 0.0,
    }  # fmt: skip
    assert read.settings.function == {
        "learning.weight": 0.4, "learning.stretch_time_mode": 1,
    }  # fmt: skip
    assert read.settings.step_s == 0.05
    assert read.settings.road.file == road
    (profile,) = ProfileStore(tmp_path / "out" / "profiles").files()
    assert profile.name.startswith("driver-000017_")


@pytest.mark.parametrize(
    ("setting", "told"),
    [
        ("wish.ofset_mps=1", "--set wish.ofset_mps: not in a study file; did you mean wish.offset"),
        ("kind=1", "--set kind: not in a study file"),
        ("wish.offset_mps=x", "wish.offset_mps = x: it must be a number"),
        ("wish.offset_mps=99", "driver.wish.offset_mps: 99.0 must be a number from -20 to 30"),
    ],
)
def test_what_cannot_be_set_is_told(
    setting: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["study", "--out", str(tmp_path / "out"), "--set", setting]) == 1
    error = capsys.readouterr().err
    assert told in error
    assert error.count("\n") == 1


def test_other_options_need_a_folder_of_their_own_or_a_restart(
    study: Study, fmu_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = Study(study.out, ["--fmus", str(fmu_folder), "--seed", "2"])
    before = study.files()
    assert other.run() == 1
    assert "holds results of another study" in capsys.readouterr().err
    assert study.files() == before


def test_the_published_means_are_those_of_the_paper() -> None:
    assert PUBLISHED == {"A": (0.2232, 0.3976, 0.5468), "B": (0.1204, 0.1242, 0.2297)}


def test_profiles_of_somebody_else_are_left_alone(
    fmu_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    precious = tmp_path / "profiles" / "driver-000001_route-0123456789abcdef.pldf"
    precious.parent.mkdir()
    precious.write_bytes(b"precious")
    assert Study(tmp_path, ["--fmus", str(fmu_folder)]).run() == 1
    assert precious.read_bytes() == b"precious"
    error = capsys.readouterr().err
    assert "holds files that are not from a study of participants; choose another" in error
    assert error.count("\n") == 1


def test_a_study_that_cannot_end_says_in_which_drive(
    fmu_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weak = ["--fmus", str(fmu_folder), "--set", "body.power_max_w=1", "--step", "0.1"]
    assert Study(tmp_path, weak).run() == 1
    assert "pldf: participant P001, drive A1 was given up: the vehicle " in capsys.readouterr().err
