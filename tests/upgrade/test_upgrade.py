"""An upgrade keeps what was promised: names, value references, start values, commands, formats.

What vanished or changed since the newest list (``promised.py``) stands, in backticks, in
CHANGELOG.md above the section of that release. New things may come; they move no others.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from promised import ARCHIVES, FMUS, Facts, Things, commands, formats, variables

HERE = Path(__file__).resolve().parent
CHANGELOG = HERE.parents[1] / "CHANGELOG.md"


def _release(path: Path) -> tuple[int, ...]:
    return tuple(map(int, path.stem.split(".")))


NEWEST = max(HERE.glob("*.json"), key=_release)
PROMISED: dict[str, Things] = json.loads(NEWEST.read_text())


def differences(before: Things, now: Things) -> Iterator[tuple[str, str]]:
    """Yield the name of each thing that an upgrade would not find as it was, and what differs."""
    for name, facts in before.items():
        if name not in now:
            yield name, "is gone"
            continue
        for key in facts.keys() | now[name].keys():
            if not _kept(key, facts.get(key), now[name].get(key)):
                yield name, f"{key} was {facts.get(key)}, is {now[name].get(key)}"
    for name in now.keys() - before.keys():
        if now[name].get("required") and _command(name) in before:
            yield name, "is new and required: command lines of before lack it"


def _kept(key: str, before: Any, now: Any) -> bool:
    if key in ("items", "columns") and before and now:  # codes and places stay, new ones follow
        return bool(now[: len(before)] == before)
    if key == "choices" and before:
        return now is None or set(before) <= set(now)
    if key == "unit" and before is None:
        return now in (None, "1")  # what had no unit is a pure number, and says so now
    return bool(before == now)


def _command(argument: str) -> str:
    return argument.rpartition(" ")[0]


def unnoted(found: Iterator[tuple[str, str]], changelog: str) -> list[str]:
    """Return the differences whose name the changelog does not mention since the newest list."""
    since = changelog.split(f"\n## [{NEWEST.stem}]", maxsplit=1)[0]
    # A command line may go on behind the option that it is about.
    named = [f"{text} " for text in re.findall(r"`([^`]+)`", since)]
    return [
        f"{name} {what}; name `{name}` in CHANGELOG.md, [Unreleased], or undo it"
        for name, what in found
        if not any(text.startswith(f"{name} ") for text in named)
    ]


@pytest.mark.parametrize("name", [name for name in FMUS if name in PROMISED])
@pytest.mark.parametrize("archive", ARCHIVES)
def test_variables_are_those_of_the_last_release(
    name: str, archive: str, fmu_folder: Path, native_folder: Path
) -> None:
    """In Python FMUs and native ones of both versions of FMI; a new one says ``since``."""
    path = (
        fmu_folder if archive == "." else native_folder / archive.removeprefix("native").strip("/")
    )
    before = dict(PROMISED[name])
    if archive != "native/fmi3":
        assert before.pop("time")["causality"] == "independent"  # FMI 3.0 alone has it
    found = differences(before, variables(path / f"{name}.fmu"))
    assert unnoted(found, CHANGELOG.read_text()) == []


@pytest.mark.parametrize("area", ["commands", "formats"])
def test_commands_and_formats_are_those_of_the_last_release(area: str) -> None:
    now = {"commands": commands, "formats": formats}[area]()
    assert unnoted(differences(PROMISED[area], now), CHANGELOG.read_text()) == []


def _without(things: Things, name: str) -> None:
    del things[name]


def _with(facts: Facts, key: str, value: Any) -> None:
    facts[key] = value


def test_what_vanished_or_changed_is_found() -> None:
    """Each kind of change, one by one, and the additions that are free."""
    function, orders = PROMISED["AdaptivePLDF"], PROMISED["commands"]
    changed: Things = copy.deepcopy(function)
    assert list(differences(function, changed)) == []
    _without(changed, "learn_faithful")
    _with(changed["localization"], "items", ["XY", "ARC_LENGTH"])
    _with(changed["learn"], "items", ["OFF", "FAITHFUL", "NEW"])
    _with(changed["time"], "valueReference", "99")
    _with(changed["driver.gas_pedal"], "min", "-1.0")
    _with(changed["driver.brake_pedal"], "displayUnit", "%")
    _with(changed, "new", {"type": "Real"})
    assert sorted(name for name, _ in differences(function, changed)) == [
        "driver.brake_pedal", "driver.gas_pedal", "learn_faithful", "localization", "time",
    ]  # fmt: skip
    changed = copy.deepcopy(orders)
    changed["pldf study --new"] = {"required": False}
    _with(changed["pldf study --fmu"], "choices", ["native", "other", "python"])
    assert list(differences(orders, changed)) == []
    changed["pldf study --new"] = {"required": True}
    changed["pldf new FILE"] = {"required": True}
    _with(changed["pldf analyse --format"], "choices", ["svg"])
    assert sorted(name for name, _ in differences(orders, changed)) == [
        "pldf analyse --format", "pldf study --new",
    ]  # fmt: skip


def test_a_note_names_the_thing_in_the_sections_since_that_release() -> None:
    found = [("pldf learn --out", "is gone"), ("learn", "is gone")]
    since, older = "## [Unreleased]\n\n{}\n", f"\n## [{NEWEST.stem}]\n\n{{}}\n"
    note = "- `pldf learn --out FILE` and `learn` changed"
    assert unnoted(iter(found), since.format(note) + older) == []
    for text in (since + older.format(note), since.format("- learn, `pldf learn`, `learned`")):
        assert len(unnoted(iter(found), text)) == 2
