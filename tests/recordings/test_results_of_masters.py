"""What importers written by others log of our FMUs is read by the ready maps, by itself."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pldf.build.packages import start_values
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import drive
from pldf.recordings.columns import LABORATORY
from pldf.recordings.interventions import rates_of
from pldf.recordings.recording import Recording, read_recording
from pldf.study.phases import PHASES

SECONDS = 30.0
STEP_S = 0.01
SCRIPT = Path(__file__).parents[1] / "support" / "master_results.py"
ON_PYPI = pytest.mark.skipif(sys.platform == "darwin", reason="no such importers for macOS on PyPI")
RESULTS = {"fmpy": ("fmpy.csv", "fmpy.npy"), "libcosim": ("pldf_*.csv",), "ecos": ("ecos.csv",)}
# Six digits of libcosim, six decimals of ecos, and a step that inputs lag behind in these.
TOLERANCES = {"fmpy": 1e-9, "libcosim": 0.02, "ecos": 0.02}


@pytest.fixture(scope="module")
def ours(fmus: dict[str, Fmu], tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """Return our recording of drive A2."""
    values = start_values(PHASES["A2"], 1)
    values["pldf"]["profile_store"] = str(tmp_path_factory.mktemp("store"))
    return drive(fmus, values, 30.0 * SECONDS, STEP_S).recording


@ON_PYPI
@pytest.mark.parametrize("importer", RESULTS)
def test_a_result_is_read_as_what_was_driven(
    importer: str, ours: Recording, fmu_folder: Path, tmp_path: Path
) -> None:
    package = fmu_folder / "study_A2.ssp"
    (tmp_path / "results").mkdir()
    command = [sys.executable, SCRIPT, importer, package, str(SECONDS), tmp_path / "results"]
    environment = {**os.environ, "PLDF_PROFILE_STORE": str(tmp_path / "store")}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for pattern in RESULTS[importer]:
        (path,) = (tmp_path / "results").glob(pattern)
        read = read_recording(path)
        assert f"the map {importer}" in read.notes[0].text
        # What analysis needs; the lever and what the driver was told are in our own recordings.
        wanted = set(ours.columns) & set(LABORATORY.names) - {"eligible"}
        assert len(wanted) >= 10
        assert set(read.columns) >= wanted
        first = 0 if importer != "fmpy" else 1  # its first row is the end of the first step
        rows = slice(first + 100, first + len(read) - 2)
        for name in ("s_m", "speed_mps", "set_speed_mps", "profile_mps", "base_mps", "limit_mps"):
            mine = ours[name][rows]
            away = read[name][100 : 100 + len(mine)] - mine
            if name == "s_m":  # up to a step behind, the same all the time
                assert np.max(np.abs(away)) <= 1.01 * STEP_S * np.max(ours["speed_mps"])
            else:
                assert np.quantile(np.abs(away), 0.99) <= TOLERANCES[importer], name
        same = read["mode"][100 : 100 + len(ours["mode"][rows])] == ours["mode"][rows]
        assert np.mean(same) > 0.995
        cut = {name: values[rows] for name, values in ours.columns.items()}
        assert rates_of(read).combined == pytest.approx(rates_of(Recording(cut)).combined, abs=0.03)
