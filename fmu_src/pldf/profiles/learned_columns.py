"""What of an iteration the kernel knows."""

from __future__ import annotations

from typing import Final

import numpy as np

from ..kernel.arrays import NextArrays, ProfileArrays
from .stored_profile import COLUMN_NAMES, Iteration

# What a drive leaves for the next one and a file keeps of it.
LEARNED: Final = tuple(name for name in NextArrays._fields if name in COLUMN_NAMES)


def fill(to: ProfileArrays | NextArrays, iteration: Iteration) -> None:
    """Copy the columns of ``iteration`` that the kernel knows."""
    for name in LEARNED:
        np.asarray(getattr(to, name))[:] = getattr(iteration, name)
