"""Which lessons of a profile are in force, and what an undo takes back (section 7).

``build/runtime/profile_undo.c`` finds the same.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Final

import numpy as np

from .stored_profile import Iteration, StoredProfile

UNDO_NOTE: Final = "undo of %d"
_NUMBER: Final = re.compile(r"(?:undo|rollback) of ([0-9]{1,9})")


def lessons_in_force(profile: StoredProfile, undone: Collection[int] = ()) -> Iterator[int]:
    """Yield the numbers of the iterations that taught and are in force, the newest first.

    Args:
        profile: with its whole history.
        undone: numbers that were undone since.
    """
    taken_back = set(undone)
    at = len(profile.iterations)
    while at > 0:
        iteration = profile.iteration(at)
        named = number_named(iteration)
        if iteration.kind == "undo":
            taken_back.add(named)
        elif iteration.kind in ("drive", "learn") and at not in taken_back and taught(profile, at):
            yield at
        # A rollback continues an older history; one of which no note tells is passed over.
        at = named if iteration.kind == "rollback" and 0 <= named < at else at - 1


def number_named(iteration: Iteration) -> int:
    """Return which iteration this one undoes or copies; -1: the note does not say."""
    match = _NUMBER.fullmatch(iteration.note)
    return int(match[1]) if match else -1


def taught(profile: StoredProfile, number: int) -> bool:
    """Tell whether iteration ``number`` changed what is driven, by pedal or by lever."""
    iteration, before = profile.iteration(number), profile.iteration(number - 1)
    by_lever = iteration.offset_mps is not before.offset_mps
    return bool(np.any(iteration.drive == number)) or (
        by_lever and bool(np.any(iteration.offset_mps != before.offset_mps))
    )
