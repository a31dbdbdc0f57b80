"""FMUs that nobody has built are built when they are first needed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from pldf.build import first_use, fmus
from pldf.build.first_use import fmus_to_drive
from pldf.build_version import build_version
from pldf.cosim.which_fmus import choose_fmus
from pldf.errors import ModelError

ARCHIVES = {f"{name}.fmu" for name in fmus.FMUS}


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, the current one, with the user's cache in ``cache``."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "cache"))
    return tmp_path


def test_they_are_built_once_and_it_says_so(
    empty: Path, capsys: pytest.CaptureFixture[str], fmu_folder: Path
) -> None:
    choice = fmus_to_drive()
    said = capsys.readouterr()
    assert said.err.startswith("pldf: no FMUs in dist; building them")
    assert str(choice.folder) in said.err
    assert choice.folder.parent == empty / "cache"
    assert build_version() in choice.folder.name
    assert {path.name for path in choice.folder.iterdir()} == ARCHIVES
    for name in ARCHIVES:
        assert (choice.folder / name).read_bytes() == (fmu_folder / name).read_bytes()
    assert choose_fmus(choice.folder).notes == ()  # up to date
    assert fmus_to_drive(kind="python") == choice
    assert capsys.readouterr().err == ""
    assert [path.name for path in (empty / "cache").iterdir()] == [choice.folder.name]


def test_what_somebody_built_or_named_wins(empty: Path, fmu_folder: Path) -> None:
    assert fmus_to_drive(fmu_folder).folder == fmu_folder
    (empty / "dist").symlink_to(fmu_folder)
    assert fmus_to_drive().folder == Path("dist")
    with pytest.raises(ModelError, match="no native FMUs are there"):
        fmus_to_drive(kind="native")
    with pytest.raises(ModelError, match="no Python FMUs are there"):
        fmus_to_drive(empty / "elsewhere", "python")
    assert not (empty / "cache").exists()


def test_a_folder_that_lacks_one_is_not_passed_over(empty: Path) -> None:
    (empty / "dist").mkdir()
    (empty / "dist" / "AdaptivePLDF.fmu").touch()
    with pytest.raises(ModelError, match="no Python FMUs are there"):
        fmus_to_drive(kind="python")
    assert not (empty / "cache").exists()


def test_other_content_has_another_folder(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = first_use.cached_folder()
    monkeypatch.setattr(first_use, "version", lambda _: "99")
    assert first_use.cached_folder() != before


def test_of_two_processes_that_build_at_once_both_drive_with_the_same(empty: Path) -> None:
    code = "from pldf.build.first_use import fmus_to_drive as f; print(f().folder)"
    command = [sys.executable, "-c", code]
    both = [
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    results = [process.communicate() for process in both]
    assert [process.returncode for process in both] == [0, 0], results
    folders = {Path(out.strip()) for out, _ in results}
    assert [path for path in (empty / "cache").iterdir()] == [*folders]


def test_who_comes_second_leaves_what_is_there(tmp_path: Path) -> None:
    made, target = tmp_path / "made", tmp_path / "target"
    for folder in (made, target):
        folder.mkdir()
        (folder / "x").write_text(folder.name)
    first_use.put(made, target)
    assert (target / "x").read_text() == "target"
    with pytest.raises(OSError, match="missing"):
        first_use.put(made, tmp_path / "missing" / "target")


def test_a_cache_that_cannot_be_written_has_a_way_out(
    empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (empty / "file").touch()
    monkeypatch.setenv("PLDF_CACHE", str(empty / "file"))
    with pytest.raises(ModelError, match="set PLDF_CACHE to a folder that can be written, or run"):
        fmus_to_drive()


def test_a_build_that_fails_leaves_nothing(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ValueError("no such compiler")

    monkeypatch.setattr(fmus, "build_python", fail)
    with pytest.raises(ModelError, match="cannot be built: no such compiler"):
        fmus_to_drive()
    assert os.listdir(empty / "cache") == []
