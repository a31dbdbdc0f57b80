"""Where what can be made again is kept."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from platformdirs import user_cache_dir
from pldf.cache import user_cache


def test_the_environment_decides_else_the_platform(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLDF_CACHE", str(tmp_path))
    assert user_cache() == tmp_path
    monkeypatch.setenv("PLDF_CACHE", "")
    assert user_cache() == Path(user_cache_dir("pldf", appauthor=False))
    monkeypatch.delenv("PLDF_CACHE")
    assert user_cache() == Path(user_cache_dir("pldf", appauthor=False))


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="a convention of Linux")
def test_linux_has_its_own_variable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PLDF_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert user_cache() == tmp_path / "pldf"
