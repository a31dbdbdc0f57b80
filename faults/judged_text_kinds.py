"""Study files and OpenDRIVE roads: a sound one, the project's reader, and what it should say.

For study files that is the standard library's TOML and a list of where each key ends up; for roads
its XML (of text that was decoded before) and the length and limits of one straight road.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from pldf.roads import read_route
from pldf.study.study_file import read_study

from . import judged_maps
from .judged_kinds import Answer, Values
from .sheets import Unclear

# By so much the length of a road and of its line may differ.
_ROUNDED_M: Final = 0.5
# More people than that, or repeats, nobody has.
_WHOLE_MAX: Final = 100_000


@dataclass(frozen=True)
class Kind:
    """One kind of text file.

    Attributes:
        name: of its file.
        text: a sound one.
        values: whether numbers are changed, or bytes alone.
        read: the project's reader.
        judge: the decoded text -> what the reader should say; Unclear if nobody knows.
    """

    name: str
    text: str
    values: bool
    read: Callable[[Path], Answer]
    judge: Callable[[str], Values]


STUDY: Final = """\
# A study of three people, M\u00fcller's
title = "Probanden M\u00fcller"
output = "out/small"

[participants]
count = 3
seed = 17
first = 2

[drives]
phases = ["A1", "A2", "B1", "B2"]
order = "fixed"
per_phase = 1
threshold_growth_per_drive = 0.05
step_s = 0.02
through = "kernels"

[road]
route = "study"

[function]
"learning.stretch_factor" = 0.25
"learning.weight" = 0.5

[vehicle]
"body.mass_kg" = 1650.0

[recordings]
participants = ["P002"]
"""


def _read_study(path: Path) -> Answer:
    study = read_study(path)
    settings = study.settings
    return Answer(
        {
            "title": study.title,
            "output": study.out.as_posix(),
            "people": [person.id for person in study.participants],
            "phases": [phase.name for phase in settings.phases],
            "counterbalanced": settings.counterbalanced,
            "growth": settings.threshold_growth_per_drive,
            "step_s": settings.step_s,
            "through": study.through,
            "function": dict(settings.function),
            "vehicle": dict(settings.vehicle),
            "recorded": sorted(settings.recorded),
        }
    )


def _judge_study(text: str) -> Values:
    try:
        file = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise Unclear("no TOML") from None
    known = tomllib.loads(STUDY)
    people, drives = file.get("participants", {}), file.get("drives", {})
    recorded = file.get("recordings", {}).get("participants", [])
    for name, table in file.items():
        if name not in known:
            raise Unclear(f"unknown {name}")
        if isinstance(table, dict) and (extra := set(table) - set(known[name])):
            raise Unclear(f"unknown {extra}")
    if file.get("road", {}).get("route", "study") not in ("study", "0"):
        raise Unclear("another road")
    first, count = people.get("first", 1), people.get("count", 43)
    repeats = drives.get("per_phase", 1)
    if any(
        type(whole) is not int or not 0 < whole < _WHOLE_MAX for whole in (first, count, repeats)
    ):
        raise Unclear("no such number of people")
    phases = drives.get("phases", ["A1", "A2", "A3", "B1", "B2", "B3"])
    if repeats != 1:
        systems = [phase[0] for phase in phases for _ in range(repeats)]
        phases = [f"{s}{systems[: at + 1].count(s)}" for at, s in enumerate(systems)]
    return {
        "title": file.get("title", "study"),
        "output": Path(file.get("output", "out/study")).as_posix(),
        "people": [f"P{first + n:03d}" for n in range(count)],
        "phases": phases,
        "counterbalanced": drives.get("order", "fixed") == "counterbalanced",
        "growth": drives.get("threshold_growth_per_drive", 0.0),
        "step_s": drives.get("step_s", 0.01),
        "through": drives.get("through", "kernels"),
        "function": file.get("function", {}),
        "vehicle": file.get("vehicle", {}),
        "recorded": sorted(recorded),
    }


ROAD: Final = """\
<?xml version="1.0" encoding="UTF-8"?>
<OpenDRIVE>
<header revMajor="1" revMinor="6" name="Stra\u00dfe nach K\u00f6ln" vendor=""/>
<road id="1" length="600.0" junction="-1">
<type s="0" type="rural"><speed max="80" unit="km/h"/></type>
<type s="250.0" type="town"><speed max="50" unit="km/h"/></type>
<planView>
<geometry s="0" x="0.0" y="0.0" hdg="0" length="600.0"><line/></geometry>
</planView>
</road>
</OpenDRIVE>
"""


def _read_road(path: Path) -> Answer:
    route = read_route(path)
    told = " ".join(map(str, getattr(route, "notes", ())))
    limits = [
        [float(s), round(float(v), 9)]
        for s, v in zip(route.s_m, route.speed_limit_mps, strict=True)
    ]
    changes = [b for a, b in zip([[0.0, 0.0], *limits], limits, strict=False) if a[1] != b[1]]
    return Answer({"length_m": route.length_m, "limits": changes}, told)


def _judge_road(text: str) -> Values:
    try:
        text = text[max(text.find("<OpenDRIVE"), 0) :]
        root = ElementTree.fromstring(re.sub(r"(?<=[\s</])\w+:(?=\w)", "", text))  # no prefixes
        (road,) = root.iter("road")
        (plan,) = road.iter("geometry")
        length, line = float(road.attrib["length"]), float(plan.attrib["length"])
        types = [t for t in road.iter("type") if float(t.attrib["s"]) < length]
        speeds = [
            (
                float(t.attrib["s"]),
                float(speed.attrib["max"]),
                speed.attrib.get("unit", "m/s").lower(),
            )
            for t in types
            for speed in t.iter("speed")
        ]
        sound = abs(line - length) <= _ROUNDED_M and float(plan.attrib["s"]) == 0.0
        straight = len(list(plan)) == 1 and plan[0].tag == "line"
        xodr = root.tag == "OpenDRIVE" and len(list(root.iter("planView"))) == 1
        known = {"type", "planView"} >= {element.tag for element in road}
    except (ElementTree.ParseError, KeyError, ValueError):
        raise Unclear("no road") from None
    starts = [s for s, _, _ in speeds]
    fits = starts[:1] == [0.0] and starts == sorted(set(starts)) and len(speeds) == len(types)
    if not (sound and straight and xodr and known and fits):
        raise Unclear("not one straight road")
    in_mps = {"km/h": 1.0 / 3.6, "m/s": 1.0, "mph": 0.44704}
    if any(unit not in in_mps or not 0 < s * in_mps[unit] <= 300 / 3.6 for _, s, unit in speeds):
        raise Unclear("units")
    limits = [[s, round(speed * in_mps[unit], 9)] for s, speed, unit in speeds]
    changes = [b for a, b in zip([[0.0, 0.0], *limits], limits, strict=False) if a[1] != b[1]]
    return {"length_m": length, "limits": changes}


KINDS: Final = (
    Kind("study.toml", STUDY, True, _read_study, _judge_study),
    Kind("map.toml", judged_maps.MAP, True, judged_maps.read, judged_maps.judge),
    Kind("road.xodr", ROAD, False, _read_road, _judge_road),
)
