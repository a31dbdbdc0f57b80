"""A small simulated study, and what its report shows."""

from __future__ import annotations

from pathlib import Path

import pytest
from built_once import once
from pldf.analysis.analysis import analyse
from pldf.analysis.study_folder import StudyFolder
from pldf.cli import main
from pldf.report.contents import Contents, collect
from pldf.report.page import report_of

STUDY = """title = "Three <people>"
[participants]
count = 3
seed = 4
[recordings]
participants = ["P001"]
"""
LONG_RUN = """variant,phase,pedal_percent,set_speed_percent,combined_percent,\
wish_error_kmh,drive_wish_error_kmh,content_percent
gain 1,B1,22,30,50,9,9.5,0
gain 1,B2,12,14,24,6,7,10
gain 0.5,B1,22,30,50,9,9.5,0
gain 0.5,B2,10,12,20,5,6,20
"""
# Satisfying items alone: A is annoying, B nice.
QUESTIONNAIRE = """participant,system,laan_2,laan_4,laan_6,laan_8
P001,A,4,4,2,2
P001,B,2,2,4,5
P002,A,3,4,2,3
P002,B,2,1,5,4
P003,A,5,4,1,2
P003,B,3,2,4,4
"""


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of three simulated drivers, the first one recorded."""

    def drive(out: Path) -> None:
        (out / "three.toml").write_text(STUDY)
        study = ["study", str(out / "three.toml"), "--out", str(out / "out"), "--jobs", "1"]
        assert main(study) == 0
        (out / "out" / "long_run.csv").write_text(LONG_RUN)
        (out / "out" / "questionnaire.csv").write_text(QUESTIONNAIRE)

    return once(tmp_path_factory, "reported_study", drive) / "out"


@pytest.fixture(scope="session")
def contents(folder: Path) -> Contents:
    return collect(analyse(StudyFolder(folder)), StudyFolder(folder))


@pytest.fixture(scope="session")
def html(contents: Contents) -> str:
    return report_of(contents)
