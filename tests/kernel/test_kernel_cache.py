"""What was compiled is found again: by the source, wherever it lies."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest
from pldf.compiled import compile_modules

SOURCE = "def doubled(x):\n    return {} * x\n"


def doubled_in(folder: Path, factor: float) -> Any:
    """Return the compiled function of a module in ``folder`` after its first call."""
    folder.mkdir()
    path = folder / "doubling.py"
    path.write_text(SOURCE.format(factor), encoding="utf-8")
    spec = importlib.util.spec_from_file_location("doubling", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    doubled = compile_modules((module,))["doubled"]
    assert doubled(3.0) == factor * 3.0
    return doubled


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_a_second_checkout_compiles_nothing(tmp_path: Path, own_cache: Path) -> None:
    assert not doubled_in(tmp_path / "one", 2.0).stats.cache_hits
    kept = {path: path.stat().st_mtime_ns for path in own_cache.rglob("*.nb?")}
    assert kept
    again = doubled_in(tmp_path / "another", 2.0)
    assert sum(again.stats.cache_hits.values()) == 1
    assert {path: path.stat().st_mtime_ns for path in own_cache.rglob("*.nb?")} == kept


def test_what_another_source_gave_is_not_taken(tmp_path: Path) -> None:
    doubled_in(tmp_path / "one", 2.0)
    assert not doubled_in(tmp_path / "another", 2.5).stats.cache_hits


def test_without_a_cache_it_is_compiled_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path / "file"))
    assert not doubled_in(tmp_path / "one", 2.0).stats.cache_hits
