"""Node.js for the tests of the page's JavaScript: that of the development packages."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def node(*arguments: object, given: str = "") -> subprocess.CompletedProcess[str]:
    """Run Node.js in the project's folder; skipped, or failed in CI, without its packages.

    Args:
        arguments: of Node.js.
        given: its standard input.
    """
    program = shutil.which("node", path=str(Path(sys.executable).parent)) or shutil.which("node")
    if program is None or not (ROOT / "node_modules").exists():
        assert not os.environ.get("PLDF_CI"), "CI checks the JavaScript: make lint installs"
        pytest.skip("no packages of Node.js: make lint installs them")
    return subprocess.run(
        [program, *map(str, arguments)],
        cwd=ROOT, input=given, capture_output=True, encoding="utf-8", check=False,
    )  # fmt: skip
