"""What was learned on one reading of a road, carried over to another reading of it.

Metre by metre from the start: a profile knows no coordinates. Where the base profile is as before,
everything stays to the bit. Where it changed, the learned speed keeps its difference to the base
profile and is bounded by the caps of the road as it is read now, with the kernel's own functions.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from .errors import ModelError
from .function import DrivingFunction
from .instance import view
from .kernel.arrays import FloatArray
from .kernel.bounds import keep_bounds, mark_violations
from .kernel.learning import SAME_PLAN_MPS
from .kernel.lowering import UNMARKED
from .profiles.older_reading import is_older_reading, nodes_alike
from .profiles.stored_profile import COLUMN_NAMES, Iteration, StoredProfile
from .roads import Route, fingerprint

Nodes = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Moved:
    """A profile on the new reading, and what became of what was learned.

    Attributes:
        profile: all iterations, on the road as it is read now.
        older_base_mps: newest base profile of the old reading, as far as the new one goes, then the
            new one's.
        changed: nodes whose base profile changed, or that are new.
        cut_mps: per node, by how much a bound lowered the newest iteration's carried speed.
    """

    profile: StoredProfile
    older_base_mps: FloatArray
    changed: Nodes
    cut_mps: FloatArray


def move_profile(
    stored: StoredProfile, route: Route, function: DrivingFunction, *, force: bool = False
) -> Moved:
    """Return ``stored`` on ``route``, which is its road read otherwise.

    Args:
        stored: what was learned on the older reading.
        route: the road as it is read now.
        function: its parameters count for the base profile and the bounds; it is prepared here.
        force: move even if the base profiles do not look as if they were of one road.

    Raises:
        ModelError: there is nothing to move, or it does not look like the same road.
    """
    function.prepare(route)
    base = np.array(function.profile.base_mps)
    _require_movable(stored, route, base, force=force)
    older = _fitted(stored.iteration().base_mps, base)
    changed = np.abs(base - older) > SAME_PLAN_MPS
    changed[stored.nodes :] = True
    carry = _Carry(function, base, older, changed)
    first = carry.base(_fitted(stored.base_mps, base))
    moved = StoredProfile(stored.driver_id, fingerprint(route), first)
    cut_mps = np.zeros(len(base))
    for iteration in stored.iterations:
        carried, cut_mps = carry.iteration(iteration)
        moved = moved.with_iteration(carried)
    return Moved(moved, older, changed, cut_mps)


def _require_movable(
    stored: StoredProfile, route: Route, base_mps: FloatArray, *, force: bool
) -> None:
    of = f"the profile of driver {stored.driver_id}"
    if stored.route == fingerprint(route) and stored.nodes == route.nodes:
        raise ModelError(
            f"{of} was learned on this reading of {route.name} ({stored.route}): there is nothing "
            "to move, the function finds it as it is"
        )
    if not stored.iterations:
        raise ModelError(f"{of} holds nothing learned: there is nothing to move")
    older_mps = stored.iteration().base_mps
    if force or is_older_reading(older_mps, base_mps):
        return
    both = min(len(older_mps), len(base_mps))
    raise ModelError(
        f"{of} ({stored.nodes - 1} m) and {route.name} ({route.nodes - 1} m) do not look like the "
        f"same road: {100 * nodes_alike(older_mps, base_mps) // both} % of the base profile is "
        "alike. Name the road and options it was learned with (--set for its parameters); if it "
        "is the same road all the same: --force"
    )


@dataclass(frozen=True, eq=False)
class _Carry:
    """Carries iterations over to the road on which ``function`` is prepared."""

    function: DrivingFunction
    base_mps: FloatArray  # of the new reading
    older_mps: FloatArray  # of the old one, as long
    changed: Nodes

    def base(self, was_mps: FloatArray) -> FloatArray:
        """Return the base profile of an iteration that had ``was_mps``.

        Other parameters may have planned it than the newest one: that is kept where it can be.
        """
        return np.where(self.changed | (was_mps == self.older_mps), self.base_mps, was_mps)

    def iteration(self, iteration: Iteration) -> tuple[Iteration, FloatArray]:
        """Return the iteration on the new reading, and by how much a bound lowered it per node."""
        columns = dict(_columns(iteration, len(self.base_mps)))
        was = _fitted(iteration.base_mps, self.base_mps)
        learned = _fitted(iteration.learned_mps, self.base_mps)
        columns["base_mps"] = base = self.base(was)
        taught = learned != was
        slowest = np.minimum(base, self.function.record.learning_speed_min_mps)
        kept = np.where(self.changed, np.maximum(base + (learned - was), slowest), learned)
        columns["learned_mps"] = carried = np.where(taught, kept, base)
        wished = carried.copy()
        self._keep_bounds(columns, taught)
        return replace(iteration, **cast(dict[str, Any], columns)), wished - carried

    def _keep_bounds(self, columns: dict[str, FloatArray], taught: Nodes) -> None:
        """Lower the speeds in ``columns`` where the new reading demands it.

        That is what was taught where the base profile changed, and what exceeds a cap or a slope
        there or beside it: what was learned elsewhere keeps its bits.
        """
        st, route, work = self.function.record, self.function.route, self.function.work
        speed, marks = view(columns["learned_mps"]), np.asarray(work.b)
        mark_violations(st, route, speed, work.b)
        beside = self.changed.copy()
        beside[1:] |= self.changed[:-1]
        beside[:-1] |= self.changed[1:]
        marked = (self.changed & taught) | (beside & (marks != UNMARKED))
        # What is lowered around a node gets its mark: so its source is known.
        marks[:] = np.where(marked, 1.0 + np.arange(len(marks)), UNMARKED)
        keep_bounds(st, route, speed, view(columns["bound"]), work)
        joined = np.flatnonzero((marks != UNMARKED) & ~marked & (columns["drive"] == 0.0))
        for name in ("drive", "intervention", "lessons"):
            columns[name][joined] = columns[name][marks[joined].astype(np.intp) - 1]


def _columns(iteration: Iteration, nodes: int) -> Iterator[tuple[str, FloatArray]]:
    """Yield all arrays of an iteration with ``nodes`` values, zeros behind the old end."""
    for name in COLUMN_NAMES:
        yield name, _fitted(getattr(iteration, name), np.zeros(nodes))


def _fitted(values: FloatArray, behind: FloatArray) -> FloatArray:
    """Return ``values`` up to the length of ``behind``, whose values follow on a shorter array."""
    fitted = behind.copy()
    both = min(len(values), len(behind))
    fitted[:both] = values[:both]
    return fitted
