"""The study of six drives: what each drive follows, teaches and leaves behind."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from laboratory import files
from pldf import cli
from pldf.analysis.published import PUBLISHED
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.recordings.interventions import rates_of
from pldf.recordings.recording import Recording, read_recording
from pldf.roads import fingerprint, packed_route
from pldf.study.phases import PHASES

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
        return read_recording(self.out / "recordings" / f"{name}.csv")

    def profile(self) -> StoredProfile:
        """Return what is in the store."""
        route = packed_route(0)
        found = ProfileStore(self.out / "profiles").load(1, fingerprint(route), route.nodes)
        assert found is not None
        return found

    def after(self, name: str) -> np.ndarray:
        """Return the columns s_m, base_mps, learned_mps, offset_mps after a drive."""
        return np.loadtxt(self.out / "profile_after" / f"{name}.csv", delimiter=",", skiprows=1).T

    def rates(self) -> list[dict[str, str]]:
        """Return the rows of rates.csv."""
        with (self.out / "rates.csv").open(encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def files(self) -> dict[str, bytes]:
        """Return all files by name."""
        return files(self.out)


@pytest.fixture(scope="module")
def study(fmu_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    made = Study(tmp_path_factory.mktemp("study") / "out", ["--fmus", str(fmu_folder)])
    assert made.run() == 0
    return made


def test_everything_is_there(study: Study) -> None:
    csvs = {f"{folder}/{name}.csv" for folder in ("recordings", "profile_after") for name in NAMES}
    store = study.out / "profiles"
    others = {path.relative_to(study.out) for path in ProfileStore(store).files()}
    pictures = {"drives.png", "profile.png", "rates.png"}
    locks = {name for name in study.files() if name.endswith("lock")}
    assert set(study.files()) - locks == (
        csvs | pictures | {"rates.csv", "study.json"} | {str(path) for path in others}
    )
    assert len(others) == 1
    for picture in pictures:
        assert min(matplotlib.image.imread(study.out / picture).shape[:2]) > 500
    described = json.loads((study.out / "study.json").read_text())
    assert described["phases"] == NAMES
    assert described["route_fingerprint"] == fingerprint(packed_route(0))


def test_interventions_fall_once_the_function_has_learned(study: Study) -> None:
    rates = {row["drive"]: row for row in study.rates()}
    combined = {name: float(rates[name]["rate_combined"]) for name in NAMES}
    assert combined["A3"] == combined["B3"] == 0.0
    assert min(combined["A1"], combined["A2"]) > 0.4
    assert max(combined["B1"], combined["B2"]) < 0.5 * min(combined["A1"], combined["A2"])


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
    for row in study.rates():
        recording = study.recording(row["drive"])
        expected = rates_of(recording)
        assert float(row["rate_pedal"]) == pytest.approx(expected.pedal, abs=1e-12)
        assert float(row["rate_set_speed"]) == pytest.approx(expected.set_speed, abs=1e-12)
        assert float(row["rate_combined"]) == pytest.approx(expected.combined, abs=1e-12)
        assert float(row["time_s"]) == recording["time_s"][-1]


def test_the_driver_is_never_quite_the_same(study: Study) -> None:
    a1, a2 = study.recording("A1"), study.recording("A2")
    common = min(len(a1), len(a2))
    assert not np.array_equal(a1["gas_pedal"][:common], a2["gas_pedal"][:common])


def test_again_into_the_same_folder_gives_the_same_bytes(
    study: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    before = study.files()
    assert study.run() == 0
    assert study.files() == before
    captured = capsys.readouterr()
    assert captured.err == ""
    for name in (*NAMES, "A mean", "B paper", "54.68"):
        assert name in captured.out
    assert f"Look at {study.out / 'drives.png'}" in captured.out


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
    assert "holds profiles that are not from a study; choose another --out" in error
    assert error.count("\n") == 1


def test_a_study_that_cannot_end_says_in_which_drive(
    fmu_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weak = ["--fmus", str(fmu_folder), "--set", "body.power_max_w=1", "--step", "0.1"]
    assert Study(tmp_path, weak).run() == 1
    assert "pldf: drive A1 was given up: the vehicle " in capsys.readouterr().err
