"""Integer codes shared by kernel, FMI enumerations, recordings and the instrument cluster."""

from __future__ import annotations

from typing import Final

from .sentences import EVENTS, REASONS
from .signals import Enumeration

# Modes of the driving function (algorithm, section 2).
OFF: Final = 0
STANDBY: Final = 1
ACTIVE: Final = 2
GAS_OVERRIDE: Final = 3
FAULT: Final = 4
MODE: Final = Enumeration("Mode", ("OFF", "STANDBY", "ACTIVE", "GAS_OVERRIDE", "FAULT"))

# What the function may learn from a drive.
LEARN_OFF: Final = 0
LEARN_FAITHFUL: Final = 1
LEARN_CONSISTENT: Final = 2
LEARN: Final = Enumeration("Learn", ("OFF", "FAITHFUL", "CONSISTENT"))

# Where the position comes from.
ARC_LENGTH: Final = 0
XY: Final = 1
LOCALIZATION: Final = Enumeration("Localization", ("ARC_LENGTH", "XY"))

# How far the stretching of an intervention may reach back.
STRETCH_RECORDED: Final = 0
STRETCH_CONSTANT_SPEED: Final = 1
STRETCH: Final = Enumeration("Stretch", ("RECORDED", "CONSTANT_SPEED"))

# Why the car drives at this speed (``REASONS`` in sentences).
REASON_LIMIT: Final = 0
REASON_CURVE: Final = 1
REASON_COASTING_TO_LIMIT: Final = 2
REASON_LEARNED_FASTER: Final = 3
REASON_LEARNED_SLOWER: Final = 4
REASON_LEARNED_OFFSET: Final = 5
REASON_MANUAL_SET: Final = 6
REASON_OVERRIDE: Final = 7
REASON_CAP_CURVE: Final = 8
REASON_CAP_LEGAL: Final = 9
REASON_STANDBY: Final = 10
REASON_FAULT: Final = 11
REASON_FOLLOWING: Final = 12
REASON_OFF: Final = 13
REASON_SLOWING_DOWN: Final = 14
REASON_SPEEDING_UP: Final = 15
REASON_TEMPORARY_LIMIT: Final = 16
REASON_HELD: Final = 17
REASON: Final = Enumeration("Reason", tuple(row.name for row in REASONS))

# What just happened, shown for a second (``EVENTS`` in sentences).
EVENT_NONE: Final = 0
EVENT_LEARNED: Final = 1
EVENT_FORGOTTEN: Final = 2
EVENT_NOTHING_TO_FORGET: Final = 3
EVENT_UNDONE: Final = 4
EVENT_NOTHING_TO_UNDO: Final = 5
EVENT_PAUSED: Final = 6
EVENT_RESUMED: Final = 7
EVENT_NEW_LIMIT: Final = 8
EVENT_TAKE_OVER: Final = 9
EVENT: Final = Enumeration("Event", tuple(row.name for row in EVENTS))

# How the cluster speaks.
LANGUAGE_EN: Final = 0
LANGUAGE_DE: Final = 1
LANGUAGE: Final = Enumeration("Language", ("EN", "DE"))
UNIT_KMH: Final = 0
UNIT_MPH: Final = 1
UNIT: Final = Enumeration("SpeedUnit", ("KMH", "MPH"))

# Which bound of section 3.8 cut the learned speed of a node last; kept in profile files.
BOUND_NONE: Final = 0
BOUND_LATERAL_ACCEL: Final = 1
BOUND_LEGAL_LIMIT: Final = 2
BOUND_ACCEL: Final = 3
BOUND_DECEL: Final = 4
BOUND_JERK: Final = 5
BOUND: Final = Enumeration(
    "Bound", ("NONE", "LATERAL_ACCEL", "LEGAL_LIMIT", "ACCEL", "DECEL", "JERK")
)

# What learning made of an intervention, by pedal or by lever.
OUTCOME_NOT_MOVED: Final = 0  # the car moved less than a metre, so there is no place to learn
OUTCOME_LEARNED: Final = 1
OUTCOME_HOLE: Final = 2  # the recording has a hole where it or its stretched piece lies
OUTCOME_STOP: Final = 3  # the car was slower than learning.speed_min_mps: a situation, not a wish
OUTCOME_NOT_ELIGIBLE: Final = 4  # learning was not allowed there
OUTCOME_TAKEN_BACK: Final = 5  # a series of presses that ended where it had begun
OUTCOME_FORGOTTEN: Final = 6  # it began before the driver pressed "forget here", and overlaps that
OUTCOME_UNDONE: Final = 7  # the driver pressed "undo" behind it
OUTCOME_FOLLOWING: Final = 8  # a lead car limited during it
OUTCOME_PENDING: Final = 9  # it waits for more evidence (section 6)
OUTCOME: Final = Enumeration(
    "Outcome",
    (
        "NOT_MOVED",
        "LEARNED",
        "HOLE",
        "STOP",
        "NOT_ELIGIBLE",
        "TAKEN_BACK",
        "FORGOTTEN",
        "UNDONE",
        "FOLLOWING",
        "PENDING",
    ),
)

# What the driver said, and the bits of what the runtime has to answer (section 7).
WORD_FORGET: Final = 1
WORD_UNDO: Final = 2
WORDS_MAX: Final = 3  # both at once

# What became of the evidence of a place in a drive (section 6), and whose it is.
EVIDENCE_SAME: Final = 0
EVIDENCE_GAINED: Final = 1
EVIDENCE_LOST: Final = 2
EVIDENCE_DROPPED: Final = 3  # and with it what was pending
EVIDENCE_ACCEPTED: Final = 4
EVIDENCE_PUT_BACK: Final = 5  # what had been accepted
EVIDENCE_CHANGE: Final = Enumeration(
    "EvidenceChange", ("SAME", "GAINED", "LOST", "DROPPED", "ACCEPTED", "PUT_BACK")
)
BY_PEDALS: Final = 0
BY_LEVER: Final = 1
EVIDENCE_BY: Final = Enumeration("EvidenceBy", ("PEDALS", "LEVER"))

# What became of the stored profile.
PROFILE_BASE: Final = 0
PROFILE_LOADED: Final = 1
PROFILE_REFUSED: Final = 2
PROFILE_NOT_PERSISTED: Final = 3
PROFILE_NOT_WRITABLE: Final = 4
PROFILE_STATUS: Final = Enumeration(
    "ProfileStatus", ("BASE", "LOADED", "REFUSED", "NOT_PERSISTED", "NOT_WRITABLE")
)

# How far the recording of this drive is.
LAP_RECORDED: Final = 0
LAP_ARRIVED: Final = 1  # at the road's end: nothing behind it belongs to the drive
LAP_SET_BACK: Final = 2  # the car was set back without a reset: what follows is another drive
LAP_BEGUN_ANEW: Final = 3  # it was set back before the function had ever been active: recorded
LAP: Final = Enumeration("Lap", ("RECORDED", "ARRIVED", "SET_BACK", "BEGUN_ANEW"))

# Why the position or an input was not accepted in the last step (0: it was).
INPUT_OK: Final = 0
INPUT_INVALID: Final = 1
OFF_ROUTE: Final = 2
POSITION_JUMP: Final = 3
INPUT_STATE: Final = Enumeration("InputState", ("OK", "INVALID", "OFF_ROUTE", "POSITION_JUMP"))
