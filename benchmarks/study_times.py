"""How long studies take: ``pldf study`` as a person starts it, with machine code in the cache."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Final

from pldf.study.study_file import study_path

RUNS: Final = 5
MANY: Final = 1000


def study_times(runs: int = RUNS, many: int = MANY) -> dict[str, float]:
    """Return seconds of wall clock: the paper's study (median), and one of ``many`` drivers."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "many.toml")
        file.write_text(
            f'title = "Many"\n[participants]\ncount = {many}\nseed = 1\n', encoding="utf-8"
        )
        paper = str(study_path("paper"))
        rounds = [_wall_s(paper, folder) for _ in range(runs + 1)]  # the first one compiles
        return {
            "43 participants of the paper": median(rounds[1:]),
            f"{many} participants": _wall_s(str(file), folder),
        }


def _wall_s(file: str, folder: str) -> float:
    out = Path(folder, Path(file).stem)
    begin = perf_counter()
    subprocess.run(
        [sys.executable, "-m", "pldf", "study", file, "--out", str(out), "--restart"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return perf_counter() - begin
