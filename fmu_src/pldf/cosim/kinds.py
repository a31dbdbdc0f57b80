"""The two kinds of FMUs, and where ``pldf build`` puts them; commands need no more to begin."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Literal

Kind = Literal["native", "python"]
KINDS: Final[tuple[Kind, ...]] = ("native", "python")
# Where the native FMUs are: in the folder of the Python ones.
NATIVE_FOLDER: Final = "native"
USUAL_FOLDER: Final = Path("dist")
