"""Native or Python FMUs: which ones drive, and what a person is told of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from pldf import cli
from pldf.build_version import build_version, native_making
from pldf.cosim import kinds, which_fmus
from pldf.cosim.which_fmus import Choice, choose_fmus
from pldf.errors import ModelError

Make = Callable[[], None]


@pytest.fixture(scope="module")
def built(fmu_folder: Path, native_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder as ``pldf build`` leaves it when it was asked for both kinds."""
    folder = tmp_path_factory.mktemp("both")
    for source, place in ((fmu_folder, folder), (native_folder, folder / "native")):
        place.mkdir(exist_ok=True)
        for path in source.glob("*.fmu"):
            shutil.copy(path, place)
    return folder


@pytest.fixture
def stale(monkeypatch: pytest.MonkeyPatch) -> Make:
    """Return a function after which the sources have changed since the FMUs were built."""
    return lambda: monkeypatch.setattr(which_fmus, "build_version", lambda: "0.1.0+0123456789ab")


@pytest.fixture
def other_runtime(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Return a function after which native FMUs would be made by what has this digest."""
    return lambda digest: monkeypatch.setattr(which_fmus, "native_making", lambda: digest)


@pytest.fixture
def elsewhere(monkeypatch: pytest.MonkeyPatch) -> Make:
    """Return a function after which this is a platform that the native FMUs were not built for."""
    return lambda: monkeypatch.setattr(which_fmus, "PLATFORM", "x86_64-windows")


def refused(folder: Path, kind: kinds.Kind | None = None) -> str:
    with pytest.raises(ModelError) as caught:
        choose_fmus(folder, kind)
    return str(caught.value)


def test_native_fmus_drive_when_they_are_there(built: Path) -> None:
    assert choose_fmus(built) == Choice("native", built / "native")
    assert choose_fmus(built, "native") == Choice("native", built / "native")
    assert choose_fmus(built, "python") == Choice("python", built)


def test_the_folder_of_the_native_ones_may_be_named(built: Path) -> None:
    native = built / "native"
    assert choose_fmus(native) == choose_fmus(native, "native") == Choice("native", native)
    told = refused(native, "python")
    assert told.startswith(f"{native}: no Python FMUs are there; ")
    assert f"'pldf build --out {built}'" in told
    assert told.endswith("or drive with --fmu native")


def test_without_native_ones_python_ones_drive(fmu_folder: Path) -> None:
    assert choose_fmus(fmu_folder) == Choice("python", fmu_folder)
    told = refused(fmu_folder, "native")
    assert told.startswith(f"{fmu_folder / 'native'}: no native FMUs are there; ")
    assert f"'pldf build --native --out {fmu_folder}'" in told
    assert told.endswith("or drive with --fmu python")


def test_native_ones_must_be_complete(built: Path, tmp_path: Path) -> None:
    shutil.copytree(built, tmp_path, dirs_exist_ok=True)
    (tmp_path / "native" / "ScriptedDriver.fmu").unlink()
    assert choose_fmus(tmp_path) == Choice("python", tmp_path)


def test_native_ones_of_older_sources_are_passed_over(built: Path, stale: Make) -> None:
    stale()
    kind, folder, (passed_over, python) = choose_fmus(built)
    assert (kind, folder) == ("python", built)
    assert passed_over == (
        f"{built / 'native'}: made from other sources than those installed, so the Python FMUs "
        f"drive; build them anew with 'pldf build --native --out {built}'"
    )
    assert python == (
        f"{built}: made from other sources than those installed; "
        f"build them anew with 'pldf build --out {built}'"
    )


def test_older_sources_are_no_hindrance_for_who_asks_for_them(built: Path, stale: Make) -> None:
    stale()
    for kind in kinds.KINDS:
        chosen, _, (note,) = choose_fmus(built, kind)
        assert chosen == kind
        assert "made from other sources than those installed; build them anew" in note
    assert refused(built / "native").endswith(", or drive with them: --fmu native")


def test_native_ones_with_an_older_c_runtime_are_passed_over(
    built: Path, other_runtime: Callable[[str], None]
) -> None:
    """The Python ones have none."""
    other_runtime("0123456789ab")
    kind, _, (note,) = choose_fmus(built)
    assert kind == "python"
    assert f"{built / 'native'}: made from other sources than those installed" in note
    assert choose_fmus(built, "python").notes == ()
    other_runtime("")  # the package alone is installed, without the C sources
    assert choose_fmus(built) == Choice("native", built / "native")


def test_native_ones_for_other_platforms_are_passed_over(built: Path, elsewhere: Make) -> None:
    elsewhere()
    kind, _, (note,) = choose_fmus(built)
    assert kind == "python"
    assert "not for this platform (x86_64-windows), so the Python FMUs drive" in note
    for folder, chosen in ((built, "native"), (built / "native", None)):
        told = refused(folder, chosen)
        assert "not for this platform (x86_64-windows)" in told
        assert "pldf build --native" in told
        assert "--fmu native" not in told


@pytest.mark.parametrize("platform", ["aarch64-linux", "riscv64-freebsd"])
def test_nobody_is_sent_to_build_what_cannot_be(
    platform: str, built: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """FMI 2.0 knows no such platform, or nobody does."""
    monkeypatch.setattr(which_fmus, "PLATFORM", platform)
    assert choose_fmus(built) == choose_fmus(built, "python") == Choice("python", built)
    for folder, kind in ((built, "native"), (built / "native", None), (built / "native", "python")):
        assert refused(folder, kind) == (
            f"{folder}: native FMUs of FMI 2.0 do not exist for this platform ({platform}); build "
            f"Python FMUs with 'pldf build --out {built}' and drive with --fmu python"
        )


def test_the_usual_folder_is_not_named_in_the_command(
    built: Path, tmp_path: Path, stale: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    stale()
    shutil.copytree(built, tmp_path / "dist")
    monkeypatch.chdir(tmp_path)
    _, _, notes = choose_fmus(kinds.USUAL_FOLDER)
    assert [note.rsplit("with ", 1)[1] for note in notes] == [
        "'pldf build --native'",
        "'pldf build'",
    ]


def test_the_fmus_built_here_are_up_to_date(built: Path) -> None:
    for path in built.rglob("*.fmu"):
        described = which_fmus.describe(path)
        assert which_fmus.up_to_date(described)
        assert described.version == build_version()
        if path.parent.name == "native":
            assert described.generationTool.endswith(f", native {native_making()}")


@pytest.mark.parametrize("kind", [None, *kinds.KINDS])
def test_a_drive_says_what_drives(
    kind: str | None,
    built: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("road.csv").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n200,0,20\n")
    drive = ["drive", "--fmus", str(built), "--driver", "none", "--route", "road.csv"]
    assert cli.main([*drive, *(["--fmu", kind] if kind else [])]) == 0
    told = capsys.readouterr()
    place = built if kind == "python" else built / "native"
    assert told.out.startswith(f"FMUs       {kind or 'native'}, in {place}\nrecording  ")
    assert told.err == ""


def test_a_drive_warns_of_older_sources_and_goes_on(
    built: Path,
    tmp_path: Path,
    stale: Make,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    stale()
    Path("road.csv").write_text("s_m,curvature_per_m,speed_limit_mps\n0,0,20\n200,0,20\n")
    drive = ["drive", "--fmus", str(built), "--driver", "none", "--route", "road.csv"]
    assert cli.main([*drive, "--fmu", "native"]) == 0
    told = capsys.readouterr()
    assert told.err.startswith(f"pldf: {built / 'native'}: made from other sources")
    assert told.err.count("\n") == 1
