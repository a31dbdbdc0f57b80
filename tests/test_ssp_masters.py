"""The SSP packages in importers written by others: the same curves, the same lessons."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from pldf.roads import fingerprint, packed_route
from pldf.store import ProfileStore, StoredProfile
from pldf.study.fmu import Fmu
from pldf.study.master import Course, drive
from pldf.study.packages import start_values
from pldf.study.phases import PHASES
from ssp_masters import STEP_S

FloatArray = NDArray[np.float64]

IMPORTERS = ("fmpy", "libcosim", "ecos")
SECONDS = 30.0
COMPARED_FROM_S = 1.0  # before that, importers may differ in how they initialize
TOLERANCE_MPS = 1e-2
FIRST, SECOND = "A2", "B1"  # learned; drives what was learned


def stored(folder: Path) -> StoredProfile:
    route = packed_route(0)
    profile = ProfileStore(folder).load(1, fingerprint(route), route.nodes)
    assert profile is not None
    return profile


@pytest.fixture(scope="module")
def lesson(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the store in which our first drive is learned."""
    return tmp_path_factory.mktemp("lesson")


@pytest.fixture(scope="module")
def speeds(
    fmus: Mapping[str, Fmu], lesson: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, FloatArray]:
    """Return our speeds at the communication points of both drives."""
    found = {}
    found[FIRST] = driven(fmus, FIRST, lesson)
    copy = tmp_path_factory.mktemp("second")
    found[SECOND] = driven(fmus, SECOND, shutil.copytree(lesson, copy / "store"))
    return found


def driven(fmus: Mapping[str, Fmu], phase: str, store: Path) -> FloatArray:
    values = start_values(PHASES[phase], list(PHASES).index(phase))
    values["pldf"]["profile_store"] = str(store)
    recording = drive(fmus, values, Course(length_m=30.0 * SECONDS, step_s=STEP_S)).recording
    assert recording["time_s"][-1] > SECONDS
    return recording["speed_mps"]


def run(importer: str, package: Path, store: Path, out: Path) -> FloatArray:
    """Return times and speeds after each step of ``package`` in an importer."""
    script = Path(__file__).with_name("ssp_masters.py")
    command = [sys.executable, str(script), importer, str(package), str(SECONDS), str(out)]
    environment = {**os.environ, "PLDF_PROFILE_STORE": str(store)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows: FloatArray = np.load(out)
    return rows


@pytest.mark.skipif(sys.platform == "darwin", reason="no such importers for macOS on PyPI")
@pytest.mark.parametrize("importer", IMPORTERS)
def test_the_same_drives_in_another_importer(
    importer: str, fmu_folder: Path, speeds: dict[str, FloatArray], lesson: Path, tmp_path: Path
) -> None:
    stores = {FIRST: tmp_path / "first", SECOND: shutil.copytree(lesson, tmp_path / "second")}
    for phase, store in stores.items():
        package = fmu_folder / f"study_{phase}.ssp"
        rows = run(importer, package, store, tmp_path / f"{phase}.npy")
        step = np.rint(rows[:, 0] / STEP_S).astype(int)
        assert np.array_equal(step, np.arange(1, len(step) + 1))
        assert len(step) >= round(SECONDS / STEP_S)
        difference = np.abs(rows[:, 1] - speeds[phase][step])[rows[:, 0] >= COMPARED_FROM_S]
        print(f"{importer}, {phase}: at most {np.max(difference):.1e} m/s apart")
        assert np.max(difference) < TOLERANCE_MPS
    ours, theirs = stored(lesson).iteration(1), stored(stores[FIRST]).iteration(1)
    # Their drive ends after 30 s, ours a little later: compared is where both had driven.
    assert np.max(np.abs(theirs.learned_mps - ours.learned_mps)[:500]) < TOLERANCE_MPS
    assert len(stored(stores[SECOND]).iterations) == 2


def test_what_was_learned_shows_in_the_second_drive(
    speeds: dict[str, FloatArray], lesson: Path
) -> None:
    steps = round(SECONDS / STEP_S)
    assert np.max(np.abs(speeds[FIRST][:steps] - speeds[SECOND][:steps])) > 0.5
    assert np.max(np.abs(stored(lesson).iteration(1).learned_mps - stored(lesson).base_mps)) > 1.0
