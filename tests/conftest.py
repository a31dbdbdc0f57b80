"""Fixtures that several test modules share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pldf.study.fmu import Fmu
from pldf.study.master import unpacked

import build_fmu


@pytest.fixture(scope="session")
def fmu_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the three FMUs, built and validated once per test run."""
    folder = tmp_path_factory.mktemp("dist")
    assert build_fmu.main(["--out", str(folder)]) == 0
    return folder


@pytest.fixture(scope="session")
def fmus(fmu_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three FMUs, unpacked once per test run."""
    with unpacked(fmu_folder) as found:
        yield found
