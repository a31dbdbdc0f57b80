"""The driver's words between steps: answered at once, and kept as iterations at the end.

The kernel hears a press (``kernel/teach.py``) and changes what is in force
(``kernel/last_word.py``). What it cannot know is the history in the file.
``build/runtime/words.c`` does the same.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from .kernel.arrays import NextArrays, ProfileArrays, RouteArrays, TraceArrays, Work
from .kernel.codes import INPUT_OK, WORD_FORGET, WORD_UNDO
from .kernel.last_word import forget_here, take_back_lesson
from .kernel.state import PldfState
from .kernel.undo import mark_lesson
from .profiles.learned_columns import LEARNED, fill
from .profiles.lessons import UNDO_NOTE, lessons_in_force
from .profiles.stored_profile import Iteration, StoredProfile

# Printf formats, the same in the native FMUs. Those of answers stand behind the time.
WORD_TEXTS: Final = {
    "WORD_FORGOTTEN": "what was learned here (%d m) is forgotten",
    "WORD_NOTHING_TO_FORGET": "nothing is learned here (%d m): nothing to forget",
    "WORD_UNDONE": "what iteration %d taught is taken back",
    "WORD_NOTHING_TO_UNDO": "nothing that was taught is in force: nothing to undo",
    "WORDS_SAVED": "words of the driver: %d",
    "FORGET_NOTE": "forget at %d m",
    "UNDO_NOTE": UNDO_NOTE,
}


class Driven(NamedTuple):
    """The arrays of an instance that drives."""

    route: RouteArrays
    profile: ProfileArrays
    trace: TraceArrays
    work: Work
    following: NextArrays


def answer(st: PldfState, arrays: Driven, stored: StoredProfile | None) -> list[str]:
    """Do what the last step heard; return what to tell about it."""
    wanted, st.teach_wanted = st.teach_wanted, 0
    told = []
    if wanted & WORD_FORGET:
        words = st.words
        forget_here(st, *arrays)
        name = "WORD_FORGOTTEN" if st.words > words else "WORD_NOTHING_TO_FORGET"
        told.append(WORD_TEXTS[name] % int(st.s_m))
    if wanted & WORD_UNDO:
        number = lesson_to_undo(st, arrays.trace, stored)
        undo(st, arrays, stored, number)
        told.append(
            WORD_TEXTS["WORD_UNDONE"] % number if number else WORD_TEXTS["WORD_NOTHING_TO_UNDO"]
        )
    return told


def lesson_to_undo(st: PldfState, trace: TraceArrays, stored: StoredProfile | None) -> int:
    """Return the number of the newest iteration of ``stored`` that taught and is in force, or 0."""
    if stored is None or not st.apply_learned or st.words >= len(trace.word_kind):
        return 0
    undone = [int(trace.word_at[k]) for k in range(st.words) if trace.word_kind[k] == WORD_UNDO]
    return next(lessons_in_force(stored, undone), 0)


def undo(st: PldfState, arrays: Driven, stored: StoredProfile | None, number: int) -> None:
    """Take back iteration ``number`` of ``stored``, in force at once; 0: there is nothing to."""
    st.taken_back = number
    if stored is not None and number > 0:
        fill(arrays.following, stored.iteration(number))
        mark_lesson(arrays.profile, arrays.following, arrays.work, number)
        fill(arrays.following, stored.iteration(number - 1))
    take_back_lesson(st, *arrays)


def keep_words(st: PldfState, arrays: Driven, stored: StoredProfile) -> StoredProfile:
    """Return ``stored`` with an iteration for each word of the drive.

    All words are said again, on what the drive began with: so what is kept is what was in force
    behind each, to the bit. ``arrays`` must hold that, and in the trace the words; they end as they
    were at the end of the drive. ``st`` is overwritten.
    """
    said = [(int(arrays.trace.word_kind[k]), arrays.trace.word_at[k]) for k in range(st.words)]
    st.words, st.input_state = 0, INPUT_OK
    st.nodes = st.drive_interventions = 0  # nothing recorded is barred a second time
    kept = stored
    for kind, at in said:
        if kind == WORD_UNDO and 0 < at <= len(stored.iterations):
            undo(st, arrays, stored, int(at))
            kept = kept.with_iteration(_word(kept, arrays, "undo", UNDO_NOTE % int(at)))
        elif kind == WORD_FORGET:
            st.s_m = at
            forget_here(st, *arrays)
            kept = kept.with_iteration(
                _word(kept, arrays, "forget", WORD_TEXTS["FORGET_NOTE"] % int(at))
            )
    return kept


def _word(kept: StoredProfile, arrays: Driven, kind: str, note: str) -> Iteration:
    columns = {name: np.array(getattr(arrays.profile, name)) for name in LEARNED}
    return kept.next_iteration(
        kind, note, 0, {"base_mps": np.array(arrays.profile.base_mps), **columns}
    )
