"""What a report is made of, read from the folder of a study."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from pldf.analysis.analysis import analyse
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.errors import ModelError
from pldf.recordings.interventions import pedal_interventions
from pldf.report.contents import Contents, collect
from pldf.roads import fingerprint, packed_route, write_route_csv


def test_the_steps_of_the_intervention_fit_together(contents: Contents) -> None:
    assert contents.driver is not None
    steps = contents.driver.steps
    assert steps is not None
    end = steps.piece_m[-1]
    assert steps.stretched_m[-1] == end
    assert steps.joined_mps[-1] == pytest.approx(steps.recorded_mps[-1])
    start = steps.stretched_m[0]
    at = int(start - steps.node_m[0])
    assert steps.driven_mps[at] == pytest.approx(steps.joined_mps[0], abs=0.2)
    inside = (steps.node_m > start) & (steps.node_m < end)
    assert abs(steps.mean_mps - steps.followed_mps)[inside].max() > 0.5


def test_what_became_of_each_intervention_is_there(contents: Contents, html: str) -> None:
    """Of every drive that was learned from: simulated drives follow what those before taught."""
    driver = contents.driver
    assert driver is not None
    assert list(driver.outcomes) == ["A2", "B1", "B2"]
    for drive, told in driver.outcomes.items():
        count = len(pedal_interventions(driver.recordings[drive]))
        assert sum(line.startswith("pedal intervention ") for line in told) == count > 0
        for line in told:
            assert f"<li>{line.replace('-', '&minus;')}</li>" in html


def test_only_who_was_recorded_can_be_shown(folder: Path) -> None:
    with pytest.raises(ModelError, match=r"recordings/P002_A2.csv.*recorded are P001"):
        collect(analyse(StudyFolder(folder)), StudyFolder(folder), "P002")


def test_a_report_on_the_wrong_road_is_refused(folder: Path, tmp_path: Path) -> None:
    road = tmp_path / "road.csv"
    road.write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n4500,0,20\n")
    source = ["analyse", str(folder), "--route", str(road), "--report", str(tmp_path / "r.html")]
    assert main(source) == 1
    assert not (tmp_path / "r.html").exists()


def test_the_road_of_the_study_file_is_found_or_said_whole(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    shutil.copytree(folder, own)
    table = '[road]\nroute = "town.csv"\n'
    (own / "study.toml").write_text((own / "study.toml").read_text() + table)
    study = StudyFolder(own)
    with pytest.raises(ModelError, match=r"driven on town.csv, which is not there.*--route"):
        collect(analyse(study), study)
    write_route_csv(packed_route(0), own / "town.csv")
    found = collect(analyse(study), study).route.route
    assert (found.name, fingerprint(found)) == ("town", fingerprint(packed_route(0)))
    text = (own / "study.toml").read_text().replace("town.csv", "town.xodr")
    (own / "study.toml").write_text(text + 'start_road = 12\nto = "Main Street"\n')
    study = StudyFolder(own)
    with pytest.raises(ModelError, match=r"town.xodr \(start_road = 12, to = Main Street\)"):
        collect(analyse(study), study)
