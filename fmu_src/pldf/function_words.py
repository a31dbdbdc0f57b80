"""What the driving function says of its inputs and its profiles, native or not."""

from __future__ import annotations

from typing import Final

from .instance import Watch
from .kernel.codes import (
    INPUT_INVALID,
    INPUT_OK,
    LAP_ARRIVED,
    LAP_BEGUN_ANEW,
    LAP_RECORDED,
    LAP_SET_BACK,
    OFF_ROUTE,
    POSITION_JUMP,
)
from .profiles.store import STORE_VARIABLE

INPUT_TEXT: Final = {
    INPUT_OK: "inputs are valid again",
    INPUT_INVALID: "an input is not a finite, plausible number: mode FAULT, safe request",
    OFF_ROUTE: "the vehicle is off the route: function inactive",
    POSITION_JUMP: "the position jumped: function inactive until it is reactivated",
}

LAP_TEXT: Final = {
    LAP_RECORDED: "the drive is recorded",
    LAP_ARRIVED: "the road's end: nothing behind it is recorded, learned or counted in the rates",
    LAP_SET_BACK: "the car was set back without a reset: the drive so far is learned when it is "
    "terminated, what follows is not; reset the function, or make a new instance, for a new drive",
    LAP_BEGUN_ANEW: "the car was set back before the function was active: the drive begins here",
}

# What the user is told about while driving.
WATCHES: Final = (
    Watch("input_state", tuple(INPUT_TEXT[code] for code in sorted(INPUT_TEXT))),
    Watch(
        "lap",
        tuple(LAP_TEXT[code] for code in sorted(LAP_TEXT)),
        quiet=(LAP_RECORDED, LAP_ARRIVED, LAP_BEGUN_ANEW),
    ),
)

NO_STORE: Final = (
    "no profile store: nothing is loaded or saved. Set the parameter profile_store or the "
    f"environment variable {STORE_VARIABLE} to a folder."
)

KEPT_BESIDE: Final = (
    "it is left as it is; the drive goes on with the base profile, and what it teaches is kept in "
    "a file of its own"
)

# A printf format, the same in the native FMUs: file, metres, file.
OLDER_READING: Final = (
    "%s was probably learned on an older reading of this road (%d of 100 m have the same base "
    "speed); the drive goes on with the base profile, and that file is left as it is. To carry "
    "over what was learned: pldf profiles move %s --route ROAD, with the road's file and options"
)
