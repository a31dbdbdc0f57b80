"""The driver's last word on a file: forget a place, undo a lesson (section 7), without a road."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelError
from ..instance import view, views, zeros
from ..kernel.arrays import FloatArray, NextArrays, ProfileArrays, RouteArrays, Work
from ..kernel.bounds import keep_bounds
from ..kernel.lowering import UNMARKED
from ..kernel.state import PldfState
from ..kernel.undo import mark_lesson, merge_before
from .learned_columns import LEARNED, fill
from .lessons import UNDO_NOTE, lessons_in_force
from .stored_profile import StoredProfile

# Per cell: the metre behind the last node that is forgotten keeps what it has.
_PER_CELL: Final = tuple(name for name in LEARNED if name.startswith("offset_"))
_NOWHERE_MPS: Final = 1e3  # a cap that binds nothing


def forgotten(profile: StoredProfile, from_m: float, to_m: float) -> StoredProfile:
    """Return ``profile`` with a new iteration in which nothing is learned between two places.

    The file knows no limits and no curves, so the speed beside the place is only lowered: to what
    the planner's acceleration, deceleration and jerk need to come down to the base profile.
    The same profile is returned if nothing is learned there.

    Raises:
        ModelError: the places are not on the road, or in the wrong order.
    """
    last = profile.nodes - 1
    if not 0.0 <= from_m < to_m <= last:
        raise ModelError(
            f"from {from_m:g} to {to_m:g} m: no piece of this road, which goes from 0 to {last} m; "
            "give --from below --to"
        )
    nodes = slice(int(np.ceil(from_m)), int(to_m) + 1)
    newest = profile.iteration()
    columns = {name: getattr(newest, name).copy() for name in LEARNED}
    for name, column in columns.items():
        column[slice(nodes.start, nodes.stop - 1) if name in _PER_CELL else nodes] = 0.0
    columns["learned_mps"][nodes] = newest.base_mps[nodes]
    number = len(profile.iterations) + 1
    eased = _eased(columns["learned_mps"], columns["bound"], nodes)
    changed = eased | (columns["learned_mps"] != newest.learned_mps)
    columns["drive"][changed] = number
    columns["intervention"][changed] = 0.0
    same = all(np.array_equal(columns[n], getattr(newest, n)) for n in LEARNED if n != "drive")
    if same and not changed.any():
        return profile
    note = f"forget {from_m:g} to {to_m:g} m"
    return profile.with_iteration(profile.next_iteration("forget", note, 0, columns))


def _eased(speed_mps: FloatArray, bound: FloatArray, nodes: slice) -> NDArray[np.bool_]:
    """Lower ``speed_mps`` around ``nodes`` as comfortably as the planner; return where."""
    st = PldfState()
    st.learning_accel_max_mps2 = st.planner_accel_max_mps2
    st.learning_accel_min_mps2 = st.planner_accel_min_mps2
    st.learning_jerk_max_mps3 = st.planner_jerk_max_mps3
    road = zeros(RouteArrays, len(speed_mps))
    np.asarray(road.limit_mps)[:] = _NOWHERE_MPS
    work = zeros(Work, len(speed_mps))
    marks = np.asarray(work.b)
    marks[nodes] = 1.0
    before = speed_mps.copy()
    keep_bounds(st, views(road), view(speed_mps), view(bound), views(work))
    lowered: NDArray[np.bool_] = (marks != UNMARKED) & (speed_mps != before)
    return lowered


def undone(profile: StoredProfile) -> tuple[StoredProfile, int]:
    """Return ``profile`` without its newest lesson that is in force, and that lesson's number.

    What was forgotten since stays forgotten. (``profile``, 0): no lesson is in force.
    """
    number = next(lessons_in_force(profile), 0)
    if number == 0:
        return profile, 0
    now, following = views(zeros(ProfileArrays, profile.nodes)), zeros(NextArrays, profile.nodes)
    work = views(zeros(Work, profile.nodes))
    fill(now, profile.iteration())
    np.asarray(now.base_mps)[:] = profile.iteration().base_mps
    fill(following, profile.iteration(number))
    mark_lesson(now, views(following), work, number)
    fill(following, profile.iteration(number - 1))
    merge_before(now, views(following), work)
    columns = {name: np.asarray(getattr(following, name)) for name in LEARNED}
    undo = profile.next_iteration("undo", UNDO_NOTE % number, 0, columns)
    return replace(profile, iterations=(*profile.iterations, undo)), number
