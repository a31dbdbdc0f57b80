"""Questionnaires from a file: the packaged ones are as printed, and every problem is told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pldf.analysis.questionnaires.labels import _ENDS
from pldf.analysis.questionnaires.scales import LAAN, PROFILE, asked_by
from pldf.cockpit.problems import Problems
from pldf.cockpit.questionnaires import PACKAGED, Asked, read_questionnaires
from pldf.errors import ModelError
from pldf.study.phases import PHASES
from pldf.toml_file import TomlFile, shown

Item = dict[str, object]


def read(path: Path, ask: dict[str, object]) -> list[dict[str, Any]]:
    """Read for a study file beside it, which says when to ask what."""
    study = path.with_name("study.toml") if path != PACKAGED else PACKAGED
    if path != PACKAGED:
        lines = [f"{name} = {shown(after)}\n" for name, after in ask.items()]
        study.write_text("".join(["[cockpit.ask]\n", *lines]), encoding="utf-8")
    problems = Problems()
    found = read_questionnaires(path, Asked(TomlFile(study), ask, list(PHASES)), problems)
    problems.finish()
    return found


def packaged() -> dict[str, list[Item]]:
    everything = {"ssq": ["start"], "nasa_tlx": ["A", "B"]}
    return {one["id"]: one["items"] for one in read(PACKAGED, everything)}


def written(folder: Path, text: str) -> Path:
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_acceptance_scale_is_as_it_is_scored() -> None:
    items = packaged()["acceptance"]
    assert tuple(item["id"] for item in items) == LAAN
    for item in items:
        assert (item["kind"], item["boxes"], item["required"]) == ("scale", 5, True)
        for side, known in zip(("left", "right"), _ENDS[str(item["id"])], strict=True):
            words = item[side]
            assert isinstance(words, dict)
            assert {words["en"], words["de"]} <= set(known)


def test_the_items_on_the_speed_profile_make_one_scale() -> None:
    asked = [asked_by(str(item["id"])) for item in packaged()["speed_profile"]]
    assert tuple(one.item for one in asked if one) == PROFILE
    assert any(one.turned for one in asked if one)


def test_the_optional_ones_are_whole() -> None:
    found = packaged()
    assert len(found["ssq"]) == 16
    assert [option["key"] for option in found["ssq"][0]["options"]] == ["0", "1", "2", "3"]  # type: ignore[attr-defined]
    assert [item["boxes"] for item in found["nasa_tlx"]] == [21] * 6
    usual = [one["id"] for one in read(PACKAGED, {})]
    assert usual == ["acceptance", "speed_profile", "remarks"]


def test_every_text_is_in_both_languages() -> None:
    for items in packaged().values():
        for item in items:
            for words in (item["text"], item["left"], item["right"]):
                assert isinstance(words, dict)
                assert bool(words["en"]) == bool(words["de"])


MINE = """
include = ["acceptance"]

[about]
title = "About you"
after = ["start"]

[about.items]
licence = { kind = "choice", text = { en = "Driving licence?", de = "Führerschein?" }, options = [
    { key = "yes", en = "yes", de = "ja" }, { key = "no", de = "nein" } ] }
years = { kind="number", text="?", low = 0, high = 80, only_if = { id = "licence", is = ["yes"] } }
more = { kind = "text", text = "More?", required = false }
"""


def test_a_file_of_ones_own(tmp_path: Path) -> None:
    first, about = read(written(tmp_path, MINE), {"about": ["end"], "ssq": ["B2"]})[:2]
    assert first["id"] == "acceptance"
    assert (about["after"], about["title"]) == (["end"], {"en": "About you", "de": "About you"})
    licence, years, more = about["items"]
    assert licence["options"][1] == {"key": "no", "text": {"en": "nein", "de": "nein"}}
    assert years["only_if"] == {"id": "licence", "is": ["yes"]}
    assert (years["low"], years["high"]) == (0.0, 80.0)
    assert (more["required"], more["only_if"]) == (False, None)


WRONG = """
include = ["acceptance", "acceptence"]
loose = 3

[Bad-Name]
title = "x"
after = ["start"]
[Bad-Name.items]
a = { kind = "text", text = "?" }

[mine]
after = ["A1", "later"]
colour = "red"
[mine.items]
b = { kind = "slider", text = "?" }
c = { kind = "choice", text = "?" }
d = { kind = "number", text = "?", low = 3, high = 1 }
e = { kind = "text" }
phase = { kind = "text", text = "?" }
f = { kind = "text", text = "?", only_if = { id = "g", is = ["1"] } }
g = { boxes = 1 }
h = 3
j = { text = { fr = "?" } }
k = { left = { en = 1 } }
l = { boxes = 7 }
laan_1 = { boxes = 7 }
i = { kind = "choice", text = "?", options = [{ key = "1" }, { key = "1" }] }

[half]
title = "x"
after = ["end"]
[half.items]
profile_1 = { text = "?" }
[untitled]
after = ["A"]
[untitled.items]
m = { kind = "choice", text = "?", options = [{ en = "?" }] }
[none]
title = "x"
after = ["later"]
"""


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    path = written(tmp_path, WRONG)
    with pytest.raises(ModelError) as refused:
        read(path, {"missing": ["A"], "half": "B"})
    told = str(refused.value).splitlines()
    beside = path.with_name("study.toml")
    assert all(line.startswith((f"{path}, line ", f"{beside}, line ")) for line in told)
    text = "\n".join(told)
    for problem in (
        'my.toml, line 2, include: ["acceptance", "acceptence"] must be a list out of "acceptance"',
        "study.toml, line 2, cockpit.ask.missing: unknown; ",
        'study.toml, line 3, cockpit.ask.half: "B" must be a list out of',
        "line 3, loose: unknown; write [loose]",
        "line 5, Bad-Name: as a name:",
        "colour: unknown",
        'mine.items.b.kind: "slider" must be one of "choice"',
        "mine.items.c: a choice without options",
        "mine.items.d: low = 3 must be below high = 1",
        "mine.items.e: no text",
        "mine.items.phase: as a name:",
        'mine.items.f: only_if: "g" is no earlier item',
        "mine.items.g.boxes: 1 must be a whole number from 2",
        'mine.items.j.text: { fr = "?" } must be a text in quotes',
        "mine.items.k.left: { en = 1 } must be a text in quotes",
        "mine.items.h: 3 must be a table",
        "mine.items.laan_1: its scale has 5 boxes",
        "mine.items.l: no text",
        "mine.items.i: two options have the same key",
        "profile_5, profile_6 is missing of the scale speed_profile",
        "untitled.title: missing; it is needed",
        "untitled.items.m.options.key: missing; it is needed",
        "none.items: no items",
        'none.after: ["later"] must be a list out of "A1"',
    ):
        assert problem in text, problem


def test_answers_on_the_system_belong_to_drives(tmp_path: Path) -> None:
    path = written(tmp_path, 'include = ["acceptance"]\n')
    with pytest.raises(ModelError, match="answers on the system belong to drives"):
        read(path, {"acceptance": ["end"]})


def test_one_column_for_two_items(tmp_path: Path) -> None:
    text = 'include = ["remarks"]\n[mine]\ntitle = "x"\nafter = ["end"]\n[mine.items]\n'
    path = written(tmp_path, text + 'remarks = { kind = "text", text = "?" }\n')
    with pytest.raises(ModelError, match=r"mine.items.remarks: an item of \[remarks\], too"):
        read(path, {})
