"""Learning only what is consistent: the sequential test of one metre and sign (section 6).

Evidence is a sequential test of "intervenes here in 20 % of the passes" against "in 70 %". A pass
with an intervention of its sign adds ``learning_evidence_gain``, a pass without one takes
``learning_evidence_loss`` away; ``learning_evidence_accept`` accepts. What was demonstrated until
then is pending, as number and mean; evidence that falls to 0 drops it. So a place that is accepted
has evidence, and nothing pending.
"""

from __future__ import annotations

from .arrays import Floats, NextArrays, ProfileArrays
from .state import PldfState

FASTER = 1
SLOWER = -1


# The test of one sign, for the pedals per node, for the lever per cell: its evidence, the number of
# demonstrations that wait, and the mean of their speeds, for the lever of their offsets.
Counter = tuple[Floats, Floats, Floats]
EVIDENCE = 0
PENDING = 1
MEAN = 2


def of_pedals(arrays: ProfileArrays | NextArrays, sign: int) -> Counter:
    """Return the pedals' test of ``sign``, FASTER or SLOWER."""
    if sign == FASTER:
        return (arrays.evidence_faster, arrays.pending_faster, arrays.pending_faster_mps)
    return (arrays.evidence_slower, arrays.pending_slower, arrays.pending_slower_mps)


def of_lever(arrays: ProfileArrays | NextArrays, sign: int) -> Counter:
    """Return the lever's test of ``sign``, FASTER or SLOWER."""
    if sign == FASTER:
        return (
            arrays.offset_evidence_faster,
            arrays.offset_pending_faster,
            arrays.offset_pending_faster_mps,
        )
    return (
        arrays.offset_evidence_slower,
        arrays.offset_pending_slower,
        arrays.offset_pending_slower_mps,
    )


def is_accepted(counter: Counter, i: int) -> bool:
    """Tell whether the wish of this sign is accepted at ``i``: from then on silence is content."""
    return counter[EVIDENCE][i] > 0.0 and counter[PENDING][i] == 0.0


def is_unjudged(faster: Counter, slower: Counter, i: int) -> bool:
    """Tell whether neither test knows anything of ``i``: what is learned there needed none."""
    evidence = faster[EVIDENCE][i] + slower[EVIDENCE][i]
    return evidence + faster[PENDING][i] + slower[PENDING][i] == 0.0


def demonstrate(counter: Counter, i: int, value_mps: float) -> None:
    """Add a demonstration to those that are pending at ``i``."""
    counter[PENDING][i] += 1.0
    counter[MEAN][i] += (value_mps - counter[MEAN][i]) / counter[PENDING][i]


def raised(st: PldfState, evidence: float) -> float:
    """Return the evidence after a pass with an intervention."""
    return min(evidence + st.learning_evidence_gain, st.learning_evidence_accept)


def lowered(st: PldfState, evidence: float) -> float:
    """Return the evidence after a pass without one."""
    return max(evidence - st.learning_evidence_loss, 0.0)


def settle(counter: Counter, i: int, evidence: float) -> None:
    """Leave nothing pending at ``i``: accepted with this evidence, with 0 forgotten."""
    counter[EVIDENCE][i] = evidence
    counter[PENDING][i] = 0.0
    counter[MEAN][i] = 0.0


def copy_evidence(known: ProfileArrays | NextArrays, kept: ProfileArrays | NextArrays) -> None:
    """Copy evidence and pending demonstrations of both signs, by pedals and lever."""
    for sign in (FASTER, SLOWER):
        for i in range(len(known.evidence_faster)):
            copy_counter(of_pedals(known, sign), of_pedals(kept, sign), i)
            copy_counter(of_lever(known, sign), of_lever(kept, sign), i)


def copy_counter(known: Counter, kept: Counter, i: int) -> None:
    """Copy what a counter says of ``i``."""
    kept[EVIDENCE][i] = known[EVIDENCE][i]
    kept[PENDING][i] = known[PENDING][i]
    kept[MEAN][i] = known[MEAN][i]
