"""Parameters that bound every profile, against those that the base profile is planned with."""

from __future__ import annotations

from typing import Final

from .errors import ModelError
from .kernel.signals import signals_of
from .kernel.state import PldfState

# Bounds of every profile, and what the base profile is planned with: it must keep to them. Where 0
# is in the range of a parameter, it stands for no bound.
BOUNDS: Final = tuple(
    (f"learning_{bound}", f"planner_{bound}")
    for bound in ("lateral_accel_max_mps2", "accel_max_mps2", "accel_min_mps2", "jerk_max_mps3")
)


def check_bounds(st: PldfState) -> None:
    """Raise ModelError if a base profile could break the bounds of a learned one."""
    names = {signal.field: signal.name for signal in signals_of(st)}
    for bound, planned in BOUNDS:
        allowed, used = getattr(st, bound), getattr(st, planned)
        if _weaker(allowed, used):
            raise ModelError(
                f"parameter {names[bound]} = {allowed:g}: it bounds every profile, so it must "
                f"not be weaker than {names[planned]} = {used:g}"
            )


def _weaker(bound: float, used: float) -> bool:
    """Tell whether ``used`` goes beyond ``bound``; 0 is no bound."""
    return bound != 0.0 and (used == 0.0 or abs(used) > abs(bound))
