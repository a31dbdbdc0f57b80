"""The installed wheel in an empty folder; run by ``tests/test_wheel.py`` with its interpreter.

Nothing here may import from the source tree or from the other tests: there is none.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import files, version
from pathlib import Path

import pldf
import pytest

import vehicle_models

COMMAND = Path(sys.executable).with_name("pldf.exe" if sys.platform == "win32" else "pldf")
FMUS = {
    "AdaptivePLDF.fmu",
    "LeadVehicle.fmu",
    "LongitudinalVehicle.fmu",
    "ScriptedDriver.fmu",
}
PHASES = {"A1", "A2", "A3", "B1", "B2", "B3"}
PACKAGES = {f"study_{traffic}{phase}.ssp" for traffic in ("", "traffic_") for phase in PHASES}


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, the current one, without a profile store."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PLDF_PROFILE_STORE", raising=False)
    return tmp_path


def run(*command: object, cache: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command; what it builds on first use goes into ``cache``."""
    environment = {**os.environ, "PYTHONUTF8": "1"}
    if cache is not None:
        environment["PLDF_CACHE"] = str(cache)
    return subprocess.run(
        [str(word) for word in command],
        env=environment,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


def good(*command: object, cache: Path | None = None) -> str:
    """Run a command that must succeed; return what it printed."""
    result = run(*command, cache=cache)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_both_packages_come_from_the_wheel_and_nothing_else_is_in_reach() -> None:
    site = Path(sys.prefix).resolve()
    for package in (pldf, vehicle_models):
        assert site in Path(str(package.__file__)).resolve().parents
        assert "site-packages" in Path(str(package.__file__)).parts
    places = [Path(entry) for entry in sys.path if (Path(entry) / "pldf").is_dir()]
    assert places == [Path(str(pldf.__file__)).parents[1]]
    assert "PYTHONPATH" not in os.environ
    assert not any((folder / "pyproject.toml").exists() for folder in Path.cwd().parents)


def test_the_wheel_holds_types_licence_and_citation() -> None:
    names = {str(file) for file in files("adaptive-pldf") or ()}
    assert {"pldf/py.typed", "pldf/__init__.pyi", "vehicle_models/py.typed"} <= names
    assert {Path(name).name for name in names if "licenses" in name} == {"LICENSE", "CITATION.cff"}
    assert not any("test" in name for name in names if name.endswith(".py"))


def test_both_ways_to_start_it_answer_with_the_version() -> None:
    answer = f"pldf {version('adaptive-pldf')}\n"
    assert good(COMMAND, "--version") == answer
    assert good(sys.executable, "-m", "pldf", "--version") == answer


def test_a_drive_builds_its_fmus_on_first_use_and_says_so(empty: Path) -> None:
    cache = empty / "cache"
    drive = (COMMAND, "drive", "--phase", "A2", "--store", "profiles", "--out", "A2.csv")
    first = run(*drive, cache=cache)
    assert first.returncode == 0, first.stderr
    (folder,) = cache.iterdir()
    assert {path.name for path in folder.iterdir()} == FMUS
    assert "no FMUs in dist; building them" in first.stderr
    recording = Path("A2.csv").read_bytes()
    second = run(*drive[:-1], "again.csv", cache=cache)
    assert (second.returncode, second.stderr) == (0, "")
    assert Path("again.csv").read_bytes() == recording
    assert len([*Path("profiles").glob("*.pldf")]) == 1


def test_fmus_and_packages_are_built_and_drive(empty: Path) -> None:
    good(COMMAND, "build")
    names = {path.name for path in Path("dist").iterdir()}
    assert names == FMUS | PACKAGES | {"inline"}
    assert {path.name for path in Path("dist", "inline").iterdir()} == PACKAGES
    cache = empty / "cache"
    assert "in dist" in good(COMMAND, "drive", "--phase", "A1", cache=cache)
    assert not cache.exists()


def test_one_driver_is_studied_with_pictures(empty: Path) -> None:
    good(COMMAND, "study", "--out", "one")
    assert len([*Path("one", "recordings").glob("*.csv")]) == 6
    assert [*Path("one").glob("*.png")]


def test_the_papers_study_is_driven_and_reported(empty: Path) -> None:
    good(COMMAND, "study", "paper", "--out", "paper")
    rows = Path("paper", "drives.csv").read_text("utf-8").splitlines()
    assert len([row for row in rows if not row.startswith("#")]) == 1 + 43 * 6
    good(COMMAND, "analyse", "paper", "--report", "report.html")
    assert Path("report.html").stat().st_size > 100_000


def test_native_fmus_are_built_with_the_extra(empty: Path) -> None:
    pytest.importorskip("ziglang", reason="the extra 'native' is not installed")
    good(COMMAND, "build", "--native", "--target", "linux64", "--only", "LongitudinalVehicle")
    assert {path.name for path in Path("dist", "native").glob("*.fmu")} == {
        "LongitudinalVehicle.fmu"
    }


@pytest.mark.parametrize("missing", ["lief", "llvmlite", "ziglang"])
def test_native_without_the_extra_names_it(empty: Path, missing: str) -> None:
    code = (
        f"import sys; sys.modules[{missing!r}] = None\n"
        "from pldf.cli import main; sys.exit(main(['build', '--native']))"
    )
    result = run(sys.executable, "-c", code)
    assert result.returncode == 1
    assert "pip install 'adaptive-pldf[native]'" in result.stderr
    assert not [*empty.rglob("*.fmu")]


@pytest.mark.parametrize("missing", ["lief", "ziglang"])
def test_the_cockpit_needs_no_compiler(empty: Path, missing: str) -> None:
    code = (
        f"import sys; sys.modules[{missing!r}] = None\n"
        "from pldf.cli import main; sys.exit(main(['cockpit', '--export', 'cockpit.html']))"
    )
    result = run(sys.executable, "-c", code, cache=empty / "cache")
    assert result.returncode == 0, result.stdout + result.stderr
    assert Path("cockpit.html").stat().st_size > 1_000_000
    assert not [*empty.rglob("*.wasm")]  # those of the wheel, none made here


def test_the_cockpits_modules_come_with_their_licences() -> None:
    names = {Path(str(f)).name for f in files("adaptive-pldf") or () if "page/wasm/" in str(f)}
    assert {name for name in names if name.endswith(".wasm")} == {
        name.replace(".fmu", ".wasm") for name in FMUS
    }
    assert "LICENSES.txt" in names


def test_the_api_works(empty: Path) -> None:
    route = pldf.open_route("study")
    assert len(pldf.base_profile(route)) == route.nodes
    driven = pldf.drive("A2", store=empty / "profiles")
    learned = pldf.learn(driven.recording, route)
    (kept,) = Path("profiles").glob("*.pldf")
    assert pldf.read_profile(kept).iterations[0].note == learned.iteration.note
