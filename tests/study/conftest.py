"""A small study that was driven once, by one process."""

from __future__ import annotations

from pathlib import Path

import pytest
from laboratory import files
from pldf import cli
from pldf.study.study_file import Study, read_study
from small_study import write_study


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with ``small.toml`` and its results in ``one``, driven by one process."""
    folder = tmp_path_factory.mktemp("finished")
    study = write_study(folder)
    assert cli.main(["study", str(study), "--out", str(folder / "one"), "--jobs", "1"]) == 0
    return folder


@pytest.fixture(scope="module")
def expected(finished: Path) -> dict[str, bytes]:
    return files(finished / "one")


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return read_study(write_study(tmp_path))
