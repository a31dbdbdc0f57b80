"""Columns that recordings lack: rates and lessons are those of the exact, whole recordings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from driven_study import ACTING, PEOPLE, driven_study, recording_of, without_columns
from numpy.typing import NDArray
from pldf.function import DrivingFunction
from pldf.profiles.store import StoredProfile, read_profile
from pldf.recordings.derived import completed, offsets_of
from pldf.recordings.interventions import rates_of
from pldf.recordings.offline import learn_from
from pldf.recordings.recording import Recording
from pldf.roads import open_route

Array = NDArray[np.float64]
KMH = 1.0 / 3.6
NOT_RECORDED = ("set_speed_offset_mps", "profile_mps", "base_mps", "limit_mps")
# How laboratories write a set speed.
ROUNDED: dict[str, Callable[[Array], Array]] = {
    "as it is": lambda v: v,
    "4 decimals": lambda v: v.round(4),
    "float32": lambda v: v.astype(np.float32).astype(np.float64),
    "0.1 km/h": lambda v: (v / KMH).round(1) * KMH,
    "1 km/h": lambda v: (v / KMH).round() * KMH,
}


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return driven_study(tmp_path_factory)


def followed(study: Path, who: str, phase: str) -> DrivingFunction:
    """The function as it was in a drive of the study: B1 follows what A2 taught, B2 B1."""
    function = DrivingFunction()
    function.prepare(open_route("study"))
    if phase[0] == "B":
        (path,) = (study / "profiles").glob(f"driver-{int(who[1:]):06d}_*")
        profile = read_profile(path)
        function.follow(replace(profile, iterations=profile.iterations[: int(phase[1])]))
    return function


def signs(recording: Recording) -> list[int]:
    return (np.flatnonzero(np.diff(recording["limit_mps"])) + 1).tolist()


@pytest.mark.parametrize("rounding", ROUNDED)
@pytest.mark.parametrize("phase", ACTING)
def test_rates_of_rounded_set_speeds_are_those_of_exact_ones(
    study: Path, phase: str, rounding: str
) -> None:
    for who in PEOPLE:
        exact = recording_of(study, who, phase)
        rounded = without_columns(exact, *NOT_RECORDED)
        rounded.columns["set_speed_mps"] = ROUNDED[rounding](exact["set_speed_mps"])
        found = completed(rounded, followed(study, who, phase))
        assert rates_of(found) == pytest.approx(rates_of(exact), abs=1e-12)


def test_the_rates_above_are_not_all_nothing(study: Path) -> None:
    rates = [rates_of(recording_of(study, who, phase)) for who in PEOPLE for phase in ACTING]
    assert sum(0.2 < rate.set_speed < 0.8 for rate in rates) >= 4
    assert sum(rate.set_speed == 0.0 for rate in rates) >= 2


@pytest.mark.parametrize("rows", [1, 30, 100])
@pytest.mark.parametrize("phase", ACTING)
def test_a_set_speed_that_lags_the_sign_gives_the_same_rate(
    study: Path, phase: str, rows: int
) -> None:
    for who in PEOPLE:
        exact = recording_of(study, who, phase)
        late = without_columns(exact, *NOT_RECORDED)
        set_mps = late.columns["set_speed_mps"].copy()
        for sign in signs(exact):
            set_mps[sign : sign + rows] = exact["set_speed_mps"][sign - 1]
        late.columns["set_speed_mps"] = (set_mps / KMH).round(1) * KMH
        found = completed(late, followed(study, who, phase))
        assert rates_of(found) == pytest.approx(rates_of(exact), abs=1e-12)


@pytest.mark.parametrize("shift_m", [-0.9, 0.9])
@pytest.mark.parametrize("phase", ACTING)
def test_a_place_beside_the_sign_costs_no_more_than_the_time_to_there(
    study: Path, phase: str, shift_m: float
) -> None:
    for who in PEOPLE:
        exact = recording_of(study, who, phase)
        moved = without_columns(exact, *NOT_RECORDED)
        moved.columns["s_m"] = np.maximum(exact["s_m"] + shift_m, 0.0)
        found = completed(moved, followed(study, who, phase))
        slowest_mps = min(exact["speed_mps"][sign] for sign in signs(exact))
        passed_s = len(signs(exact)) * abs(shift_m) / slowest_mps
        duration_s = exact["time_s"][-1]
        assert rates_of(found).set_speed == pytest.approx(
            rates_of(exact).set_speed, abs=passed_s / duration_s
        )


def test_rows_of_a_second_behind_and_before_a_sign_are_no_offset() -> None:
    time_s = np.arange(0.0, 20.0, 0.5)
    automatic = np.where(time_s < 10.0, 100.0, 60.0) * KMH

    def found(set_kmh: Array) -> Array:
        offset: Array = offsets_of(time_s, set_kmh * KMH, automatic, 0.5 * KMH).offset_mps / KMH
        return offset

    def marked(set_kmh: Array) -> list[float]:
        return time_s[np.abs(found(set_kmh)) > 0.0].tolist()

    assert marked(np.where(time_s < 11.0, 100.0, 60.0)) == []
    assert marked(np.where(time_s < 9.0, 100.0, 60.0)) == []
    # A set speed of its own before the sign counts up to the sign, however late it is dropped.
    own = np.where(time_s < 5.0, 100.0, np.where(time_s < 11.0, 110.0, 60.0))
    assert marked(own) == time_s[(time_s >= 5.0) & (time_s < 10.0)].tolist()
    # What is kept for longer, the driver has set; and so has who presses soon after the sign.
    assert marked(np.full(40, 100.0)) == time_s[time_s >= 10.0].tolist()
    pressed = np.where(time_s < 10.0, 100.0, np.where(time_s < 10.5, 60.0, 70.0))
    assert marked(pressed) == time_s[time_s >= 10.5].tolist()
    assert (
        marked(np.where(time_s < 7.0, 100.0, 60.0))
        == time_s[(time_s >= 7.0) & (time_s < 10.0)].tolist()
    )
    assert marked(np.where((time_s > 3.0) & (time_s < 4.0), 0.0, automatic / KMH)) == []
    assert found(automatic / KMH + 0.5).tolist() == [0.0] * 40
    assert found(automatic / KMH + 0.6) == pytest.approx(0.6)


@pytest.mark.parametrize("rounding", ROUNDED)
def test_a_rounded_recording_teaches_the_offsets_of_the_exact_one(
    study: Path, rounding: str
) -> None:
    route = open_route("study")
    for who in PEOPLE:
        exact = recording_of(study, who, "A2")
        rounded = without_columns(exact, *NOT_RECORDED)
        rounded.columns["set_speed_mps"] = ROUNDED[rounding](exact["set_speed_mps"])
        one, other = (learn_from(r, route).iteration.offset_mps for r in (exact, rounded))
        assert other == pytest.approx(one, abs=0.5 * KMH)
        assert np.array_equal(other != 0.0, one != 0.0)


def test_what_a_function_had_learned_before_is_said_or_stays_unknown(study: Path) -> None:
    drive = without_columns(recording_of(study, "P001", "B1"), *NOT_RECORDED)
    function = followed(study, "P001", "A1")
    unknown = completed(drive, function, "B1.csv", profile_known=False)
    assert "profile_mps" not in unknown
    assert "set_speed_offset_mps" not in unknown
    assert np.isnan([rates_of(unknown).set_speed, rates_of(unknown).combined]).all()
    assert rates_of(unknown).pedal == rates_of(recording_of(study, "P001", "B1")).pedal

    told = "; ".join(map(str, learn_from(drive, open_route("study"), file="B1.csv").notes))
    assert "B1.csv: no profile named, so the drive counts as driven with the base profile" in told
    assert "brake" not in told  # was recorded
    whole = learn_from(recording_of(study, "P001", "B1"), open_route("study"), file="B1.csv")
    (note,) = whole.notes
    assert note.severity == "warning"
    assert "off the base profile: the drive followed another one" in note.text
    assert "--profile-in" in note.way_out
    (path,) = (study / "profiles").glob("driver-000001_*")
    stored = read_profile(path)
    before = StoredProfile(1, stored.route, stored.base_mps, stored.iterations[:1])
    assert learn_from(recording_of(study, "P001", "B1"), open_route("study"), before).notes == ()
    (note,) = learn_from(recording_of(study, "P001", "B2"), open_route("study"), before).notes
    assert "off the newest iteration of the profile named" in note.text
    assert learn_from(recording_of(study, "P001", "A2"), open_route("study")).notes == ()


def test_no_set_speed_at_all_is_a_warning(study: Path) -> None:
    drive = without_columns(
        recording_of(study, "P001", "A1"), *NOT_RECORDED, "set_speed_mps", "brake_pedal"
    )
    notes = completed(drive, followed(study, "P001", "A1"), "A1.csv").notes
    assert [note.severity for note in notes] == ["note", "warning"]
    assert "brake_pedal (standby after driving counts as braked)" in notes[0].text
    assert "neither set_speed_mps nor set_speed_offset_mps was recorded" in notes[1].text
