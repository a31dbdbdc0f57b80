"""What the instrument cluster can say: every reason and event with its sentences.

This is the one table of them. The enumerations ``Reason`` and ``Event``, the sentences of
``hmi.text`` in Python and C, ``resources/hmi_texts.json`` in the FMUs and docs/cluster.md are made
from it. The place in its list is a reason's or event's code, so new ones go to the end.

A sentence takes whole numbers, in the unit that ``hmi.unit`` names: ``{speed}`` the car aims at,
``{base}`` what it would be without lessons, ``{limit}`` in force or ahead, ``{drive}`` that taught
it last. They are the outputs ``hmi.sentence_speed`` and so on. What stands in square brackets is
left out where no such drive is known (0).
"""

from __future__ import annotations

from typing import Final, NamedTuple


class Sentence(NamedTuple):
    """A reason or an event.

    Attributes:
        name: of its code.
        priority: 1 is the most urgent; of what is true at once, the most urgent is said.
        icon: name of a pictogram for it.
        english: sentence.
        german: sentence.
        meaning: when it is said, for people who wire a cluster.
    """

    name: str
    priority: int
    icon: str
    english: str
    german: str
    meaning: str


REASONS: Final = (
    Sentence(
        "LIMIT", 12, "limit",
        "Speed limit {limit}", "Tempolimit {limit}",
        "the car drives at the legal limit",
    ),
    Sentence(
        "CURVE", 9, "curve",
        "{speed} for the curve", "{speed} wegen der Kurve",
        "it slows down for a curve or drives at the curve's speed",
    ),
    Sentence(
        "COASTING_TO_LIMIT", 9, "limit-ahead",
        "{speed}: limit {limit} ahead", "{speed}: Tempolimit {limit} voraus",
        "it slows down for the next sign",
    ),
    Sentence(
        "LEARNED_FASTER", 8, "learned-faster",
        "{speed} instead of {base}: you drove faster here[ in drive {drive}]",
        "{speed} statt {base}: hier fuhren Sie[ in Fahrt {drive}] schneller",
        "pedals taught a higher speed here",
    ),
    Sentence(
        "LEARNED_SLOWER", 8, "learned-slower",
        "{speed} instead of {base}: you drove slower here[ in drive {drive}]",
        "{speed} statt {base}: hier fuhren Sie[ in Fahrt {drive}] langsamer",
        "pedals taught a lower speed here",
    ),
    Sentence(
        "LEARNED_OFFSET", 11, "learned-set-speed",
        "{speed} at limit {limit}: your learned set speed",
        "{speed} bei Tempolimit {limit}: Ihr gelerntes Setztempo",
        "the car drives at the set speed that the lever taught",
    ),
    Sentence(
        "MANUAL_SET", 10, "set-speed",
        "{speed}: set by you", "{speed}: von Ihnen gesetzt",
        "the set speed of the lever holds",
    ),
    Sentence(
        "OVERRIDE", 4, "pedal",
        "You drive: gas pedal", "Sie fahren: Gaspedal",
        "the driver overrides with the gas pedal",
    ),
    Sentence(
        "CAP_CURVE", 7, "curve-bound",
        "{speed} is the most in this curve", "{speed} ist in dieser Kurve das Höchste",
        "what was taught is cut by the lateral acceleration",
    ),
    Sentence(
        "CAP_LEGAL", 7, "limit-bound",
        "{speed} is the most at limit {limit}", "{speed} ist bei Tempolimit {limit} das Höchste",
        "what was taught is cut by the legal limit and its tolerance",
    ),
    Sentence(
        "STANDBY", 3, "standby",
        "You drive; RESUME hands over", "Sie fahren; RESUME übergibt",
        "the function is ready and not active",
    ),
    Sentence(
        "FAULT", 2, "fault",
        "Fault: please drive yourself", "Störung: bitte selbst fahren",
        "inputs cannot be used; the log says which",
    ),
    Sentence(
        "FOLLOWING", 6, "car-ahead",
        "Following the car ahead", "Folgt dem Auto voraus",
        "the car ahead, not the profile, sets the speed",
    ),
    Sentence(
        "OFF", 3, "off",
        "Switched off", "Ausgeschaltet",
        "the main switch is off",
    ),
    Sentence(
        "SLOWING_DOWN", 9, "slower",
        "Slowing down to {speed}", "Bremst auf {speed}",
        "the car is above the speed to drive, or a learned place ends",
    ),
    Sentence(
        "SPEEDING_UP", 9, "faster",
        "Speeding up to {speed}", "Beschleunigt auf {speed}",
        "the car is below the speed to drive, or a higher speed is allowed now",
    ),
    Sentence(
        "TEMPORARY_LIMIT", 7, "temporary-limit",
        "Temporary limit {limit}", "Vorübergehendes Tempolimit {limit}",
        "limit.override_mps is the lowest speed that is asked for",
    ),
    Sentence(
        "HELD", 5, "car-ahead-stands",
        "RESUME or gas to drive on", "Weiter mit RESUME oder Gas",
        "the car stood behind another one too long to drive on by itself",
    ),
)  # fmt: skip

EVENTS: Final = (
    Sentence("NONE", 13, "", "", "", "nothing happened in the last second"),
    Sentence(
        "LEARNED", 4, "learned",
        "Learned from this drive", "Aus dieser Fahrt gelernt",
        "the drive has ended and changed the profile of the next one",
    ),
    Sentence(
        "FORGOTTEN", 4, "forgotten",
        "Forgotten what was learned here", "Vergessen, was hier gelernt war",
        "teach.forget_here put the base profile back",
    ),
    Sentence(
        "NOTHING_TO_FORGET", 4, "nothing",
        "Nothing to forget here", "Hier ist nichts zu vergessen",
        "teach.forget_here, where nothing is known",
    ),
    Sentence(
        "UNDONE", 4, "undone",
        "The last lesson is undone", "Die letzte Lektion ist zurückgenommen",
        "teach.undo took back what this drive recorded, or the newest lesson",
    ),
    Sentence(
        "NOTHING_TO_UNDO", 4, "nothing",
        "Nothing to undo", "Nichts zurückzunehmen",
        "teach.undo, and there is no lesson left",
    ),
    Sentence(
        "PAUSED", 4, "paused",
        "Paused: nothing is learned", "Pause: nichts wird gelernt",
        "teach.pause was set",
    ),
    Sentence(
        "RESUMED", 4, "resumed",
        "The pause is over", "Die Pause ist vorbei",
        "teach.pause was released",
    ),
    Sentence(
        "NEW_LIMIT", 5, "limit",
        "New speed limit: {limit}", "Neues Tempolimit: {limit}",
        "a sign was passed",
    ),
    Sentence(
        "TAKE_OVER", 1, "take-over",
        "Brake now!", "Jetzt bremsen!",
        "following alone may not keep the car from the one ahead",
    ),
)  # fmt: skip

# ``hmi.sentence`` is the code of a reason, or this plus the code of an event.
EVENT_SENTENCES: Final = 100
# Numbers that a sentence can take: each is the output ``hmi.sentence_`` and its name.
NUMBERS: Final = ("speed", "base", "limit", "drive")
