"""What the lever said, weighed per limit segment (section 6).

The test is that of the pedals, with one pass per limit and drive. An offset is a number that the
driver chose: so what is accepted is adopted as it is, also where it goes against an older one
(decision), and where a drive set none, those that are pending in this limit wait on.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, TraceArrays
from .codes import OUTCOME_LEARNED, OUTCOME_PENDING, OUTCOME_TAKEN_BACK
from .evidence import (
    EVIDENCE,
    FASTER,
    MEAN,
    PENDING,
    SLOWER,
    Counter,
    demonstrate,
    is_accepted,
    is_unjudged,
    lowered,
    of_lever,
    raised,
    settle,
)
from .offsets import Drive, end_of_limit
from .state import PldfState

COUNTED_SHARE = 0.5  # of a limit's metres that the function has to drive for a pass to count


def recognize_offsets(st: PldfState, known: ProfileArrays, following: NextArrays) -> None:
    """Count as accepted what was adopted without evidence, by FAITHFUL (decision)."""
    for cell in range(len(following.offset_mps)):
        sign = offset_adopted_at_once(st, known, cell)
        if sign != 0:
            of_lever(following, sign)[EVIDENCE][cell] = st.learning_evidence_accept


def offset_adopted_at_once(st: PldfState, known: ProfileArrays, cell: int) -> int:
    """Return the sign of the offset adopted in ``cell`` without evidence, 0 if none was."""
    if not is_unjudged(of_lever(known, FASTER), of_lever(known, SLOWER), cell):
        return 0
    return _sign_of_change(st, known.offset_mps[cell])


def _sign_of_change(st: PldfState, change_mps: float) -> int:
    if abs(change_mps) <= st.learning_offset_tolerance_mps:
        return 0
    return FASTER if change_mps > 0.0 else SLOWER


def weigh_offsets(st: PldfState, drive: Drive) -> None:
    """Adopt what is accepted, put back what has to wait, limit by limit.

    ``drive`` is as ``adopt_offsets`` left it, with every offset adopted.
    """
    route, profile, trace, following, _ = drive
    nodes = len(route.limit_mps)
    for cell in range(nodes):
        following.offset_mps[cell] = profile.offset_mps[cell]
    first = 0
    while first < nodes:
        last = end_of_limit(route, first, nodes - 1)
        silent = _is_pass(st, trace, first, last) and not _is_barred(st, drive, first, last)
        for sign in (FASTER, SLOWER):
            if _is_set(st, drive, first, last, sign):
                _weigh_series(st, drive, first, last, sign)
            elif silent:
                _weigh_silence(st, of_lever(following, sign), first, last)
        first = last + 1


def _is_pass(st: PldfState, trace: TraceArrays, first: int, last: int) -> bool:
    """Tell whether the function drove enough of this limit, where learning was allowed."""
    counted = 0
    for cell in range(max(first, st.first_node), min(last + 1, st.first_node + st.nodes)):
        open_to_lessons = trace.eligible[cell] > trace.gap[cell] and trace.set_barred[cell] <= 0.0
        if open_to_lessons and trace.active[cell] > 0.0:
            counted += 1
    return counted >= COUNTED_SHARE * (last + 1 - first)


def _is_barred(st: PldfState, drive: Drive, first: int, last: int) -> bool:
    """Tell whether the lever was moved under this limit where learning was not allowed."""
    following = drive[3]
    barred = False
    for k in range(st.set_series):
        inside = first <= following.set_from_m[k] <= last
        weighed = following.set_outcome[k] in (OUTCOME_LEARNED, OUTCOME_TAKEN_BACK)
        barred = barred or (inside and not weighed)
    return barred


def _sign_of(st: PldfState, drive: Drive, cell: int) -> int:
    """Return the sign of the offset set for ``cell`` against the one that was known, 0 = none."""
    _, profile, _, following, series = drive
    if series[cell] <= 0.0:
        return 0
    wish = following.set_offset_mps[int(series[cell]) - 1]
    return _sign_of_change(st, wish - profile.offset_mps[cell])


def _is_set(st: PldfState, drive: Drive, first: int, last: int, sign: int) -> bool:
    found = False
    for cell in range(first, last + 1):
        found = found or _sign_of(st, drive, cell) == sign
    return found


def _weigh_series(st: PldfState, drive: Drive, first: int, last: int, sign: int) -> None:
    """Count a pass with presses of this sign; adopt their mean, or let them wait."""
    following, series = drive[3], drive[4]
    counter = of_lever(following, sign)
    accept = st.learning_evidence_accept
    evidence = raised(st, _highest(counter, first, last))
    if _is_limit_accepted(counter, first, last):
        evidence = accept
    for cell in range(first, last + 1):
        if _sign_of(st, drive, cell) == sign:
            k = int(series[cell]) - 1
            demonstrate(counter, cell, following.set_offset_mps[k])
            following.set_outcome[k] = OUTCOME_LEARNED if evidence >= accept else OUTCOME_PENDING
            following.set_proof[k] = evidence
    for cell in range(first, last + 1):
        if counter[PENDING][cell] > 0.0 and evidence < accept:
            counter[EVIDENCE][cell] = evidence
        elif counter[PENDING][cell] > 0.0:
            following.offset_mps[cell] = counter[MEAN][cell]
            settle(counter, cell, accept)
            settle(of_lever(following, -sign), cell, 0.0)


def _highest(counter: Counter, first: int, last: int) -> float:
    highest = 0.0
    for cell in range(first, last + 1):
        highest = max(highest, counter[EVIDENCE][cell])
    return highest


def _is_limit_accepted(counter: Counter, first: int, last: int) -> bool:
    accepted = False
    for cell in range(first, last + 1):
        accepted = accepted or is_accepted(counter, cell)
    return accepted


def _weigh_silence(st: PldfState, counter: Counter, first: int, last: int) -> None:
    """Count a pass without a press of this sign for what is pending."""
    for cell in range(first, last + 1):
        if counter[PENDING][cell] > 0.0:
            evidence = lowered(st, counter[EVIDENCE][cell])
            if evidence > 0.0:
                counter[EVIDENCE][cell] = evidence
            else:
                settle(counter, cell, 0.0)


def drop_offset_evidence(drive: Drive) -> None:
    """Forget evidence under each limit whose offset was adopted at once."""
    route, _, _, following, series = drive
    nodes = len(route.limit_mps)
    first = 0
    while first < nodes:
        last = end_of_limit(route, first, nodes - 1)
        adopted = False
        for cell in range(first, last + 1):
            adopted = adopted or series[cell] > 0.0
        for cell in range(first, last + 1):
            if adopted:
                settle(of_lever(following, FASTER), cell, 0.0)
                settle(of_lever(following, SLOWER), cell, 0.0)
        first = last + 1
