"""Lowering one node of a learned profile, and what counts as marked (section 3.8)."""

from __future__ import annotations

from .arrays import Floats, Work

ROUNDING = 1e-9  # relative excess of v^2 that is rounding, not a violation
UNMARKED = 0.0  # this drive taught nothing here; above 0: 1 + number of the intervention


def lower(work: Work, bound: Floats, at: int, allowed: float, mark: float, code: int) -> int:
    """Lower the square of the speed in ``work.c[at]`` to ``allowed`` (m2/s2), if it is above.

    Args:
        work: ``b`` marks, ``c`` squares of speeds.
        bound: which bound cut a node last.
        at: the node.
        allowed: the bound; what exceeds it by rounding only stays.
        mark: of the nodes involved; UNMARKED: nothing is asked for.
        code: of the bound.

    Returns:
        1 if the node was lowered, else 0.
    """
    if mark == UNMARKED or work.c[at] <= allowed * (1.0 + ROUNDING):
        return 0
    work.c[at] = allowed
    bound[at] = code
    if work.b[at] == UNMARKED:
        work.b[at] = mark
    return 1
