"""The items that are asked, the scales that they form, and how a box is scored.

The acceptance scale is that of Van der Laan, Heino and De Waard, "A simple procedure for the
assessment of acceptance of advanced transport telematics", Transportation Research Part C 5 (1997):
nine pairs of words, five boxes between each, scored from -2 to +2 so that the favourable word is
+2. It stands on the left in items 1, 2, 4, 5, 7 and 9, on the right in items 3, 6 and 8. Usefulness
is the mean of the odd items, satisfying the mean of the even ones.

The six items on the speed profile are the study's own; 5 is full agreement. Their score is the mean
after items worded negatively (``_reversed`` behind the column's name) have been turned round.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

LAAN: Final = tuple(f"laan_{number}" for number in range(1, 10))
PROFILE: Final = tuple(f"profile_{number}" for number in range(1, 7))
REVERSED: Final = "_reversed"
SCALES: Final = {"usefulness": LAAN[0::2], "satisfying": LAAN[1::2], "speed_profile": PROFILE}
BOXES: Final = 5

_FAVOURABLE_RIGHT: Final = ("laan_3", "laan_6", "laan_8")
# profile_3_reversed_B2; survey tools write names in any case.
_NAME: Final = re.compile(
    rf"(laan_[1-9]|profile_[1-6](?={REVERSED}|_|$))({REVERSED})?(?:_([AB][0-9]*))?", re.IGNORECASE
)


class Asked(NamedTuple):
    """What a column asks.

    Attributes:
        item: one of ``LAAN`` and ``PROFILE``.
        turned: it is worded negatively.
        group: system or drive that it asks about; empty if the row says so.
    """

    item: str
    turned: bool
    group: str

    def scored(self, box: float) -> float:
        """Return the score of ``box``, 1 (left) to 5; the favourable answer is the higher one."""
        if self.item in PROFILE:
            return BOXES + 1.0 - box if self.turned else box
        return box - 3.0 if self.item in _FAVOURABLE_RIGHT else 3.0 - box


def asked_by(name: str) -> Asked | None:
    """Return what a column with our ``name`` asks, None if that is no name of an item."""
    found = _NAME.fullmatch(name)
    if not found or (found[2] and found[1].lower() not in PROFILE):
        return None
    return Asked(found[1].lower(), bool(found[2]), (found[3] or "").upper())
