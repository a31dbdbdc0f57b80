"""Participants, questionnaires, drives and exclusions: as ``judged_kinds``."""

from __future__ import annotations

import random
import re
from math import isnan, nan
from pathlib import Path
from typing import Final

from pldf.analysis.drives_table import missing, read_drives, repeated
from pldf.analysis.exclusions import Exclusions, read_exclusions
from pldf.analysis.problems import StudyError
from pldf.analysis.questionnaires import read_questionnaire
from pldf.findings import Finding
from pldf.study.participants_file import read_participants

from .judged_kinds import Answer, Kind, Values, notes, texts
from .sheets import Sheet, Unclear

# Participants: by their numbers; an absent parameter keeps its default.

_DRIVER: Final = ("wish.offset_mps", "driver.reaction_s", "driver.uses_lever")


def _participants_sheet(chance: random.Random) -> Sheet:
    n = 12
    rows = texts(
        [f"P{at + 1:03d}" for at in range(n)],
        [chance.randrange(1, 99999) for _ in range(n)],
        [round(chance.uniform(-3, 3), 3) for _ in range(n)],
        [round(chance.uniform(0.5, 2.0), 2) for _ in range(n)],
        [chance.randrange(2) for _ in range(n)],
    )
    return Sheet(["participant", "seed", *_DRIVER], rows)


def _read_participants(path: Path) -> Answer:
    told: list[Finding] = []
    people = read_participants(path, told)
    values: Values = {
        "participant": [p.id for p in people],
        "seed": [float(p.seed) for p in people],
    }
    for name in _DRIVER:
        field = name.replace(".", "_")
        if all(field in person.values for person in people):
            values[name] = [float(person.values[field]) for person in people]
    return Answer(values, " ".join(map(str, told)))


def _judge_participants(columns: Values) -> Values:
    seeds = columns["seed"]
    names = columns.setdefault("participant", [f"P{n + 1:03d}" for n in range(len(seeds))])
    if len(set(names)) < len(names):
        raise Unclear("somebody twice")
    if any(not (name[:1] == "P" and name[1:].isascii() and name[1:].isdecimal()) for name in names):
        raise Unclear("no name")
    order = sorted(range(len(names)), key=lambda row: int(names[row][1:]))
    return {name: [cells[row] for row in order] for name, cells in columns.items()}


# Questionnaires: 3 minus the box where the favourable word stands left, box minus 3 where right.

_ITEMS: Final = tuple(f"laan_{n}" for n in range(1, 10))


def _questionnaire_sheet(chance: random.Random) -> Sheet:
    who = [(f"P{n:03d}", system) for n in range(1, 13) for system in "AB"]
    items = ([chance.randint(1, 5) for _ in who] for _ in _ITEMS)
    people, systems = zip(*who, strict=True)
    return Sheet(["participant", "system", *_ITEMS], texts(people, systems, *items))


def _read_questionnaire(path: Path) -> Answer:
    answers = read_questionnaire(path)
    values = {
        item: sorted((who, system, value) for (who, system), value in given.items())
        for item, given in answers.items.items()
    }
    return Answer(values, notes(answers))


def _judge_questionnaire(columns: Values) -> Values:
    keys = [
        (who, s.upper()) for who, s in zip(columns["participant"], columns["system"], strict=True)
    ]
    if len(set(keys)) < len(keys) or any(not who or s not in ("A", "B") for who, s in keys):
        raise Unclear("who answered after which drives")
    values = {}
    for item in _ITEMS:
        boxes = columns[item]
        if any(not isnan(box) and box not in (1, 2, 3, 4, 5) for box in boxes):
            raise Unclear("no box")
        right = item in ("laan_3", "laan_6", "laan_8")
        scored = [box - 3.0 if right else 3.0 - box for box in boxes]
        given = [(*key, value) for key, value in zip(keys, scored, strict=True)]
        values[item] = sorted(one for one in given if not isnan(one[-1]))
    return values


# Tables of drives: one row per participant and phase, shares of the time.

_RATES: Final = ("pedal_rate", "set_speed_rate", "combined_rate")
_ROUNDED: Final = 0.015  # of three shares with two decimals
_PHASES: Final = ("A1", "A2", "B1", "B2")


def _drives_sheet(chance: random.Random) -> Sheet:
    who = [(f"P{n:03d}", phase) for n in range(1, 9) for phase in _PHASES]
    rates = [sorted(round(chance.uniform(0, 0.5), 4) for _ in range(2)) for _ in who]
    rows = texts(
        *zip(*who, strict=True),
        [f"{chance.uniform(900, 2000):.1f}" for _ in who],
        *([rate[at] for rate in rates] for at in (0, 1)),
        [min(1.0, round(sum(rate), 4)) for rate in rates],
        [chance.randrange(9) for _ in who],
    )
    return Sheet(["participant", "phase", "duration_s", *_RATES, "interventions"], rows)


def _read_drives(path: Path) -> Answer:
    told: list[Finding] = []
    drives = read_drives(path, None, told)
    driven = [(drive.participant, drive.phase) for drive in drives]
    wrong = [*repeated(drives), *missing(driven, _PHASES, str(path), Exclusions())]
    if wrong:
        raise StudyError(wrong)
    names = ("duration_s", *_RATES, "interventions")
    rates = {
        n: sorted((d.participant, d.phase, float(getattr(d, n))) for d in drives) for n in names
    }
    return Answer(rates, " ".join(map(str, told)))


def _judge_drives(columns: Values) -> Values:
    keys = list(zip(columns["participant"], columns["phase"], strict=True))
    everybody = {who for who, _ in keys}
    if len(set(keys)) < len(keys) or not all(everybody):
        raise Unclear("a drive twice, or nobody's")
    if {(who, phase) for who in everybody for phase in _PHASES} - set(keys):
        raise Unclear("a drive is missing")
    for pedal, lever, either in zip(*(columns[rate] for rate in _RATES), strict=True):
        if not (0.0 <= pedal <= 1.0 and 0.0 <= lever <= 1.0):
            raise Unclear("no share")
        if not max(pedal, lever) - _ROUNDED <= either <= min(1.0, pedal + lever) + _ROUNDED:
            raise Unclear("three shares that cannot be of one drive")
    absent = [nan] * len(keys)
    return {
        name: sorted((*key, v) for key, v in zip(keys, columns.get(name, absent), strict=True))
        for name in ("duration_s", *_RATES, "interventions")
    }


# Lists of exclusions: a reason for each; without a phase, all drives of somebody.


def _exclusions_sheet(chance: random.Random) -> Sheet:
    who = [f"P{n:03d}" for n in range(1, 11)]
    drives = [chance.choice((*_PHASES, "")) for _ in who]
    reasons = [chance.choice(("felt sick", "rain, hail; and fog", 'said "no"')) for _ in who]
    return Sheet(["participant", "phase", "reason"], texts(who, drives, reasons))


def _read_exclusions(path: Path) -> Answer:
    exclusions = read_exclusions(path)
    listed = [(one.participant, one.phase, one.reason) for one in exclusions.listed]
    return Answer({"listed": listed}, notes(exclusions))


def _judge_exclusions(columns: Values) -> Values:
    people, reasons = columns["participant"], columns["reason"]
    phases = columns.get("phase", [""] * len(people))
    if not all(people) or not all(reasons):
        raise Unclear("nobody, or no reason")
    if any(not re.fullmatch("([AB][1-9][0-9]*)?", phase) for phase in phases):
        raise Unclear("no phase")
    return {"listed": list(zip(people, phases, reasons, strict=True))}


KINDS: Final = (
    Kind(
        "participants.csv",
        {"participant": "text", "seed": "number", **dict.fromkeys(_DRIVER, "number")},
        ("seed",), _participants_sheet, _read_participants, _judge_participants,
    ),
    Kind(
        "questionnaire.csv",
        {"participant": "text", "system": "text", **dict.fromkeys(_ITEMS, "number")},
        ("participant", "system", *_ITEMS), _questionnaire_sheet, _read_questionnaire,
        _judge_questionnaire,
    ),
    Kind(
        "exclusions.csv", dict.fromkeys(("participant", "phase", "reason"), "text"),
        ("participant", "reason"), _exclusions_sheet, _read_exclusions, _judge_exclusions,
        rows_min=0,
    ),
    Kind(
        "drives.csv",
        {"participant": "text", "phase": "text",
         **dict.fromkeys(("duration_s", *_RATES, "interventions"), "number")},
        ("participant", "phase", *_RATES), _drives_sheet, _read_drives, _judge_drives,
    ),
)  # fmt: skip
