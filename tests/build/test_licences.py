"""Each archive brings the licences of what it contains, and docs/licences.md lists them all."""

from __future__ import annotations

import io
import re
import zipfile
from importlib.metadata import files
from pathlib import Path

import pytest

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "licences.md").read_text()
PLACE = "documentation/licenses/"


def licences(archive: zipfile.ZipFile) -> dict[str, bytes]:
    return {
        Path(name).stem: archive.read(name) for name in archive.namelist() if name.startswith(PLACE)
    }


def installed(distribution: str) -> bytes:
    (found,) = {f for f in files(distribution) or () if f.name == "LICENSE"}
    return Path(str(found.locate())).read_bytes()


@pytest.mark.parametrize("kind", ["python", "native"])
def test_fmus_bring_the_licences_of_what_is_in_them(
    kind: str, fmu_folder: Path, native_folder: Path
) -> None:
    folder = fmu_folder if kind == "python" else native_folder
    others = "pythonfmu" if kind == "python" else "zig"
    archives = sorted(folder.rglob("*.fmu"))
    assert len(archives) >= 3
    for path in archives:
        with zipfile.ZipFile(path) as archive:
            texts = licences(archive)
            packages = {n.split("/")[1] for n in archive.namelist() if n.startswith("resources/py")}
        assert set(texts) == {"license", others}
        assert all(b"Permission is hereby granted" in text for text in texts.values())
        assert packages == ({"pythonfmu"} if kind == "python" else set())


def test_licence_texts_are_those_of_the_installed_packages(fmu_folder: Path) -> None:
    with zipfile.ZipFile(fmu_folder / "AdaptivePLDF.fmu") as archive:
        texts = licences(archive)
    assert texts["pythonfmu"] == installed("pythonfmu")
    assert texts["license"] == installed("adaptive-pldf")


def test_packages_bring_them_in_their_fmus(fmu_folder: Path) -> None:
    for path in sorted(fmu_folder.glob("*.ssp")):
        with zipfile.ZipFile(path) as package:
            inner = [name for name in package.namelist() if name.endswith(".fmu")]
            assert len(inner) == (4 if "traffic" in path.name else 3)
            for name in inner:
                with zipfile.ZipFile(io.BytesIO(package.read(name))) as archive:
                    assert "pythonfmu" in licences(archive)


def test_page_lists_every_licence_that_an_archive_brings(
    fmu_folder: Path, native_folder: Path
) -> None:
    named = set(re.findall(rf"`{PLACE}([\w-]+)\.txt`", PAGE))
    brought = set()
    for path in (*fmu_folder.glob("*.fmu"), *native_folder.rglob("*.fmu")):
        with zipfile.ZipFile(path) as archive:
            brought |= set(licences(archive))
    # Libraries for Windows are linked on request alone: build/native/archives.py.
    assert named == brought | {"mingw-w64"}
