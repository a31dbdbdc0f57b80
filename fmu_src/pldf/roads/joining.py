"""The roads of a way, put behind each other."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from ..kernel.arrays import FloatArray
from .sampling import Joints, Stretch, jumps

# Between roads the reference line may move by lane widths while the lanes go straight on.
LINK_GAP_MAX_M: Final = 10.0


def joined(stretches: list[Stretch]) -> tuple[FloatArray, Joints]:
    """Return the knots of the whole way, float64 [6, knots], and all its joints.

    A border has two knots only where curvature or grade jump.

    Raises:
        ModelError: the line jumps where a road is linked to the next.
    """
    parts: list[FloatArray] = []
    joints = [stretches[0].joints]
    for before, behind in pairwise(stretches):
        end, start = before.columns[:, -1], behind.columns[:, 0]
        gap = float(np.hypot(*(start - end)[4:]))
        if gap > LINK_GAP_MAX_M:
            raise behind.place.error(
                behind.contents.leg.road,
                f"the line jumps by {gap:.3g} m at {start[0]:.6g} m of the route; correct x and y",
            )
        parts.append(before.columns if jumps(end, start) else before.columns[:, :-1])
        joints.append(behind.joints)
    columns = np.concatenate([*parts, stretches[-1].columns], axis=1)
    return columns, Joints(*(np.concatenate(values) for values in zip(*joints, strict=True)))
