"""Type checkers see what the installed wheel offers; run by ``tests/test_wheel.py``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def test_type_checkers_know_the_api(tmp_path: Path) -> None:
    (tmp_path / "use.py").write_text(
        "import pldf\n"
        "reveal_type(pldf.base_profile(pldf.open_route('study')))\n"
        "pldf.drive(phase=3)\n"
        "pldf.steer()\n",
        encoding="utf-8",
    )
    said = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "use.py"],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=False,
    ).stdout
    assert 'Revealed type is "numpy.ndarray[' in said
    assert "float64" in said or "floating" in said
    assert 'Argument "phase" to "drive" has incompatible type "int"' in said
    assert 'Module has no attribute "steer"' in said
    assert "Found 2 errors" in said
