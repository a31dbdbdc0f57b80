"""How findings are said: the gravest first, many of a kind summed up, counted at the end."""

from __future__ import annotations

import pytest
from pldf.commands.shared.telling import counted, listed, tell
from pldf.findings import Finding


def jump(number: int) -> Finding:
    place = f"road {number}, s = {10 * number} m"
    return Finding("note", "town.xodr", 7 + number, place, f"a jump of {0.5 * number:.1f} m")


GRAVE = Finding("warning", "town.xodr", 3, "road '5'", "no limit", "50 km/h", "--default-limit 70")


def test_many_of_a_kind_are_summed_up_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    tell([*(jump(number) for number in range(16)), GRAVE])
    assert capsys.readouterr().err.splitlines() == [
        f"warning: {GRAVE}",
        f"note: {jump(0)}",
        f"note: {jump(1)}",
        "note: 14 more like this; pldf check town.xodr, with the same options, shows all",
    ]


def test_few_of_a_kind_are_all_said(capsys: pytest.CaptureFixture[str]) -> None:
    tell([jump(1), jump(2), jump(3)])
    assert capsys.readouterr().err.count("a jump of") == 3


def test_what_differs_in_more_than_numbers_and_names_is_no_kind() -> None:
    notes = [Finding("note", "a.xodr", 0, "", f"text {word}") for word in ("one", "two", "six")]
    notes += [Finding("note", f"{name}.xodr", 0, "", "text") for name in "bcd"]
    assert counted(notes) == "6 notes"
    assert len([line for line in listed(notes) if line.startswith("note ")]) == 6


def test_the_list_is_as_wide_as_the_summary_and_ends_with_the_count() -> None:
    long = Finding("error", "town.xodr", 4, "road 12, s = 340 m", "what is the matter " * 12)
    lines = list(listed([jump(3), GRAVE, long, GRAVE]))
    assert max(map(len, lines)) <= 96
    assert [line[:12].strip() for line in lines if line[0] != " "][:3] == [
        "error", "warning", "note",
    ]  # fmt: skip
    assert lines[-1] == "1 error, 1 warning, 1 note"  # each once


def test_nothing_is_said_so() -> None:
    assert list(listed([])) == ["nothing to tell"]
