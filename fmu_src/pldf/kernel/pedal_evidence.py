"""What the pedals said, weighed: which places they teach, which have to wait (section 6).

``work`` holds, per node: a = speed wished; b = marks of the pieces, then the numbers of what is
accepted; c = the profile before the pedals' lessons; e = of which intervention's run the node is;
f = sign of the wish shown in this drive, twice that where it had been accepted before; g = what is
to be learned.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, TraceArrays, Work
from .codes import OUTCOME_LEARNED, OUTCOME_PENDING
from .evidence import (
    EVIDENCE,
    FASTER,
    MEAN,
    PENDING,
    SLOWER,
    demonstrate,
    is_accepted,
    is_unjudged,
    lowered,
    of_pedals,
    raised,
    settle,
)
from .pieces import FREE
from .segments import AS_PLANNED
from .state import PldfState


def recognize_lessons(
    st: PldfState, known: ProfileArrays | NextArrays, following: NextArrays
) -> None:
    """Count as accepted what was learned without evidence, by FAITHFUL (decision)."""
    for i in range(len(following.learned_mps)):
        sign = learned_at_once(st, known, i)
        if sign != 0:
            of_pedals(following, sign)[EVIDENCE][i] = st.learning_evidence_accept


def learned_at_once(st: PldfState, known: ProfileArrays | NextArrays, i: int) -> int:
    """Return the sign of what was learned at node ``i`` without evidence, 0 if nothing was."""
    if known.lessons[i] <= 0.0:
        return 0
    if not is_unjudged(of_pedals(known, FASTER), of_pedals(known, SLOWER), i):
        return 0
    return _sign(known.learned_mps[i] - known.planned_mps[i], st.learning_deviation_min_mps)


def _sign(change_mps: float, threshold_mps: float) -> int:
    if abs(change_mps) <= threshold_mps:
        return 0
    return FASTER if change_mps > 0.0 else SLOWER


def weigh_pedals(st: PldfState, trace: TraceArrays, work: Work, following: NextArrays) -> None:
    """Count this pass at each node: a demonstration of its sign, silence, or neither.

    Neither counts where nothing may be learned, or where the function did not drive.
    """
    _find_signs(st, work)
    for i in range(st.first_node, st.first_node + st.nodes):
        sign = int(work.f[i])
        if sign != 0:
            _count_demonstration(st, work, following, i, sign)
            _count_silence(st, following, i, -sign)
        elif _is_silent(st, trace, work, i):
            _count_silence(st, following, i, FASTER)
            _count_silence(st, following, i, SLOWER)


def _find_signs(st: PldfState, work: Work) -> None:
    """Fill ``work.f``: where a wish hardly differs from the profile, its run's sign counts."""
    n = len(work.e)
    i = 0
    while i < n:
        last = i
        total = 0.0
        while last < n and work.e[last] > 0.0:
            total += work.a[last] - work.c[last]
            last += 1
        whole = FASTER if total >= 0.0 else SLOWER
        for j in range(i, last):
            own = _sign(work.a[j] - work.c[j], st.learning_deviation_min_mps)
            work.f[j] = float(own if own != 0 else whole)
        i = last + 1


def _is_silent(st: PldfState, trace: TraceArrays, work: Work, i: int) -> bool:
    """Tell whether the function drove node ``i`` and the driver let it."""
    counts = work.b[i] == FREE and work.e[i] == 0.0 and trace.active[i] > 0.0
    return counts and trace.speed_mps[i] >= st.learning_speed_min_mps


def _count_demonstration(
    st: PldfState, work: Work, following: NextArrays, i: int, sign: int
) -> None:
    counter = of_pedals(following, sign)
    if is_accepted(counter, i):
        work.f[i] = 2.0 * sign
        counter[EVIDENCE][i] = st.learning_evidence_accept
    else:
        counter[EVIDENCE][i] = raised(st, counter[EVIDENCE][i])
    demonstrate(counter, i, work.a[i])


def _count_silence(st: PldfState, following: NextArrays, i: int, sign: int) -> None:
    counter = of_pedals(following, sign)
    if counter[PENDING][i] > 0.0:
        evidence = lowered(st, counter[EVIDENCE][i])
        if evidence > 0.0:
            counter[EVIDENCE][i] = evidence
        else:
            settle(counter, i, 0.0)


def accept_pedals(st: PldfState, work: Work, following: NextArrays) -> None:
    """Fill ``work.g`` with what is learned, number its nodes in ``work.e``, tell what waits."""
    for i in range(len(work.b)):
        work.b[i] = 0.0
    for sign in (FASTER, SLOWER):
        _accept_runs(st, work, following, sign)
    for i in range(len(work.e)):
        if work.e[i] > 0.0 and work.b[i] <= 0.0:
            _tell_waiting(work, following, i, int(work.e[i]) - 1)
    for i in range(len(work.e)):
        if work.b[i] > 0.0:
            following.outcome[int(work.b[i]) - 1] = OUTCOME_LEARNED
        work.e[i] = work.b[i]


def _tell_waiting(work: Work, following: NextArrays, i: int, k: int) -> None:
    """Note that intervention ``k`` waits, with the highest evidence that it has got."""
    if following.outcome[k] != OUTCOME_PENDING:
        following.outcome[k] = OUTCOME_PENDING
        following.proof[k] = 0.0
    sign = FASTER if work.f[i] > 0.0 else SLOWER
    following.proof[k] = max(following.proof[k], of_pedals(following, sign)[EVIDENCE][i])


def _accept_runs(st: PldfState, work: Work, following: NextArrays, sign: int) -> None:
    """Judge each run of nodes with pending demonstrations of ``sign``.

    A run ends where what is accepted of the opposite sign begins or ends: that takes two of its
    own to go back.
    """
    pending, opposite = of_pedals(following, sign)[PENDING], of_pedals(following, -sign)
    n = len(work.b)
    i = 0
    while i < n:
        behind = i
        against = is_accepted(opposite, i)
        while behind < n and pending[behind] > 0.0 and is_accepted(opposite, behind) == against:
            behind += 1
        if behind > i:
            _judge_run(st, work, following, sign, (i, behind - 1))
        i = max(behind, i + 1)


def _judge_run(
    st: PldfState, work: Work, following: NextArrays, sign: int, ends: tuple[int, int]
) -> None:
    """Accept the run as a whole if this drive demonstrates it and half its metres are accepted.

    Else only those are learned that had been accepted before.
    """
    evidence = of_pedals(following, sign)[EVIDENCE]
    reached = 0
    number = 0.0
    for i in range(ends[0], ends[1] + 1):
        reached += 1 if evidence[i] >= st.learning_evidence_accept else 0
        if number == 0.0 and sign * work.f[i] > 0.0:
            number = work.e[i]
    whole = number > 0.0 and 2 * reached >= ends[1] + 1 - ends[0]
    for i in range(ends[0], ends[1] + 1):
        number = work.e[i] if sign * work.f[i] > 0.0 else number
        other = sign * work.f[i] < 0.0 or work.b[i] > 0.0
        if not other and (whole or work.f[i] == 2.0 * sign):
            _accept_node(st, work, following, i, sign)
            work.b[i] = number


def _accept_node(st: PldfState, work: Work, following: NextArrays, i: int, sign: int) -> None:
    """Decide what node ``i`` gets: eq. (3), or the plan back where the opposite was accepted."""
    counter, opposite = of_pedals(following, sign), of_pedals(following, -sign)
    if is_accepted(opposite, i):
        work.g[i] = following.planned_mps[i]
        work.f[i] = AS_PLANNED
        settle(counter, i, 0.0)
        settle(opposite, i, 0.0)
        return
    # The plan may have changed since: a wish to go faster never slows.
    change = counter[MEAN][i] - work.c[i]
    change = max(change, 0.0) if sign == FASTER else min(change, 0.0)
    work.g[i] = work.c[i] + st.learning_weight * change
    settle(counter, i, st.learning_evidence_accept)


def drop_evidence(work: Work, following: NextArrays) -> None:
    """Forget evidence where a lesson was learned at once: it has overtaken what was pending."""
    for i in range(len(work.e)):
        if work.e[i] > 0.0:
            settle(of_pedals(following, FASTER), i, 0.0)
            settle(of_pedals(following, SLOWER), i, 0.0)
