"""Taking back one iteration of a profile, whatever came behind it (section 7).

Only what still is as that iteration left it goes back to what was before it. What was forgotten or
learned since stays. Pedal lessons name their iteration (``drive``); offsets and evidence do not, so
their values are compared.
"""

from __future__ import annotations

from .arrays import NextArrays, ProfileArrays, Work
from .evidence import (
    EVIDENCE,
    FASTER,
    MEAN,
    PENDING,
    SLOWER,
    Counter,
    copy_counter,
    of_lever,
    of_pedals,
)


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
        work.c[i] = _is_as_left(of_pedals(profile, FASTER), of_pedals(following, FASTER), i)
        work.d[i] = _is_as_left(of_pedals(profile, SLOWER), of_pedals(following, SLOWER), i)
        work.e[i] = _is_as_left(of_lever(profile, FASTER), of_lever(following, FASTER), i)
        work.f[i] = _is_as_left(of_lever(profile, SLOWER), of_lever(following, SLOWER), i)


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
            copy_counter(of_pedals(profile, FASTER), of_pedals(following, FASTER), i)
        if work.d[i] <= 0.0:
            copy_counter(of_pedals(profile, SLOWER), of_pedals(following, SLOWER), i)
        if work.e[i] <= 0.0:
            copy_counter(of_lever(profile, FASTER), of_lever(following, FASTER), i)
        if work.f[i] <= 0.0:
            copy_counter(of_lever(profile, SLOWER), of_lever(following, SLOWER), i)


def _is_as_left(one: Counter, other: Counter, i: int) -> float:
    same = one[EVIDENCE][i] == other[EVIDENCE][i] and one[PENDING][i] == other[PENDING][i]
    return 1.0 if same and one[MEAN][i] == other[MEAN][i] else 0.0
