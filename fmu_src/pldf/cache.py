"""Where what can be made again is kept: compiled kernels, and FMUs that nobody has built."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from platformdirs import user_cache_path

CACHE_VARIABLE: Final = "PLDF_CACHE"


def user_cache() -> Path:
    """Return the folder: the environment variable's, else the platform's for this user."""
    chosen = os.environ.get(CACHE_VARIABLE)
    return Path(chosen) if chosen else user_cache_path("pldf", appauthor=False)
