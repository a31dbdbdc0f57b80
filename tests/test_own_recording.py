"""The function's own recording: by metre, written at the end of the drive, read as any other."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from laboratory import KMH, PointMass, files
from pldf.kernel.codes import MODE, REASON
from pldf.recordings.interventions import pedal_interventions, rates_of
from pldf.recordings.offline import learn_from
from pldf.recordings.recording import Recording, read_recording
from pldf.roads import open_route
from recorded_drive import drive, started

SHORT_S = 10.0


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> tuple[PointMass, Path]:
    folder = tmp_path_factory.mktemp("own") / "laboratory" / "recordings"
    car = started(folder, driver_id=7, learn=1, apply_learned=0)
    drive(car)
    assert not folder.exists()  # nothing is written in a step
    car.made.finish()
    return car, folder / "P007_A1.csv"


@pytest.fixture(scope="module")
def recording(driven: tuple[PointMass, Path]) -> Recording:
    return read_recording(driven[1])


def short(folder: Path | str, **settings: int) -> PointMass:
    car = started(folder, **settings)
    car.run(SHORT_S)
    car.made.finish()
    return car


def test_there_is_a_row_per_metre_with_what_was_in_force(
    driven: tuple[PointMass, Path], recording: Recording
) -> None:
    made = driven[0].made
    s_m = recording["s_m"]
    metres = np.flatnonzero(s_m == np.floor(s_m))
    assert len(metres) == made.record.nodes
    nodes = s_m[metres].astype(int)
    for column, array in (
        ("time_s", made.trace.time_s),
        ("speed_mps", made.trace.speed_mps),
        ("base_mps", made.profile.base_mps),
        ("profile_mps", made.profile.learned_mps),
        ("limit_mps", made.route.limit_mps),
        ("eligible", made.trace.eligible),
    ):
        assert np.array_equal(recording[column][metres], np.asarray(array)[nodes])
    assert {0.0, 1.0} == set(recording["eligible"])


def test_pedals_modes_and_lever_are_where_they_were(recording: Recording) -> None:
    """Against the drive's plan: gas from 20.2 to 25.2 s, the lever at 35.2 s, brake at 55.4 s."""
    time = recording["time_s"]

    def between(first_s: float, last_s: float, column: str) -> set[float]:
        return set(recording[column][(time > first_s) & (time < last_s)])

    assert between(20.4, 25.1, "gas_pedal") == {0.3}
    assert between(20.4, 25.1, "mode") == {MODE.code("GAS_OVERRIDE")}
    assert between(1.0, 20.1, "set_speed_offset_mps") == {0.0}
    assert between(55.6, 57.3, "brake_pedal") == {0.2}
    assert between(55.6, 59.3, "mode") == {MODE.code("STANDBY")}
    offset = between(35.6, 37.0, "set_speed_offset_mps")
    assert min(offset) == pytest.approx(5.0 * KMH)
    reasons = between(20.4, 25.1, "hmi_reason")
    assert reasons == {REASON.code("OVERRIDE")}


def test_a_stop_is_no_hole(recording: Recording) -> None:
    time = recording["time_s"]
    assert np.max(np.diff(time)) < 1.5
    stood = np.flatnonzero(recording["s_m"] != np.floor(recording["s_m"]))
    assert 5 < len(stood) < 15
    assert np.all(np.diff(recording["s_m"]) > 0.0)


def test_it_teaches_what_the_drive_taught(
    driven: tuple[PointMass, Path], recording: Recording
) -> None:
    """Interventions begin and end at a whole metre, no more."""
    made = driven[0].made
    assert made.learned is not None
    again = learn_from(recording, open_route("study")).iteration
    off = np.abs(again.learned_mps - made.learned.learned_mps)
    taught = np.abs(made.learned.learned_mps - np.asarray(made.profile.base_mps))
    assert np.max(off) < 0.2 * KMH < 5.0 * KMH < np.max(taught)
    assert np.count_nonzero(again.offset_mps != made.learned.offset_mps) <= 2


def test_the_head_has_the_exact_rates(driven: tuple[PointMass, Path], recording: Recording) -> None:
    st = driven[0].made.record
    head = dict(line.split(" ", 1) for line in recording.comments[1:])
    assert head["route"] == "92a6126a3ee130f8"
    assert head["driver_id"] == "7"
    exact = (st.rate_pedal, st.rate_set_speed, st.rate_combined)
    assert (
        tuple(float(head[f"rate.{name}"]) for name in ("pedal", "set_speed", "combined")) == exact
    )
    # By the rows they are a little off: when a standing car was reactivated is not among them.
    assert rates_of(recording) == pytest.approx(exact, abs=0.01)
    assert len(pedal_interventions(recording)) == int(head["drive.interventions"]) == 3


def test_every_drive_has_a_file_of_its_own(tmp_path: Path) -> None:
    for _ in range(2):
        short(tmp_path, driver_id=3, apply_learned=0)
    short(tmp_path, driver_id=3, apply_learned=1)
    short(tmp_path, driver_id=12345, apply_learned=1)
    assert sorted(files(tmp_path)) == ["P003_A1.csv", "P003_A2.csv", "P003_B1.csv", "P12345_B1.csv"]


def test_nothing_is_written_unless_somebody_asks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PLDF_RECORDING_FOLDER", raising=False)
    short("")
    assert files(tmp_path) == {}
    monkeypatch.setenv("PLDF_RECORDING_FOLDER", "named/by the environment")
    car = started("")
    monkeypatch.chdir("/")  # the folder is where it was when the drive began
    car.run(SHORT_S)
    car.made.finish()
    assert list(files(tmp_path)) == ["named/by the environment/P000_B1.csv"]


def told(car: PointMass, level: str) -> list[str]:
    return [m.text for m in car.made.messages if m.level == level and "recording of this" in m.text]


def test_a_folder_that_cannot_be_is_told_before_the_drive_and_after_it(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    car = started(tmp_path / "file" / "folder")
    (before,) = told(car, "warning")
    assert before.endswith("not a folder; choose another recording_folder")
    car.run(SHORT_S)
    car.made.finish()
    (after,) = told(car, "error")
    assert after.startswith(f"recording of this drive not written: {tmp_path / 'file' / 'folder'}")


def pldf(*arguments: Any) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "pldf", *map(str, arguments)],
        capture_output=True, check=False, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_learn_and_check_read_it(driven: tuple[PointMass, Path], tmp_path: Path) -> None:
    path = driven[1]
    out = tmp_path / "p.pldf"
    said = pldf("learn", "--route", "study", "--recording", path, "--out", out)
    assert "Pedal intervention 1" in said
    assert out.is_file()
    said = pldf("check", path, "--route", "study")
    assert "0 errors, 0 warnings" in said


def test_its_folder_is_that_of_a_study(driven: tuple[PointMass, Path], tmp_path: Path) -> None:
    """Names are those that an analysis expects."""
    folder = tmp_path / "laboratory" / "recordings"
    folder.mkdir(parents=True)
    for who in (1, 2):
        for phase in ("A1", "A2", "B1", "B2"):
            shutil.copy(driven[1], folder / f"P{who:03d}_{phase}.csv")
    said = pldf("analyse", folder.parent, "--route", "study")
    assert "2 participants" in said
