"""Packages and FMUs in importers written by others: the same curves, the same lessons."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple
from zipfile import ZipFile

import lone_fmu
import numpy as np
import pytest
from fmi_host import Host
from numpy.typing import NDArray
from pldf.build.packages import start_values
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import drive
from pldf.profiles.store import ProfileStore, StoredProfile
from pldf.roads import fingerprint, packed_route
from pldf.study.phases import PHASES
from ssp_masters import STEP_S

FloatArray = NDArray[np.float64]

FOLDER = Path(__file__).parents[1] / "support"
IMPORTERS = ("fmpy", "libcosim", "ecos")
COMPARED_FROM_S = 1.0  # before that, importers may differ in how they initialize
TOLERANCE_MPS = 1e-2
ON_PYPI = pytest.mark.skipif(sys.platform == "darwin", reason="no such importers for macOS on PyPI")


class Trial(NamedTuple):
    """Two drives for ``seconds`` with the FMUs in ``folder``: the second follows the first."""

    folder: Path
    fmus: Mapping[str, Fmu]
    first: str
    second: str
    seconds: float


@pytest.fixture(scope="module", params=["python", "native"])
def trial(request: pytest.FixtureRequest) -> Trial:
    """Native FMUs are quick enough for nearly the whole road."""
    native = "native_" if request.param == "native" else ""
    folder = request.getfixturevalue(f"{native or 'fmu_'}folder")
    fmus = request.getfixturevalue(f"{native}fmus")
    return Trial(folder, fmus, "A2", *(("B2", 170.0) if native else ("B1", 30.0)))


def stored(folder: Path) -> StoredProfile:
    route = packed_route(0)
    profile = ProfileStore(folder).load(1, fingerprint(route), route.nodes)
    assert profile is not None
    return profile


@pytest.fixture(scope="module")
def lesson(trial: Trial, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the store in which our first drive is learned."""
    return tmp_path_factory.mktemp("lesson")


@pytest.fixture(scope="module")
def speeds(
    trial: Trial, lesson: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, FloatArray]:
    """Return our speeds at the communication points of both drives."""
    found = {trial.first: driven(trial, trial.first, lesson)}
    copy = tmp_path_factory.mktemp("second")
    store = shutil.copytree(lesson, copy / "store")
    return {**found, trial.second: driven(trial, trial.second, store)}


def driven(
    trial: Trial, phase: str, store: Path, person: Mapping[str, float] | None = None
) -> FloatArray:
    values = start_values(PHASES[phase], list(PHASES).index(phase))
    values["pldf"]["profile_store"] = str(store)
    values["driver"].update(person or {})
    length_m = min(30.0 * trial.seconds, packed_route(0).nodes - 1.0)
    recording = drive(trial.fmus, values, length_m, STEP_S).recording
    assert recording["time_s"][-1] > trial.seconds
    return recording["speed_mps"]


def run(arguments: list[object], store: Path, out: Path) -> FloatArray:
    """Return what a script for importers writes into ``out``."""
    script, *rest = arguments
    command = [sys.executable, str(FOLDER / str(script)), *map(str, rest), str(out)]
    environment = {**os.environ, "PLDF_PROFILE_STORE": str(store)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows: FloatArray = np.load(out)
    return rows


@ON_PYPI
@pytest.mark.parametrize("importer", IMPORTERS)
def test_the_same_drives_in_another_importer(
    importer: str, trial: Trial, speeds: dict[str, FloatArray], lesson: Path, tmp_path: Path
) -> None:
    first, second = tmp_path / "first", shutil.copytree(lesson, tmp_path / "second")
    for phase, store in ((trial.first, first), (trial.second, second)):
        package = trial.folder / f"study_{phase}.ssp"
        arguments = ["ssp_masters.py", importer, package, trial.seconds]
        rows = run(arguments, store, tmp_path / f"{phase}.npy")
        step = np.rint(rows[:, 0] / STEP_S).astype(int)
        assert np.array_equal(step, np.arange(1, len(step) + 1))
        assert len(step) >= round(trial.seconds / STEP_S)
        difference = np.abs(rows[:, 1] - speeds[phase][step])[rows[:, 0] >= COMPARED_FROM_S]
        print(f"{importer}, {phase}: at most {np.max(difference):.1e} m/s apart")
        assert np.max(difference) < TOLERANCE_MPS
    ours, theirs = stored(lesson).iteration(1), stored(first).iteration(1)
    # Their drive ends before ours: compared is where both had driven.
    assert np.max(np.abs(theirs.learned_mps - ours.learned_mps)[:500]) < TOLERANCE_MPS
    assert len(stored(second).iterations) == 2


VARYING: dict[str, float] = {
    "person_seed": 77,
    "wish.offset_person_sd_mps": 1.0,
    "wish.offset_place_sd_mps": 0.8,
    "wish.offset_occasion_sd_mps": 0.6,
    "wish.lateral_person_sigma": 0.2,
    "wish.lateral_place_sigma": 0.15,
    "wish.lateral_occasion_sigma": 0.1,
}


def with_person(package: Path, folder: Path) -> Path:
    """Return a copy of ``package`` whose driver has the values of ``VARYING``."""
    edited = folder / package.name
    with ZipFile(package) as old, ZipFile(edited, "w") as new:
        for name in old.namelist():
            text = old.read(name)
            if name.endswith("driver.ssv"):
                text = _edited(text.decode()).encode()
            new.writestr(name, text)
    return edited


def _edited(values: str) -> str:
    written = f'name="person_seed">\n      <ssv:Integer value="{VARYING["person_seed"]}" />'
    values, count = re.subn(r'name="person_seed">\s*<ssv:Integer value="1" ?/>', written, values)
    assert count == 1
    more = "".join(
        f'<ssv:Parameter name="{name}"><ssv:Real value="{value}" /></ssv:Parameter>'
        for name, value in VARYING.items()
        if name != "person_seed"
    )
    return values.replace("</ssv:Parameters>", f"{more}</ssv:Parameters>")


@ON_PYPI
@pytest.mark.parametrize("importer", IMPORTERS)
def test_a_person_whose_wish_varies_drives_the_same_in_a_package(
    importer: str, trial: Trial, speeds: dict[str, FloatArray], tmp_path: Path
) -> None:
    ours = driven(trial, trial.first, tmp_path / "ours", VARYING)
    package = with_person(trial.folder / f"study_{trial.first}.ssp", tmp_path)
    arguments = ["ssp_masters.py", importer, package, trial.seconds]
    rows = run(arguments, tmp_path / "theirs", tmp_path / "out.npy")
    step = np.rint(rows[:, 0] / STEP_S).astype(int)
    after = rows[:, 0] >= COMPARED_FROM_S
    assert np.max(np.abs(rows[:, 1] - ours[step])[after]) < TOLERANCE_MPS
    assert np.max(np.abs(rows[:, 1] - speeds[trial.first][step])) > 0.5  # not the usual person


def test_what_was_learned_shows_in_the_second_drive(
    trial: Trial, speeds: dict[str, FloatArray], lesson: Path
) -> None:
    steps = round(trial.seconds / STEP_S)
    assert np.max(np.abs(speeds[trial.first][:steps] - speeds[trial.second][:steps])) > 0.5
    assert np.max(np.abs(stored(lesson).iteration(1).learned_mps - stored(lesson).base_mps)) > 1.0


@ON_PYPI
@pytest.mark.parametrize(("importer", "place"), [("libcosim", ""), ("ecos", ""), ("ecos", "fmi3")])
def test_a_native_fmu_alone_in_another_importer(
    importer: str, place: str, native_folder: Path, tmp_path: Path
) -> None:
    """In FMI 2.0 and, where the importer knows it, in FMI 3.0."""
    fmu = native_folder / place / "AdaptivePLDF.fmu"
    rows = run(["lone_fmu.py", importer, fmu], tmp_path, tmp_path / "rows.npy")
    slave = Host(native_folder / fmu.name, tmp_path / "unpacked").instantiate().start()
    expected = []
    for k in range(lone_fmu.STEPS):
        reals, resume = lone_fmu.inputs(k)
        given = dict(zip(lone_fmu.REALS_IN, reals, strict=True))
        slave.set(**{name.replace(".", "__"): value for name, value in given.items()})
        slave.set(**{lone_fmu.SWITCH.replace(".", "__"): resume})
        slave.fmu.doStep(k * STEP_S, STEP_S)
        expected.append([slave.get(name) for name in lone_fmu.REALS_OUT])
    slave.free()
    assert np.ptp(np.array(expected)[:, 0]) > 0.5
    # libcosim counts time in nanoseconds, so its steps are not quite ours.
    np.testing.assert_allclose(rows, expected, rtol=0.0, atol=1e-12)


@ON_PYPI
def test_a_package_of_fmi_3_fmus_drives_the_same_in_ecos(
    native_folder: Path, tmp_path: Path
) -> None:
    packages = {"fmi2": native_folder / "study_A2.ssp", "fmi3": tmp_path / "study_A2.ssp"}
    with ZipFile(packages["fmi2"]) as source, ZipFile(packages["fmi3"], "w") as made:
        for name in source.namelist():
            fmu = native_folder / "fmi3" / Path(name).name
            made.writestr(name, fmu.read_bytes() if fmu.suffix == ".fmu" else source.read(name))
    found = []
    for version, package in packages.items():
        arguments = ["ssp_masters.py", "ecos", package, 30.0]
        rows = run(arguments, tmp_path / version, tmp_path / f"{version}.npy")
        (profile,) = (tmp_path / version).iterdir()
        found.append((rows.tobytes(), profile.read_bytes()))
    assert found[0] == found[1]
