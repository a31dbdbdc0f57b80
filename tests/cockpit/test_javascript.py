"""The tests of the page's modules that need no browser, in Node.js: a test file each."""

from __future__ import annotations

from pathlib import Path

import pytest
from node import node

TESTS = sorted((Path(__file__).parent / "javascript").glob("*.test.mjs"))


def test_there_are_tests() -> None:
    assert TESTS


@pytest.mark.parametrize("path", TESTS, ids=lambda path: path.name)
def test_the_modules_pass_their_tests(path: Path) -> None:
    result = node("--test", path)
    assert result.returncode == 0, result.stdout + result.stderr
