"""A drive from its own recording: every answer of the function comes back to the bit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pldf
import pytest
from driven_study import driven_study, recording_of
from pldf.errors import ModelError
from pldf.profiles.store import StoredProfile, read_profile
from pldf.recordings.columns import COLUMNS
from pldf.recordings.recording import Recording, recording_csv
from pldf.roads import open_route

WHO = "P001"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return driven_study(tmp_path_factory)


def followed(study: Path, iterations: int) -> StoredProfile:
    (path,) = (study / "profiles").glob("driver-000001_*")
    profile = read_profile(path)
    return replace(profile, iterations=profile.iterations[:iterations])


@pytest.mark.parametrize(("phase", "iterations"), [("A2", 0), ("B1", 1), ("B2", 2)])
def test_a_drive_is_replayed_to_the_bit(study: Path, phase: str, iterations: int) -> None:
    """From the file: the recording has all digits, and what it says is what it says again."""
    recording = recording_of(study, WHO, phase)
    assert set(recording.columns) == set(COLUMNS)
    known = followed(study, iterations)
    again = pldf.replay(
        recording,
        open_route("study"),
        profile=known if iterations else None,
        parameters={"learn_faithful": True, "driver_id": 1},
    )
    assert recording_csv(again.recording) == recording_csv(recording)
    # What it learned, too: the next state of the profile, as the drive left it in the store.
    assert again.iteration is not None
    learned = followed(study, iterations + 1).iteration()
    for name in ("learned_mps", "offset_mps", "lessons", "bound"):
        assert np.array_equal(getattr(again.iteration, name), getattr(learned, name))
    assert np.any(learned.learned_mps != known.iteration().learned_mps)


def test_other_parameters_answer_differently(study: Path) -> None:
    recording = recording_of(study, WHO, "A2")
    again = pldf.replay(
        recording, open_route("study"), parameters={"planner.accel_min_mps2": -0.8}
    ).recording
    assert np.any(again["base_mps"] != recording["base_mps"])
    assert np.array_equal(again["speed_mps"], recording["speed_mps"])  # the car is the recorded one
    assert again.notes == ()


def test_a_recording_without_the_lever_is_refused_with_what_it_lacks(study: Path) -> None:
    recording = recording_of(study, WHO, "A2")
    columns = {n: v for n, v in recording.columns.items() if not n.startswith("lever_")}
    with pytest.raises(ModelError, match="not recorded: lever_resume, lever_cancel"):
        pldf.replay(Recording(columns), open_route("study"))


def test_inputs_that_may_be_missing_are_told(study: Path) -> None:
    recording = recording_of(study, WHO, "A2")
    columns = {n: v for n, v in recording.columns.items() if not n.startswith("lead_")}
    again = pldf.replay(Recording(columns), open_route("study")).recording
    (note,) = again.notes
    assert "lead_present, lead_gap_m, lead_speed_mps" in note.text
