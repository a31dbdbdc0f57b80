"""Modes of the driving function: one table (state, event) -> state (section 2).

An event that means nothing in a state changes nothing. Pedals are events for as long as they are
pressed or released, lever contacts when they close; so the order of events within one step decides
(brake last: it always wins).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from .codes import ACTIVE, FAULT, GAS_OVERRIDE, OFF, STANDBY

SWITCH_OFF: Final = 0
SWITCH_ON: Final = 1
RESUME: Final = 2
CANCEL: Final = 3
GAS_RELEASE: Final = 4
GAS_PRESS: Final = 5
BRAKE_PRESS: Final = 6
LOST: Final = 7  # position off the route, behind its end, or jumping
FAIL: Final = 8  # an input is not a finite number
RECOVER: Final = 9  # inputs have been valid for a while
EVENTS: Final = (
    "SWITCH_OFF",
    "SWITCH_ON",
    "RESUME",
    "CANCEL",
    "GAS_RELEASE",
    "GAS_PRESS",
    "BRAKE_PRESS",
    "LOST",
    "FAIL",
    "RECOVER",
)

_O, _S, _A, _G, _F = OFF, STANDBY, ACTIVE, GAS_OVERRIDE, FAULT

# Row: mode now (OFF, STANDBY, ACTIVE, GAS_OVERRIDE, FAULT). Column: event, in the order of EVENTS.
TRANSITIONS: Final = np.array(
    [
        # off on res can rel gas brk lost fail recover
        [_O, _S, _O, _O, _O, _O, _O, _O, _O, _O],
        [_O, _S, _A, _S, _S, _S, _S, _S, _F, _S],
        [_O, _A, _A, _S, _A, _G, _S, _S, _F, _A],
        [_O, _G, _G, _S, _A, _G, _S, _S, _F, _G],
        [_O, _F, _F, _F, _F, _F, _F, _F, _F, _S],
    ]
)


def next_mode(mode: int, event: int) -> int:
    """Return the mode that ``event`` leads to from ``mode``."""
    # A plain int also in CPython: NumPy's would spread through the record and slow every step down.
    return int(TRANSITIONS[mode, event])
