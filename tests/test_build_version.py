"""The version that says which results an FMU gives."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest
from pldf import __version__
from pldf.build_version import build_version

import build_fmu

PACKAGES = {"pldf": "fmu_src/pldf", "vehicle_models": "vehicle_models"}


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Return a folder with a copy of both packages."""
    for name, place in PACKAGES.items():
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(build_fmu.ROOT / place, tmp_path / name, ignore=ignored)
    return tmp_path


def version_of(copy: Path) -> str:
    """Return what the copied sources say."""
    code = "from pldf.build_version import build_version; print(build_version(), end='')"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


def changed(copy: Path, file: str) -> str:
    """Return the version after one more line in ``file``."""
    path = copy / file
    text = path.read_text()
    path.write_text(text + "# more\n")
    try:
        return version_of(copy)
    finally:
        path.write_text(text)


def test_it_is_the_package_version_and_a_digest() -> None:
    assert re.fullmatch(re.escape(__version__) + r"\+[0-9a-f]{12}", build_version())


def test_it_is_the_same_wherever_the_sources_are(copy: Path) -> None:
    assert version_of(copy) == build_version()


def test_it_is_the_same_with_other_line_ends(copy: Path) -> None:
    for path in copy.rglob("*.py"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert version_of(copy) == build_version()


@pytest.mark.parametrize(
    "file",
    [
        "pldf/kernel/planner.py",
        "pldf/kernel/parameters.py",
        "pldf/roads/data/study_road.csv",
        "pldf/roads/route.py",
        "pldf/function.py",
        "vehicle_models/vehicle_kernel.py",
        "vehicle_models/driver_state.py",
        "vehicle_models/scripts/brake_for_village.csv",
    ],
)
def test_it_changes_with_what_decides_results(copy: Path, file: str) -> None:
    assert changed(copy, file) != build_version()


@pytest.mark.parametrize(
    "file",
    [
        "pldf/cli.py",
        "pldf/fmi/slave.py",
        "pldf/native/build.py",
        "pldf/store.py",
        "pldf/study/runner.py",
        "vehicle_models/native.py",
    ],
)
def test_it_does_not_change_with_what_carries_values(copy: Path, file: str) -> None:
    assert changed(copy, file) == build_version()


def test_python_fmus_carry_it(fmu_folder: Path) -> None:
    """Native ones too: ``test_native_description.py``."""
    for name in build_fmu.FMUS:
        archive = zipfile.ZipFile(fmu_folder / f"{name}.fmu")
        root = fromstring(archive.read("modelDescription.xml"))
        assert root.attrib["version"] == build_version()
        assert not [member for member in archive.namelist() if "build_version" in member]
