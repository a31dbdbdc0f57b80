"""``pldf doctor``: one block for a bug report, and what is broken is an error."""

from __future__ import annotations

import shutil
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pldf.build
import pytest
from pldf import __version__, cli
from pldf.build import first_use
from pldf.build_version import build_version
from pldf.commands import doctor
from pldf.profiles.store import write_profile
from two_readings import lesson, newer_reading, older_reading

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, the current one, with a cache of its own and no store."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("pldf.cockpit.wasm_models.PACKED", tmp_path / "no wheel made this")
    monkeypatch.delenv("PLDF_PROFILE_STORE", raising=False)
    return tmp_path


def examined(capsys: Capture, status: int = 0) -> dict[str, str]:
    """Return the lines of the block by title, and what is said on stderr as ``error``."""
    assert cli.main(["doctor"]) == status
    captured = capsys.readouterr()
    found: dict[str, str] = {"error": captured.err}
    title = ""
    for line in captured.out.splitlines():
        title = line[:10].strip() or title
        found[title] = f"{found[title]}\n{line[11:]}" if title in found else line[11:]
    return found


def without(monkeypatch: pytest.MonkeyPatch, *missing: str, **other: str) -> None:
    """Let packages be missing or have other versions."""

    def pretended(name: str) -> str:
        if name in missing:
            raise PackageNotFoundError(name)
        return other.get(name) or version(name)

    monkeypatch.setattr(doctor, "version", pretended)


def test_it_says_what_is_installed_and_where(empty: Path, capsys: Capture) -> None:
    found = examined(capsys)
    assert found["pldf"].startswith(f"{__version__}, in ")
    assert sys.executable in found["Python"]
    for name in ("numpy", "numba", "fmpy", "pythonfmu", "scipy", "platformdirs"):
        assert f"{name} {version(name)}" in found["packages"]
    assert "missing" not in found["extras"]
    for line in ("native: lief 1.0.0, ", "parquet: pyarrow ", "mdf: asammdf ", "cluster: distrib"):
        assert line in found["extras"]
    assert found["compiler"] == f"zig for native FMUs: {version('ziglang').partition('.post')[0]}"
    assert found["sources"] == build_version()
    assert found["FMUs"].startswith(f"none yet; the first drive builds them into {empty / 'cache'}")
    assert found["cockpit"].startswith("none yet; 'pldf cockpit' compiles its FMUs")
    assert found["profiles"].startswith("PLDF_PROFILE_STORE is not set")
    assert found["cache"].startswith(str(empty / "cache"))
    assert found["error"] == ""
    assert not [*empty.iterdir()]  # it changes nothing


def test_a_missing_extra_is_no_error_and_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    without(monkeypatch, "ziglang", "pyarrow", numba="0.99.0")
    found = examined(capsys)
    native, parquet = found["extras"].splitlines()[-2:]
    assert "numba 0.99.0 is not ==" in native
    assert "ziglang is missing; if you need it: pip install 'adaptive-pldf[native]'" in native
    assert parquet == (
        "parquet: pyarrow is missing; if you need it: pip install 'adaptive-pldf[parquet]'"
    )
    assert found["compiler"].startswith("none for native FMUs")
    assert found["cockpit"].startswith("no FMUs as WebAssembly; compiling them needs the extra")


def test_a_missing_or_old_dependency_is_an_error(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    without(monkeypatch, "plotly", scipy="1.2.0")
    found = examined(capsys, status=1)
    assert "BROKEN: plotly is missing; run: pip install adaptive-pldf" in found["packages"]
    assert "BROKEN: scipy 1.2.0 is not >=" in found["packages"]
    assert found["error"].startswith("pldf: plotly is missing; ")
    assert "scipy 1.2.0 is not >=" in found["error"]


def test_it_lives_without_what_the_fmus_need(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.delattr(pldf.build, "first_use", raising=False)
    monkeypatch.setitem(sys.modules, "pldf.build.first_use", None)
    assert examined(capsys, status=1)["FMUs"].startswith("BROKEN: ")


def test_it_says_which_fmus_would_drive(empty: Path, fmu_folder: Path, capsys: Capture) -> None:
    (empty / "dist").symlink_to(fmu_folder)
    assert examined(capsys)["FMUs"] == f"python, in {fmu_folder.resolve()}"
    (empty / "dist").unlink()
    first_use.cached_folder().mkdir(parents=True)
    assert examined(capsys)["FMUs"] == f"Python, in {first_use.cached_folder()}"


def test_fmus_that_cannot_drive_are_an_error(empty: Path, capsys: Capture) -> None:
    (empty / "dist").mkdir()
    for name in ("AdaptivePLDF", "LongitudinalVehicle", "ScriptedDriver"):
        (empty / "dist" / f"{name}.fmu").write_text("no archive")
    found = examined(capsys, status=1)
    assert "not a usable FMU" in found["FMUs"]
    assert "build it again" in found["error"]


def test_a_profile_store_is_looked_into(
    empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setenv("PLDF_PROFILE_STORE", str(empty / "store"))
    assert examined(capsys)["profiles"] == f"0 in {empty / 'store'}, 0 put aside as unusable"
    for route in (older_reading(), newer_reading()):
        profile = lesson(route)[1]
        write_profile(empty / "store" / f"{profile.route}.pldf", profile)
    names = sorted(path.name for path in (empty / "store").glob("*.pldf"))
    found = examined(capsys)["profiles"]
    assert found.startswith("2 in ")
    assert f"{names[0]} and {names[1]} are probably of one road, read in two ways" in found
    shutil.rmtree(empty / "store")
    (empty / "store").touch()  # a file is no store
    found = examined(capsys, status=1)
    assert "cannot be written" in found["profiles"]
    assert "PLDF_PROFILE_STORE" in found["error"]


def test_a_cache_that_cannot_be_written_is_no_error_but_said(
    empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    (empty / "file").touch()
    monkeypatch.setenv("PLDF_CACHE", str(empty / "file"))
    found = examined(capsys)
    assert f"{empty / 'file'} cannot be written" in found["cache"]
    assert "set PLDF_CACHE" in found["cache"]
