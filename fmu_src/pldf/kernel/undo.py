"""Taking back one iteration of a profile, whatever came behind it (section 7).

Only what still is as that iteration left it goes back to what was before it. What was forgotten or
learned since stays. Pedal lessons name their iteration (``drive``); offsets and evidence do not, so
their values are compared.
"""

from __future__ import annotations

from .arrays import Floats, NextArrays, ProfileArrays, Work

# Evidence, number of pending demonstrations and their mean, of one sign.
Waiting = tuple[Floats, Floats, Floats]


def mark_lesson(profile: ProfileArrays, following: NextArrays, work: Work, number: int) -> None:
    """Mark where ``profile`` still is as iteration ``number`` left it.

    Args:
        profile: what is known now.
        following: what was known behind that iteration.
        work: filled with 1 where it is the same, else 0. Per node a: pedal lesson, c and d:
            evidence for faster and slower; per cell b: offset, e and f: evidence of the lever.
        number: of the iteration.
    """
    for i in range(len(work.a)):
        work.a[i] = 1.0 if profile.drive[i] == number else 0.0
        work.b[i] = 1.0 if profile.offset_mps[i] == following.offset_mps[i] else 0.0
        work.c[i] = _is_as_left(_waits_faster(profile), _waits_faster(following), i)
        work.d[i] = _is_as_left(_waits_slower(profile), _waits_slower(following), i)
        work.e[i] = _is_as_left(_lever_faster(profile), _lever_faster(following), i)
        work.f[i] = _is_as_left(_lever_slower(profile), _lever_slower(following), i)


def merge_before(profile: ProfileArrays, following: NextArrays, work: Work) -> None:
    """Fill ``following`` with what is known without the iteration.

    Args:
        profile: what is known now.
        following: what was known before the iteration; it stays where ``work`` marks it.
        work: as ``mark_lesson`` fills it.
    """
    for i in range(len(work.a)):
        if work.a[i] <= 0.0:
            following.learned_mps[i] = profile.learned_mps[i]
            following.drive[i] = profile.drive[i]
            following.intervention[i] = profile.intervention[i]
            following.lessons[i] = profile.lessons[i]
            following.bound[i] = profile.bound[i]
        elif following.drive[i] == 0.0:
            # Never taught before: the base profile of today, whose parameters may be others.
            following.learned_mps[i] = profile.base_mps[i]
        if work.b[i] <= 0.0:
            following.offset_mps[i] = profile.offset_mps[i]
        if work.c[i] <= 0.0:
            _copy_waiting(_waits_faster(profile), _waits_faster(following), i)
        if work.d[i] <= 0.0:
            _copy_waiting(_waits_slower(profile), _waits_slower(following), i)
        if work.e[i] <= 0.0:
            _copy_waiting(_lever_faster(profile), _lever_faster(following), i)
        if work.f[i] <= 0.0:
            _copy_waiting(_lever_slower(profile), _lever_slower(following), i)


def _waits_faster(of: ProfileArrays | NextArrays) -> Waiting:
    return of.evidence_faster, of.pending_faster, of.pending_faster_mps


def _waits_slower(of: ProfileArrays | NextArrays) -> Waiting:
    return of.evidence_slower, of.pending_slower, of.pending_slower_mps


def _lever_faster(of: ProfileArrays | NextArrays) -> Waiting:
    return of.offset_evidence_faster, of.offset_pending_faster, of.offset_pending_faster_mps


def _lever_slower(of: ProfileArrays | NextArrays) -> Waiting:
    return of.offset_evidence_slower, of.offset_pending_slower, of.offset_pending_slower_mps


def _is_as_left(one: Waiting, other: Waiting, i: int) -> float:
    same = one[0][i] == other[0][i] and one[1][i] == other[1][i] and one[2][i] == other[2][i]
    return 1.0 if same else 0.0


def _copy_waiting(source: Waiting, to: Waiting, i: int) -> None:
    to[0][i] = source[0][i]
    to[1][i] = source[1][i]
    to[2][i] = source[2][i]
