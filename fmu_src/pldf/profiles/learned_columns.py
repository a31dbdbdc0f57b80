"""What of an iteration the kernel knows: into its arrays before a drive, out of them after it."""

from __future__ import annotations

from typing import Final

import numpy as np

from ..kernel.arrays import NextArrays, ProfileArrays
from ..kernel.state import PldfState
from .stored_profile import COLUMN_NAMES, Iteration, StoredProfile

# What a drive leaves for the next one and a file keeps of it.
LEARNED: Final = tuple(name for name in NextArrays._fields if name in COLUMN_NAMES)


def fill(to: ProfileArrays | NextArrays, iteration: Iteration) -> None:
    """Copy the columns of ``iteration`` that the kernel knows."""
    for name in LEARNED:
        np.asarray(getattr(to, name))[:] = getattr(iteration, name)


def next_iteration(
    st: PldfState,
    profile: ProfileArrays,
    following: NextArrays,
    stored: StoredProfile,
    kind: str = "drive",
) -> Iteration:
    """Return what a finished drive leaves behind as the next iteration of ``stored``.

    What the kernel does not know yet is carried over from the iteration that the drive followed.
    """
    truncated = ", last intervention truncated" if st.intervening else ""
    columns = {name: np.array(getattr(following, name)) for name in LEARNED}
    return stored.next_iteration(
        kind,
        f"drive{truncated}",
        st.drive_interventions,
        {"base_mps": np.array(profile.base_mps), **columns},
        after=None if st.apply_learned else 0,
    )
