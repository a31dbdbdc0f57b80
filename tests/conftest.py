"""Fixtures that several test modules share: what is built is built once per test run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from built_once import once
from native_hosts import Hosts, native_archives
from pldf.study.fmu import Fmu
from pldf.study.master import unpacked

import build_fmu


@pytest.fixture(scope="session")
def fmu_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the three FMUs, validated by fmpy, and the study's SSP packages."""

    def build(folder: Path) -> None:
        assert build_fmu.main(["--out", str(folder)]) == 0

    return once(tmp_path_factory, "dist", build)


@pytest.fixture(scope="session")
def fmus(fmu_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three FMUs, unpacked."""
    with unpacked(fmu_folder) as found:
        yield found


@pytest.fixture(scope="session")
def native_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the native FMUs of this platform; those for FMI 3.0 in ``fmi3``."""
    return native_archives(tmp_path_factory, "linux64")


@pytest.fixture(scope="session")
def native_fmus(native_folder: Path) -> Iterator[dict[str, Fmu]]:
    """Return the three native FMUs, unpacked."""
    with unpacked(native_folder) as found:
        yield found


@pytest.fixture(scope="session")
def hosts(tmp_path_factory: pytest.TempPathFactory) -> Hosts:
    """Return the C host and the native FMUs for every platform."""
    return Hosts(tmp_path_factory)
