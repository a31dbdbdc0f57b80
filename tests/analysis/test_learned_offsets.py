"""Recordings of system B that do not say what the function had learned before the drive."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from driven_study import PEOPLE, driven_study, laboratory_of
from laboratory import road
from pldf.analysis.analysis import Analysis, analyse
from pldf.analysis.followed import Profiles
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.errors import ModelError
from pldf.profiles.store import read_profile, write_profile
from pldf.roads import open_route
from pldf.study.phases import PHASES

NOT_RECORDED = ("set_speed_offset_mps", "profile_mps", "base_mps", "limit_mps")


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return driven_study(tmp_path_factory)


@pytest.fixture
def laboratory(driven: Path, tmp_path: Path) -> Path:
    """Recordings as a laboratory has them, without a word on what was learned."""
    return laboratory_of(driven, tmp_path / "laboratory", *NOT_RECORDED)


def rates(found: Analysis) -> dict[tuple[str, str], tuple[float, ...]]:
    return {
        (d.participant, d.phase): (d.pedal_rate, d.set_speed_rate, d.combined_rate)
        for d in found.drives
    }


def refusal(study: StudyFolder) -> str:
    with pytest.raises(ModelError) as refused:
        analyse(study)
    return str(refused.value)


def test_without_profiles_all_drives_of_b_are_refused_in_one_error(laboratory: Path) -> None:
    told = refusal(StudyFolder(laboratory, open_route("study")))
    assert told.count("\n") == 0
    assert "P001_B1, P001_B2, P001_B3, P002_B1" in told
    assert "P003_B3" in told
    assert "_A" not in told
    assert "what the function had learned before is not known" in told
    assert "record set_speed_offset_mps, or name the folder of the learned profiles" in told


@pytest.mark.parametrize("beside", [True, False])
def test_with_profiles_the_rates_are_those_of_the_whole_recordings(
    driven: Path, laboratory: Path, beside: bool
) -> None:
    profiles = None if beside else driven / "profiles"
    if beside:
        shutil.copytree(driven / "profiles", laboratory / "profiles")
    found = analyse(StudyFolder(laboratory, open_route("study"), profiles=profiles))
    whole = laboratory_of(driven, laboratory / "whole")
    expected = rates(analyse(StudyFolder(whole)))
    for drive, three in rates(found).items():
        assert three == pytest.approx(expected[drive], abs=1e-9)
    assert [n.text for n in found.notes if n.text.startswith("followed iteration 2 of")]
    # Learned offsets are there: without them, B would have been set by the driver half the time.
    first = [read_profile(p).iterations[0].offset_mps for p in (driven / "profiles").iterdir()]
    assert sum(np.mean(np.abs(offset) > 0.3) > 0.2 for offset in first) >= 2


def test_profiles_by_name_and_those_that_do_not_tell(driven: Path, tmp_path: Path) -> None:
    route = open_route("study")
    names = sorted((driven / "profiles").iterdir())
    profile = read_profile(names[0])
    store = tmp_path / "store"
    store.mkdir()
    write_profile(store / "anna.pldf", profile)
    profiles = Profiles(store, route, list(PHASES.values()))
    counts = [len(profiles.followed("anna", phase).iterations) for phase in ("B1", "B2", "B3")]
    assert counts == [1, 2, 3]
    with pytest.raises(ModelError, match=r"no ben.pldf, which is what ben taught"):
        profiles.followed("ben", "B1")
    with pytest.raises(ModelError, match=r"neither P09.pldf nor driver-000009_route"):
        profiles.followed("P09", "B1")
    shutil.copy(names[0], store)
    fresh = Profiles(store, route, list(PHASES.values()))
    fresh.followed("P1", "B1")
    with pytest.raises(ModelError, match="meant for both P1 and Q1"):
        fresh.followed("Q1", "B1")
    with pytest.raises(ModelError, match="which one B7 followed cannot be told"):
        fresh.followed("P1", "B7")
    write_profile(store / "carl.pldf", profile.rolled_back(1))
    with pytest.raises(ModelError, match="iteration 4 is of kind rollback"):
        profiles.followed("carl", "B1")
    with pytest.raises(ModelError, match="learned on route"):
        Profiles(store, road(2000.0), list(PHASES.values())).followed("anna", "B1")


def test_a_profile_that_is_missing_is_named_for_each_participant(
    driven: Path, laboratory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(driven / "profiles", laboratory / "profiles")
    for path in sorted((laboratory / "profiles").iterdir())[1:]:
        path.unlink()
    assert main(["analyse", str(laboratory), "--route", "study"]) == 1
    told = capsys.readouterr().err
    assert "P002.pldf nor driver-000002" in told
    assert "P003.pldf nor driver-000003" in told
    assert "P001" not in told
    assert not (laboratory / "analysis").exists()
    assert set(PEOPLE) == {"P001", "P002", "P003"}
