"""A study of a few participants and two drives, for tests of how studies run."""

from __future__ import annotations

from pathlib import Path

from pldf.study.results import StudyResults
from pldf.study.study_file import Study

TEXT = """
title = "a small study"
[participants]
count = {count}
seed = 5
[drives]
phases = ["A2", "B1"]
step_s = 0.05
[recordings]
participants = ["P002"]
"""
COUNT = 6


def write_study(folder: Path, count: int = COUNT) -> Path:
    path = folder / "small.toml"
    path.write_text(TEXT.format(count=count), encoding="utf-8")
    return path


def opened(study: Study, out: Path) -> StudyResults:
    folder = StudyResults(study, out)
    folder.open(restart=False)
    return folder
