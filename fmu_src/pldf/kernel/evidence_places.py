"""Which places gained or lost evidence in a drive, for its log (section 6)."""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays
from .codes import (
    BY_LEVER,
    BY_PEDALS,
    EVIDENCE_ACCEPTED,
    EVIDENCE_DROPPED,
    EVIDENCE_GAINED,
    EVIDENCE_LOST,
    EVIDENCE_PUT_BACK,
    EVIDENCE_SAME,
)
from .evidence import (
    EVIDENCE,
    FASTER,
    PENDING,
    SLOWER,
    Counter,
    is_accepted,
    of_lever,
    of_pedals,
)
from .lever_evidence import offset_adopted_at_once
from .pedal_evidence import learned_at_once
from .state import PldfState


def find_places(st: PldfState, profile: ProfileArrays, following: NextArrays) -> None:
    """Note each run of nodes, or cells, whose evidence changed in the same way.

    ``profile`` holds what was known before; the number of places goes into
    ``st.evidence_places``.
    """
    st.evidence_places = 0
    for sign in (FASTER, SLOWER):
        _find_changes(st, profile, following, BY_PEDALS, sign)
    for sign in (FASTER, SLOWER):
        _find_changes(st, profile, following, BY_LEVER, sign)


def _find_changes(
    st: PldfState, profile: ProfileArrays, following: NextArrays, by: int, sign: int
) -> None:
    before = EVIDENCE_SAME
    for i in range(len(following.learned_mps)):
        change = _change_of(st, profile, following, (by, sign), i)
        if change != EVIDENCE_SAME:
            # There is room for one per node; more cannot be told.
            if change != before and st.evidence_places < len(following.place_from_m):
                _begin_place(st, following, (by, sign), change, i)
            _extend_place(st, following, (by, sign), i)
        before = change


def _begin_place(
    st: PldfState, following: NextArrays, test: tuple[int, int], change: int, i: int
) -> None:
    k = st.evidence_places
    following.place_by[k] = float(test[0])
    following.place_sign[k] = float(test[1])
    following.place_change[k] = float(change)
    following.place_from_m[k] = float(i)
    following.place_evidence[k] = 0.0
    st.evidence_places = k + 1


def _extend_place(st: PldfState, following: NextArrays, test: tuple[int, int], i: int) -> None:
    k = st.evidence_places - 1
    evidence = _counter_of(following, test)[EVIDENCE][i]
    following.place_to_m[k] = float(i)
    following.place_evidence[k] = max(following.place_evidence[k], evidence)


def _counter_of(arrays: ProfileArrays | NextArrays, test: tuple[int, int]) -> Counter:
    if test[0] == BY_PEDALS:
        return of_pedals(arrays, test[1])
    return of_lever(arrays, test[1])


def _change_of(
    st: PldfState, profile: ProfileArrays, following: NextArrays, test: tuple[int, int], i: int
) -> int:
    """Return what became of the evidence at ``i`` (EVIDENCE_CHANGE in codes)."""
    known, counter = _counter_of(profile, test), _counter_of(following, test)
    at_once = learned_at_once(st, profile, i)
    if test[0] == BY_LEVER:
        at_once = offset_adopted_at_once(st, profile, i)
    was_accepted = is_accepted(known, i) or at_once == test[1]
    if is_accepted(counter, i):
        return EVIDENCE_SAME if was_accepted else EVIDENCE_ACCEPTED
    if was_accepted:
        return EVIDENCE_PUT_BACK
    if counter[EVIDENCE][i] > known[EVIDENCE][i] or counter[PENDING][i] > known[PENDING][i]:
        return EVIDENCE_GAINED
    if counter[EVIDENCE][i] >= known[EVIDENCE][i]:
        return EVIDENCE_SAME
    if counter[EVIDENCE][i] > 0.0:
        return EVIDENCE_LOST
    opposite = (test[0], -test[1])
    used = is_accepted(_counter_of(profile, opposite), i)
    used = used and not is_accepted(_counter_of(following, opposite), i)
    return EVIDENCE_SAME if used else EVIDENCE_DROPPED  # what it put back is told there
