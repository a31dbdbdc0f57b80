"""When a drive is over, and how finely it is driven: the same for FMUs and in process."""

from __future__ import annotations

from typing import Final

from ..kernel.units import KMH_PER_MPS

STEP_S: Final = 0.01
STANDSTILL_MPS: Final = 0.1
STANDSTILL_MAX_S: Final = 60.0
# Slower than this on average, a drive is given up.
SLOWEST_MPS: Final = 10.0 / KMH_PER_MPS
