"""How a communication step is divided, in all models alike."""

from __future__ import annotations

SUBSTEP_MAX_S = 0.010
# Importers make steps by subtracting times, so a step of 100 ms may be longer by a rounding: that
# is no reason for an eleventh part.
SUBSTEP_ROUNDING = 1e-6


def substep_count(step_s: float) -> int:
    """Return into how many equal parts of at most 10 ms a step of ``step_s`` > 0 is divided."""
    return max(int(step_s / SUBSTEP_MAX_S + 1.0 - SUBSTEP_ROUNDING), 1)
