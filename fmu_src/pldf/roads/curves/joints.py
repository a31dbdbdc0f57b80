"""Where the pieces of a drawn line meet."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ...kernel.arrays import FloatArray


class Joints(NamedTuple):
    """Where a geometry ends and the next begins, one value per such place."""

    s_m: FloatArray  # on the route
    turn_rad: FloatArray  # jump of the heading, positive to the left
    line: FloatArray  # of the file, where the geometry behind it stands


NO_JOINTS: Final = Joints(np.zeros(0), np.zeros(0), np.zeros(0))
