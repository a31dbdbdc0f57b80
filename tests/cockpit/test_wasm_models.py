"""The page's FMUs are packed, kept from before or compiled, and never those of other sources."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from pldf.build import fmus
from pldf.build_version import build_version
from pldf.cockpit import wasm_models
from pldf.cosim.kinds import WASM_FOLDER
from pldf.errors import ModelError

Build = Callable[[str, Path, Callable[[str], None]], list[Path]]


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with neither a packed set nor one in the user's cache."""
    monkeypatch.setattr(wasm_models, "PACKED", tmp_path / "packed")
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "cache"))
    return tmp_path


def building(wasm_folder: Path, built: list[str]) -> Build:
    """Return what stands in for the compilers: it copies what they have made, and notes it."""

    def build(name: str, out: Path, announce: Callable[[str], None]) -> list[Path]:
        built.append(name)
        (out / WASM_FOLDER).mkdir(exist_ok=True)
        names = [f"{name}{suffix}" for suffix in (".wasm", ".xml")]
        return [Path(shutil.copy(wasm_folder / n, out / WASM_FOLDER / n)) for n in names]

    return build


def never(name: str, out: Path, announce: Callable[[str], None]) -> list[Path]:
    raise AssertionError(f"{name} is there already")


def test_packed_modules_need_no_compiler(
    wasm_folder: Path, empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(wasm_folder, empty / "packed")
    monkeypatch.setattr(fmus, "build_wasm", never)
    found = wasm_models.wasm_models()
    assert set(found) == set(fmus.FMUS)
    for name, model in found.items():
        assert model.wasm == (wasm_folder / f"{name}.wasm").read_bytes()
        assert model.description == (wasm_folder / f"{name}.xml").read_bytes()
    assert not (empty / "cache").exists()


def test_modules_are_compiled_once_and_told(
    wasm_folder: Path, empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    built, told = list[str](), list[str]()
    monkeypatch.setattr(fmus, "build_wasm", building(wasm_folder, built))
    first = wasm_models.wasm_models(told.append)
    assert built == list(fmus.FMUS)
    assert told[0] == "[1/4] AdaptivePLDF as WebAssembly, which is kept"
    monkeypatch.setattr(fmus, "build_wasm", never)
    assert wasm_models.wasm_models(told.append) == first
    assert len(told) == 4


@pytest.mark.parametrize("how", ["other sources", "other making", "one is missing"])
def test_packed_modules_of_other_sources_are_passed_over(
    how: str, wasm_folder: Path, empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed = Path(shutil.copytree(wasm_folder, empty / "packed"))
    described = packed / "ScriptedDriver.xml"
    if how == "one is missing":
        described.unlink()
    elif how == "other sources":
        text = described.read_text(encoding="utf-8")
        described.write_text(text.replace(build_version(), "0.2.0+0123456789ab"), encoding="utf-8")
    else:
        monkeypatch.setattr(wasm_models, "native_making", lambda: "0123456789ab")
    built = list[str]()
    monkeypatch.setattr(fmus, "build_wasm", building(wasm_folder, built))
    if how == "other making":  # then what is compiled is of that making, here it cannot be
        with pytest.raises(AssertionError):
            wasm_models.wasm_models()
    else:
        wasm_models.wasm_models()
    assert built == list(fmus.FMUS)


def test_without_any_it_is_said_what_to_install(
    empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fmus, "EXTRA", ("lief", "no_such_compiler"))
    with pytest.raises(ModelError) as caught:
        wasm_models.wasm_models()
    said = str(caught.value)
    assert "the cockpit has no FMUs for its page" in said
    assert "no_such_compiler" in said
    assert "pip install 'adaptive-pldf[native]'" in said
