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
from pldf.build import fmus as fmu_build
from pldf.build_version import build_version

ROOT = Path(__file__).parents[2]
PACKAGES = {"pldf": "fmu_src/pldf", "vehicle_models": "vehicle_models"}


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Return a folder with a copy of both packages."""
    for name, place in PACKAGES.items():
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / place, tmp_path / "packages" / name, ignore=ignored)
    return tmp_path / "packages"


def version_of(copy: Path, called: str = "build_version") -> str:
    """Return what the copied sources say."""
    code = f"from pldf import build_version; print(build_version.{called}(), end='')"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


def changed(copy: Path, file: str, called: str = "build_version") -> str:
    """Return the version after one more line in ``file``."""
    path = copy / file
    text = path.read_text()
    path.write_text(text + "# more\n")
    try:
        return version_of(copy, called)
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
        "pldf/build/native/archives.py",
        "pldf/profiles/store.py",
        "pldf/study/runner.py",
        "vehicle_models/native.py",
    ],
)
def test_it_does_not_change_with_what_carries_values(copy: Path, file: str) -> None:
    assert changed(copy, file) == build_version()


@pytest.mark.parametrize(
    "file",
    ["pldf/build/native/linking.py", "pldf/build/runtime/disk.c", "vehicle_models/native.py"],
)
def test_what_makes_native_fmus_has_its_own_digest(copy: Path, file: str) -> None:
    found = version_of(copy, "native_making")
    assert re.fullmatch(r"[0-9a-f]{12}", found)
    assert changed(copy, file, "native_making") != found
    assert changed(copy, file) == build_version()


def test_python_fmus_carry_it(fmu_folder: Path) -> None:
    """Native ones too: ``test_native_description.py``."""
    for name in fmu_build.FMUS:
        archive = zipfile.ZipFile(fmu_folder / f"{name}.fmu")
        root = fromstring(archive.read("modelDescription.xml"))
        assert root.attrib["version"] == build_version()
        assert not [member for member in archive.namelist() if "build_version" in member]
